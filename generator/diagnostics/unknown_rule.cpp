#include "diagnostics/unknown_rule.hpp"

#include <fmt/format.h>

#include <vector>

#include "diagnostics/quote.hpp"
#include "text/suggestion.hpp"

namespace edsc {

std::string unknown_rule(std::string_view id, std::span<const Rule> table) {
  std::vector<std::string_view> ids;
  for (const Rule& rule : table) ids.push_back(rule.id);
  return fmt::format("unknown rule {}{}", quote(id), did_you_mean(id, ids));
}

}  // namespace edsc
