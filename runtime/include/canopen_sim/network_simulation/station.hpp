/// A node of a simulated network: power-on, configuration, changing values and faults. Host side.
#pragma once

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <deque>
#include <memory>
#include <optional>
#include <random>
#include <span>
#include <string_view>
#include <vector>

#include "canopen/nmt_master/concise_dcf.hpp"
#include "canopen/sdo/sdo_client.hpp"
#include "canopen_sim/network_simulation/changing_values.hpp"
#include "canopen_sim/network_simulation/heartbeat_watch.hpp"
#include "canopen_sim/network_simulation/network_plan.hpp"
#include "canopen_sim/virtual_bus.hpp"

namespace canopen::network_simulation {

/// Gets what happens at the stations. `node` is a place in NetworkPlan::nodes.
class StationLog {
 public:
  virtual void refused(std::size_t node, std::uint16_t index, std::uint8_t sub_index, AbortCode code) = 0;
  virtual void emergency(std::size_t node, std::uint16_t code, std::uint8_t error_register) = 0;
  virtual void heartbeat(std::size_t node, HeartbeatEvent event, NodeId other) = 0;
  virtual void state(std::size_t node, NmtState state) = 0;

 protected:
  ~StationLog() = default;
};

class Station final : public SimulatedBus, private HeartbeatListener {
 public:
  static constexpr std::uint64_t never = UINT64_MAX;
  enum class Condition : std::uint8_t { off, running, lost, babbling };

  /// Powers the node on at `power_on` of VirtualBus::elapsed().
  Station(VirtualBus& bus, const NetworkPlan& plan, std::size_t place, StationLog& log, std::uint64_t power_on,
          std::uint32_t seed)
      : bus_{bus},
        endpoint_{bus.attach()},
        plan_{plan.nodes[place]},
        place_{place},
        log_{log},
        power_on_{power_on},
        values_{plan_.changes, seed},
        memory_{NodeId{plan_.node_id}} {
    endpoint_.queue_limit = longest_queue;
    endpoint_.on_frame = [this](const Frame& frame, TimePoint now) { on_frame(frame, now); };
    endpoint_.on_time = [this](TimePoint now) { on_time(now); };
    endpoint_.next_deadline = [this] { return next_deadline(); };
    endpoint_.accepted_frames = [this](std::vector<AcceptedFrame>& frames) {
      if (condition_ == Condition::running) node_->accepted_frames(frames);
    };
  }
  Station(const Station&) = delete;
  Station& operator=(const Station&) = delete;
  ~Station() = default;

  /// Lets the node fail at this time: it falls silent, or sends without a pause.
  void fail_at(std::uint64_t time, Condition condition) {
    fails_ = time;
    failure_ = condition;
  }

  [[nodiscard]] Condition condition() const { return condition_; }
  [[nodiscard]] NmtState state() const { return state_; }
  [[nodiscard]] const VirtualBus::Endpoint& endpoint() const { return endpoint_; }
  [[nodiscard]] const ChangingValues& values() const { return values_; }

  /// For the node.
  bool send(const Frame& frame) override {
    if (is_configured_now_ && frame.id == function_code::sdo_response + std::uint32_t{plan_.node_id} &&
        !frame.extended) {
      responses_.push_back(frame);
      return true;
    }
    if (!endpoint_.send(frame)) return false;
    if (plan_.emcy_can_id != 0 && frame.id == plan_.emcy_can_id && !frame.extended && frame.size == 8) {
      log_.emergency(place_, static_cast<std::uint16_t>(frame.data[0] | frame.data[1] << 8), frame.data[2]);
    }
    return true;
  }

 private:
  /// Several frames of each TPDO; a full queue is that of an overloaded bus.
  static constexpr std::size_t longest_queue = 256;

  /// The bus of the SDO client that configures the node.
  struct Loop {
    SimulatedNode& node;
    TimePoint now;
    bool send(const Frame& frame) {
      node.on_frame(frame, now);
      return true;
    }
  };

  /// Calls a function of the node.
  template <class Call>
  void serve(Call call) {
    HeartbeatListener::served = this;
    call(*node_);
    HeartbeatListener::served = nullptr;
    const NmtState now = node_->state();
    if (now == state_) return;
    const bool is_started = now == NmtState::operational;
    if (is_started || state_ == NmtState::operational) is_started ? values_.start(bus_.elapsed()) : values_.stop();
    state_ = now;
    log_.state(place_, state_);
  }

  void on_heartbeat(HeartbeatEvent event, NodeId other) override { log_.heartbeat(place_, event, other); }

  void on_frame(const Frame& frame, TimePoint now) {
    if (condition_ != Condition::running) return;
    serve([&](SimulatedNode& node) { node.on_frame(frame, now); });
  }

  void on_time(TimePoint now) {
    if (bus_.elapsed() >= fails_) fail();
    switch (condition_) {
      case Condition::off:
        if (bus_.elapsed() >= power_on_) power_on(now);
        return;
      case Condition::running:
        values_.serve(*node_, bus_.elapsed());
        return serve([&](SimulatedNode& node) { node.on_time(now); });
      case Condition::babbling: return babble();
      case Condition::lost: return;
    }
  }

  [[nodiscard]] std::optional<TimePoint> next_deadline() const {
    std::uint64_t next = fails_;
    switch (condition_) {
      case Condition::off: next = std::min(next, power_on_); break;
      case Condition::running: {
        next = std::min(next, values_.due());
        const auto of_node = node_->next_deadline();
        if (of_node && is_earlier(*of_node, next)) return of_node;
        break;
      }
      case Condition::babbling:
        if (endpoint_.waiting() == 0) return bus_.now();
        break;
      case Condition::lost: break;
    }
    if (next == never) return std::nullopt;
    return bus_.now() + Duration{static_cast<std::uint32_t>(std::min(ahead(next), longest_ahead))};
  }

  [[nodiscard]] std::uint64_t ahead(std::uint64_t time) const {
    return time > bus_.elapsed() ? time - bus_.elapsed() : 0;
  }
  [[nodiscard]] bool is_earlier(TimePoint of_node, std::uint64_t time) const {
    const auto distance = static_cast<std::int32_t>((of_node - bus_.now()).count());
    return distance <= 0 || static_cast<std::uint64_t>(distance) < ahead(time);
  }

  void power_on(TimePoint now) {
    condition_ = Condition::running;
    node_ = plan_.make(*this, memory_);
    serve([&](SimulatedNode& node) { node.start(now); });
    is_configured_now_ = true;
    ConciseDcfPlace at;
    for (at.begin(plan_.dcf); !at.at_end(); at.advance(plan_.dcf)) {
      const auto data = at.data(plan_.dcf);
      if (!data) break;
      const std::uint16_t index = at.index(plan_.dcf);
      const std::uint8_t sub_index = at.sub_index(plan_.dcf);
      const AbortCode code = download(index, sub_index, *data, now);
      if (code != ok) log_.refused(place_, index, sub_index, code);
    }
    is_configured_now_ = false;
  }

  /// Writes an entry through the SDO server of the node, without the bus.
  [[nodiscard]] AbortCode download(std::uint16_t index, std::uint8_t sub_index, std::span<const std::uint8_t> bytes,
                                   TimePoint now) {
    Loop loop{*node_, now};
    SdoClient<Loop> client{loop, NodeId{plan_.node_id}};
    (void)client.download(index, sub_index, bytes, now);
    while (client.busy()) {
      if (responses_.empty()) node_->on_time(now);
      if (responses_.empty()) return AbortCode::timeout;
      const Frame response = responses_.front();
      responses_.pop_front();
      client.on_frame(response, now);
    }
    return client.result();
  }

  void fail() {
    fails_ = never;
    condition_ = failure_;
    values_.stop();
    endpoint_.discard();
  }

  /// Keeps a frame in the queue.
  void babble() {
    if (endpoint_.waiting() != 0) return;
    Frame frame{.id = plan_.babbling_can_id, .size = 8};
    for (std::uint8_t& byte : frame.data) byte = static_cast<std::uint8_t>(random_());
    (void)endpoint_.send(frame);
  }

  static constexpr std::uint64_t longest_ahead = 1'000'000'000;

  VirtualBus& bus_;
  VirtualBus::Endpoint& endpoint_;
  const PlannedNode& plan_;
  std::size_t place_;
  StationLog& log_;
  std::uint64_t power_on_;
  std::uint64_t fails_ = never;
  Condition failure_ = Condition::lost;
  Condition condition_ = Condition::off;
  ChangingValues values_;
  SimulatedMemory memory_;
  std::unique_ptr<SimulatedNode> node_;
  NmtState state_ = NmtState::initialisation;
  bool is_configured_now_ = false;
  std::deque<Frame> responses_;
  std::minstd_rand random_;
};

}  // namespace canopen::network_simulation
