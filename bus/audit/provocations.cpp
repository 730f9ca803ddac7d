#include "audit/provocations.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <limits>
#include <nlohmann/json.hpp>

#include "audit/audit_rules.hpp"

namespace edsc::audit {
namespace {

/// A case that did not run does not have frames.
bool ran(const nlohmann::json& object) { return object.at("verdict").get<std::string_view>() != "not_run"; }

/// A report of another version may have a rule that is not known here: its findings are listed like any other.
std::vector<RuleId> rules_of(const nlohmann::json& object) {
  std::vector<RuleId> rules;
  for (const nlohmann::json& id : object.at("provokes")) {
    if (const auto rule = find_rule(audit_rules, id.get<std::string_view>())) rules.push_back(*rule);
  }
  return rules;
}

}  // namespace

std::optional<Provocations> Provocations::read(std::string_view text, std::string& problem) {
  Provocations read;
  try {
    const auto report = nlohmann::json::parse(text);
    read.cases_.push_back({{}, {}, 0, 0, rules_of(report)});
    for (const nlohmann::json& object : report.at("cases")) {
      if (!ran(object)) continue;
      read.cases_.push_back({object.at("id"), object.at("title"), object.at("began_us"), 0, rules_of(object)});
    }
  } catch (const nlohmann::json::exception& error) {
    problem = fmt::format("not a report of \"edsc conform --json\": {}", error.what());
    return std::nullopt;
  }
  std::ranges::stable_sort(read.cases_, {}, &ProvokingCase::began_us);
  for (std::size_t i = 0; i < read.cases_.size(); ++i) {
    const bool last = i + 1 == read.cases_.size();
    read.cases_[i].ended_us = last ? std::numeric_limits<std::int64_t>::max() : read.cases_[i + 1].began_us;
  }
  return read;
}

/// In simulated time a frame may have the time at which the next case begins.
bool Provocations::count(RuleId rule, std::int64_t log_us) {
  const auto provokes = [&](const ProvokingCase& one) {
    return one.began_us <= log_us && log_us <= one.ended_us && std::ranges::find(one.rules, rule) != one.rules.end();
  };
  const auto found = std::ranges::find_if(cases_, provokes);
  if (found == cases_.end()) return false;
  ++counts_[{static_cast<std::size_t>(found - cases_.begin()), rule}];
  return true;
}

std::vector<Provoked> Provocations::counted() const {
  std::vector<Provoked> all;
  for (const auto& [key, count] : counts_) all.push_back({&cases_[key.first], key.second, count});
  return all;
}

}  // namespace edsc::audit
