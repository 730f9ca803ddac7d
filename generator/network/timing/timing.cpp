#include "network/timing/timing.hpp"

#include <algorithm>
#include <chrono>
#include <optional>
#include <string_view>
#include <utility>

#include "device/complete_device.hpp"
#include "device/options/options.hpp"
#include "device/pdo/pdo_defaults.hpp"
#include "network/communication_objects.hpp"
#include "network/error_control.hpp"

namespace edsc {
namespace {

using std::chrono::microseconds;
using std::chrono::milliseconds;

constexpr std::uint8_t time_of_day_bytes = 6;
constexpr std::uint8_t nmt_command_bytes = 2;

milliseconds interval(const WrittenNumber& number, unsigned default_ms) {
  return milliseconds{number ? number->value : default_ms};
}

/// Inhibit times of 1015h and of PDOs are in multiples of 100 us.
Nanoseconds inhibit_time(std::uint64_t value, std::uint32_t unit_us = usual_inhibit_time_unit) {
  return microseconds{unit_us} * static_cast<std::int64_t>(value);
}

/// 0 if no node sends SYNC.
Nanoseconds sync_period_of(const std::vector<CobIdUse>& uses) {
  const CobIdUse* const producer = sync_producer(uses);
  if (producer == nullptr) return {};
  const auto period = value_of(producer->node->device(), communication::cycle_period).value_or(0);
  return microseconds{static_cast<std::int64_t>(period)};
}

std::uint64_t transmission_type(const CobIdUse& pdo) {
  return communication_default(*pdo.pdo, transmission_type_sub_index).value_or(default_transmission_type);
}

Nanoseconds time_of_cycles(std::uint64_t type, Nanoseconds sync_period) {
  return sync_period * static_cast<std::int64_t>(std::max<std::uint64_t>(type, 1));
}

milliseconds event_timer(const CobIdUse& pdo) {
  return milliseconds{static_cast<std::int64_t>(communication_default(*pdo.pdo, event_timer_sub_index).value_or(0))};
}

class MessageCollector {
 public:
  MessageCollector(const Network& network, const std::vector<CobIdUse>& uses)
      : network_{network}, uses_{uses}, assume_{network.description.assume}, sync_period_{sync_period_of(uses)} {}

  std::vector<TimedMessage> collect() {
    for (const CobIdUse& use : uses_) {
      if (use.transmits && use.service != FrameService::sdo) add(use);
    }
    add_sdo(SdoFrames::requests, "SDO requests");
    add_sdo(SdoFrames::responses, "SDO responses");
    std::ranges::stable_sort(messages_, {}, [](const TimedMessage& one) { return one.message.can_id; });
    return std::move(messages_);
  }

 private:
  void add(const CobIdUse& use) {
    switch (use.service) {
      case FrameService::pdo: return add_pdo(use);
      case FrameService::sync: {
        const bool is_counted = value_of(use.node->device(), communication::sync_overflow).value_or(0) != 0;
        return add(use, is_counted ? 1 : 0, sync_period_);
      }
      case FrameService::time: return add_assumed(use, time_of_day_bytes, interval(assume_.time_ms, 1000));
      case FrameService::nmt: return add_assumed(use, nmt_command_bytes, interval(assume_.nmt_ms, 1000));
      case FrameService::emcy: {
        const auto inhibit = value_of(use.node->device(), communication::inhibit_time_emcy).value_or(0);
        if (inhibit != 0) return add(use, 8, inhibit_time(inhibit));
        return add_assumed(use, 8, interval(assume_.emcy_ms, 1000));
      }
      case FrameService::error_control: return add_error_control(use);
      case FrameService::sdo: return;
    }
  }

  TimedMessage message_of(const CobIdUse& use, std::size_t size, Nanoseconds period) const {
    TimedMessage one;
    one.name = named(use);
    one.position = use.position;
    one.service = use.service;
    one.message.can_id = use.can_id;
    one.message.extended = use.extended;
    one.message.size = static_cast<std::uint8_t>(std::min<std::size_t>(size, 8));
    one.message.period = period;
    return one;
  }

  void add(const CobIdUse& use, std::size_t size, Nanoseconds period) {
    if (period > Nanoseconds{}) messages_.push_back(message_of(use, size, period));
  }

  void add_assumed(const CobIdUse& use, std::size_t size, Nanoseconds period) {
    messages_.push_back(message_of(use, size, period));
    messages_.back().has_assumed_period = true;
  }

  void add_pdo(const CobIdUse& use) {
    const std::uint64_t type = transmission_type(use);
    const std::size_t size = use.pdo->multiplexed ? classical_can.bytes : use.pdo->bytes();
    switch (canopen::transmission_of(static_cast<std::uint32_t>(type))) {
      case canopen::Transmission::synchronous: return add_synchronous(use, size, type);
      case canopen::Transmission::event_driven: return add_event_driven(use, size);
      case canopen::Transmission::remote_synchronous:
      case canopen::Transmission::remote:
      case canopen::Transmission::reserved: return;
    }
  }

  void add_synchronous(const CobIdUse& use, std::size_t size, std::uint64_t type) {
    if (sync_period_ == Nanoseconds{}) return;
    TimedMessage one = message_of(use, size, time_of_cycles(type, sync_period_));
    one.is_synchronous = true;
    const auto window = value_of(use.node->device(), communication::window_length).value_or(0);
    one.message.deadline = window != 0 ? microseconds{static_cast<std::int64_t>(window)} : sync_period_;
    messages_.push_back(std::move(one));
  }

  void add_event_driven(const CobIdUse& use, std::size_t size) {
    const Nanoseconds inhibit = inhibit_time(communication_default(*use.pdo, inhibit_time_sub_index).value_or(0),
                                             use.node->loaded->options.inhibit_time_unit());
    const milliseconds timer = event_timer(use);
    TimedMessage one = message_of(use, size, inhibit != Nanoseconds{} ? inhibit : timer);
    if (one.message.period == Nanoseconds{}) {
      one.message.period = interval(assume_.event_ms, 100);
      one.has_assumed_period = true;
    }
    one.may_be_sent_earlier = inhibit == Nanoseconds{};
    // Without an event timer, the network does not state when the value is needed.
    const Nanoseconds needed = timer != milliseconds{} ? Nanoseconds{timer} : interval(assume_.event_ms, 100);
    one.message.deadline = std::max(needed, one.message.period);
    messages_.push_back(std::move(one));
  }

  /// Heartbeat, or node guarding with a request of the master.
  void add_error_control(const CobIdUse& use) {
    const Device& device = use.node->device();
    const std::uint64_t heartbeat = heartbeat_time(device);
    if (heartbeat != 0) {
      messages_.push_back(message_of(use, 1, milliseconds{static_cast<std::int64_t>(heartbeat)}));
      messages_.back().name = use.node->name + " heartbeat";
      messages_.back().message.deadline = slack_of_heartbeat(*use.node, heartbeat);
      return;
    }
    const auto guarding = node_guarding(device);
    if (!guarding) return;
    const milliseconds guard_time{guarding->guard_time};
    messages_.push_back(message_of(use, 1, guard_time));
    messages_.push_back(message_of(use, 1, guard_time));
    messages_.back().message.remote = true;
    messages_.back().name += " request";
  }

  /// The time by which a heartbeat may be late before the first of its consumers reports the node.
  [[nodiscard]] Nanoseconds slack_of_heartbeat(const NetworkNode& producer, std::uint64_t heartbeat) const {
    std::optional<std::uint64_t> shortest;
    for (const NetworkNode& node : network_.nodes) {
      const Object* const object = node.device().find(communication::consumer_heartbeat);
      if (object == nullptr) continue;
      for (const Entry& entry : object->entries) {
        const std::uint64_t value = entry.sub_index != 0 && entry.default_value ? entry.default_value->bits : 0;
        const std::uint64_t time = value & 0xFFFF;
        if ((value >> 16 & 0xFF) == producer.node_id && time > heartbeat) {
          shortest = std::min(shortest.value_or(time), time);
        }
      }
    }
    const std::uint64_t slack = shortest ? *shortest - heartbeat : heartbeat;
    return milliseconds{static_cast<std::int64_t>(slack)};
  }

  /// The request or response of highest priority, for all SDOs of the network.
  void add_sdo(SdoFrames frames, std::string_view name) {
    const CobIdUse* first = nullptr;
    for (const CobIdUse& use : uses_) {
      const bool is_kind = use.sdo == frames && use.transmits && !use.extended;
      if (is_kind && (first == nullptr || use.can_id < first->can_id)) first = &use;
    }
    if (first == nullptr) return;
    add_assumed(*first, 8, interval(assume_.sdo_ms, 10));
    messages_.back().name = name;
  }

  const Network& network_;
  const std::vector<CobIdUse>& uses_;
  const AssumedIntervals& assume_;
  Nanoseconds sync_period_;
  std::vector<TimedMessage> messages_;
};

std::vector<ResponseTime> responses(const std::vector<TimedMessage>& messages, const BusTiming& bus) {
  std::vector<CanMessage> plain;
  plain.reserve(messages.size());
  for (const TimedMessage& one : messages) plain.push_back(one.message);
  return response_times(plain, bus);
}

/// A synchronous PDO cannot be queued before SYNC was received.
void add_sync_jitter(std::vector<TimedMessage>& messages, const std::vector<ResponseTime>& found) {
  Nanoseconds sync{};
  for (std::size_t i = 0; i < found.size(); ++i) {
    if (messages[i].service == FrameService::sync) sync = found[i].worst.value_or(Nanoseconds{});
  }
  for (TimedMessage& one : messages) {
    if (one.is_synchronous) one.message.jitter = sync;
  }
}

}  // namespace

std::optional<Nanoseconds> longest_interval(const CobIdUse& tpdo, const std::vector<CobIdUse>& uses) {
  const std::uint64_t type = transmission_type(tpdo);
  Nanoseconds interval{};
  switch (canopen::transmission_of(static_cast<std::uint32_t>(type))) {
    case canopen::Transmission::synchronous:
      // Type 0: at the SYNC after an event.
      if (type != 0) interval = time_of_cycles(type, sync_period_of(uses));
      break;
    case canopen::Transmission::event_driven: interval = event_timer(tpdo); break;
    case canopen::Transmission::remote_synchronous:
    case canopen::Transmission::remote:
    case canopen::Transmission::reserved: break;
  }
  return interval != Nanoseconds{} ? std::optional{interval} : std::nullopt;
}

NetworkTiming network_timing(const Network& network, const std::vector<CobIdUse>& uses) {
  NetworkTiming timing;
  if (!network.description.bit_rate) return timing;
  BusTiming bus{network.description.bit_rate->value * 1000, {}};
  if (const WrittenNumber& error = network.description.error_interval_ms)
    bus.error_interval = milliseconds{error->value};
  timing.messages = MessageCollector{network, uses}.collect();
  add_sync_jitter(timing.messages, responses(timing.messages, bus));
  const std::vector<ResponseTime> found = responses(timing.messages, bus);
  for (std::size_t i = 0; i < found.size(); ++i) timing.messages[i].response = found[i];
  std::vector<CanMessage> plain;
  for (const TimedMessage& one : timing.messages) plain.push_back(one.message);
  timing.load = bus_load(plain, bus);
  return timing;
}

}  // namespace edsc
