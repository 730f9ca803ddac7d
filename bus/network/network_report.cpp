#include "network/network_report.hpp"

#include <fmt/format.h>

#include <algorithm>

#include "configure/configuration_report.hpp"
#include "diagnostics/place.hpp"
#include "network/node_configuration.hpp"
#include "text/counted.hpp"

namespace edsc {
namespace {

using Json = nlohmann::ordered_json;

bool is_write_only(const ConfigurationChange& change) {
  const Entry* const entry = change.value.entry.entry;
  return !change.before && entry != nullptr && !canopen::readable(entry->access);
}

std::size_t count_write_only(const LiveNode& live) {
  const auto count =
      std::ranges::count_if(live.run.changes, is_write_only) + std::ranges::count_if(live.run.withheld, is_write_only);
  return static_cast<std::size_t>(count);
}

Json identity_json(const Identity& identity) {
  Json json = Json::object();
  for (const IdentityNumber& number : identity_numbers) {
    const auto& value = identity.*number.value;
    json[std::string{number.key}] = value ? Json(*value) : Json(nullptr);
  }
  return json;
}

Json node_json(const LiveNode& live) {
  Json problems = Json::array();
  for (const NodeProblem& problem : live.problems) problems.push_back(problem.text);
  return {{"name", live.node->name},
          {"node_id", live.node->node_id},
          {"file", file_of(*live.node)},
          {"answers", live.answers},
          {"problems", std::move(problems)}};
}

Json difference_json(const ConfigurationChange& change) {
  Json row = entry_json(change.value.entry, &change.value);
  row["wanted"] = wanted_text(change);
  row["found"] = change.before ? Json(found_text(change)) : Json(nullptr);
  return row;
}

}  // namespace

std::vector<const ConfigurationChange*> differences(const LiveNode& live) {
  std::vector<const ConfigurationChange*> found;
  for (const auto* const changes : {&live.run.changes, &live.run.withheld}) {
    for (const ConfigurationChange& change : *changes) {
      if (!is_write_only(change)) found.push_back(&change);
    }
  }
  return found;
}

bool is_same(const LiveNode& live) { return live.problems.empty() && live.is_compared && differences(live).empty(); }

std::string identity_not_compared(const LiveNode& live) {
  return live.is_compared ? names_of(not_compared(expected_identity(*live.node), live.identity)) : std::string{};
}

std::string other_minor_revision(const LiveNode& live) {
  const Identity expected = expected_identity(*live.node);
  if (!live.is_compared || compare_identity(expected, live.identity) != IdentityMatch::minor_revision) return {};
  return identity_differences(expected, live.identity) + ": another minor revision, which a master rejects (1F87h)";
}

std::string problem_text(const NodeProblem& problem) {
  const Place place = place_of(problem.position);
  return fmt::format("{}:{}:{}: error: {}", place.file, place.line, place.column, problem.text);
}

std::vector<std::string> verify_lines(const LiveNode& live) {
  std::vector<std::string> lines;
  for (const NodeProblem& problem : live.problems) lines.push_back(problem_text(problem));
  const auto differing = differences(live);
  for (const ConfigurationChange* const change : differing) {
    lines.push_back(fmt::format("{}: {} is {}, expected {}", label(*live.node), title(change->value.entry),
                                found_text(*change), wanted_text(*change)));
  }
  if (!live.is_compared) return lines;
  std::string summary = fmt::format("{}: {} of {} {}", label(*live.node), differing.size(),
                                    counted(live.run.compared, "value"), differing.size() == 1 ? "differs" : "differ");
  if (const std::size_t count = count_write_only(live); count != 0) {
    summary += fmt::format(", {} cannot be compared (write-only)", count);
  }
  lines.push_back(std::move(summary));
  return lines;
}

std::string verify_summary(const std::vector<LiveNode>& nodes, const std::string& file) {
  const auto same = std::ranges::count_if(nodes, is_same);
  return fmt::format("{} of {} as in {}", same, counted(nodes.size(), "node"), file);
}

Json verify_json(const std::vector<LiveNode>& nodes) {
  Json json{{"schema", 2}, {"same", std::ranges::all_of(nodes, is_same)}, {"nodes", Json::array()}};
  for (const LiveNode& live : nodes) {
    Json row = node_json(live);
    row["same"] = is_same(live);
    row["identity"] = live.answers ? identity_json(live.identity) : Json(nullptr);
    row["compared"] = live.run.compared;
    row["write_only"] = count_write_only(live);
    row["differences"] = Json::array();
    for (const ConfigurationChange* const change : differences(live)) {
      row["differences"].push_back(difference_json(*change));
    }
    json["nodes"].push_back(std::move(row));
  }
  return json;
}

std::string apply_summary(const std::vector<LiveNode>& nodes) {
  const auto configured = static_cast<std::size_t>(std::ranges::count_if(nodes, &LiveNode::succeeded));
  const auto started = static_cast<std::size_t>(std::ranges::count_if(nodes, &LiveNode::started));
  const bool stored = std::ranges::any_of(nodes, [](const LiveNode& live) { return live.run.stored; });
  std::string text =
      fmt::format("{} of {} configured{}", configured, counted(nodes.size(), "node"), stored ? ", stored" : "");
  if (started != 0) return text + (started == nodes.size() ? ", started" : fmt::format(", {} started", started));
  return configured == nodes.size() ? text : text + "; none started";
}

Json apply_json(const std::vector<LiveNode>& nodes) {
  Json json{{"schema", 2},
            {"succeeded", std::ranges::all_of(nodes, &LiveNode::succeeded)},
            {"started", std::ranges::all_of(nodes, &LiveNode::started)},
            {"nodes", Json::array()}};
  for (const LiveNode& live : nodes) {
    Json row = node_json(live);
    row["succeeded"] = live.succeeded();
    row["attempts"] = live.attempts;
    row["configuration"] = live.is_compared ? as_json(live.run) : Json(nullptr);
    json["nodes"].push_back(std::move(row));
  }
  return json;
}

}  // namespace edsc
