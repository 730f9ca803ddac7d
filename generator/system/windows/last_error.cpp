#include "system/windows/last_error.hpp"

#include <windows.h>

#include <cerrno>
#include <system_error>

namespace edsc {

int last_error_number() {
  const std::error_code error{static_cast<int>(GetLastError()), std::system_category()};
  const std::error_condition condition = error.default_error_condition();
  return condition.category() == std::generic_category() ? condition.value() : EIO;
}

bool fail_with_last_error() {
  errno = last_error_number();
  return false;
}

}  // namespace edsc
