#include "audit/audit_state.hpp"

#include <fmt/format.h>

namespace edsc::audit {

std::string milliseconds(std::int64_t us) {
  std::string text = fmt::format("{}.{:03}", us / 1000, us % 1000);
  text.erase(text.find_last_not_of('0') + 1);
  if (text.back() == '.') text.pop_back();
  return text + " ms";
}

}  // namespace edsc::audit
