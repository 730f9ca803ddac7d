#include "shared/file_arguments.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <filesystem>
#include <iterator>
#include <system_error>

#include "shared/exit_code.hpp"
#include "shared/generated_files.hpp"
#include "system/find_files.hpp"
#include "system/path.hpp"

namespace edsc {
std::vector<std::string> expand_folders(const std::vector<std::string>& paths,
                                        std::span<const std::string_view> extensions, WrittenByEdsc written) {
  std::vector<std::string> files;
  for (const std::string& path : paths) {
    std::error_code error;
    if (!std::filesystem::is_directory(to_native(path), error)) {
      files.push_back(path);
      continue;
    }
    FoundFiles below = find_files(path, extensions);
    if (!below.problems.empty()) fail(below.problems.front());
    if (written == WrittenByEdsc::skipped) std::erase_if(below.paths, is_listed_as_written);
    if (below.paths.empty()) fail(fmt::format("{}: the folder and its subfolders have no EDS, DCF or XDD file", path));
    std::ranges::move(below.paths, std::back_inserter(files));
  }
  return files;
}

}  // namespace edsc
