#include "decode/log/message_filter.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <optional>
#include <string>
#include <vector>

#include "eds/number.hpp"
#include "text/ascii.hpp"
#include "text/number_text.hpp"
#include "text/suggestion.hpp"

namespace edsc {
namespace {

/// `185h`, `0x185`
std::optional<std::uint32_t> parse_can_id(std::string_view text) {
  const auto id = parse_whole<std::uint32_t>(digits_of(text, 16).text, 16);
  return id && *id <= 0x1FFF'FFFF ? id : std::nullopt;
}

}  // namespace

std::string MessageFilter::add(std::string_view text, const NodeLabels& labels) {
  while (!text.empty()) {
    const std::size_t comma = text.find(',');
    const std::string_view condition = trim(text.substr(0, comma));
    const std::size_t equals = condition.find('=');
    if (equals == std::string_view::npos) return fmt::format("\"{}\" is not a condition such as node=5", condition);
    const std::string problem =
        add_condition(trim(condition.substr(0, equals)), trim(condition.substr(equals + 1)), labels);
    if (!problem.empty()) return problem;
    text = comma == std::string_view::npos ? std::string_view{} : text.substr(comma + 1);
  }
  return "";
}

std::string MessageFilter::add_node(std::string_view value, const NodeLabels& labels) {
  std::vector<std::string> names;
  for (std::uint8_t node_id = 1; node_id <= 127; ++node_id) {
    const std::string_view name = labels.name(node_id);
    if (name.empty()) continue;
    if (name == value) {
      nodes_.set(node_id);
      return "";
    }
    names.emplace_back(name);
  }
  const auto node_id = parse_unsigned(value);
  if (!node_id || *node_id < 1 || *node_id > 127) {
    return fmt::format("\"{}\" is not a node-ID from 1 to 127{}{}", value,
                       names.empty() ? "" : " and not the name of a node", did_you_mean(value, names));
  }
  nodes_.set(*node_id);
  return "";
}

std::string MessageFilter::add_condition(std::string_view key, std::string_view value, const NodeLabels& labels) {
  if (key == "node") return add_node(value, labels);
  if (key == "service") {
    bool found = false;
    for (const ServiceRow& row : services) {
      const bool pdo = value == "pdo" && (row.service == Service::tpdo || row.service == Service::rpdo);
      if (row.name != value && !pdo) continue;
      services_.set(static_cast<std::size_t>(row.service));
      found = true;
    }
    return found ? "" : fmt::format("unknown service \"{}\"", value);
  }
  if (key == "id") {
    const auto can_id = parse_can_id(value);
    if (!can_id) return fmt::format("\"{}\" is not a CAN-ID such as 185h", value);
    can_ids_.push_back(*can_id);
    return "";
  }
  if (key == "problem" && value == "yes") {
    problems_only_ = true;
    return "";
  }
  return fmt::format("\"{}={}\" is not a condition; expected node, service, id or problem=yes", key, value);
}

bool MessageFilter::passes(const LogLine& line, const Message& message) const {
  if (nodes_.any() && !nodes_.test(message.node_id % nodes_.size())) return false;
  if (services_.any() && !services_.test(static_cast<std::size_t>(message.service))) return false;
  if (!can_ids_.empty() && std::ranges::find(can_ids_, line.frame.id) == can_ids_.end()) return false;
  return !problems_only_ || message.problem;
}

}  // namespace edsc
