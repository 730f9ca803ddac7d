/// A device as a program in simulated time: `edsc` starts it and talks to it over standard input and output, one answer for
/// one request. It needs no CAN interface and no clock, and it is as fast as the computer. POSIX, host side.
///
///     // conform.cpp; edsc_add_conformance_test writes it
///     #include <canopen/port/simulated_device.hpp>
///     #include <pump/device.hpp>
///     #include "pump_application.hpp"
///     int main(int argc, char** argv) { return canopen::simulate_device<pump::Device, PumpApplication>(argc, argv); }
///
///     edsc read simulated:build/conform@5 5 1018h:01 --type u32
///
/// `PumpApplication` is default-constructible, once per power-on, and has what the device does with its objects. The same
/// class serves a real bus: `canopen::make_node<pump::Device>(bus, node_id, application.handlers())`.
///
///     class PumpApplication {
///      public:
///       auto handlers() {  // a tuple of on_write(), on_read(), stored_in(), ...
///         return std::tuple{canopen::on_write<od::speed_setpoint>([this](std::uint16_t speed) { speed_ = speed; })};
///       }
///       void start(auto& node) { node.template set<od::pressure>(0); }                     // optional: after power-on
///       void tick(auto& node, canopen::TimePoint) {                                        // optional: each millisecond
///         node.template set<od::pressure>(static_cast<std::uint16_t>(speed_ / 4));
///       }
///      private:
///       std::uint16_t speed_ = 0;
///     };
///
/// A device whose dictionary has 1010h or 1011h gets a storage in memory, and one with LSS a port that stores node-ID and bit
/// rate, where the handlers do not bring their own.
///
/// The protocol, version 1, is lines of text with words separated by one blank. CAN-IDs, indices, codes and bytes are
/// hexadecimal, all else decimal. The program begins with `edsc-simulation 1`. It obeys
///
///     node NODE-ID [NAME]          a new bus of 1 Mbit/s, a new node with empty storage, power-on at time 0
///     send CAN-ID[X] [BYTES]       another participant sends a data frame; X: 29 bits
///     send CAN-ID[X]R LENGTH       the same with a remote frame
///     run MICROSECONDS             lets this time pass, at most until the device has sent a frame. The answer is the time since
///                                  `node` in us, and the frame: `TIME` or `TIME CAN-ID[X] [BYTES]` or `TIME CAN-ID[X]R LENGTH`
///     set INDEX SUB BYTES          the application sets an object, bytes as SDO sends them
///     emergency CODE REGISTER      the application reports an error with these bits of 1001h
///     emergency_over REGISTER      the error has gone
///     power_cycle                  off and on; storage is kept
///
/// `send` does not have an answer. That of `node` is `ok`, or `no` from a program that does not have this device. The last four
/// answer `ok`, `refused ABORT-CODE`, or `no` from a program that cannot do it, and let no time pass. The program ends with its
/// input, with exit code 0, or with 2 at a line that is not one of these.
/// What the application prints on standard output goes to standard error.
#pragma once

#include <fcntl.h>
#include <unistd.h>

#include <array>
#include <cerrno>
#include <charconv>
#include <cstdint>
#include <cstdio>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "canopen/frame.hpp"
#include "canopen/lss_protocol.hpp"
#include "canopen/node_id.hpp"
#include "canopen/port/descriptor.hpp"
#include "canopen/port/simulated_node.hpp"
#include "canopen/port/virtual_bus.hpp"
#include "canopen/time.hpp"

namespace canopen {

namespace simulation_detail {

template <class T>
[[nodiscard]] std::optional<T> number(std::string_view text, int base, T max) {
  T value = 0;
  const char* const last = text.data() + text.size();
  const auto [end, error] = std::from_chars(text.data(), last, value, base);
  if (error != std::errc{} || end != last || value > max) return std::nullopt;
  return value;
}

/// The words of a line.
class Words {
 public:
  explicit Words(std::string_view line) : rest_{line} {}

  /// Empty after the last one.
  std::string_view next() {
    const std::size_t blank = rest_.find(' ');
    const std::string_view word = rest_.substr(0, blank);
    rest_ = blank == std::string_view::npos ? std::string_view{} : rest_.substr(blank + 1);
    return word;
  }
  [[nodiscard]] bool at_end() const { return rest_.empty(); }

 private:
  std::string_view rest_;
};

/// False for what is not pairs of hexadecimal digits.
[[nodiscard]] inline bool append_bytes(std::vector<std::uint8_t>& bytes, std::string_view digits) {
  if (digits.size() % 2 != 0) return false;
  for (std::size_t i = 0; i < digits.size(); i += 2) {
    const auto byte = number<std::uint8_t>(digits.substr(i, 2), 16, 0xFF);
    if (!byte) return false;
    bytes.push_back(*byte);
  }
  return true;
}

[[nodiscard]] inline std::optional<Frame> parse_frame(Words words) {
  Frame frame;
  std::string_view id = words.next();
  if (id.ends_with('R')) {
    frame.remote = true;
    id.remove_suffix(1);
  }
  if (id.ends_with('X')) {
    frame.extended = true;
    id.remove_suffix(1);
  }
  const auto can_id = number<std::uint32_t>(id, 16, frame.extended ? 0x1FFF'FFFF : 0x7FF);
  const std::string_view rest = words.next();
  if (!can_id || !words.at_end()) return std::nullopt;
  frame.id = *can_id;
  if (frame.remote) {
    const auto length = number<std::uint8_t>(rest, 10, 8);
    frame.size = length.value_or(0);
    return length ? std::optional{frame} : std::nullopt;
  }
  std::vector<std::uint8_t> bytes;
  if (!append_bytes(bytes, rest) || bytes.size() > frame.data.size()) return std::nullopt;
  for (const std::uint8_t byte : bytes) frame.data[frame.size++] = byte;
  return frame;
}

inline void append_frame(std::string& text, const Frame& frame) {
  constexpr std::string_view digits = "0123456789ABCDEF";
  for (int shift = frame.extended ? 28 : 8; shift >= 0; shift -= 4) text += digits[(frame.id >> shift) & 0xF];
  if (frame.extended) text += 'X';
  if (frame.remote) {
    text += "R ";
    text += digits[frame.size];
    return;
  }
  if (frame.size != 0) text += ' ';
  for (std::size_t i = 0; i < frame.size; ++i) {
    text += digits[frame.data[i] >> 4];
    text += digits[frame.data[i] & 0xF];
  }
}

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

  /// The frame that the device has sent meanwhile, at `elapsed()`.
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
    Words words{line};
    const std::string_view command = words.next();
    if (command == "node") return make_node(words, answer);
    if (!simulation_) return false;
    if (command == "run") return run(words, answer);
    if (command == "send") {
      const std::optional<Frame> frame = parse_frame(words);
      if (frame) simulation_->send_to_device(*frame);
      return frame.has_value();
    }
    if (command == "set") return set(words, answer);
    if (command == "emergency") {
      const auto code = number<std::uint16_t>(words.next(), 16, 0xFFFF);
      const auto bits = number<std::uint8_t>(words.next(), 16, 0xFF);
      if (!code || !bits || !words.at_end()) return false;
      simulation_->node().emergency(*code, ErrorRegister{*bits});
    } else if (command == "emergency_over") {
      const auto bits = number<std::uint8_t>(words.next(), 16, 0xFF);
      if (!bits || !words.at_end()) return false;
      simulation_->node().emergency_over(ErrorRegister{*bits});
    } else if (command == "power_cycle") {
      if (!words.at_end()) return false;
      simulation_->power_cycle();
    } else {
      return false;
    }
    answer += "ok\n";
    return true;
  }

 private:
  [[nodiscard]] bool make_node(Words words, std::string& answer) {
    const auto node_id = number<std::uint8_t>(words.next(), 10, 255);
    const std::string_view name = words.next();
    if (!node_id || !words.at_end()) return false;
    if (!NodeId{*node_id}.valid() && NodeId{*node_id} != unconfigured_node_id) return false;
    for (const SimulatedDevice& device : devices_) {
      if (!name.empty() && name != device.name) continue;
      simulation_ = std::make_unique<Simulation>(device, NodeId{*node_id});
      answer += "ok\n";
      return true;
    }
    answer += "no\n";
    return true;
  }

  [[nodiscard]] bool run(Words words, std::string& answer) {
    const auto span = number<std::uint32_t>(words.next(), 10, longest_span.count());
    if (!span || !words.at_end()) return false;
    const std::optional<Frame> frame = simulation_->run(Duration{*span});
    answer += std::to_string(simulation_->elapsed());
    if (frame) {
      answer += ' ';
      append_frame(answer, *frame);
    }
    answer += '\n';
    return true;
  }

  [[nodiscard]] bool set(Words words, std::string& answer) {
    const auto index = number<std::uint16_t>(words.next(), 16, 0xFFFF);
    const auto sub_index = number<std::uint8_t>(words.next(), 16, 0xFF);
    std::vector<std::uint8_t> bytes;
    if (!append_bytes(bytes, words.next()) || !index || !sub_index || !words.at_end()) return false;
    const AbortCode code = simulation_->node().set(*index, *sub_index, bytes);
    if (code == ok) {
      answer += "ok\n";
    } else {
      std::array<char, 20> text;
      std::snprintf(text.data(), text.size(), "refused %08X\n", static_cast<unsigned>(code));
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

/// Lines of standard input until it ends. Answers are written when there is no line left to obey.
[[nodiscard]] inline int serve(Session& session, int output, const char* program) {
  std::string answer = "edsc-simulation 1\n";
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

/// The `main` of a program that simulates a device that edsc has generated, with the application of the user.
template <class Device, class Application = NoApplication>
[[nodiscard]] int simulate_device(int argc, char** argv) {
  const SimulatedDevice device{"device", &make_simulated_node<Device, Application>};
  return simulate_devices(argc, argv, {&device, 1});
}

}  // namespace canopen
