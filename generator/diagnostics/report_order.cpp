#include "diagnostics/report_order.hpp"

#include <algorithm>
#include <map>
#include <numeric>
#include <tuple>

namespace edsc {
namespace {

/// The rank of each file: the order of its first finding.
std::map<const SourceFile*, std::size_t> ranks_of_files(const Diagnostics& diagnostics) {
  std::map<const SourceFile*, std::size_t> ranks;
  for (const Diagnostic& one : diagnostics.all()) ranks.try_emplace(one.position.file, ranks.size());
  return ranks;
}

}  // namespace

std::vector<std::size_t> report_order(const Diagnostics& diagnostics) {
  const std::vector<Diagnostic>& all = diagnostics.all();
  const auto ranks = ranks_of_files(diagnostics);
  const auto key = [&](std::size_t at) {
    const Diagnostic& one = all[at];
    return std::tuple{ranks.at(one.position.file), -static_cast<int>(one.severity), one.position.line,
                      one.position.column, at};
  };
  std::vector<std::size_t> order(all.size());
  std::iota(order.begin(), order.end(), std::size_t{0});
  std::ranges::sort(order, {}, [&](std::size_t at) {
    const auto cause = all[at].follows_from;
    return std::tuple{key(cause.value_or(at)), cause.has_value(), key(at)};
  });
  return order;
}

std::vector<Consequence> consequences_of(std::size_t cause, const Diagnostics& diagnostics) {
  std::map<RuleId, std::size_t> counts;
  for (const Diagnostic& one : diagnostics.all()) {
    if (one.follows_from == cause) ++counts[one.rule];
  }
  for (const Diagnostics::Omitted& omitted : diagnostics.omitted()) {
    if (diagnostics.all()[omitted.last_listed].follows_from == cause) counts[omitted.rule] += omitted.count;
  }
  std::vector<Consequence> consequences;
  consequences.reserve(counts.size());
  for (const auto& [rule, count] : counts) consequences.push_back({rule, count});
  std::ranges::stable_sort(consequences, std::ranges::greater{}, &Consequence::count);
  return consequences;
}

std::size_t count_causes(const Diagnostics& diagnostics) {
  std::size_t count = 0;
  for (const Diagnostic& one : diagnostics.all()) {
    if (one.severity != Severity::note && !one.follows_from) ++count;
  }
  for (const Diagnostics::Omitted& omitted : diagnostics.omitted()) {
    const bool follows = diagnostics.all()[omitted.last_listed].follows_from.has_value();
    if (omitted.severity != Severity::note && !follows) count += omitted.count;
  }
  return count;
}

}  // namespace edsc
