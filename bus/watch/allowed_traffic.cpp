#include "watch/allowed_traffic.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <canopen/pdo/transmission_type.hpp>
#include <chrono>

#include "device/cob_id_parameter.hpp"
#include "device/index_range.hpp"
#include "device/options/options.hpp"
#include "device/pdo/pdo_defaults.hpp"
#include "network/communication_objects.hpp"
#include "network/error_control.hpp"
#include "network/timing/timing.hpp"
#include "values/value_bytes.hpp"

namespace edsc::watch {
namespace {

constexpr std::int64_t per_millisecond = 1000;

/// Whether the use is of the server of an SDO, which has the CAN-IDs for both directions.
bool is_of_server(const CobIdUse& use) { return (use.sdo == SdoFrames::requests) != use.transmits; }

/// Mapping and communication parameters, of RPDOs and TPDOs, differ by this.
constexpr std::uint16_t to_mapping = 0x0200;

bool has_setting(const NetworkNode& node, std::uint16_t index) {
  return std::ranges::any_of(node.settings, [&](const Setting& one) { return one.index == index; });
}

/// Whether the network file configures the PDO of this parameter.
bool is_of_configured_pdo(const NetworkNode& node, std::uint16_t index, std::uint8_t sub_index) {
  constexpr std::array communication = {IndexRange{0x1400, 0x15FF}, IndexRange{0x1800, 0x19FF}};
  if (contains(mapping_parameters, index)) {
    return has_setting(node, index) || has_setting(node, static_cast<std::uint16_t>(index - to_mapping));
  }
  return contains(communication, index) && sub_index == 1 &&
         (has_setting(node, index) || has_setting(node, static_cast<std::uint16_t>(index + to_mapping)));
}

/// Store, restore and the date of the configuration, which every master may write at boot-up.
bool is_of_boot_up(std::uint16_t index) {
  return index == 0x1010 || index == 0x1011 || index == communication::verify_configuration;
}

}  // namespace

AllowedTraffic::AllowedTraffic(const Network& network) : network_{&network} {
  const std::vector<CobIdUse> uses = cob_id_uses(network);
  for (const CobIdUse& use : uses) {
    if (use.service == FrameService::sdo ? is_of_server(use) : use.transmits) add(use, uses);
  }
  for (const CobIdUse& use : uses) {
    if (!use.transmits && !places_.contains(cob_id_of(use.can_id, use.extended)))
      received_.emplace(cob_id_of(use.can_id, use.extended), named(use));
  }
  // The rates on which the load and the response times of the network rely.
  for (const TimedMessage& one : network_timing(network, uses).messages) {
    const auto at = places_.find(cob_id_of(one.message.can_id, one.message.extended));
    if (at == places_.end() || one.service != FrameService::pdo) continue;
    frames_[at->second].period_us = std::chrono::duration_cast<std::chrono::microseconds>(one.message.period).count();
  }
}

void AllowedTraffic::add(const CobIdUse& use, const std::vector<CobIdUse>& uses) {
  if (!places_.emplace(cob_id_of(use.can_id, use.extended), frames_.size()).second) return;
  AllowedFrame frame{.node = use.node, .service = use.service, .sdo = use.sdo, .name = named(use)};
  const auto bytes = [&](std::uint8_t size) { frame.min_bytes = frame.max_bytes = size; };
  switch (use.service) {
    case FrameService::nmt: bytes(2); break;
    case FrameService::sync:
      bytes(value_of(use.node->device(), communication::sync_overflow).value_or(0) != 0 ? 1 : 0);
      frame.period_us =
          static_cast<std::int64_t>(value_of(use.node->device(), communication::cycle_period).value_or(0));
      break;
    case FrameService::time: bytes(6); break;
    case FrameService::emcy:
    case FrameService::sdo: bytes(8); break;
    case FrameService::error_control: bytes(1); break;
    case FrameService::pdo: add_pdo(use, uses, frame); break;
  }
  frames_.push_back(std::move(frame));
}

void AllowedTraffic::add_pdo(const CobIdUse& use, const std::vector<CobIdUse>& uses, AllowedFrame& frame) const {
  const Pdo& pdo = *use.pdo;
  frame.max_bytes = static_cast<std::uint8_t>(pdo.multiplexed ? 8U : std::min(pdo.bytes(), 8U));
  frame.min_bytes = frame.max_bytes;
  const auto type = static_cast<std::uint32_t>(communication_default(pdo, transmission_type_sub_index).value_or(255));
  const auto interval = longest_interval(use, uses);
  const std::int64_t longest =
      interval ? std::chrono::duration_cast<std::chrono::microseconds>(*interval).count() : std::int64_t{0};
  switch (canopen::transmission_of(type)) {
    case canopen::Transmission::synchronous:
      if (sync_producer(uses) != nullptr) frame.sync_cycles = type;
      break;
    case canopen::Transmission::event_driven:
      frame.longest_us = longest;
      frame.inhibit_us = static_cast<std::int64_t>(communication_default(pdo, inhibit_time_sub_index).value_or(0) *
                                                   use.node->loaded->options.inhibit_time_unit());
      break;
    case canopen::Transmission::remote_synchronous:
    case canopen::Transmission::remote: frame.is_requested = true; break;
    case canopen::Transmission::reserved: break;
  }
}

std::optional<std::size_t> AllowedTraffic::find(const canopen::Frame& frame) const {
  const auto at = places_.find(canopen::cob_id_of(frame));
  return at == places_.end() ? std::nullopt : std::optional{at->second};
}

std::string AllowedTraffic::receiver_of(const canopen::Frame& frame) const {
  const auto at = received_.find(canopen::cob_id_of(frame));
  return at == received_.end() ? std::string{} : at->second;
}

NodeTimes AllowedTraffic::times_of(const NetworkNode& node) const {
  NodeTimes times;
  times.heartbeat_us = static_cast<std::int64_t>(heartbeat_time(node.device())) * per_millisecond;
  if (times.heartbeat_us == 0) {
    const auto guarding = node_guarding(node.device());
    if (guarding && !node.is_master) {
      times.timeout_us = std::int64_t{guarding->guard_time} * guarding->life_time_factor * per_millisecond;
    }
    return times;
  }
  std::int64_t shortest = 2 * times.heartbeat_us;
  bool is_consumed = false;
  for (const NetworkNode& consumer : network_->nodes) {
    const Object* const object = consumer.device().find(communication::consumer_heartbeat);
    if (object == nullptr) continue;
    for (const Entry& entry : object->entries) {
      const std::uint64_t value = entry.sub_index != 0 && entry.default_value ? entry.default_value->bits : 0;
      const auto consumed = static_cast<std::int64_t>(value & 0xFFFF) * per_millisecond;
      if ((value >> 16 & 0xFF) != node.node_id || consumed <= times.heartbeat_us) continue;
      shortest = is_consumed ? std::min(shortest, consumed) : consumed;
      is_consumed = true;
    }
  }
  times.timeout_us = shortest;
  return times;
}

bool AllowedTraffic::is_configured(const NetworkNode& node, std::uint16_t index, std::uint8_t sub_index) {
  if (is_of_boot_up(index) || index == communication::producer_heartbeat) return true;
  if (node.settings.find(index, sub_index) != nullptr || is_of_configured_pdo(node, index, sub_index)) return true;
  // A DCF configures all entries with a value.
  const Entry* const entry = node.description->dcf ? node.device().find(index, sub_index) : nullptr;
  return entry != nullptr && entry->default_value && canopen::writable(entry->access);
}

std::string AllowedTraffic::configured_value(const NetworkNode& node, std::uint16_t index, std::uint8_t sub_index) {
  if (is_of_boot_up(index)) return {};
  const Entry* const entry = node.device().find(index, sub_index);
  if (entry == nullptr || !entry->default_value || entry->default_value->plus_node_id) return {};
  return bytes_of(*entry->default_value, *entry->type);
}

std::string entry_name(const NetworkNode& node, std::uint16_t index, std::uint8_t sub_index) {
  const Object* const object = node.device().find(index);
  const Entry* const entry = object != nullptr ? object->find(sub_index) : nullptr;
  std::string text = fmt::format("{:04X}h:{:02X}", index, sub_index);
  if (entry != nullptr) text += " " + entry->parameter_name();
  return text;
}

}  // namespace edsc::watch
