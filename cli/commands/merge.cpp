#include <fmt/format.h>

#include <memory>
#include <string>
#include <utility>

#include "change/line_diff.hpp"
#include "change/merge_sheets.hpp"
#include "change/text_edit.hpp"
#include "commands/commands.hpp"
#include "shared/define_command.hpp"
#include "shared/exit_code.hpp"
#include "shared/output.hpp"
#include "text/printable.hpp"
#include "text/source_file.hpp"

namespace edsc {
namespace {

constexpr const char* examples = R"(Examples:
  git config merge.edsc.driver "edsc merge %O %A %B %P"     git calls the command for files with merge=edsc
  echo "*.eds merge=edsc" >> .gitattributes
  edsc merge base.eds ours.eds theirs.eds                   ours.eds gets the changes of theirs.eds)";

struct Settings {
  std::string base, ours, theirs, name;
};

std::unique_ptr<SourceFile> read_version(const std::string& path, const ReadingChoices& choices = {}) {
  std::string error;
  auto file = read_source_file(path, error, choices);
  if (!file) fail(error);
  if (file->packing() != Packing::none) fail(path + ": a gzip file is not merged");
  return file;
}

int merge(const Settings& settings) {
  const auto ours = read_version(settings.ours);
  const auto base = read_version(settings.base);
  const auto theirs = read_version(settings.theirs);
  const std::string& name = settings.name.empty() ? settings.ours : settings.name;
  const MergedSheet merged = merge_sheets(*base, *ours, *theirs);
  const SourceFile result{name, merged.text};
  const EditedBytes bytes =
      edited_bytes(read_bytes(settings.ours).bytes, ours->encoding(), line_edits(*ours, result), true);
  if (!bytes.error.empty()) fail(fmt::format("{}: {}", name, bytes.error));
  write_output(settings.ours, bytes.bytes, {settings.base, settings.theirs});
  for (const std::string& title : merged.conflicts) print_to_stderr("{}: conflict in [{}]\n", name, title);
  return merged.conflicts.empty() ? exit_fine : exit_input_has_errors;
}

}  // namespace

void add_merge_options(Command command, int& exit_code) {
  Settings& settings = define_command(command, examples, merge, exit_code);
  command.add_option("BASE", settings.base, "common ancestor of both versions; %O of git").required();
  command.add_option("FILE", settings.ours, "our version, which gets the result; %A of git").required();
  command.add_option("OTHER", settings.theirs, "their version; %B of git").required();
  command.add_option("NAME", settings.name, "name of the file in messages; %P of git");
}

}  // namespace edsc
