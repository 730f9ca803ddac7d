/// A device as a program in simulated time: `edsc` starts it and talks to it over standard input and output, one answer
/// for one request. It needs no CAN interface and no clock, and it is as fast as the computer. POSIX, host side.
///
///     // conform.cpp; edsc_add_conformance_test writes it
///     #include <canopen_sim/simulated_device.hpp>
///     #include <pump/device.hpp>
///     #include "pump.hpp"
///     int main(int argc, char** argv) { return canopen::simulate_device<pump::Device, Pump>(argc, argv); }
///
///     edsc read simulated:build/conform@5 5 1018h:01 --type u32
///
/// `Pump` is default-constructible, once per power-on, and is the same class that a node on a real bus has:
/// `canopen::Node<pump::Device, Bus, Pump>`. Instead of a device and an application, it may be a composition, which
/// is the same for the program (node/composition.hpp): `canopen::simulate_device<PumpParts>(argc, argv)`.
///
///     struct Pump {
///       void written(od::speed_setpoint, std::uint16_t speed) { speed_ = speed; }  // node/application.hpp has them
///       void every(canopen::Milliseconds<1>, auto& node) {
///         node.set(od::pressure{}, static_cast<std::uint16_t>(speed_ / 4));
///       }
///       std::uint16_t speed_ = 0;
///     };
///
/// Instead of such functions, it may have `auto handlers()`, which returns a tuple of on_write(), on_read(), ...; the
/// functions of the class itself are called if application_at(*this) is one of them.
///
/// The storage, the LSS port and the memory of DOMAINs that the EDS promises are in the memory of the computer, unless
/// the composition omits them.
///
/// The protocol is in `simulation_codec.hpp`. What the application prints on standard output goes to standard
/// error.
#pragma once

#include <fcntl.h>
#include <unistd.h>

#include <array>
#include <cerrno>
#include <cstdint>
#include <cstdio>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <string_view>

#include "canopen/base/clock.hpp"
#include "canopen/can/frame.hpp"
#include "canopen/can/node_id.hpp"
#include "canopen/host/descriptor.hpp"
#include "canopen/lss/lss_protocol.hpp"
#include "canopen_sim/simulated_node.hpp"
#include "canopen_sim/simulation_codec.hpp"
#include "canopen_sim/virtual_bus.hpp"

namespace canopen {

namespace simulation_detail {

using simulation::number;
using simulation::take_word;

/// A device on a bus of its own, and another participant that sends.
class Simulation final : public SimulatedBus {
 public:
  Simulation(const SimulatedDevice& device, NodeId node_id) : make_{device.make}, memory_{node_id} {
    tester_.queue_limit = SIZE_MAX;
    tester_.on_frame = [this](const Frame& frame, TimePoint) { sent_ = frame; };
    port_.on_frame = [this](const Frame& frame, TimePoint now) { node_->on_frame(frame, now); };
    port_.on_time = [this](TimePoint now) { node_->on_time(now); };
    port_.next_deadline = [this] { return node_->next_deadline(); };
    power_on();
  }

  bool send(const Frame& frame) override { return port_.send(frame); }

  /// For the application, at the present time.
  [[nodiscard]] SimulatedNode& node() {
    node_->on_time(bus_.now());
    return *node_;
  }
  void power_cycle() {
    node_.reset();
    port_.discard();
    power_on();
  }

  void send_to_device(const Frame& frame) { static_cast<void>(tester_.send(frame)); }

  /// The frame that the device has sent in this time, at `elapsed()`.
  [[nodiscard]] std::optional<Frame> run(Duration span) {
    sent_.reset();
    bus_.run_until([this] { return sent_.has_value(); }, span);
    return sent_;
  }
  [[nodiscard]] std::uint64_t elapsed() const { return bus_.elapsed(); }

 private:
  void power_on() {
    node_ = make_(*this, memory_);
    node_->start(bus_.now());
  }

  MakeSimulatedNode make_;
  SimulatedMemory memory_;
  VirtualBus bus_{1'000'000};
  VirtualBus::Endpoint& tester_ = bus_.attach();
  VirtualBus::Endpoint& port_ = bus_.attach();
  std::optional<Frame> sent_;  ///< by the device
  std::unique_ptr<SimulatedNode> node_;
};

/// Obeys lines.
class Session {
 public:
  explicit Session(std::span<const SimulatedDevice> devices) : devices_{devices} {}

  /// Appends the answer; false when the line is malformed.
  [[nodiscard]] bool obey(std::string_view line, std::string& answer) {
    const std::string_view command = take_word(line);
    if (command == "node") return make_node(line, answer);
    if (!simulation_) return false;
    if (command == "run") return run(line, answer);
    if (command == "send") {
      const std::optional<Frame> frame = simulation::parse_frame(line);
      if (frame) simulation_->send_to_device(*frame);
      return frame.has_value();
    }
    if (command == "set") return set(line, answer);
    if (command == "emergency") {
      const auto code = number<std::uint16_t>(take_word(line), 16, 0xFFFF);
      const auto bits = number<std::uint8_t>(line, 16, 0xFF);
      if (!code || !bits) return false;
      simulation_->node().emergency(*code, ErrorRegister{*bits});
    } else if (command == "emergency_over") {
      const auto bits = number<std::uint8_t>(line, 16, 0xFF);
      if (!bits) return false;
      simulation_->node().emergency_over(ErrorRegister{*bits});
    } else if (command == "power_cycle") {
      if (!line.empty()) return false;
      simulation_->power_cycle();
    } else {
      return false;
    }
    answer += "ok\n";
    return true;
  }

 private:
  [[nodiscard]] bool make_node(std::string_view words, std::string& answer) {
    const auto node_id = number<std::uint8_t>(take_word(words), 10, 255);
    const std::string_view name = take_word(words);
    if (!node_id || !words.empty()) return false;
    if (!NodeId{*node_id}.valid() && NodeId{*node_id} != unconfigured_node_id) return false;
    for (const SimulatedDevice& device : devices_) {
      if (!name.empty() && name != device.name) continue;
      simulation_ = std::make_unique<Simulation>(device, NodeId{*node_id});
      answer.append("ok").append(simulation_->node().composition()) += '\n';
      return true;
    }
    answer += "no\n";
    return true;
  }

  [[nodiscard]] bool run(std::string_view words, std::string& answer) {
    const auto span = number<std::uint32_t>(words, 10, longest_span.count());
    if (!span) return false;
    const std::optional<Frame> frame = simulation_->run(Duration{*span});
    answer += std::to_string(simulation_->elapsed());
    if (frame) {
      answer += ' ';
      simulation::append_frame(answer, *frame);
    }
    answer += '\n';
    return true;
  }

  [[nodiscard]] bool set(std::string_view words, std::string& answer) {
    const auto index = number<std::uint16_t>(take_word(words), 16, 0xFFFF);
    const auto sub_index = number<std::uint8_t>(take_word(words), 16, 0xFF);
    const auto bytes = simulation::parse_bytes(words);
    if (!index || !sub_index || !bytes) return false;
    const AbortCode code = simulation_->node().set(*index, *sub_index, *bytes);
    if (code == ok) {
      answer += "ok\n";
    } else {
      std::array<char, 20> text;
      std::snprintf(text.data(), text.size(), "refused %08X\n", unsigned{code_in_frame(code)});
      answer += text.data();
    }
    return true;
  }

  std::span<const SimulatedDevice> devices_;
  std::unique_ptr<Simulation> simulation_;
};

/// False when the reader has gone.
[[nodiscard]] inline bool write_all(int descriptor, std::string_view text) {
  while (!text.empty()) {
    const ssize_t written = ::write(descriptor, text.data(), text.size());
    if (written < 0 && errno != EINTR) return false;
    if (written > 0) text.remove_prefix(static_cast<std::size_t>(written));
  }
  return true;
}

/// Lines of standard input until it ends. Answers are written when all lines that have arrived are obeyed.
[[nodiscard]] inline int serve(Session& session, int output, const char* program) {
  std::string answer{simulation::greeting};
  answer += '\n';
  std::string input;
  std::array<char, 4096> piece;
  for (;;) {
    if (!write_all(output, answer)) return 0;
    answer.clear();
    const ssize_t got = ::read(STDIN_FILENO, piece.data(), piece.size());
    if (got < 0 && errno == EINTR) continue;
    if (got <= 0) return 0;
    input.append(piece.data(), static_cast<std::size_t>(got));
    std::size_t begin = 0;
    for (std::size_t end = 0; (end = input.find('\n', begin)) != std::string::npos; begin = end + 1) {
      const std::string_view line = std::string_view{input}.substr(begin, end - begin);
      if (session.obey(line, answer)) continue;
      static_cast<void>(write_all(output, answer));
      std::fprintf(stderr, "%s: not understood: %.*s\n", program, static_cast<int>(line.size()), line.data());
      return 2;
    }
    input.erase(0, begin);
  }
}

}  // namespace simulation_detail

/// The `main` of a program that simulates one of several devices: the first one, or that of the name.
[[nodiscard]] inline int simulate_devices(int argc, char** argv, std::span<const SimulatedDevice> devices) {
  const char* const program = argc > 0 ? argv[0] : "simulation";
  if (argc > 1) {
    std::fprintf(stderr, "usage: edsc COMMAND simulated:%s@NODE-ID[,NAME] ...\nNAME is one of\n", program);
    for (const SimulatedDevice& device : devices) {
      std::fprintf(stderr, "  %.*s\n", static_cast<int>(device.name.size()), device.name.data());
    }
    return 2;
  }
  const Descriptor output{::fcntl(STDOUT_FILENO, F_DUPFD_CLOEXEC, 3)};
  static_cast<void>(::dup2(STDERR_FILENO, STDOUT_FILENO));
  simulation_detail::Session session{devices};
  return simulation_detail::serve(session, output.number(), program);
}

namespace simulation_detail {

/// The device and the application of a program's device: a generated device, or a composition.
template <class Parts>
struct Simulated {
  using Device = Parts;
  using Application = NoApplication;
};
template <class OfDevice, class... Parts>
struct Simulated<Composition<OfDevice, Parts...>> {
  using Device = OfDevice;
  using Application = Composition<OfDevice, Parts...>;
};

}  // namespace simulation_detail

/// The `main` of a program that simulates a device: a Composition, or a device that edsc has generated and the
/// application of the user. Without application, edsc makes the composition.
template <class Parts, class Application = typename simulation_detail::Simulated<Parts>::Application>
[[nodiscard]] int simulate_device(int argc, char** argv) {
  const SimulatedDevice device{"device",
                               &make_simulated_node<typename simulation_detail::Simulated<Parts>::Device, Application>};
  return simulate_devices(argc, argv, {&device, 1});
}

}  // namespace canopen
