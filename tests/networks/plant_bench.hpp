/// The master of a plant and its nodes on a virtual bus with a bit rate, and what happens there.
#pragma once

#include <canopen/can/frame.hpp>
#include <canopen/node.hpp>
#include <canopen_plant/plant_text.hpp>
#include <canopen_sim/virtual_bus.hpp>
#include <cstdint>
#include <map>
#include <optional>
#include <string>
#include <vector>

#include "support/omitting.hpp"

namespace plant_bench {

/// A device that can lose power, and with it the values in RAM.
template <class Device>
class LiveNode {
 public:
  LiveNode(canopen::VirtualBus& bus, std::uint8_t node_id) : bus_{bus}, end_{bus.attach()}, node_id_{node_id} {
    end_.on_frame = [this](const canopen::Frame& frame, canopen::TimePoint now) {
      if (node_) node_->on_frame(frame, now);
    };
    end_.on_time = [this](canopen::TimePoint now) {
      if (node_) node_->on_time(now);
    };
    end_.next_deadline = [this] { return node_ ? node_->next_deadline() : std::nullopt; };
    switch_on();
  }

  void switch_on() {
    node_.emplace(end_, canopen::NodeId{node_id_});
    node_->start(bus_.now());
  }
  void switch_off() {
    node_.reset();
    end_.discard();
  }
  [[nodiscard]] auto& node() { return *node_; }

 private:
  canopen::VirtualBus& bus_;
  canopen::VirtualBus::Endpoint& end_;
  std::uint8_t node_id_;
  std::optional<bench::NodeOf<Device, canopen::VirtualBus::Endpoint>> node_;
};

/// `Control` has the member `plant`. The nodes are attached before `start`.
template <template <class Bus> class Control>
class PlantBench {
 public:
  explicit PlantBench(std::uint32_t bit_rate) : bus{bit_rate}, end_{bus.attach()}, control{end_} {
    end_.queue_limit = 64;
    canopen::VirtualBus::connect(end_, control.plant);
    control.plant.on_booted = [this](const canopen::PlantNode& node) { ++boots[std::string{node.name}]; };
    control.plant.on_fault = [this](const canopen::PlantNode& node, const canopen::PlantFault& fault) {
      using Network = typename decltype(control.plant)::Network;
      faults.push_back(fault_text(node, fault, Network::places, Network::errors));
    };
    bus.listen([this](const canopen::Frame& frame, canopen::TimePoint) { frames.push_back(frame); });
  }

  void start() { control.plant.start(bus.now()); }

  /// Runs until all nodes have booted; false if they have not after this time.
  [[nodiscard]] bool boot(canopen::Duration most) {
    bus.run_until([this] { return control.plant.all_booted(); }, most);
    return control.plant.all_booted();
  }

  /// Frames with a CAN-ID since the last call of `forget`.
  [[nodiscard]] std::size_t count(std::uint32_t can_id) const {
    std::size_t found = 0;
    for (const canopen::Frame& frame : frames) found += frame.id == can_id;
    return found;
  }
  /// Data of the last frame with a CAN-ID; empty if there is none.
  [[nodiscard]] std::vector<std::uint8_t> last(std::uint32_t can_id) const {
    for (auto at = frames.rbegin(); at != frames.rend(); ++at) {
      if (at->id == can_id) return {at->data.begin(), at->data.begin() + at->size};
    }
    return {};
  }
  [[nodiscard]] std::size_t count_boot_ups(std::uint8_t node_id) const {
    std::size_t found = 0;
    for (const canopen::Frame& frame : frames) found += frame.id == 0x700U + node_id && frame.data[0] == 0;
    return found;
  }

  /// Forgets frames and faults.
  void forget() {
    frames.clear();
    faults.clear();
  }

  canopen::VirtualBus bus;

 private:
  canopen::VirtualBus::Endpoint& end_;

 public:
  Control<canopen::VirtualBus::Endpoint> control;
  std::map<std::string, int> boots;
  std::vector<std::string> faults;
  std::vector<canopen::Frame> frames;
};

}  // namespace plant_bench
