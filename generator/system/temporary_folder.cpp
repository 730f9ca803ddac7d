#include "system/temporary_folder.hpp"

#include <cerrno>
#include <cstdlib>
#include <filesystem>
#include <system_error>

namespace edsc {

namespace fs = std::filesystem;

TemporaryFolder::TemporaryFolder(const std::string& prefix)
    : path_{(fs::temp_directory_path() / (prefix + "XXXXXX")).string()} {
  if (mkdtemp(path_.data()) == nullptr) {
    throw std::system_error{errno, std::generic_category(), "cannot create a temporary folder " + path_};
  }
}

TemporaryFolder::~TemporaryFolder() {
  std::error_code ignored;
  fs::remove_all(path_, ignored);
}

}  // namespace edsc
