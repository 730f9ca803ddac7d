#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <iterator>
#include <map>
#include <tuple>

#include "device/bit_rates.hpp"
#include "eds/number.hpp"
#include "network/checks/check_groups.hpp"
#include "network/communication_objects.hpp"

namespace edsc {
namespace {

/// The maximum length of a bus in m (CiA 303-1, table 3), for each of `bit_rates`.
constexpr std::uint32_t max_lengths[] = {5000, 2500, 1000, 500, 250, 100, 50, 25};
static_assert(std::size(max_lengths) == bit_rates.size());

/// The NodeID of a DCF is that of the network file.
void check_commissioned_node_ids(const NetworkContext& context) {
  for (const NetworkNode& node : context.network.nodes) {
    const Device& device = node.device();
    const bool is_other = device.node_id && node.description->dcf && node.description->node_id &&
                          node.loaded->sheet.commissioning.node_id.present;
    if (!is_other) continue;
    const auto stated = number_of(node.loaded->sheet.commissioning.node_id);
    if (stated && *stated != node.node_id) {
      context.diagnostics.warning(
          "network-node-id", node.description->node_id->position,
          fmt::format("node {} has node-ID {}, but its DCF is for {}", node.name, node.node_id, *stated),
          {{node.loaded->sheet.commissioning.node_id.position, "the NodeID of the DCF"}});
    }
  }
}

void check_length(const NetworkContext& context, const Written<std::uint32_t>& bit_rate, std::uint32_t max_length) {
  const WrittenNumber& length = context.network.description.length_m;
  if (!length || length->value <= max_length) return;
  context.diagnostics.warning("network-length", length->position,
                              fmt::format("a bus of {} m is too long for {} kbit/s: the maximum is {} m", length->value,
                                          bit_rate.value, max_length));
}

void check_bit_rate(const NetworkContext& context) {
  const WrittenNumber& bit_rate = context.network.description.bit_rate;
  if (!bit_rate) return;
  const auto lists_it = [&](const NetworkNode& node) {
    const std::vector<std::uint16_t>& supported = node.device().information.capabilities.baud_rates;
    return std::ranges::find(supported, bit_rate->value) != supported.end();
  };
  const auto rate = std::ranges::find(bit_rates, bit_rate->value);
  if (rate == bit_rates.end()) {
    std::string message = fmt::format("{} kbit/s is not a bit rate of CANopen", bit_rate->value);
    if (std::ranges::none_of(context.network.nodes, lists_it)) {
      context.diagnostics.error("network-bit-rate", bit_rate->position, std::move(message));
      return;
    }
    context.diagnostics.warning("network-bit-rate", bit_rate->position,
                                message + "; the maximum length of the bus is not checked");
  } else {
    check_length(context, *bit_rate, max_lengths[rate - bit_rates.begin()]);
  }
  for (const NetworkNode& node : context.network.nodes) {
    const std::vector<std::uint16_t>& supported = node.device().information.capabilities.baud_rates;
    if (node.has_file() && !supported.empty() && !lists_it(node)) {
      context.diagnostics.error("network-bit-rate", node.position,
                                fmt::format("node {} does not support {} kbit/s; its EDS has {}", node.name,
                                            bit_rate->value, fmt::join(supported, ", ")),
                                {{bit_rate->position, "the bit rate of the network"}});
    }
    const auto& commissioning = node.device().information.commissioning;
    // Tools write 0 where the bit rate is not known.
    const bool is_of_dcf = node.description->dcf && commissioning && commissioning->baudrate.value_or(0) != 0;
    if (is_of_dcf && *commissioning->baudrate != bit_rate->value) {
      context.diagnostics.warning("network-bit-rate", node.description->dcf->position,
                                  fmt::format("the DCF of node {} is for {} kbit/s, the network has {}", node.name,
                                              *commissioning->baudrate, bit_rate->value));
    }
  }
}

/// The serial number of a node: that of the network file or of the DCF. 0 is unknown: 1018h:04 of an EDS is that of a
/// type of device.
std::uint32_t serial_number(const NetworkNode& node) {
  if (node.description->serial_number) return node.description->serial_number->value;
  const auto& commissioning = node.device().information.commissioning;
  if (node.description->dcf && commissioning && commissioning->lss_serial_number) {
    return *commissioning->lss_serial_number;
  }
  return 0;
}

void check_lss_addresses(const NetworkContext& context) {
  std::map<std::tuple<std::uint64_t, std::uint64_t, std::uint64_t, std::uint32_t>, const NetworkNode*> addresses;
  for (const NetworkNode& node : context.network.nodes) {
    const std::uint32_t serial = serial_number(node);
    if (serial == 0) continue;
    const auto part = [&](std::uint8_t sub_index) {
      return value_of(node.device(), communication::identity, sub_index).value_or(0);
    };
    const auto [at, is_new] = addresses.emplace(std::tuple{part(1), part(2), part(3), serial}, &node);
    if (is_new) continue;
    context.diagnostics.error("network-lss-address", node.position,
                              fmt::format("nodes {} and {} have the same vendor-ID, product code, revision number and "
                                          "serial number {}",
                                          at->second->name, node.name, serial),
                              {{at->second->position, at->second->name}});
  }
}

}  // namespace

bool check_node_ids(const NetworkContext& context) {
  std::map<std::uint8_t, const NetworkNode*> nodes;
  for (const NetworkNode& node : context.network.nodes) {
    const auto [at, is_new] = nodes.emplace(node.node_id, &node);
    if (is_new) continue;
    const NetworkNode& first = *at->second;
    context.diagnostics.error("network-node-id", node.position,
                              fmt::format("nodes {} and {} have node-ID {}", first.name, node.name, node.node_id),
                              {{first.position, first.name}});
  }
  return nodes.size() == context.network.nodes.size();
}

void check_nodes(const NetworkContext& context) {
  check_commissioned_node_ids(context);
  check_bit_rate(context);
  check_lss_addresses(context);
}

}  // namespace edsc
