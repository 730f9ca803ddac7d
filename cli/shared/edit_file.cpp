#include "shared/edit_file.hpp"

#include <fmt/chrono.h>
#include <fmt/format.h>

#include <ctime>
#include <filesystem>
#include <memory>
#include <system_error>
#include <utility>

#include "backend/cpp/identifier.hpp"
#include "change/apply_changes.hpp"
#include "change/line_diff.hpp"
#include "overlay/overlay_file.hpp"
#include "shared/exit_code.hpp"
#include "shared/output.hpp"
#include "system/path.hpp"
#include "text/printable.hpp"
#include "text/source_file.hpp"
#include "xdd/read_xdd.hpp"

namespace edsc {
namespace {

ChangeStamp stamp_of_now() {
  const std::time_t now = std::time(nullptr);
  const std::tm local = fmt::localtime(now);
  return {fmt::format("{:%m-%d-%Y}", local), fmt::format("{:%I:%M%p}", local)};
}

void report(const EditSettings& settings, const AppliedChanges& applied) {
  for (const std::string& objection : applied.objections) print_to_stderr("edsc: {}: {}\n", settings.path, objection);
  Diagnostics diagnostics;
  for (const Diagnostic& error : applied.new_errors) diagnostics.report(error);
  print_findings(diagnostics, settings.color);
}

void write_if_unchanged(const EditSettings& settings, const OpenSheet& before, const OpenSheet& after) {
  const FileBytes now = read_bytes(settings.path);
  if (!now.error.empty()) fail(now.error);
  if (now.bytes != before.bytes) {
    fail(fmt::format("{}: another program changed the file; nothing was written", settings.path));
  }
  write_all_files({{settings.path, after.bytes}});
}

}  // namespace

Options options_beside(const std::string& path) {
  const std::filesystem::path beside = to_native(path).replace_extension(".options.json");
  std::error_code missing;
  if (!std::filesystem::exists(beside, missing)) return {};
  std::string error;
  std::shared_ptr<const SourceFile> source = read_source_file(from_native(beside), error);
  if (!source) fail(error);
  Diagnostics diagnostics;
  Options options = read_options(*source, is_identifier, diagnostics);
  if (diagnostics.errors() > 0) {
    print_findings(diagnostics, {});
    throw Exit{exit_input_has_errors};
  }
  options.source = std::move(source);
  return options;
}

void EditSettings::add_to(Command command) {
  command.add_flag("--dry-run", dry_run, "as a unified diff");
  command.add_flag("--force", force, "also write a file with new errors");
  command.add_flag("--utf8", utf8);
  command.add_flag("--stamp", stamp);
  color.add_to(command);
}

std::unique_ptr<OpenSheet> open_file(const std::string& path) {
  if (path == "-") fail("-: standard input cannot be changed; name a file");
  FileBytes file = read_bytes(path);
  if (!file.error.empty()) fail(file.error);
  if (file.packing != Packing::none) fail(fmt::format("{}: a gzip file is not changed; unpack it first", path));
  auto open = open_sheet(path, std::move(file.bytes), options_beside(path), SheetChecks::reading);
  if (is_xml(*open->source)) {
    fail(
        fmt::format("{}: XDD and XDC are not changed; \"edsc format {} -o FILE\" makes an EDS or DCF, and an overlay "
                    "corrects the file",
                    path, path));
  }
  if (is_overlay(*open->source)) fail(fmt::format("{}: an overlay is changed as a text", path));
  return open;
}

int edit_file(const EditSettings& settings, const OpenSheet& file, const std::vector<SheetChange>& changes) {
  ChangeSettings of_changes;
  of_changes.force = settings.force;
  of_changes.utf8 = settings.utf8;
  if (settings.stamp) of_changes.stamp = stamp_of_now();
  const AppliedChanges applied = apply_changes(file, changes, of_changes);
  if (!applied.problem.empty()) {
    print_to_stderr("edsc: {}: {}; nothing was written\n", settings.path, applied.problem);
    return exit_input_has_errors;
  }
  report(settings, applied);
  if (applied.is_rejected) {
    print_to_stderr("edsc: {}: nothing was written; --force writes the file\n", settings.path);
    return exit_input_has_errors;
  }
  if (settings.dry_run) {
    write_output(unified_diff(*file.source, applied.edits, settings.path));
    return exit_fine;
  }
  if (applied.edits.empty()) {
    print_visibly(stdout, "{}: unchanged\n", settings.path);
    return exit_fine;
  }
  write_if_unchanged(settings, file, *applied.after);
  for (const SheetChange& change : changes) print_visibly(stdout, "{}: {}\n", settings.path, change_text(change));
  return exit_fine;
}

}  // namespace edsc
