#include "shared/live_options.hpp"

#include <algorithm>
#include <set>

#include "online/live_entry.hpp"
#include "shared/common_options.hpp"
#include "shared/parse_number.hpp"

namespace edsc {

Option add_bus_argument(Command command, std::string& bus) {
  return command
      .add_option("BUS", bus,
                  "socketcan:can0, slcan:/dev/ttyACM0, socketcand:127.0.0.1:29536/vcan0, or "
                  "simulated:PROGRAM@NODE-ID for a device in simulated time")
      .required();
}

Option add_node_argument(Command command, std::string& node, const std::string& detail) {
  const std::string forms = "node-ID, 1..127, or a name from the network file";
  return command.add_option("NODE", node, detail.empty() ? forms : detail).required();
}

NamedNode NodeSettings::resolve() {
  if (written_node.empty()) return {};
  NamedNode found = find_node("NODE", written_node, network, sheet.empty());
  node = found.node_id;
  if (sheet.empty()) sheet = found.sheet;
  if (sheet.empty()) without_sheet = found.name;
  return found;
}

std::vector<Option> add_node_arguments(Command command, NodeSettings& settings) {
  std::vector<Option> arguments{add_bus_argument(command, settings.bus),
                                add_node_argument(command, settings.written_node)};
  add_network_option(command, settings.network);
  return arguments;
}

Option add_timeout_option(Command command, unsigned& milliseconds) {
  return command.add_milliseconds("--timeout", milliseconds, 1, 600'000);
}

Option add_step_option(Command command, unsigned& milliseconds) {
  return command.add_milliseconds("--step", milliseconds, 1, 10'000);
}

Option add_format_option(Command command, std::string& format) {
  return add_choice(command, "--format", format, {"text", "json"});
}

Option add_type_option(Command command, const canopen::DataTypeRow*& type) {
  const auto parse = [](const std::string& text) -> std::optional<const canopen::DataTypeRow*> {
    const canopen::DataTypeRow* const found = find_type(text);
    return found != nullptr ? std::optional{found} : std::nullopt;
  };
  return add_parsed(command, "--type", type, parse, "a data type, such as u16 or string");
}

std::optional<std::uint32_t> parse_count(const std::string& text, std::uint32_t most) {
  const auto number = parse_number(text, most);
  return number ? std::optional{static_cast<std::uint32_t>(*number)} : std::nullopt;
}

std::optional<std::uint8_t> parse_node(const std::string& text) {
  const auto number = parse_count(text, 127);
  if (!number || *number == 0) return std::nullopt;
  return static_cast<std::uint8_t>(*number);
}

std::optional<NodeFile> parse_node_file(const std::string& text) {
  const std::size_t equals = text.find('=');
  const auto node_id = parse_node(text.substr(0, equals));
  if (equals == std::string::npos || equals + 1 == text.size() || !node_id) return std::nullopt;
  return NodeFile{*node_id, text.substr(equals + 1)};
}

std::vector<std::uint8_t> parse_node_list(const std::string& text) {
  std::set<std::uint8_t> nodes;
  std::size_t begin = 0;
  while (begin <= text.size()) {
    const std::size_t comma = std::min(text.find(',', begin), text.size());
    const std::string part = text.substr(begin, comma - begin);
    const std::size_t dots = part.find("..");
    const auto first = parse_node(part.substr(0, dots));
    const auto last = dots == std::string::npos ? first : parse_node(part.substr(dots + 2));
    if (!first || !last || *first > *last) return {};
    for (unsigned node = *first; node <= *last; ++node) nodes.insert(static_cast<std::uint8_t>(node));
    begin = comma + 1;
  }
  return {nodes.begin(), nodes.end()};
}

ScanSettings ScanOptions::parsed() const {
  ScanSettings settings = times;
  settings.nodes = parse_node_list(nodes);
  return settings;
}

void add_scanned_nodes(Command command, ScanOptions& options) {
  command.add_option("--nodes", options.nodes)
      .check([](const std::string& text) {
        return parse_node_list(text).empty() ? "\"" + text + "\" is not a list of node-IDs, such as 1..127 or 1,3,8..20"
                                             : std::string{};
      })
      .show_default();
  add_timeout_option(command, options.times.timeout_ms);
  command.add_milliseconds("--for", options.times.listen_ms, 0, 600'000, "at least, for heartbeats");
}

Option add_count_option(Command command, const std::string& name, std::optional<std::uint32_t>& number,
                        const std::string& detail) {
  const auto parse = [](const std::string& text) { return parse_count(text); };
  return add_parsed(command, name, number, parse, "a number; expected 31, 0x1F or 1Fh", detail);
}

}  // namespace edsc
