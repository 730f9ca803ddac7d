#include "system/environment.hpp"

#include <cstdlib>
#include <system_error>

namespace edsc {

std::vector<std::string> program_arguments(int argc, char** argv) { return {argv + 1, argv + argc}; }

std::optional<std::string> environment_variable(const char* name) {
  const char* const value = std::getenv(name);
  return value != nullptr ? std::optional<std::string>{value} : std::nullopt;
}

std::filesystem::path program_file() {
  std::error_code error;
  return std::filesystem::read_symlink("/proc/self/exe", error);
}

}  // namespace edsc
