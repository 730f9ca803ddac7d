/// Files whose names edsc chooses, in a folder that a command line names. A file that is there already and that edsc
/// has not written, or that was changed since, is not replaced: it may be the only copy of somebody's work.
#pragma once

#include <string>
#include <string_view>
#include <vector>

#include "shared/command_line.hpp"
#include "system/write_files.hpp"

namespace edsc {

struct ReplaceSettings {
  bool force = false;  ///< replace files of others too
  bool check = false;  ///< print what would be written, without writing
};

/// `--force`, and `--check` if `has_check`.
void add_replace_options(Command command, ReplaceSettings& settings, bool has_check);

/// The list of the files that edsc has written into a folder, with their checksums, is a file of that folder.
inline constexpr const char* list_of_written_files = ".edsc-files";

/// Whether edsc wrote the text: its first line says so.
[[nodiscard]] bool has_mark_of_edsc(std::string_view text);

/// Whether edsc has written the file: the list in its folder names it.
[[nodiscard]] bool is_listed_as_written(const std::string& path);

/// Ends the command if one of the files exists without the mark, unless `settings.force` is set.
void check_marks(const std::vector<OutputFile>& files, const ReplaceSettings& settings);

/// Writes the files, whose paths are relative to `folder`, and the list of them; `others` are files that the command
/// line names. With `settings.check`, prints what would be written. Returns the exit code; ends the command for a file
/// of others.
[[nodiscard]] int write_generated_files(const std::string& folder, std::vector<OutputFile> files,
                                        std::vector<OutputFile> others, const std::vector<std::string>& inputs,
                                        const ReplaceSettings& settings);

}  // namespace edsc
