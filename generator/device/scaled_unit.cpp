#include "device/scaled_unit.hpp"

#include <charconv>

namespace edsc {

bool is_scaled(const Entry& entry) {
  double number = 1;
  const std::string& factor = entry.factor;
  const char* const end = factor.data() + factor.size();
  const auto [rest, error] = std::from_chars(factor.data(), end, number);
  return !factor.empty() && (error != std::errc{} || rest != end || number != 1);
}

std::string_view raw_unit(const Entry& entry) { return is_scaled(entry) ? std::string_view{} : entry.unit; }

std::string physical_unit(const Entry& entry) {
  if (!is_scaled(entry)) return entry.unit;
  return entry.unit.empty() ? entry.factor : entry.factor + " " + entry.unit;
}

}  // namespace edsc
