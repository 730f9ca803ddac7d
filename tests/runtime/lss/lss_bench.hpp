/// An LSS slave with a device that records its events.
#pragma once

#include <canopen/lss/lss_slave.hpp>
#include <cstdint>
#include <string>
#include <vector>

#include "support/bench.hpp"

namespace bench {

/// The example of manual 004, below Figure 12.
inline constexpr canopen::LssAddress rk5c_address{0x0000'0093, 0x4335'4B52, 0x0001'0001, 0x1501'1234};

/// A device as its LSS slave uses it. It enters Pre-operational from Initialisation when it has a node-ID.
template <canopen::LssOptions options = canopen::LssOptions{}>
class LssDevice {
 public:
  struct Hooks {
    LssDevice& device;
    std::uint32_t identity(std::uint8_t sub_index) { return device.identity(sub_index); }
    canopen::LssError accept(canopen::NodeId) { return device.node_id_error; }
    canopen::LssError accept(canopen::LssBitTiming) { return device.bit_timing_error; }
    canopen::LssError store(canopen::NodeId node_id, canopen::LssBitTiming bit_timing) {
      if (device.store_error.code == 0) {
        device.stored_node_id = node_id;
        device.stored_bit_timing = bit_timing;
      }
      return device.store_error;
    }
    void reset_communication() { device.reset_communication(); }
    void stop_communication() { device.events.push_back(device.at() + "stop"); }
    void start_communication(canopen::LssBitTiming bit_timing) {
      device.events.push_back(device.at() + "start " + std::to_string(bit_timing.table) + "." +
                              std::to_string(bit_timing.index));
    }
  };

  explicit LssDevice(canopen::NodeId persistent = canopen::NodeId{5},
                     const canopen::LssAddress& lss_address = rk5c_address)
      : address{lss_address}, stored_node_id{persistent} {
    power_on();
  }

  void power_on() {
    slave.start(stored_node_id, stored_bit_timing);
    reset_communication();
  }

  void reset_communication() {
    const canopen::NodeId node_id = slave.reset_communication();
    enter(canopen::NmtState::initialisation);
    if (node_id.valid()) enter(canopen::NmtState::pre_operational);
  }

  void enter(canopen::NmtState next) {
    state = next;
    slave.enter(next);
  }

  /// Returns what the device sends in response to this frame.
  std::string ask(const std::string& request) { return ask(frame(request)); }
  std::string ask(const canopen::Frame& request) {
    slave.on_frame(request, Hooks{*this}, now);
    (void)slave.serve(bus);
    return bus.take();
  }

  /// Returns what it sends during this time.
  std::string pass(canopen::Duration span) {
    const canopen::TimePoint end = now + span;
    while (const auto deadline = slave.next_deadline()) {
      if (*deadline > end) break;
      now = *deadline;
      slave.on_time(Hooks{*this}, now);
      (void)slave.serve(bus);
    }
    now = end;
    return bus.take();
  }

  [[nodiscard]] std::uint32_t identity(std::uint8_t sub_index) const {
    switch (sub_index) {
      case 1: return address.vendor_id;
      case 2: return address.product_code;
      case 3: return address.revision_number;
      case 4: return address.serial_number;
      default: ADD_FAILURE() << "1018h has no sub-index " << int{sub_index}; return 0;
    }
  }

  [[nodiscard]] std::string at() const { return std::to_string(now.since_start().count() / 1000) + " ms: "; }

  canopen::LssAddress address;
  canopen::NodeId stored_node_id;
  canopen::LssBitTiming stored_bit_timing{0, 4};
  canopen::LssError node_id_error{};
  canopen::LssError bit_timing_error{};
  canopen::LssError store_error{};
  canopen::NmtState state = canopen::NmtState::initialisation;
  std::vector<std::string> events;
  RecordingBus bus;
  canopen::TimePoint now{};
  canopen::LssSlave<options> slave;
};

inline constexpr auto to_waiting = "7E5 04 00 00 00 00 00 00 00";
inline constexpr auto to_configuration = "7E5 04 01 00 00 00 00 00 00";

/// A slave in configuration state.
template <canopen::LssOptions options = canopen::LssOptions{}>
struct ConfiguredDevice : LssDevice<options> {
  explicit ConfiguredDevice(canopen::NodeId persistent = canopen::NodeId{5}) : LssDevice<options>{persistent} {
    this->ask(to_configuration);
  }
};

}  // namespace bench
