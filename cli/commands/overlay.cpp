#include <fmt/format.h>

#include <algorithm>
#include <memory>
#include <string>
#include <utility>

#include "change/sheet_text.hpp"
#include "change/text_edit.hpp"
#include "commands/commands.hpp"
#include "load/load_device.hpp"
#include "overlay/compose_overlay.hpp"
#include "overlay/derive_overlay.hpp"
#include "overlay/overlay_file.hpp"
#include "shared/common_options.hpp"
#include "shared/define_command.hpp"
#include "shared/exit_code.hpp"
#include "shared/output.hpp"
#include "system/path.hpp"
#include "text/printable.hpp"
#include "text/source_file.hpp"
#include "xdd/read_xdd.hpp"

namespace edsc {
namespace {

constexpr const char* examples = R"(Examples:
  edsc check epos4.overlay                                      every command reads an overlay in place of an EDS
  edsc overlay apply epos4.overlay -o epos4.eds                 the corrected EDS, for other tools
  edsc overlay from vendor.eds corrected.eds -o epos4.overlay   an overlay of the differences of an edited copy
  edsc overlay rebase epos4.overlay new.eds -o epos4.overlay    the overlay for a new file of the vendor)"
#ifndef EDSC_OFFLINE
                                 R"(
  edsc overlay from-bus socketcan:can0 5 epos4.eds -o epos4.overlay   what the device shows that its EDS does not)"
#endif
    ;

struct ApplySettings {
  std::string path;
  std::string output;
  bool utf8 = false;
  ColorOption color;
};

std::shared_ptr<const SourceFile> read_or_fail(const std::string& path, const ReadingChoices& choices = {}) {
  std::string error;
  std::shared_ptr<const SourceFile> file = read_source_file(path, error, choices);
  if (!file) fail(error);
  return file;
}

/// The bytes of the base, with the changes of all overlays.
EditedBytes result_bytes(const ComposedOverlay& composed, bool allow_utf8) {
  const SourceFile& base = *composed.parts.back();
  const bool is_converted = is_xml(base);
  EditedBytes result;
  result.bytes =
      is_converted ? std::string{text_of_base(composed.parts.back())->text()} : read_bytes(composed.base_path).bytes;
  const Encoding encoding = is_converted ? Encoding::utf8 : base.encoding();
  for (const std::vector<TextEdit>& edits : composed.edits) {
    result = edited_bytes(result.bytes, encoding, edits, allow_utf8);
    if (!result.error.empty()) break;
  }
  return result;
}

int apply(const ApplySettings& settings) {
  Diagnostics diagnostics;
  const ChoicesOfOptions options = choices_beside(settings.path, diagnostics);
  const std::shared_ptr<const SourceFile> overlay = read_or_fail(settings.path);
  ComposedOverlay composed;
  if (is_overlay(*overlay)) {
    composed = compose_overlay(overlay, {{}, false, options.choices}, diagnostics);
  } else {
    diagnostics.error("overlay-file", {overlay.get()}, "missing section [Overlay]");
  }
  print_findings(diagnostics, settings.color);
  if (composed.is_unreadable) return exit_wrong_usage;
  if (diagnostics.errors() > 0) return exit_input_has_errors;
  EditedBytes result = result_bytes(composed, settings.utf8);
  if (!result.error.empty()) fail(fmt::format("{}: {}", composed.base_path, result.error));
  std::vector<std::string> inputs;
  for (const auto& part : composed.parts) inputs.push_back(part->name());
  write_output(settings.output, std::move(result.bytes), inputs);
  return exit_fine;
}

void add_apply_options(Command command, int& exit_code) {
  ApplySettings& settings = define_command(command, "", apply, exit_code);
  command.add_option("FILE", settings.path, "overlay").required();
  command.add_option("--output", settings.output, "EDS or DCF (default: standard output)").check(xdd_name_problem);
  command.add_flag("--utf8", settings.utf8);
  settings.color.add_to(command);
}

struct FromSettings {
  std::string base;
  std::string edited;
  std::string output;
};

/// The text that an overlay is for, read as the options beside the file state it: that of an overlay has the changes.
/// Null after errors.
std::shared_ptr<const SourceFile> read_base(const std::string& path, Diagnostics& diagnostics) {
  const ChoicesOfOptions options = choices_beside(path, diagnostics);
  const std::shared_ptr<const SourceFile> file = read_or_fail(path);
  std::shared_ptr<const SourceFile> text = is_overlay(*file)
                                               ? compose_overlay(file, {{}, false, options.choices}, diagnostics).text
                                               : text_of_base(read_or_fail(path, options.choices));
  return diagnostics.errors() == 0 ? text : nullptr;
}

int from(const FromSettings& settings) {
  Diagnostics ignored;
  const std::shared_ptr<const SourceFile> text = read_base(settings.base, ignored);
  if (!text) fail(settings.base + ": the file has errors; \"edsc check\" lists them");
  const std::shared_ptr<const SourceFile> edited = read_or_fail(settings.edited, text->choices());
  DerivedOverlay derived = derive_overlay(text, *text_of_base(edited), path_from(settings.output, settings.base));
  if (!derived.problem.empty()) {
    print_to_stderr("edsc: {}: an overlay cannot express {}; nothing was written\n", settings.edited, derived.problem);
    return exit_input_has_errors;
  }
  write_output(settings.output, std::move(derived.text), {settings.base, settings.edited});
  return exit_fine;
}

void add_from_options(Command command, int& exit_code) {
  FromSettings& settings = define_command(command, "", from, exit_code);
  command.add_option("BASE", settings.base, "EDS, DCF, XDD, XDC or overlay to correct").required();
  command.add_option("FILE", settings.edited, "edited copy of it").required();
  command.add_option("--output", settings.output, "the overlay (default: standard output)");
}

struct RebaseSettings {
  std::string path;
  std::string base;
  std::string output;
};

constexpr std::string_view state_names[] = {"kept", "obsolete", "stale"};

int rebase(const RebaseSettings& settings) {
  const std::shared_ptr<const SourceFile> file = read_or_fail(settings.path);
  Diagnostics diagnostics;
  const OverlayFile overlay = read_overlay(*file, diagnostics);
  if (!is_overlay(*file) || !overlay.header.base.present) {
    fail(settings.path + ": not an overlay with a Base");
  }
  const std::shared_ptr<const SourceFile> text = read_base(settings.base, diagnostics);
  if (!text) {
    print_findings(diagnostics, {});
    return exit_input_has_errors;
  }
  const std::vector<LineOutcome> outcomes = edits_of(overlay, SheetText{*text}, false, diagnostics).outcomes;
  bool is_stale = false;
  for (const LineOutcome& outcome : outcomes) {
    print_visibly(stdout, "{}:{}: {}: {}\n", file->name(), outcome.line,
                  state_names[static_cast<std::size_t>(outcome.state)], file->line(outcome.line));
    is_stale = is_stale || outcome.state == LineState::stale;
  }
  if (!settings.output.empty()) {
    EditedBytes result =
        rebased_overlay(overlay, read_bytes(settings.path).bytes, outcomes, path_from(settings.output, settings.base));
    write_output(settings.output, std::move(result.bytes), {settings.base});
  }
  return is_stale ? exit_input_has_errors : exit_fine;
}

void add_rebase_options(Command command, int& exit_code) {
  RebaseSettings& settings = define_command(command, "", rebase, exit_code);
  command.add_option("FILE", settings.path, "overlay").required();
  command.add_option("BASE", settings.base, "new version of the file that the overlay corrects").required();
  command.add_option("--output", settings.output,
                     "the overlay, without the obsolete lines; may be FILE (default: only list the lines)");
}

struct OverlayAction {
  const char* name;
  const char* description;
  AddOptions* add_options;
};

constexpr OverlayAction overlay_actions[] = {
    {"apply", "write the EDS or DCF that an overlay results in", add_apply_options},
    {"from", "write an overlay of the differences between a file and an edited copy", add_from_options},
#ifndef EDSC_OFFLINE
    {"from-bus", "write an overlay of what a device shows to be wrong in its file", add_overlay_from_bus_options},
#endif
    {"rebase", "list kept, obsolete and stale lines for a new base, and write the overlay for it", add_rebase_options},
};

}  // namespace

void add_overlay_options(Command command, int& exit_code) {
  command.footer(examples);
  for (const OverlayAction& row : overlay_actions) {
    row.add_options(command.add_subcommand(row.name, row.description), exit_code);
  }
}

}  // namespace edsc
