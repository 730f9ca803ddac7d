/// An NMT master and slaves on a virtual bus, with all that happens in order.
#pragma once

#include <gtest/gtest.h>
#include <canopen/nmt_master/nmt_master.hpp>
#include <canopen_sim/virtual_bus.hpp>

#include <chrono>
#include <cstdint>
#include <cstdio>
#include <list>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "support/bench.hpp"

namespace master_bench {

inline constexpr const char* event_names[] = {"boot-up", "state", "unexpected state", "toggle error",
                                              "lost",    "back",  "not watched",      "restarted"};

/// Records the events of the master.
struct Host {
  std::vector<std::string>* log;

  void happened(canopen::NmtMasterEvent event, canopen::NodeId node_id, canopen::NmtState state) {
    if (event == canopen::NmtMasterEvent::not_watched) return;  // true of most slaves here
    char text[40];
    std::snprintf(text, sizeof text, "(%d %s %02X)", node_id.value(), event_names[static_cast<int>(event)],
                  static_cast<unsigned>(state));
    log->push_back(text);
  }
  void booted(canopen::NodeId node_id, canopen::BootStatus status) {
    log->push_back("(" + std::to_string(node_id.value()) + " " + static_cast<char>(status) + ")");
  }
  void network_started() { log->push_back("(network started)"); }
  void boot_time_elapsed() { log->push_back("(boot time elapsed)"); }
};

/// The sample device as a slave on the bus: with a heartbeat every 50 ms after each reset, or guarded.
class Slave {
 public:
  Slave(canopen::VirtualBus& bus, std::uint8_t node_id, bool beats)
      : bus_{bus}, end_{bus.attach()}, node_{end_, canopen::NodeId{node_id}}, node_id_{node_id}, beats_{beats} {
    end_.on_frame = [this](const canopen::Frame& frame, canopen::TimePoint now) { on_frame(frame, now); };
    end_.on_time = [this](canopen::TimePoint now) {
      if (on_) node_.on_time(now);
    };
    end_.next_deadline = [this]() -> std::optional<canopen::TimePoint> {
      return on_ ? node_.next_deadline() : std::nullopt;
    };
  }

  void switch_on() {
    on_ = true;
    node_.start(bus_.now());
    after_reset();
  }
  void switch_off() { on_ = false; }

  [[nodiscard]] canopen::NmtState state() const { return node_.state(); }

 private:
  void on_frame(const canopen::Frame& frame, canopen::TimePoint now) {
    if (!on_) return;
    if (canopen::is_guarding_request(frame, node_id_) && !beats_) {
      guarding_.on_request(0, 0, now);
      EXPECT_TRUE(guarding_.serve(end_, node_id_, node_.state()));
      return;
    }
    node_.on_frame(frame, now);
    const auto command = canopen::nmt_command(frame, node_id_);
    if (command == canopen::NmtCommand::reset_node || command == canopen::NmtCommand::reset_communication)
      after_reset();
  }

  void after_reset() {
    guarding_.reset();
    if (beats_) {
      EXPECT_EQ(node_.set<sample::od::producer_heartbeat_time>(canopen::raw(50)), canopen::ok);
    }
  }

  canopen::VirtualBus& bus_;
  canopen::VirtualBus::Endpoint& end_;
  bench::NodeOf<sample::Device, canopen::VirtualBus::Endpoint> node_;
  canopen::NodeGuardingSlave guarding_{};
  canopen::NodeId node_id_;
  bool beats_;
  bool on_ = false;
};

/// A master, its slaves, and everything that happens, in order: frames as in a candump log, events of the master in
/// brackets. PDOs are ignored; so are heartbeats and guarding unless they are requested.
struct Network {
  Network(std::vector<canopen::NmtSlave> list, canopen::NmtStartUp how)
      : slaves{std::move(list)}, master{end, slaves, how, std::chrono::milliseconds{100}, Host{&log}} {
    canopen::VirtualBus::connect(end, master);
    bus.listen([this](const canopen::Frame& frame, canopen::TimePoint) {
      const std::uint32_t function = frame.id & ~0x7Fu;
      const bool boot_up = function == 0x700 && !frame.remote && frame.data[0] == 0;
      if (function >= 0x180 && function < 0x580) return;
      if (function == 0x700 && !boot_up && !with_error_control) return;
      log.push_back(bench::text(frame));
    });
  }

  Slave& slave(std::uint8_t node_id, bool beats) { return devices.emplace_back(bus, node_id, beats); }

  /// Returns what happens during this time.
  std::vector<std::string> pass(canopen::Duration span) {
    bus.run_for(span);
    return std::exchange(log, {});
  }

  canopen::VirtualBus bus;
  std::vector<std::string> log;
  bool with_error_control = false;
  std::vector<canopen::NmtSlave> slaves;
  canopen::VirtualBus::Endpoint& end = bus.attach();
  canopen::NmtMaster<canopen::VirtualBus::Endpoint, 8, Host> master;
  std::list<Slave> devices;
};

/// The identity of the sample device.
inline canopen::NmtSlave slave_with_identity(std::uint8_t node_id, std::uint32_t bits) {
  canopen::NmtSlave slave{canopen::NodeId{node_id}, bits};
  slave.device_type = 0xF0191;
  slave.vendor_id = 0x1234;
  slave.product_code = 0x10001;
  slave.revision_number = 0x10002;
  return slave;
}

}  // namespace master_bench
