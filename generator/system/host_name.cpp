#include "system/host_name.hpp"

#ifdef _WIN32
#include <cstdlib>
#else
#include <unistd.h>

#include <array>
#endif

namespace edsc {

#ifdef _WIN32

std::string host_name() {
  const char* const name = std::getenv("COMPUTERNAME");
  return name == nullptr ? std::string{} : std::string{name};
}

#else

std::string host_name() {
  std::array<char, 256> name{};
  if (gethostname(name.data(), name.size() - 1) != 0) return {};
  return name.data();
}

#endif

}  // namespace edsc
