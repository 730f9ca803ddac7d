/// A dynamic node with a behaviour and faults, between power-on and power-off and beyond.
#pragma once

#include <canopen_sim/simulated_node.hpp>
#include <cstdint>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "device/behaviour.hpp"
#include "device/dynamic_node.hpp"
#include "device/node_faults.hpp"
#include "device/node_watch.hpp"
#include "device/profile_behaviour.hpp"
#include "device/sheet.hpp"

namespace edsc {

/// What a node is made of. `memory` names the file of its stored values; empty: the memory of the program.
struct BehavingNodeSettings {
  std::shared_ptr<const Sheet> sheet;
  std::string memory;
  std::uint64_t seed = 0;
  bool starts_operational = false;  ///< after each boot-up
  std::uint16_t profile = 0;        ///< it behaves as this device profile says; 0: only the protocol
};

class BehavingNode final : public canopen::SimulatedNode,
                           private canopen::SimulatedBus,
                           private NodeWatch,
                           private BehaviourTarget {
 public:
  /// Bus and memory must outlive the node.
  BehavingNode(BehavingNodeSettings settings, canopen::SimulatedBus& bus, canopen::SimulatedMemory& memory);

  [[nodiscard]] Behaviour& behaviour() { return behaviour_; }
  /// The node-ID, which LSS may have changed.
  [[nodiscard]] canopen::NodeId node_id() const { return node_->node_id(); }

  /// Power-on; again, after the node was off.
  void start(canopen::TimePoint now) override;
  void on_frame(const canopen::Frame& frame, canopen::TimePoint now) override;
  void on_time(canopen::TimePoint now) override;
  [[nodiscard]] std::optional<canopen::TimePoint> next_deadline() const override;
  [[nodiscard]] canopen::NmtState state() const override { return node_->state(); }
  void accepted_frames(std::vector<canopen::AcceptedFrame>& frames) override { node_->accepted_frames(frames); }
  [[nodiscard]] canopen::AbortCode set(std::uint16_t index, std::uint8_t sub_index,
                                       std::span<const std::uint8_t> bytes) override;
  void emergency(std::uint16_t code, canopen::ErrorRegister bits) override { node_->emergency(code, bits); }
  void emergency_over(canopen::ErrorRegister bits) override { node_->emergency_over(bits); }
  [[nodiscard]] std::string composition() const override { return node_->composition(); }

 private:
  // Frames of the node.
  bool send(const canopen::Frame& frame) override;

  // Events of the node.
  [[nodiscard]] canopen::AbortCode before_write(std::uint32_t key, std::span<std::uint8_t> bytes) override;
  void after_write(std::uint32_t key) override;
  [[nodiscard]] canopen::AbortCode before_read(std::uint32_t key) override;
  void on_state(canopen::NmtState state) override;
  void on_sync() override;
  void on_error(std::uint16_t code) override;

  // Actions.
  [[nodiscard]] std::optional<std::vector<std::uint8_t>> get(std::uint16_t index, std::uint8_t sub_index) override;
  void request(canopen::NmtCommand command) override { node_->request(command, now_); }
  void hold_error(canopen::ErrorRegister bits) override { node_->hold_error(bits); }
  [[nodiscard]] canopen::NmtState nmt_state() const override { return node_->state(); }
  void power_cycle() override;
  void set_connected(bool connected) override;
  void start_fault(const NodeFault& fault) override;
  void clear_faults() override;
  [[nodiscard]] std::string state_text() const override;

  void set_time(canopen::TimePoint now);
  void power_on();
  /// What follows from frames and time that the node has processed.
  void serve();
  void send_queued();
  /// Restarts the node with or without its node-ID if the fault has begun or ended.
  void follow_lost_node_id();

  BehavingNodeSettings settings_;
  canopen::SimulatedBus& bus_;
  canopen::SimulatedMemory& memory_;
  NodeFaults faults_;
  Behaviour behaviour_;
  std::unique_ptr<ProfileBehaviour> profile_;  ///< null: only the protocol
  std::unique_ptr<DynamicNode> node_;
  canopen::TimePoint now_{};
  std::uint64_t now_us_ = 0;
  bool connected_ = true;
  bool was_full_ = false;    ///< the bus had no room for a queued frame
  bool must_start_ = false;  ///< the node has booted, and is to become Operational
  bool has_started_ = false;
  std::optional<canopen::NodeId> lost_node_id_;  ///< while the fault lasts
};

}  // namespace edsc
