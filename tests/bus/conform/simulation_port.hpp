/// A simulated device in this process as the port of a LiveBus, with a mutant on the wire.
#pragma once

#include <algorithm>
#include <canopen_sim/simulated_device.hpp>
#include <deque>
#include <optional>
#include <utility>

#include "conform/dut/stimuli.hpp"
#include "mutant.hpp"
#include "online/live_bus.hpp"

namespace edsc::conform {

class SimulationPort final : public BusPort {
 public:
  using Simulation = canopen::simulation_detail::Simulation;

  SimulationPort(Simulation& device, Mutant mutant) : device_{device}, mutant_{std::move(mutant)} {}

  bool send(const canopen::Frame& frame) override {
    canopen::Frame changed = frame;
    const Wire wire = put_on(mutant_.of_requests, changed);
    for (const canopen::Frame& added : wire.to_device) device_.send_to_device(added);
    if (wire.keep) device_.send_to_device(changed);
    return true;
  }

  std::optional<canopen::Frame> receive(canopen::Duration timeout) override {
    const canopen::TimePoint end = now() + timeout;
    for (;;) {
      if (const auto frame = due()) return frame;
      if (now() >= end) return std::nullopt;
      canopen::Duration span = end - now();
      for (const Waiting& waiting : waiting_) span = std::min(span, waiting.at - now());
      if (auto frame = device_.run(span)) {
        const Wire wire = put_on(mutant_.of_answers, *frame);
        if (wire.keep) waiting_.push_back({now() + wire.later, *frame});
      }
    }
  }

  canopen::TimePoint now() const override {
    return canopen::TimePoint{canopen::Duration{static_cast<std::uint32_t>(device_.elapsed())}};
  }
  canopen::TimePoint received_at() const override { return now(); }

 private:
  struct Waiting {
    canopen::TimePoint at;
    canopen::Frame frame;
  };

  /// Applies the mutant to a frame. Additional frames wait for `receive`.
  Wire put_on(const Change& change, canopen::Frame& frame) {
    Wire wire;
    wire.now = now();
    if (change) change(wire, frame);
    for (const canopen::Frame& added : wire.from_device) waiting_.push_back({now(), added});
    return wire;
  }

  std::optional<canopen::Frame> due() {
    const auto found = std::ranges::find_if(waiting_, [this](const Waiting& waiting) { return waiting.at <= now(); });
    if (found == waiting_.end()) return std::nullopt;
    const canopen::Frame frame = found->frame;
    waiting_.erase(found);
    return frame;
  }

  Simulation& device_;
  Mutant mutant_;
  std::deque<Waiting> waiting_;
};

/// Stimuli of a simulated device from outside the bus.
class SimulationStimuli final : public Stimuli {
 public:
  explicit SimulationStimuli(SimulationPort::Simulation& device) : device_{device} {}

  bool set(std::uint16_t index, std::uint8_t sub_index, std::span<const std::uint8_t> value) override {
    return device_.node().set(index, sub_index, value) == canopen::ok;
  }
  bool emergency(std::uint16_t code, std::uint8_t bits) override {
    device_.node().emergency(code, canopen::ErrorRegister{bits});
    return true;
  }
  bool emergency_over(std::uint8_t bits) override {
    device_.node().emergency_over(canopen::ErrorRegister{bits});
    return true;
  }
  bool power_cycle() override {
    device_.power_cycle();
    return true;
  }

 private:
  SimulationPort::Simulation& device_;
};

}  // namespace edsc::conform
