#include "diagnostics/new_errors.hpp"

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <map>
#include <string>
#include <utility>

namespace edsc {
namespace {

std::string without_digits(std::string text) {
  std::erase_if(text, [](char one) { return one >= '0' && one <= '9'; });
  return text;
}

}  // namespace

std::vector<Diagnostic> new_errors(const Diagnostics& after, const Diagnostics& before, bool is_renamed,
                                   std::span<const std::string_view> calculated) {
  const auto key_of = [&](const Diagnostic& one) {
    const bool is_calculated = std::ranges::find(calculated, one.rule.text()) != calculated.end();
    return std::pair{one.rule, is_calculated ? without_digits(one.message) : one.message};
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
