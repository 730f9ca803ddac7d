/// A network whose nodes are devices that edsc has generated, on a VirtualBus with the lengths and the arbitration of
/// CAN. `edsc network simulate` writes and runs a program of it (simulation_protocol.hpp). The nodes power on at
/// different times, are configured through their SDO servers without the bus, and are started two seconds later. Host
/// side.
#pragma once

#include <algorithm>
#include <charconv>
#include <cinttypes>
#include <cstddef>
#include <cstdint>
#include <cstdio>
#include <deque>
#include <iterator>
#include <optional>
#include <random>
#include <span>
#include <string_view>
#include <system_error>
#include <vector>

#include "canopen/can/cob_id.hpp"
#include "canopen_sim/network_simulation/frame_statistics.hpp"
#include "canopen_sim/network_simulation/network_plan.hpp"
#include "canopen_sim/network_simulation/simulation_protocol.hpp"
#include "canopen_sim/network_simulation/station.hpp"

namespace canopen::network_simulation {

class NetworkSimulation final : private StationLog {
 public:
  /// The same seed has the same result.
  NetworkSimulation(const NetworkPlan& plan, std::uint32_t seed)
      : plan_{plan}, bus_{plan.bit_rate, WireModel::exact}, commands_{bus_.attach()}, statistics_{plan} {
    std::minstd_rand random{seed};
    bus_.assume_independent_endpoints();
    bus_.observe([this](const VirtualBus::Transmission& one) { statistics_.add(one); });
    commands_.on_time = [this](TimePoint) { on_time(); };
    commands_.next_deadline = [this] { return next_deadline(); };
    commands_.accepted_frames = [](std::vector<AcceptedFrame>&) {};
    for (std::size_t i = 0; i < plan.nodes.size(); ++i) {
      const std::uint64_t power_on = random() % 1'000'000;
      stations_.emplace_back(bus_, plan, i, static_cast<StationLog&>(*this), power_on,
                             static_cast<std::uint32_t>(random()));
    }
  }

  void add(const PlannedFault& fault) {
    switch (fault.kind) {
      case PlannedFault::Kind::lost:
        return stations_[fault.node].fail_at(start_time + fault.time, Station::Condition::lost);
      case PlannedFault::Kind::babbling:
        return stations_[fault.node].fail_at(start_time + fault.time, Station::Condition::babbling);
      case PlannedFault::Kind::errors: error_interval_ = Duration{static_cast<std::uint32_t>(fault.time)}; return;
    }
  }

  void run(std::uint64_t duration) {
    advance_to(start_time);
    statistics_.begin(start_time);
    bus_.make_errors(error_interval_);
    next_command_ = start_time;
    const std::uint64_t report = duration / 100 + 1;
    for (std::uint64_t done = 0; done < duration;) {
      done = std::min(done + report, duration);
      advance_to(start_time + done);
      std::printf("progress %" PRIu64 "\n", done);
      std::fflush(stdout);
    }
    print_frames();
    for (std::size_t i = 0; i < stations_.size(); ++i) {
      std::printf("node %zu %u %u\n", i, static_cast<unsigned>(stations_[i].condition()),
                  static_cast<unsigned>(stations_[i].state()));
    }
    std::printf("bus %" PRIu64 " %" PRIu64 " %" PRIu64 " %" PRIu64 " %" PRIu64 "\nend\n", duration, statistics_.busy(),
                statistics_.busiest_second(), statistics_.frames(), statistics_.errors());
  }

 private:
  static constexpr std::uint64_t start_time = 2'000'000;  ///< of elapsed(), in us
  static constexpr std::uint64_t longest_run = 1'000'000;
  static constexpr std::size_t max_events = 10'000;

  void advance_to(std::uint64_t time) {
    while (bus_.elapsed() < time) {
      bus_.run_for(Duration{static_cast<std::uint32_t>(std::min(time - bus_.elapsed(), longest_run))});
    }
  }

  [[nodiscard]] std::optional<TimePoint> next_deadline() const {
    if (next_command_ == Station::never) return std::nullopt;
    const std::uint64_t now = bus_.elapsed();
    const std::uint64_t ahead = next_command_ > now ? next_command_ - now : 0;
    return bus_.now() + Duration{static_cast<std::uint32_t>(std::min(ahead, longest_run))};
  }

  /// What the application of the master does: it starts the nodes, then requests a value of one after the other.
  void on_time() {
    if (bus_.elapsed() < next_command_) return;
    if (!is_started_) {
      is_started_ = true;
      (void)commands_.send({.id = function_code::nmt, .size = 2, .data = {1, 0}});
    } else {
      request_value();
    }
    const bool requests = plan_.master < stations_.size() && stations_.size() > 1;
    next_command_ = requests ? next_command_ + plan_.sdo_interval : Station::never;
  }

  void request_value() {
    if (stations_[plan_.master].condition() != Station::Condition::running) return;
    server_ = (server_ + 1) % plan_.nodes.size();
    if (server_ == plan_.master) server_ = (server_ + 1) % plan_.nodes.size();
    Frame request{.id = function_code::sdo_request + std::uint32_t{plan_.nodes[server_].node_id}, .size = 8};
    request.data = {0x40, 0x18, 0x10, 0x01};  // upload of the vendor-ID
    (void)commands_.send(request);
  }

  [[nodiscard]] std::int64_t since_start() const {
    return static_cast<std::int64_t>(bus_.elapsed()) - static_cast<std::int64_t>(start_time);
  }

  /// A network in a loop of faults must not fill the disk.
  [[nodiscard]] bool is_logged() { return events_++ < max_events; }

  void refused(std::size_t node, std::uint16_t index, std::uint8_t sub_index, AbortCode code) override {
    std::printf("refused %zu %u %u %" PRIu32 "\n", node, unsigned{index}, unsigned{sub_index}, code_in_frame(code));
  }
  void emergency(std::size_t node, std::uint16_t code, std::uint8_t error_register) override {
    if (!is_logged()) return;
    std::printf("emergency %" PRId64 " %zu %u %u\n", since_start(), node, unsigned{code}, unsigned{error_register});
  }
  void heartbeat(std::size_t node, HeartbeatEvent event, NodeId other) override {
    const bool is_lost = event == HeartbeatEvent::lost;
    if ((!is_lost && event != HeartbeatEvent::back) || !is_logged()) return;
    std::printf("heartbeat %" PRId64 " %zu %u %s\n", since_start(), node, unsigned{other.value()},
                is_lost ? "lost" : "back");
  }
  void state(std::size_t node, NmtState state) override {
    if (is_logged()) std::printf("state %" PRId64 " %zu %u\n", since_start(), node, static_cast<unsigned>(state));
  }

  [[nodiscard]] int node_of(const VirtualBus::Endpoint* sender) const {
    for (std::size_t i = 0; i < stations_.size(); ++i) {
      if (&stations_[i].endpoint() == sender) return static_cast<int>(i);
    }
    return -1;
  }

  void print_frames() const {
    std::vector<const FrameRow*> planned;
    for (std::size_t i = 0; i < plan_.messages.size(); ++i) {
      const FrameRow* const row = statistics_.find(plan_.messages[i]);
      std::printf("message %zu ", i);
      print(row != nullptr ? *row : FrameRow{});
      if (row != nullptr) planned.push_back(row);
    }
    for (const auto& [priority, row] : statistics_.sorted()) {
      const auto is_same = [&frame = row.frame](const FrameRow* one) { return one->frame == frame; };
      if (row.count == 0 || std::ranges::any_of(planned, is_same)) continue;
      std::printf("frame %" PRIu32 " %d %d %d ", row.frame.id, int{row.frame.extended}, int{row.frame.remote},
                  node_of(row.sender));
      print(row);
    }
    for (const Station& station : stations_) {
      station.values().for_each([](const PlannedChange& change, std::uint64_t count) {
        if (change.is_expected) std::printf("changes %zu %" PRIu64 "\n", change.message, count);
      });
    }
  }

  static void print(const FrameRow& row) {
    const std::uint64_t at = row.at > start_time ? row.at - start_time : 0;
    std::printf("%" PRIu64 " %" PRIu64 " %" PRIu64 "\n", row.count, row.worst, at);
  }

  const NetworkPlan& plan_;
  VirtualBus bus_;
  VirtualBus::Endpoint& commands_;
  FrameStatistics statistics_;
  std::deque<Station> stations_;
  Duration error_interval_{0};
  std::uint64_t next_command_ = Station::never;
  bool is_started_ = false;
  std::size_t server_ = 0;
  std::size_t events_ = 0;
};

/// The program. Returns 2 if the arguments are not as described above.
[[nodiscard]] inline int simulate_network(int argc, char** argv, const NetworkPlan& plan) {
  std::vector<std::string_view> words(argv + 1, argv + argc);
  const auto number = [&words](std::size_t at) {
    std::uint64_t value = UINT64_MAX;
    if (at < words.size()) (void)std::from_chars(words[at].data(), words[at].data() + words[at].size(), value);
    return value;
  };
  const std::uint64_t duration = number(0);
  const std::uint64_t seed = number(1);
  if (duration > std::uint64_t{1} << 50 || seed > UINT32_MAX || words.size() % 3 != 2) return 2;
  std::printf("%s\n", greeting.data());
  NetworkSimulation simulation{plan, static_cast<std::uint32_t>(seed)};
  for (std::size_t i = 2; i < words.size(); i += 3) {
    const auto kind = std::ranges::find(fault_names, words[i]);
    const std::uint64_t node = number(i + 1);
    if (kind == std::end(fault_names) || node >= plan.nodes.size() || number(i + 2) > duration) return 2;
    simulation.add(
        {static_cast<PlannedFault::Kind>(kind - fault_names), static_cast<std::size_t>(node), number(i + 2)});
  }
  simulation.run(duration);
  return 0;
}

}  // namespace canopen::network_simulation
