/// A node of the runtime and a model of the NMT slave receive the same frames: all commands with all node-IDs and
/// lengths in each state, and random walks with the other services in between.
#include "nmt_slave_model.hpp"

#include <gtest/gtest.h>
#include <canopen/node.hpp>
#include <pdo_device/device.hpp>

#include <cstdio>
#include <cstdlib>
#include <random>
#include <vector>

namespace {

namespace od = pdo_device::od;
using canopen::Frame;
using State = model::NmtSlave::State;
using Reset = model::NmtSlave::Reset;
using namespace std::chrono_literals;

#ifdef EDSC_SANITIZED
constexpr unsigned thinned = 10;
#else
constexpr unsigned thinned = 1;
#endif

constexpr std::uint8_t node_id = 5;

struct Bus {
  std::vector<Frame> sent;
  bool send(const Frame& frame) {
    sent.push_back(frame);
    return true;
  }
};

class Pair {
 public:
  Pair() {
    node.start(now);
    expect_sent({boot_up()}, "a boot-up message after power-on");
    check();
  }

  void ask(const Frame& frame) {
    ++requests;
    bus.sent.clear();
    node.on_frame(frame, now);
  }

  /// A frame with CAN-ID 000h.
  void command(const Frame& frame) {
    const bool was_operational = expected.pdo();
    const Reset reset = expected.take({frame.data.data(), frame.size});
    ask(frame);
    last = frame;
    if (reset != Reset::none) {
      heartbeat = 0;
      if (reset == Reset::application) {
        byte = 0;
        long_word = 0;
      }
      expect_sent({boot_up()}, "a reset ends with the boot-up message");
    } else {
      // EMCYs that waited in Stopped, and event-driven TPDOs on entering Operational (7.2.2.4).
      const bool entered = !was_operational && expected.pdo();
      for (const Frame& sent : bus.sent) {
        expect((entered && is_tpdo(sent)) || (waiting && expected.emcy() && sent.id == 0x085),
               "a command is not answered");
      }
    }
    if (expected.emcy()) waiting = false;
    check();
  }

  void check() {
    expect(static_cast<std::uint8_t>(node.state()) == static_cast<std::uint8_t>(expected.state()), "the NMT state");
    expect(node.get<od::byte>() == byte && node.get<od::long_word>() == long_word, "values of the application");
    expect(canopen::to_raw(node.get<od::producer_heartbeat_time>()) == heartbeat, "1017h");
  }

  /// Uses each service once.
  void probe(std::uint32_t value) {
    // SDO
    ask({.id = 0x605, .size = 8, .data = {0x40, 0x00, 0x10}});
    if (expected.sdo()) {
      expect_sent({{.id = 0x585, .size = 8, .data = {0x43, 0x00, 0x10}}}, "SDO is answered");
    } else {
      expect_sent({}, "SDO is not answered");
    }
    // An RPDO with 2001h and 2002h.
    Frame rpdo{.id = 0x205, .size = 6};
    for (unsigned i = 0; i < 4; ++i) rpdo.data[2 + i] = static_cast<std::uint8_t>(value >> 8 * i);
    ask(rpdo);
    if (expected.pdo()) {
      long_word = value;
    } else {
      expect_sent({}, "a PDO is not answered");
    }
    // SYNC: TPDO 3 is of type 1.
    ask({.id = 0x080, .size = 0});
    std::size_t synchronous = 0;
    for (const Frame& sent : bus.sent) {
      expect(expected.pdo() && is_tpdo(sent), "PDOs are sent in Operational alone");
      if (sent.id == 0x385) ++synchronous;
    }
    expect(synchronous == (expected.pdo() ? 1u : 0u), "SYNC sends a synchronous TPDO in Operational alone");
    check();
  }

  /// Sets values over SDO: an application object and 1017h.
  void configure(std::uint8_t new_byte, std::uint8_t new_heartbeat) {
    ask({.id = 0x605, .size = 8, .data = {0x2F, 0x00, 0x20, 0x00, new_byte}});
    ask({.id = 0x605, .size = 8, .data = {0x2B, 0x17, 0x10, 0x00, new_heartbeat}});
    if (expected.sdo()) {
      byte = new_byte;
      heartbeat = new_heartbeat;
    }
    check();
  }

  /// Lets 1 s pass: heartbeats contain the state, in each state.
  void pass() {
    bus.sent.clear();
    const canopen::TimePoint end = now + canopen::Duration{1s};
    while (const auto deadline = node.next_deadline()) {
      if (*deadline > end) break;
      if (*deadline > now) now = *deadline;
      node.on_time(now);
    }
    now = end;
    node.on_time(now);
    std::size_t heartbeats = 0;
    for (const Frame& sent : bus.sent) {
      if (sent.id == 0x700 + node_id) {
        ++heartbeats;
        expect(sent.size == 1 && sent.data[0] == static_cast<std::uint8_t>(expected.state()),
               "a heartbeat tells the state");
      } else {
        expect(expected.pdo() && is_tpdo(sent), "PDOs are sent in Operational alone");
      }
    }
    if (heartbeat == 0) return expect(heartbeats == 0, "1017h = 0: no heartbeats");
    const std::size_t right = 1000u / heartbeat;
    expect(heartbeats + 1 >= right && heartbeats <= right + 1, "a heartbeat each period");
  }

  /// Reports an error of the application: EMCY is sent except in Stopped.
  void error() {
    bus.sent.clear();
    node.emergency(0xFF00, canopen::ErrorRegister{});
    node.on_time(now);
    std::size_t emergencies = 0;
    for (const Frame& sent : bus.sent) emergencies += sent.id == 0x085 ? 1u : 0u;
    waiting = waiting || !expected.emcy();
    expect(emergencies == (expected.emcy() ? 1u : 0u), "EMCY is sent except in Stopped");
    node.emergency_over(canopen::ErrorRegister{});
    node.on_time(now);
  }

  std::uint64_t requests = 0;
  int failures = 0;

 private:
  [[nodiscard]] static Frame boot_up() { return {.id = 0x700 + node_id, .size = 1}; }
  [[nodiscard]] static bool is_tpdo(const Frame& frame) {
    return frame.id == 0x185 || frame.id == 0x285 || frame.id == 0x385;
  }

  void expect_sent(const std::vector<Frame>& frames, const char* what) { expect(bus.sent == frames, what); }
  void expect(bool holds, const char* what) {
    if (holds || ++failures > 10) return;
    ADD_FAILURE() << what << " does not hold in state " << static_cast<int>(expected.state())
                  << " (the node's: " << static_cast<int>(node.state()) << "), last command " << int{last.data[0]}
                  << " for " << int{last.data[1]} << ", " << int{last.size} << " bytes, " << bus.sent.size()
                  << " frames" << (bus.sent.empty() ? "" : ", the first with CAN-ID ")
                  << (bus.sent.empty() ? 0 : bus.sent.front().id);
  }

  canopen::TimePoint now{};
  Bus bus;
  canopen::Node<pdo_device::Device, Bus> node{bus, canopen::NodeId{node_id}};
  model::NmtSlave expected{node_id};
  Frame last{};
  std::uint8_t byte = 0;
  std::uint32_t long_word = 0;
  std::uint16_t heartbeat = 0;
  bool waiting = false;  ///< EMCYs are waiting
};

void tell(const Pair& pair) { std::printf("%llu requests\n", static_cast<unsigned long long>(pair.requests)); }

constexpr std::uint8_t from_each_state[] = {1, 2, 128};
constexpr std::uint8_t sizes[] = {0, 1, 2, 3, 8};

TEST(NmtSlaveModel, EachCommandInEachState) {
  Pair pair;
  for (const std::uint8_t before : from_each_state) {
    for (unsigned command = 0; command < 256; ++command) {
      for (unsigned to = 0; to<256; to += to> 8 ? thinned : 1) {
        for (const std::uint8_t size : sizes) {
          if (size != 2 && to > 6) continue;
          pair.command({.id = 0, .size = 2, .data = {before, node_id}});
          pair.command(
              {.id = 0, .size = size, .data = {static_cast<std::uint8_t>(command), static_cast<std::uint8_t>(to)}});
          if (to < 7) pair.probe(command * 256 + to);
        }
      }
    }
  }
  tell(pair);
}

TEST(NmtSlaveModel, OtherFramesAreNotCommands) {
  Pair pair;
  for (const std::uint8_t before : from_each_state) {
    for (unsigned command = 0; command < 256; ++command) {
      pair.command({.id = 0, .size = 2, .data = {before, 0}});
      const canopen::sdo::Data data{static_cast<std::uint8_t>(command), node_id};
      pair.ask({.id = 0, .size = 2, .extended = true, .data = data});
      pair.check();
      pair.ask({.id = 0, .size = 2, .remote = true, .data = data});
      pair.check();
      pair.ask({.id = 0x001, .size = 2, .data = data});
      pair.check();
    }
  }
}

TEST(NmtSlaveModel, RandomWalks) {
  const char* const given = std::getenv("EDSC_MODEL_SEED");
  const std::uint32_t seed = given != nullptr ? static_cast<std::uint32_t>(std::strtoul(given, nullptr, 0)) : 20261122u;
  std::printf("seed %u; EDSC_MODEL_SEED is another one\n", seed);
  std::mt19937 random{seed};
  Pair pair;
  for (unsigned i = 0; i < 400'000 / thinned && pair.failures == 0; ++i) {
    const auto number = static_cast<std::uint32_t>(random());
    constexpr std::uint8_t commands[] = {1, 1, 2, 128, 129, 130, 0, 3, 127, 131};
    constexpr std::uint8_t receivers[] = {0, node_id, node_id, 6, 127, 133};
    switch (number % 8) {
      case 0:
      case 1:
      case 2:
        pair.command({.id = 0,
                      .size = static_cast<std::uint8_t>((number >> 8) % 16 == 0 ? 3 : 2),
                      .data = {commands[(number >> 12) % 10], receivers[(number >> 20) % 6]}});
        break;
      case 3:
      case 4: pair.probe(number); break;
      case 5:
        pair.configure(static_cast<std::uint8_t>(number >> 8), static_cast<std::uint8_t>((number >> 16) % 3 * 50));
        break;
      case 6:
        if (i % 16 == 6) pair.pass();
        break;
      default: pair.error(); break;
    }
  }
  tell(pair);
}

}  // namespace
