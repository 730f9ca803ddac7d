#include "diagnostics/new_errors.hpp"

#include <algorithm>
#include <array>
#include <cstddef>
#include <cstdint>
#include <map>
#include <string>
#include <string_view>
#include <utility>

namespace edsc {
namespace {

constexpr std::string_view digits = "0123456789";
constexpr std::array<std::string_view, 4> units{" %", " kbit/s", " ms", " us"};

/// Without the numbers before a unit. Those in names, such as `axis2 TPDO 1`, remain.
std::string without_quantities(std::string text) {
  for (std::size_t at = text.find_first_of(digits); at != std::string::npos; at = text.find_first_of(digits, at)) {
    const std::size_t end = std::min(text.find_first_not_of("0123456789.", at), text.size());
    const auto follows = [&](std::string_view unit) { return std::string_view{text}.substr(end).starts_with(unit); };
    const bool is_quantity =
        (at == 0 || text[at - 1] == ' ' || text[at - 1] == '(') && std::ranges::any_of(units, follows);
    if (is_quantity) text.erase(at, end - at);
    at = is_quantity ? at : end;
  }
  return text;
}

}  // namespace

std::vector<Diagnostic> new_errors(const Diagnostics& after, const Diagnostics& before, bool is_renamed,
                                   std::span<const std::string_view> calculated) {
  const auto key_of = [&](const Diagnostic& one) {
    const bool is_calculated = std::ranges::find(calculated, one.rule.text()) != calculated.end();
    return std::pair{one.rule, is_calculated ? without_quantities(one.message) : one.message};
  };
  std::map<std::pair<RuleId, std::string>, std::size_t> old_errors;
  std::map<RuleId, std::int64_t> more;
  for (const Diagnostic& one : before.all()) {
    if (one.severity != Severity::error) continue;
    ++old_errors[key_of(one)];
    --more[one.rule];
  }
  std::vector<Diagnostic> errors;
  for (const Diagnostic& one : after.all()) {
    if (one.severity == Severity::error) ++more[one.rule];
  }
  for (const Diagnostic& one : after.all()) {
    if (one.severity != Severity::error || (is_renamed && more[one.rule] <= 0)) continue;
    std::size_t& same = old_errors[key_of(one)];
    if (same > 0) {
      --same;
    } else {
      errors.push_back(one);
    }
  }
  return errors;
}

}  // namespace edsc
