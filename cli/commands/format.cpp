#include <fmt/format.h>

#include <algorithm>
#include <filesystem>
#include <map>
#include <vector>

#include "commands/commands.hpp"
#include "device/resolve.hpp"
#include "diagnostics/place.hpp"
#include "eds/ini.hpp"
#include "format/canonical_form.hpp"
#include "format/dcf/concise_dcf.hpp"
#include "format/dcf/make_dcf.hpp"
#include "format/dcf/move_values.hpp"
#include "format/sheet_document.hpp"
#include "format/storage_locations.hpp"
#include "load/load_device.hpp"
#include "overlay/compose_overlay.hpp"
#include "overlay/overlay_file.hpp"
#include "rules/check_rules.hpp"
#include "shared/common_options.hpp"
#include "shared/define_command.hpp"
#include "shared/exit_code.hpp"
#include "shared/file_arguments.hpp"
#include "shared/output.hpp"
#include "system/path.hpp"
#include "text/printable.hpp"
#include "text/reading_choices.hpp"
#include "text/source_file.hpp"
#include "xdd/read_xdd.hpp"

namespace edsc {
namespace {

constexpr const char* examples = R"(Examples:
  edsc format drive.eds                                    the canonical form, on standard output
  edsc format drive.eds -o drive.eds                       in place
  edsc format --in-place eds/*.eds                         the same for many files
  edsc format --check eds/*.eds                            exit code 1 when one of them is not canonical
  edsc format drive.eds --dcf --node-id 5 -o axis1.dcf     the DCF of node 5
  edsc format drive.eds --dcf --node-id 5 --all            the same with a ParameterValue for each writable entry
  edsc format axis1.dcf --dcf --node-id 7 -o axis2.dcf     the same configuration for node 7
  edsc format drive.xdd -o drive.eds                       an EDS from an XDD
  edsc format axis1.xdc -o axis1.dcf                       a DCF from an XDC
  edsc format axis1.dcf --concise -o axis1.bin             the concise DCF for a master (object 1F22h)
  edsc format node.eds --write-options node.options.json   the storage groups of an EDS of CANopenNode, as options)";

struct Settings {
  std::vector<std::string> paths;
  std::string output;
  std::string options;
  std::optional<std::uint8_t> node_id;
  bool check = false;
  bool in_place = false;
  bool dcf = false;
  bool all = false;
  bool concise = false;
  bool keep_going = false;
  std::map<std::string_view, std::string> choices;  ///< by option of the options file
  ColorOption color;
};

/// These rules report parts as skipped that remain in the text.
constexpr AnyRule rules_of_what_stays[] = {"unknown-key", "unknown-section"};

/// A data sheet with its lines. Values are not checked here, but by `edsc check`.
struct Input {
  ChoicesOfOptions of_options;
  std::shared_ptr<const SourceFile> file;    ///< as read
  std::shared_ptr<const SourceFile> source;  ///< null if the file itself is an EDS or DCF
  IniFile ini;
  DataSheet sheet;
  Device device;
  bool has_values_for_eds = false;  ///< an XDC, whose values an EDS cannot hold, and an EDS is wanted

  [[nodiscard]] const SourceFile& text() const { return source ? *source : *file; }
};

void read(const Settings& settings, Input& input, Diagnostics& diagnostics) {
  for (const AnyRule rule : rules_of_what_stays) diagnostics.silence(rule);
  input.ini = parse_ini(input.text(), diagnostics);
  if (input.ini.sections.empty()) return;
  input.sheet = read_data_sheet(input.ini, diagnostics);
  Diagnostics ignored;
  input.device = resolve_device(input.sheet, {}, settings.node_id, ignored);
}

/// Converts an XDD to an EDS, an XDC to a DCF. Reports losses as notes.
void convert(const Settings& settings, Input& input, Diagnostics& diagnostics) {
  std::vector<NotInEds> not_in_eds;
  const DataSheet sheet = read_xdd(*input.file, diagnostics, &not_in_eds);
  if (sheet.objects.empty()) return;
  const std::string_view format = sheet.is_dcf ? "DCF" : "EDS";
  for (const NotInEds& lost : not_in_eds) {
    diagnostics.note("xml-element", lost.position,
                     fmt::format("{} cannot be expressed in the {}; ignored", lost.what, format));
  }
  input.has_values_for_eds = sheet.is_dcf && ends_with_ignoring_case(settings.output, ".eds");
  std::filesystem::path path = to_native(settings.output.empty() ? settings.paths.front() : settings.output);
  if (settings.output.empty()) path.replace_extension(sheet.is_dcf ? ".dcf" : ".eds");
  input.source =
      std::make_unique<SourceFile>(sheet.is_dcf && !sheet.commissioning.present ? "converted.dcf" : "converted.eds",
                                   to_text(document_of(sheet, from_native(path.filename()))));
}

std::string canonical_text(const Settings& settings, const Input& input) {
  Document document = canonical_form(input.ini, input.sheet, input.device);
  if (settings.dcf) {
    make_dcf(document, input.sheet, input.device, settings.all ? DcfValues::all : DcfValues::different);
  }
  return to_text(document);
}

/// For another node than that of the DCF, its node-ID-dependent values are first converted.
void move_to_node(const Settings& settings, Input& input, Diagnostics& diagnostics) {
  if (!settings.node_id || !input.sheet.commissioning.present) return;
  Diagnostics ignored;
  const Device before = resolve_device(input.sheet, {}, {}, ignored);
  if (!before.node_id || before.node_id == settings.node_id) return;
  Document document = canonical_form(input.ini, input.sheet, input.device);
  move_values(document, input.sheet, before, *settings.node_id, diagnostics);
  const std::string name = input.text().name();
  input.source = std::make_unique<SourceFile>(name, to_text(document));
  read(settings, input, ignored);
}

/// The bytes of a file: `gzip`, `CP1252`.
std::string_view byte_form(const SourceFile& source) {
  if (source.packing() == Packing::gzip) return "gzip";
  return source.encoding() == Encoding::utf8 ? "UTF-8 with a byte order mark" : to_string(source.encoding());
}

int check(const SourceFile& source, const std::string& text) {
  if (source.is_verbatim() && source.text() == text) return exit_fine;
  if (source.text() == text) {
    print_to_stderr("{}: the file is {}; the canonical form is UTF-8\n", source.name(), byte_form(source));
    return exit_input_has_errors;
  }
  const auto [in_file, in_text] = std::ranges::mismatch(source.text(), text);
  const std::uint32_t line = position_at(source, static_cast<std::size_t>(in_file - source.text().begin())).line;
  print_to_stderr("{}:{}: the canonical form differs from here on\n", source.name(), line);
  return exit_input_has_errors;
}

/// Whether `path` is the file that was read, by any of its names.
bool is_file_of(const SourceFile& source, const std::string& path) {
  std::error_code error;
  return std::filesystem::equivalent(to_native(source.name()), to_native(path), error);
}

void write(const Settings& settings, const SourceFile& source, const std::string& path, std::string content) {
  if (source.packing() == Packing::gzip && is_file_of(source, path)) {
    fail(fmt::format("{}: a gzip file is not replaced by its text; name another file with -o", path));
  }
  if (const std::string problem = xdd_name_problem(path); !problem.empty())
    fail(problem);  // an EDS of this name, in place
  write_output(path, std::move(content));
  const bool is_utf8 = source.encoding() == Encoding::ascii || source.encoding() == Encoding::utf8;
  if (!path.empty() && !is_utf8 && !settings.concise) {
    print_to_stderr("edsc: {}: converted from {} to UTF-8\n", path, to_string(source.encoding()));
  }
}

/// Writes the options file that the comments of CANopenNode result in.
int write_options(const Settings& settings, const std::string& path, const Input& input) {
  const nlohmann::ordered_json options = storage_options(input.ini, input.device, {});
  if (options.is_null()) fail(path + ": no comment ;StorageLocation= in a section of an entry");
  write_output(settings.options, options.dump(2) + "\n", {path});
  return exit_fine;
}

/// The choices of the options file beside the file, replaced by those of the command line.
ReadingChoices choices_for(const Settings& settings, ReadingChoices choices) {
  for (const ReadingChoiceRow& row : reading_choice_rows()) {
    const std::string& value = settings.choices.at(row.option);
    if (!value.empty()) row.set(value, choices);
  }
  return choices;
}

/// Refuses to convert a file by a guess of its encoding, or to leave an options file that is wrong for the result.
void check_conversion(const Settings& settings, const Input& input, const std::string& path) {
  const SourceFile& file = *input.file;
  if (!file.undefined_bytes().empty() && !settings.check) {
    fail(fmt::format("{}: {}; nothing is converted: --encoding names the encoding", path, undefined_bytes_text(file)),
         exit_input_has_errors);
  }
  const bool replaces = settings.in_place || (!settings.output.empty() && is_file_of(file, settings.output));
  if (!replaces) return;
  if (file.is_encoding_guessed()) {
    fail(
        fmt::format("{}: the encoding of the file is not known; {} is the most likely one. A file is not replaced by a "
                    "guess: --encoding names its encoding, or -o another file",
                    path, to_string(file.encoding())),
        exit_input_has_errors);
  }
  if (settings.keep_going) fail(path + ": with --keep-going a file is not replaced; name another file with -o");
  if (input.of_options.choices != ReadingChoices{}) {
    fail(fmt::format(
        "{}: {} states how this file is read, which would be wrong for its canonical form; move these options "
        "to the command line, or name another file with -o",
        path, input.of_options.options->name()));
  }
}

int format_file(const Settings& settings, const std::string& path) {
  Input input;
  Diagnostics diagnostics;
  input.of_options = choices_beside(path, diagnostics);
  std::string error;
  input.file = read_source_file(path, error, choices_for(settings, input.of_options.choices));
  if (!input.file) fail(error);
  if (settings.keep_going) diagnostics.keep_going(input.file.get());
  check_conversion(settings, input, path);
  if (is_overlay(*input.file)) {
    if (settings.check || settings.in_place) {
      fail(path + ": an overlay does not have a canonical form; -o FILE writes the EDS or DCF that it results in");
    }
    ComposedOverlay composed =
        compose_overlay(input.file, {{}, false, choices_for(settings, input.of_options.choices)}, diagnostics);
    input.source = std::move(composed.text);
    if (!input.source) {
      print_findings(diagnostics, settings.color);
      return composed.is_unreadable ? exit_wrong_usage : exit_input_has_errors;
    }
  }
  if (is_xml(*input.file)) {
    if (settings.check || settings.in_place) {
      diagnostics.error("xml-file", {input.file.get()},
                        "XML does not have a canonical form; -o FILE makes an EDS or DCF from an XDD or XDC");
    } else {
      convert(settings, input, diagnostics);
    }
  }
  if (input.has_values_for_eds) {
    fail(path + ": an XDC has the values of one node, which an EDS cannot have; name the output .dcf");
  }
  if (diagnostics.errors() == 0) read(settings, input, diagnostics);
  if (diagnostics.errors() == 0) move_to_node(settings, input, diagnostics);
  std::string content;
  if (diagnostics.errors() == 0) {
    content = settings.concise ? concise_dcf(input.sheet, input.device, diagnostics) : canonical_text(settings, input);
  }
  print_findings(diagnostics, settings.color);
  if (diagnostics.errors() > 0) return exit_input_has_errors;
  if (!settings.options.empty()) return write_options(settings, path, input);
  if (settings.check) return check(*input.file, content);
  write(settings, *input.file, settings.in_place ? path : settings.output, std::move(content));
  return exit_fine;
}

void check_usage(const Settings& settings) {
  if (settings.node_id && !settings.dcf && !settings.concise) {
    throw_requires("--node-id", "--dcf or --concise");
  }
  if (settings.paths.size() > 1 && !settings.check && !settings.in_place) {
    throw_invalid("FILE", "several files need --check or --in-place");
  }
  if (settings.in_place && std::ranges::find(settings.paths, "-") != settings.paths.end()) {
    throw_invalid("--in-place", "standard input cannot be written");
  }
}

int format(const Settings& settings) {
  check_usage(settings);
  int worst = exit_fine;
  const bool takes_folders = settings.check || settings.in_place;
  for (const std::string& path :
       takes_folders ? expand_folders(settings.paths, canonical_extensions) : settings.paths) {
    try {
      worst = std::max(worst, format_file(settings, path));
    } catch (const Exit& exit) {  // of this file
      worst = std::max(worst, exit.code);
    }
  }
  return worst;
}

}  // namespace

void add_format_options(Command command, int& exit_code) {
  Settings& settings = define_command(command, examples, format, exit_code);
  command
      .add_option("FILE", settings.paths,
                  "EDS, DCF, XDD, XDC or overlay; - is standard input; with --check or --in-place also folders")
      .required();
  const Option output =
      command.add_option("--output", settings.output, "may be FILE (default: standard output)").check(xdd_name_problem);
  const Option in_place = command.add_flag("--in-place", settings.in_place);
  const Option check = command.add_flag("--check", settings.check, "lists each FILE that is not canonical");
  const Option dcf = command.add_flag("--dcf", settings.dcf);
  const Option all = command.add_flag("--all", settings.all, "with --dcf");
  const Option concise =
      command.add_flag("--concise", settings.concise, "write it: what differs from the default values");
  const Option options = command.add_option("--write-options", settings.options);
  add_node_id_option(command, settings.node_id);
  command.add_flag("--keep-going", settings.keep_going);
  for (const ReadingChoiceRow& row : reading_choice_rows()) {
    std::string name = "--" + std::string{row.option};
    std::ranges::replace(name, '_', '-');
    command.add_option(name, settings.choices[row.option], fmt::format("{}: {}", row.meaning, row.expected()))
        .check([&row](const std::string& value) {
          ReadingChoices choices;
          return row.set(value, choices) ? std::string{} : fmt::format("expected {}", row.expected());
        });
  }
  settings.color.add_to(command);
  options.excludes(output).excludes(in_place).excludes(check).excludes(dcf).excludes(concise);
  check.excludes(output).excludes(dcf).excludes(concise).excludes(in_place);
  in_place.excludes(output).excludes(dcf).excludes(concise);
  dcf.excludes(concise).needs("--node-id");
  all.needs(dcf);
}

}  // namespace edsc
