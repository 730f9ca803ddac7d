#include "system/temporary_folder.hpp"

#include <fmt/format.h>
#include <windows.h>

#include <filesystem>
#include <random>
#include <system_error>

#include "system/path.hpp"
#include "system/windows/last_error.hpp"

namespace edsc {

namespace fs = std::filesystem;

// The folder for temporary files belongs to the user, and so do all folders in it.
TemporaryFolder::TemporaryFolder(const std::string& prefix) {
  constexpr int max_names = 100;
  std::random_device random;
  for (int i = 0; i < max_names; ++i) {
    const fs::path path = fs::temp_directory_path() / to_native(fmt::format("{}{:08x}", prefix, random()));
    path_ = from_native(path);
    if (CreateDirectoryW(path.c_str(), nullptr) != 0) return;
    if (GetLastError() != ERROR_ALREADY_EXISTS) break;
  }
  throw std::system_error{last_error_number(), std::generic_category(), "cannot create a temporary folder " + path_};
}

TemporaryFolder::~TemporaryFolder() {
  std::error_code ignored;
  fs::remove_all(to_native(path_), ignored);
}

}  // namespace edsc
