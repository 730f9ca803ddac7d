/// An hour of a full network: 127 reference devices and a guarding master on one bus, while TimePoint wraps. Each
/// message is sent once and exactly when it is due, and no station wakes up without a reason.
#include <gtest/gtest.h>

#include <can_2053c/device.hpp>
#include <canopen/nmt/node_guarding.hpp>
#include <canopen/node.hpp>
#include <canopen_sim/virtual_bus.hpp>
#include <cpc_tc1/device.hpp>
#include <cpd/device.hpp>
#include <rk5c/device.hpp>

#include <algorithm>
#include <array>
#include <cstring>
#include <deque>
#include <initializer_list>
#include <optional>
#include <span>
#include <string>
#include <utility>
#include <vector>

#include "support/omitting.hpp"

namespace {

using canopen::Duration;
using canopen::Frame;
using canopen::GuardingEvent;
using canopen::NmtState;
using canopen::NodeId;
using canopen::TimePoint;
using canopen::VirtualBus;
using namespace std::chrono_literals;

constexpr Duration bus_time = 60min;
/// TimePoint wraps in the middle of the hour.
constexpr Duration begin{0u - bus_time.count() / 2};

constexpr std::uint32_t bit_rate = 1'000'000;
/// Two messages of each of 128 participants at once.
constexpr std::uint64_t longest_delay = 2 * 128 * 111;

constexpr std::uint32_t sync_id = 0x080;
constexpr std::uint8_t transmission_types[] = {1, 2, 3, 10, 60, 240};

/// The expected and the received messages with one CAN-ID. Times are in us since the beginning of the test.
struct Message {
  std::uint64_t first = 0;
  std::uint64_t period = 0;  ///< 0: another message causes this one
  std::uint32_t cause = 0;   ///< key of that message
  unsigned every = 0;        ///< causing messages per message; 0: not expected at all
  unsigned causes = 0;       ///< causing messages since the last one
  unsigned sent = 0;
  unsigned seen = 0;
  std::uint64_t sent_at = 0;
  std::uint64_t seen_at = 0;
};

/// A key is the CAN-ID, plus this bit for a remote frame.
constexpr std::uint32_t remote = 0x800;
std::uint32_t key_of(const Frame& frame) { return frame.id | (frame.remote ? remote : 0); }

class Timetable {
 public:
  explicit Timetable(VirtualBus& bus) : bus_{bus}, last_{bus.now()} {
    bus.listen([this](const Frame& frame, TimePoint) { seen(frame); });
  }

  /// The first message is due at `first`, the next ones after each period.
  void periodic(std::uint32_t key, std::uint64_t first, Duration period) {
    messages_[key].first = first;
    messages_[key].period = period.count();
    messages_[key].every = 1;
  }
  /// A message is due when every n-th message of another kind has been transmitted.
  void caused(std::uint32_t key, std::uint32_t cause, unsigned every) {
    messages_[key].cause = cause;
    messages_[key].every = every;
  }

  void sent(const Frame& frame) {
    const std::uint64_t now = time();
    Message& message = messages_.at(key_of(frame));
    const bool in_turn = message.period != 0
                             ? now == message.first + message.sent * message.period
                             : message.causes == message.every && messages_[message.cause].seen_at == now;
    if (message.every == 0 || !in_turn) complain(frame, "is not due");
    message.causes = 0;
    message.sent_at = now;
    ++message.sent;
  }

  /// Checks that all messages that were due have been sent.
  void finish() {
    const std::uint64_t now = time();
    for (std::uint32_t key = 0; key < messages_.size(); ++key) {
      const Message& message = messages_[key];
      if (message.every == 0) continue;
      const std::uint64_t expected = message.period != 0 ? (now - message.first) / message.period + 1
                                                         : messages_[message.cause].seen / message.every;
      EXPECT_EQ(message.sent, expected) << std::hex << key;
      EXPECT_LE(message.sent - message.seen, 1u) << std::hex << key;
      EXPECT_GE(message.sent, 2u) << std::hex << key;
    }
    for (const std::string& line : complaints) ADD_FAILURE() << line;
  }

  [[nodiscard]] const Message& operator[](std::uint32_t key) const { return messages_[key]; }

  /// Does not wrap.
  std::uint64_t time() {
    time_ += (bus_.now() - last_).count();
    last_ = bus_.now();
    return time_;
  }

  std::vector<std::string> complaints;
  std::uint64_t frames = 0;

 private:
  void seen(const Frame& frame) {
    ++frames;
    Message& message = messages_.at(key_of(frame));
    ++message.seen;
    message.seen_at = time();
    if (message.every == 0) return;  // the NMT command that starts the network
    if (message.seen != message.sent) complain(frame, "has not been sent");
    if (message.seen_at - message.sent_at > longest_delay) complain(frame, "is late");
    for (Message& other : messages_) {
      if (other.every != 0 && other.period == 0 && &messages_[other.cause] == &message) ++other.causes;
    }
  }

  void complain(const Frame& frame, const char* what) {
    if (complaints.size() < 10)
      complaints.push_back(std::to_string(key_of(frame)) + " " + what + " at " + std::to_string(time()));
  }

  VirtualBus& bus_;
  TimePoint last_;
  std::uint64_t time_ = 0;
  std::array<Message, 0x1000> messages_{};
};

/// A participant's access to the bus.
struct Port {
  bool send(const Frame& frame) {
    if (!endpoint.send(frame)) return false;
    if (timetable != nullptr) timetable->sent(frame);
    return true;
  }
  VirtualBus::Endpoint& endpoint;
  Timetable* timetable = nullptr;  ///< null before the test begins
};

template <class Device>
struct Station {
  Station(VirtualBus& bus, std::uint8_t node_id) : port{bus.attach()}, node{port, NodeId{node_id}} {
    VirtualBus::connect(port.endpoint, node);
    port.endpoint.on_time = [this](TimePoint now) {
      ++wake_ups;
      node.on_time(now);
    };
    node.start(bus.now());
  }

  void set(std::uint16_t index, std::uint8_t sub_index, std::uint32_t value, std::size_t size) {
    std::array<std::uint8_t, 4> bytes;
    std::memcpy(bytes.data(), &value, sizeof value);
    ASSERT_EQ(node.set(index, sub_index, std::span{bytes}.first(size)), canopen::ok) << std::hex << index;
  }
  void set_heartbeat(Duration period) { set(0x1017, 0, period.count() / 1000, 2); }
  void set_event_timer(Duration period) { set(0x1800, 5, period.count() / 1000, 2); }
  [[nodiscard]] std::uint32_t number() const { return node.node_id().value(); }

  Port port;
  bench::NodeOf<Device, Port> node;
  unsigned wake_ups = 0;
};

/// Guards the I/O modules and starts the network.
struct Master {
  struct Host {
    Master& master;
    void happened(GuardingEvent event, NodeId, NmtState) {
      if (event == GuardingEvent::started) ++master.started;
      if (event != GuardingEvent::started && event != GuardingEvent::state_changed) ++master.errors;
    }
  };

  explicit Master(VirtualBus& bus) : port{bus.attach()} {
    port.endpoint.queue_limit = 64;
    port.endpoint.on_frame = [this](const Frame& frame, TimePoint) {
      const auto message = canopen::error_control_message(frame);
      if (!message) return;
      for (auto& guard : guards) guard.on_message(*message, Host{*this});
    };
    port.endpoint.on_time = [this](TimePoint now) {
      ++wake_ups;
      for (auto& guard : guards) guard.serve(port, now, Host{*this});
    };
    port.endpoint.next_deadline = [this] {
      std::optional<TimePoint> next;
      for (const auto& guard : guards) {
        const auto own = guard.next_deadline();
        if (own && (!next || *own < *next)) next = own;
      }
      return next;
    };
  }

  Port port;
  std::array<canopen::NodeGuardingMaster, 40> guards{};
  int started = 0;
  int errors = 0;
  unsigned wake_ups = 0;
};

class Network {
 public:
  Network() {
    bus.assume_independent_endpoints();
    while (bus.now() != TimePoint{begin}) bus.run_for(std::min<Duration>(20min, TimePoint{begin} - bus.now()));
    producer.emplace_back(bus, std::uint8_t{1});
    for (std::uint8_t id = 2; id < 42; ++id) drives.emplace_back(bus, id);
    for (std::uint8_t id = 42; id < 82; ++id) modules.emplace_back(bus, id);
    for (std::uint8_t id = 82; id < 128; ++id) sensors.emplace_back(bus, id);
    bus.settle();  // the boot-up messages
    timetable.emplace(bus);
    master.port.timetable = &*timetable;
    const Frame start{.id = 0, .size = 2, .data = {1, 0}};
    master.port.endpoint.send(start);
    started_at_ = bus.duration_of(start).count();
    for_each([this](auto& station) {
      station.port.timetable = &*timetable;
      station.node.on_time(bus.now());
    });
    configure_producer(producer.front());
    for (auto& drive : drives) configure_drive(drive);
    for (auto& module : modules) configure_module(module);
    for (auto& sensor : sensors) configure_sensor(sensor);
  }

  template <class Visit>
  void for_each(Visit visit) {
    for (auto& station : producer) visit(station);
    for (auto& station : drives) visit(station);
    for (auto& station : modules) visit(station);
    for (auto& station : sensors) visit(station);
  }

  /// How often a station has a reason to wake up. A guarded station also wakes up at each guard time.
  template <class Device>
  [[nodiscard]] unsigned occasions(const Station<Device>& station) const {
    const std::uint32_t id = station.number();
    unsigned sum = (*timetable)[0x180 + id].sent + (*timetable)[0x700 + id].sent;
    if (id == producer.front().number()) sum += (*timetable)[sync_id].sent;
    return sum;
  }

  VirtualBus bus{bit_rate};
  Master master{bus};
  std::optional<Timetable> timetable;
  std::deque<Station<cpc_tc1::Device>> producer;
  std::deque<Station<cpd::Device>> drives;
  std::deque<Station<can_2053c::Device>> modules;
  std::deque<Station<rk5c::Device>> sensors;

 private:
  /// SYNC every 500 ms, a TPDO every second; watches the heartbeats of four drives.
  void configure_producer(Station<cpc_tc1::Device>& station) {
    constexpr Duration sync_period = 500ms;
    for (const std::uint16_t index : std::initializer_list<std::uint16_t>{0x1801, 0x1802, 0x1803})
      station.set(index, 1, 0xC000'0000, 4);
    for (std::uint8_t i = 1; i <= 4; ++i) station.set(0x1016, i, (i + 1u) << 16 | 30'000, 4);
    station.set_event_timer(1s);
    station.set_heartbeat(7s);
    station.set(0x1006, 0, sync_period.count(), 4);
    station.set(0x1005, 0, 0x4000'0000 | sync_id, 4);
    timetable->periodic(0x180 + station.number(), started_at_, 1s);
    timetable->periodic(0x700 + station.number(), 0, 7s);
    timetable->periodic(sync_id, sync_period.count(), sync_period);
  }

  /// Heartbeat, a TPDO with an event timer, and one at every n-th SYNC.
  void configure_drive(Station<cpd::Device>& station) {
    const std::uint32_t id = station.number();
    const std::uint8_t type = transmission_types[id % std::size(transmission_types)];
    const Duration timer = 11s + Duration{137ms} * id;
    const Duration heartbeat = 10s + Duration{100ms} * id;
    station.set_event_timer(timer);
    station.set(0x1801, 2, type, 1);
    station.set(0x1801, 1, 0x280 + id, 4);
    station.set_heartbeat(heartbeat);
    timetable->periodic(0x180 + id, started_at_, timer);
    timetable->periodic(0x700 + id, 0, heartbeat);
    timetable->caused(0x280 + id, sync_id, type);
  }

  /// Node guarding and a TPDO with an event timer.
  void configure_module(Station<can_2053c::Device>& station) {
    const std::uint32_t id = station.number();
    const auto guard_time = static_cast<std::uint16_t>(5000 + 61 * id);
    const Duration timer = 13s + Duration{211ms} * id;
    const Duration first = Duration{10ms} * id;
    station.set(0x100C, 0, guard_time, 2);
    station.set(0x100D, 0, 3, 1);
    station.set_event_timer(timer);
    master.guards[id - 42].start(NodeId{static_cast<std::uint8_t>(id)}, guard_time, 3, bus.now() + first);
    timetable->periodic(0x180 + id, started_at_, timer);
    timetable->periodic(remote | (0x700 + id), first.count(), canopen::from_milliseconds(guard_time));
    timetable->caused(0x700 + id, remote | (0x700 + id), 1);
  }

  /// Heartbeat and a TPDO with an event timer; the first TPDO is sent after the first period.
  void configure_sensor(Station<rk5c::Device>& station) {
    const std::uint32_t id = station.number();
    const Duration timer = 3s + Duration{57ms} * id;
    const Duration heartbeat = 60s;  // all sensors at the same time
    station.set_event_timer(timer);
    station.set_heartbeat(heartbeat);
    timetable->periodic(0x180 + id, started_at_ + timer.count(), timer);
    timetable->periodic(0x700 + id, 0, heartbeat);
  }

  std::uint64_t started_at_ = 0;  ///< end of the transmission of "start"
};

TEST(NetworkHour, EachOf127NodesSendsEverythingAtItsTimeAndSleepsOtherwise) {
  Network network;
  for (Duration passed{0}; passed < bus_time; passed += 1min) network.bus.run_for(1min);
  EXPECT_EQ(network.timetable->time(), bus_time.count());
  EXPECT_LT(network.bus.now(), TimePoint{bus_time});  // TimePoint has wrapped
  network.timetable->finish();
  unsigned stations = 0;
  network.for_each([&](auto& station) {
    ++stations;
    EXPECT_EQ(station.node.state(), NmtState::operational) << station.number();
    EXPECT_LE(station.wake_ups, network.occasions(station)) << station.number();
  });
  EXPECT_EQ(stations, 127u);
  EXPECT_EQ(network.master.started, 40);
  EXPECT_EQ(network.master.errors, 0);
  EXPECT_GT(network.timetable->frames, bus_time.count() / 100'000);
  for (std::uint8_t id = 2; id <= 5; ++id) {
    EXPECT_EQ(network.producer.front().node.state_of(NodeId{id}), NmtState::operational);
  }
}

}  // namespace
