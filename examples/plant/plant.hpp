/// Four I/O modules on one bus, wired to each other: the digital outputs of the first are the digital inputs of the
/// second, the analogue outputs of the third are analogue inputs of the fourth.
#pragma once

#include <array>
#include <canopen/base/clock.hpp>
#include <canopen/can/bus_status.hpp>
#include <canopen/can/frame.hpp>
#include <cstddef>
#include <cstdint>
#include <deque>
#include <optional>
#include <utility>

#include "can_2017c/can_2017c.hpp"
#include "can_2024c/can_2024c.hpp"
#include "can_2053c/can_2053c.hpp"
#include "can_2057c/can_2057c.hpp"
#include "shared/description.hpp"
#include "shared/input_line.hpp"
#include "shared/surroundings.hpp"

/// All four modules must have the same lifetime. The last analogue output is also wired to the sixth input.
template <class DigitalOut, class DigitalIn, class AnalogueOut, class AnalogueIn>
void wire(DigitalOut& digital_out, DigitalIn& digital_in, AnalogueOut& analogue_out, AnalogueIn& analogue_in) {
  digital_out.on_digital = [&digital_in](std::uint8_t block, std::uint8_t levels) {
    digital_in.set_digital(block, levels);
  };
  analogue_out.on_analogue = [&analogue_in](std::uint8_t channel, std::int16_t raw) {
    analogue_in.set_analogue(channel, raw);
    if (channel == 3) analogue_in.set_analogue(5, raw);
  };
}

/// The surroundings must outlive it.
template <canopen::Bus B>
class Plant {
 public:
  static constexpr nodes::Description description{
      "plant", "Four I/O modules, wired to each other: can_2057c 1 to can_2053c 2, can_2024c 3 to can_2017c 4.",
      "1 to 4, whatever it says", "  node N LINE                      a line for one of them: node 4 analogue 7 2.5\n"};

  Plant(B& bus, nodes::Surroundings& around)
      : digital_out_{*this, bus, 0, around.part("can_2057c")},
        digital_in_{*this, bus, 1, around.part("can_2053c")},
        analogue_out_{*this, bus, 2, around.part("can_2024c")},
        analogue_in_{*this, bus, 3, around.part("can_2017c")} {
    wire(digital_out_.module, digital_in_.module, analogue_out_.module, analogue_in_.module);
  }
  Plant(const Plant&) = delete;
  Plant& operator=(const Plant&) = delete;

  void start(canopen::TimePoint now) {
    for_each([&](auto& node) { node.module.start(now); });
    exchange(now);
  }
  void on_frame(const canopen::Frame& frame, canopen::TimePoint now) {
    for_each([&](auto& node) { node.module.on_frame(frame, now); });
    on_time(now);
  }
  void on_time(canopen::TimePoint now) {
    for_each([&](auto& node) { node.module.on_time(now); });
    exchange(now);
  }
  [[nodiscard]] std::optional<canopen::TimePoint> next_deadline() const {
    std::optional<canopen::TimePoint> next;
    for_each([&](const auto& node) {
      const auto deadline = node.module.next_deadline();
      if (deadline && (!next || *deadline < *next)) next = deadline;
    });
    return next;
  }
  void on_bus_status(const canopen::BusStatus& status, canopen::TimePoint now) {
    for_each([&](auto& node) { node.module.on_bus_status(status, now); });
    exchange(now);
  }
  bool input(const nodes::InputLine& line, canopen::TimePoint now) {
    if (!line.begins_with("node", 2)) return false;
    const auto number = line.number<std::uint8_t>(1, 1, 4);
    bool taken = false;
    for_each([&](auto& node) {
      if (number && node.position + 1u == *number) taken = node.module.input(line.after(2), now);
    });
    exchange(now);
    return taken;
  }

  [[nodiscard]] auto& digital_out() { return digital_out_.module; }
  [[nodiscard]] auto& digital_in() { return digital_in_.module; }
  [[nodiscard]] auto& analogue_out() { return analogue_out_.module; }
  [[nodiscard]] auto& analogue_in() { return analogue_in_.module; }

 private:
  /// The bus for one module: sends to the bus and to the other modules of the process.
  struct Tap {
    Plant& plant;
    B& bus;
    std::size_t position;
    [[nodiscard]] bool send(const canopen::Frame& frame) {
      if (!bus.send(frame)) return false;
      plant.sent_.push_back({position, frame});
      return true;
    }
  };

  template <template <class Bus> class Module>
  struct Place {
    Place(Plant& plant, B& bus, std::size_t number, nodes::Surroundings& around)
        : position{number}, tap{plant, bus, number}, module{tap, around} {}
    std::size_t position;
    Tap tap;
    Module<Tap> module;
  };

  template <class Visit>
  void for_each(Visit visit) {
    visit(digital_out_);
    visit(digital_in_);
    visit(analogue_out_);
    visit(analogue_in_);
  }
  template <class Visit>
  void for_each(Visit visit) const {
    visit(digital_out_);
    visit(digital_in_);
    visit(analogue_out_);
    visit(analogue_in_);
  }

  /// Passes the frames that each module has sent to the others.
  void exchange(canopen::TimePoint now) {
    while (!sent_.empty()) {
      const auto [sender, frame] = sent_.front();
      sent_.pop_front();
      for_each([&, from = sender, &message = frame](auto& node) {
        if (node.position != from) node.module.on_frame(message, now);
      });
    }
  }

  std::deque<std::pair<std::size_t, canopen::Frame>> sent_;
  Place<Can2057c> digital_out_;
  Place<Can2053c> digital_in_;
  Place<Can2024c> analogue_out_;
  Place<Can2017c> analogue_in_;
};
