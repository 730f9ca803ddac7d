#include "system/temporary_folder.hpp"

#include <cerrno>
#include <cstdlib>
#include <filesystem>
#include <system_error>

#include "system/path.hpp"

namespace edsc {

namespace fs = std::filesystem;

TemporaryFolder::TemporaryFolder(const std::string& prefix)
    : path_{from_native(fs::temp_directory_path() / to_native(prefix + "XXXXXX"))} {
  if (mkdtemp(path_.data()) == nullptr) {
    throw std::system_error{errno, std::generic_category(), "cannot create a temporary folder " + path_};
  }
}

TemporaryFolder::~TemporaryFolder() {
  std::error_code ignored;
  fs::remove_all(to_native(path_), ignored);
}

}  // namespace edsc
