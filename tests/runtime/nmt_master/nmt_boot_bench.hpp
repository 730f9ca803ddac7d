/// An NMT master whose slaves are written by the test, frame by frame, and transfers of its application.
#pragma once

#include <gtest/gtest.h>
#include <canopen/nmt_master/nmt_master.hpp>

#include <array>
#include <chrono>
#include <cstdint>
#include <span>
#include <string>
#include <utility>
#include <vector>

#include "support/bench.hpp"

namespace boot_bench {

using Lines = std::vector<std::string>;

inline constexpr std::uint32_t mandatory =
    canopen::slave_assignment::listed | canopen::slave_assignment::boot | canopen::slave_assignment::mandatory;

struct Told {
  Lines log;
  std::vector<canopen::BootResult> results;
};

struct Host {
  Told* told;

  void happened(canopen::NmtMasterEvent event, canopen::NodeId node_id, canopen::NmtState) {
    if (event == canopen::NmtMasterEvent::state_changed) return;
    told->log.push_back(std::to_string(node_id.value()) + " " + std::string{to_text(event)});
  }
  void configure(canopen::NodeId node_id) { told->log.push_back(std::to_string(node_id.value()) + " configure"); }
  void booted(canopen::NodeId node_id, const canopen::BootResult& result) {
    told->log.push_back(std::to_string(node_id.value()) + " " + static_cast<char>(result.status));
    told->results.push_back(result);
  }
  void network_started() { told->log.push_back("network started"); }
  void boot_time_elapsed() { told->log.push_back("boot time elapsed"); }
};

/// A master of nodes 5 and 6; the test writes the frames of the slaves.
struct Desk {
  explicit Desk(std::vector<canopen::NmtSlave> list) : slaves{std::move(list)} {}

  void start() {
    master.start(now);
    EXPECT_EQ(bus.take(), "000 82 00");
  }
  std::string take(const std::string& text) {
    master.on_frame(bench::frame(text), now);
    return bus.take();
  }
  std::string pass(canopen::Duration span) {
    const canopen::TimePoint end = now + span;
    for (int calls = 0; calls < 100'000; ++calls) {
      const auto deadline = master.next_deadline();
      if (!deadline || *deadline > end) break;
      if (*deadline <= now) {  // it waits for room
        if (bus.room == 0) break;
      } else {
        now = *deadline;
      }
      master.on_time(now);
    }
    now = end;
    master.on_time(now);
    return bus.take();
  }
  /// Node 5 sends `count` heartbeats with this distance; returns what the master sends at the last one.
  std::string beat(int count, canopen::Duration period) {
    for (; count > 1; --count) {
      EXPECT_EQ(take("705 7F"), "");
      EXPECT_EQ(pass(period), "");
    }
    return take("705 7F");
  }
  Lines log() { return std::exchange(told.log, {}); }

  bench::RecordingBus bus;
  Told told;
  canopen::TimePoint now{};
  std::vector<canopen::NmtSlave> slaves;
  canopen::NmtMaster<bench::RecordingBus, 2, Host, 3> master{
      bus, slaves, {}, std::chrono::milliseconds{100}, Host{&told}};
};

/// The response to each read of the device type.
inline constexpr auto device_type = "585 43 00 10 00 91 01 0F 00";

inline canopen::NmtSlave slave(std::uint8_t node_id, std::uint16_t heartbeat_time = 0) {
  canopen::NmtSlave result{canopen::NodeId{node_id}, mandatory};
  result.heartbeat_time = heartbeat_time;
  return result;
}

/// A transfer of the application that records its result.
struct Transfer {
  canopen::SdoRequest read(std::uint16_t index, std::uint8_t sub_index) {
    canopen::SdoRequest request;
    request.index = index;
    request.sub_index = sub_index;
    request.memory = memory;
    request.done = done;
    request.context = this;
    return request;
  }
  canopen::SdoRequest write(std::uint16_t index, std::uint8_t sub_index, std::span<const std::uint8_t> bytes) {
    canopen::SdoRequest request;
    request.index = index;
    request.sub_index = sub_index;
    request.download = true;
    request.bytes = bytes;
    request.done = done;
    request.context = this;
    return request;
  }
  static void done(void* context, canopen::NodeId, const canopen::SdoAnswer& answer) {
    auto& self = *static_cast<Transfer*>(context);
    ++self.calls;
    self.result = answer.result;
    self.size = answer.data.size();
  }

  std::array<std::uint8_t, 8> memory{};
  canopen::AbortCode result = ok_to_come;
  std::size_t size = 0;
  int calls = 0;
  static constexpr canopen::AbortCode ok_to_come = canopen::AbortCode::local_control;
};

}  // namespace boot_bench
