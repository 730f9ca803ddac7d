#include "shared/file_arguments.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <filesystem>
#include <iterator>
#include <system_error>

#include "shared/exit_code.hpp"
#include "system/path.hpp"
#include "text/ascii.hpp"

namespace edsc {
namespace {

namespace fs = std::filesystem;

bool is_hidden(const fs::path& path) { return from_native(path.filename()).starts_with('.'); }

std::vector<std::string> files_below(const std::string& folder, std::span<const std::string_view> extensions) {
  std::vector<std::string> found;
  std::error_code error;
  const fs::path start = to_native(folder).lexically_normal();
  auto at = fs::recursive_directory_iterator{start, error};
  for (; !error && at != fs::recursive_directory_iterator{}; at.increment(error)) {
    std::error_code of_file;
    if (at->is_directory(of_file) && is_hidden(at->path())) at.disable_recursion_pending();
    std::string extension = from_native(at->path().extension());
    std::ranges::transform(extension, extension.begin(), to_lower);
    if (std::ranges::find(extensions, extension) == extensions.end() || !at->is_regular_file(of_file)) continue;
    found.push_back(from_native(at->path().lexically_normal()));
  }
  if (error) fail(fmt::format("{}: {}", folder, error.default_error_condition().message()));
  std::ranges::sort(found);
  return found;
}

}  // namespace

std::vector<std::string> expand_folders(const std::vector<std::string>& paths,
                                        std::span<const std::string_view> extensions) {
  std::vector<std::string> files;
  for (const std::string& path : paths) {
    std::error_code error;
    if (!fs::is_directory(to_native(path), error)) {
      files.push_back(path);
      continue;
    }
    std::vector<std::string> below = files_below(path, extensions);
    if (below.empty()) fail(fmt::format("{}: the folder and its subfolders have no EDS, DCF or XDD file", path));
    std::ranges::move(below, std::back_inserter(files));
  }
  return files;
}

}  // namespace edsc
