#include "system/find_files.hpp"

#include <algorithm>
#include <filesystem>
#include <system_error>

#include "system/path.hpp"

namespace edsc {
namespace {

namespace fs = std::filesystem;

bool has_extension(const fs::path& path, std::span<const std::string_view> extensions) {
  std::string extension = from_native(path.extension());
  for (char& c : extension) {
    if (c >= 'A' && c <= 'Z') c = static_cast<char>(c - 'A' + 'a');
  }
  return std::ranges::find(extensions, extension) != extensions.end();
}

void find_below(const fs::path& folder, std::span<const std::string_view> extensions, Subfolders subfolders,
                FoundFiles& found) {
  std::error_code error;
  fs::directory_iterator at{folder, error};
  for (; !error && at != fs::directory_iterator{}; at.increment(error)) {
    std::error_code of_file;
    const fs::path& path = at->path();
    if (at->symlink_status(of_file).type() == fs::file_type::directory) {
      const bool is_hidden = from_native(path.filename()).starts_with('.');
      if (subfolders == Subfolders::searched && !is_hidden) find_below(path, extensions, subfolders, found);
    } else if (has_extension(path, extensions) && at->is_regular_file(of_file)) {
      found.paths.push_back(from_native(path.lexically_normal()));
    }
  }
  if (error) found.problems.push_back(from_native(folder) + ": " + error.default_error_condition().message());
}

}  // namespace

FoundFiles find_files(const std::string& folder, std::span<const std::string_view> extensions, Subfolders subfolders) {
  FoundFiles found;
  find_below(to_native(folder).lexically_normal(), extensions, subfolders, found);
  std::ranges::sort(found.paths);
  std::ranges::sort(found.problems);
  return found;
}

}  // namespace edsc
