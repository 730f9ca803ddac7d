/// An I/O module of CiA 401 as one object: a node, the transfer between its objects and its terminals, and the
/// terminals that the user writes.
///
///     struct Terminals {  // only the functions for the channels that the device has
///       std::uint8_t digital(std::uint8_t block);                      // levels of eight inputs
///       void set_digital(std::uint8_t block, std::uint8_t levels);     // of eight outputs
///       std::int16_t analogue(std::uint8_t channel);
///       void set_analogue(std::uint8_t channel, std::int16_t value);
///     };
///     canopen::cia401::ModuleNode<can_2053c::Device, Bus, Terminals> module{bus, canopen::NodeId{5}};
#pragma once

#include <cstdint>
#include <utility>

#include "canopen/base/clock.hpp"
#include "canopen/can/bus_status.hpp"
#include "canopen/can/node_id.hpp"
#include "canopen/nmt/heartbeat_consumer.hpp"
#include "canopen/nmt/nmt.hpp"
#include "canopen/node.hpp"
#include "canopen/profile/cia401.hpp"
#include "canopen/profile/profile_node.hpp"

namespace canopen::cia401 {

/// `Parts`: a device or a composition. `Handlers`: further parts of the node, such as an application class or a
/// storage. Blocks and channels count from 0.
template <class Parts, Bus BusType, class Terminals, class... Handlers>
class ModuleNode : public ProfileNode<ModuleNode<Parts, BusType, Terminals, Handlers...>> {
  friend ProfileNode<ModuleNode>;
  using Device = composition_detail::DeviceOf<Parts>;

 public:
  constexpr ModuleNode(BusType& bus, NodeId node_id, Handlers... handlers)
      : node_{bus,
              node_id,
              on_state(StateWatch{this}),
              on_life_guarding(GuardWatch{this}),
              on_heartbeat(HeartbeatWatch{this}),
              std::move(handlers)...} {}

  /// Reads the inputs, sets the outputs and sends what is due. Call it at `next_deadline`, and as often as the inputs
  /// are to be read.
  void on_time(TimePoint now) {
    sample();
    node_.on_time(now);
    update();
  }
  void on_bus_status(const BusStatus& status, TimePoint now) {
    node_.on_bus_status(status, now);
    if (outputs_fail(status)) fail();
    update();
  }

  [[nodiscard]] Terminals& terminals() { return terminals_; }
  [[nodiscard]] auto& node() { return node_; }
  [[nodiscard]] const auto& node() const { return node_; }

 private:
  struct StateWatch {
    ModuleNode* module;
    void operator()(NmtState state) const {
      if (outputs_fail(state)) module->fail();
    }
  };
  struct GuardWatch {
    ModuleNode* module;
    void operator()(bool lost) const {
      if (lost) module->fail();
    }
  };
  struct HeartbeatWatch {
    ModuleNode* module;
    void operator()(HeartbeatEvent event, NodeId, NmtState) const {
      if (outputs_fail(event)) module->fail();
    }
  };

  void after_event(TimePoint) { update(); }

  void sample() {
    for (std::uint8_t i = 0; i < DigitalInputs<Device>::blocks; ++i) {
      if constexpr (DigitalInputs<Device>::blocks != 0) digital_inputs_.sample(node_, i, terminals_.digital(i));
    }
    for (std::uint8_t i = 0; i < AnalogueInputs<Device>::channels; ++i) {
      if constexpr (AnalogueInputs<Device>::channels != 0) analogue_inputs_.sample(node_, i, terminals_.analogue(i));
    }
  }
  void update() {
    if constexpr (DigitalOutputs<Device>::blocks != 0) {
      digital_outputs_.update(
          node_, [this](std::uint8_t block, std::uint8_t levels) { terminals_.set_digital(block, levels); });
    }
    if constexpr (AnalogueOutputs<Device>::channels != 0) {
      analogue_outputs_.update(
          node_, [this](std::uint8_t channel, std::int16_t value) { terminals_.set_analogue(channel, value); });
    }
  }
  void fail() {
    digital_outputs_.fail(node_);
    analogue_outputs_.fail(node_);
  }

  Terminals terminals_{};
  [[no_unique_address]] DigitalInputs<Device> digital_inputs_{};
  [[no_unique_address]] DigitalOutputs<Device> digital_outputs_{};
  [[no_unique_address]] AnalogueInputs<Device> analogue_inputs_{};
  [[no_unique_address]] AnalogueOutputs<Device> analogue_outputs_{};
  composition_detail::NodeWith<Parts, BusType,
                               composition_detail::Types<StateHandler<StateWatch>, LifeGuardingHandler<GuardWatch>,
                                                         HeartbeatHandler<HeartbeatWatch>>,
                               Handlers...>
      node_;
};

}  // namespace canopen::cia401
