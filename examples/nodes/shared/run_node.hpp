/// The `main` of a node: `PROGRAM BUS [--node-id N] [--store FILE] [--serial N]`, until SIGINT or SIGTERM.
///
///     template <canopen::Bus B>
///     class Drive {
///      public:
///       static constexpr nodes::Description description{...};
///       Drive(B& bus, nodes::Surroundings& around);        // the surroundings outlive it
///       void start(canopen::TimePoint now);                // power-on
///       void on_frame(const canopen::Frame&, canopen::TimePoint now);
///       void on_time(canopen::TimePoint now);
///       std::optional<canopen::TimePoint> next_deadline() const;
///       void on_bus_status(const canopen::BusStatus&, canopen::TimePoint now);
///       bool input(const nodes::InputLine&, canopen::TimePoint now);   // false: unknown line
///     };
///     int main(int argc, char** argv) { return nodes::run_node<Drive>(argc, argv); }
#pragma once

#include <poll.h>
#include <unistd.h>

#include <array>
#include <atomic>
#include <canopen/can/node_id.hpp>
#include <canopen/host/host_bus.hpp>
#include <cerrno>
#include <charconv>
#include <csignal>
#include <cstdint>
#include <cstdio>
#include <exception>
#include <optional>
#include <stdexcept>
#include <string>
#include <string_view>
#include <utility>

#include "description.hpp"
#include "input_line.hpp"
#include "surroundings.hpp"

#if __has_include(<value_only_objects.hpp>)
#include <value_only_objects.hpp>  // generated from value_only.tsv of the node
#else
namespace nodes {
inline constexpr const char* value_only_objects = "";
}  // namespace nodes
#endif

namespace nodes {

namespace exit_code {
inline constexpr int fine = 0;
inline constexpr int failed = 1;  ///< the bus is lost
inline constexpr int usage = 2;   ///< wrong arguments, or the bus cannot be opened
}  // namespace exit_code

struct Arguments {
  std::string bus;
  std::optional<canopen::NodeId> node_id;
  std::uint32_t serial_number = 1;
  std::string store;
  bool help = false;
};

/// Throws std::invalid_argument with a message.
[[nodiscard]] inline Arguments parse_arguments(int argc, const char* const* argv, int highest_node_id = 127) {
  Arguments result;
  const auto number = [](std::string_view option, std::string_view text, std::uint32_t most) {
    const bool hex = text.starts_with("0x");
    std::uint32_t value = 0;
    const char* begin = text.data() + (hex ? 2 : 0);
    const auto [end, error] = std::from_chars(begin, text.data() + text.size(), value, hex ? 16 : 10);
    if (error != std::errc{} || end != text.data() + text.size() || value > most)
      throw std::invalid_argument{std::string{option} + ": '" + std::string{text} + "' is not a number up to " +
                                  std::to_string(most)};
    return value;
  };
  for (int i = 1; i < argc; ++i) {
    const std::string_view argument = argv[i];
    const auto value = [&]() -> std::string_view {
      if (i + 1 == argc) throw std::invalid_argument{std::string{argument} + " wants a value"};
      return argv[++i];
    };
    if (argument == "--help" || argument == "-h") {
      result.help = true;
    } else if (argument == "--node-id") {
      const canopen::NodeId node_id{static_cast<std::uint8_t>(number(argument, value(), 127))};
      if (!node_id.valid() || node_id.value() > highest_node_id)
        throw std::invalid_argument{"--node-id: a node-ID is 1 to " + std::to_string(highest_node_id)};
      result.node_id = node_id;
    } else if (argument == "--serial") {
      result.serial_number = number(argument, value(), 0xFFFF'FFFF);
    } else if (argument == "--store") {
      result.store = value();
    } else if (argument.starts_with("-")) {
      throw std::invalid_argument{"there is no option " + std::string{argument}};
    } else if (result.bus.empty()) {
      result.bus = argument;
    } else {
      throw std::invalid_argument{"'" + std::string{argument} + "' is one argument too many"};
    }
  }
  if (!result.help && result.bus.empty()) throw std::invalid_argument{"no BUS is given"};
  return result;
}

inline void print_help(const Description& what) {
  std::printf(
      "usage: %s BUS [--node-id N] [--store FILE] [--serial N]\n"
      "%s\n\n"
      "  BUS           socketcan:vcan0, slcan:/dev/ttyACM0 or socketcand:127.0.0.1:29536/vcan0\n"
      "  --node-id N   1 to %d; without it %s\n"
      "  --store FILE  where parameters are stored; without it they last as long as the program\n"
      "  --serial N    serial number 1018h:04, where the device has one to set\n\n"
      "It runs until SIGINT or SIGTERM and logs on standard output. Lines on standard input are its inputs:\n"
      "%s"
      "  can active|passive|off|overrun   what the CAN controller tells\n"
      "  power-cycle                      switches it off and on\n"
      "%s%s\n"
      "examples:\n"
      "  %s socketcan:vcan0 --node-id 5 --store %s.parameters\n"
      "  (sleep 1; echo power-cycle; sleep 1) | %s socketcan:vcan0 --node-id 5\n\n"
      "exit codes: 0 ended by a signal; 1 the bus is lost; 2 wrong arguments, or the bus cannot be opened\n",
      what.program, what.device, what.highest_node_id, what.node_id, what.inputs,
      *value_only_objects == 0 ? "" : "\nobjects that hold a value and have no other effect:\n", value_only_objects,
      what.program, what.program, what.program);
}

/// Lines of standard input, read without waiting.
class StandardInput {
 public:
  /// -1 after the end of standard input.
  [[nodiscard]] int file_descriptor() const { return open_ ? STDIN_FILENO : -1; }

  /// Reads available input. Call it only if there is some.
  void read() {
    std::array<char, 512> piece;
    const ssize_t got = ::read(STDIN_FILENO, piece.data(), piece.size());
    if (got > 0) {
      text_.append(piece.data(), static_cast<std::size_t>(got));
    } else if (got == 0 || (errno != EINTR && errno != EAGAIN)) {
      open_ = false;
      if (!text_.empty()) text_ += '\n';
    }
  }

  [[nodiscard]] std::optional<std::string> next_line() {
    const std::size_t end = text_.find('\n');
    if (end == std::string::npos) return std::nullopt;
    std::string line = text_.substr(0, end);
    text_.erase(0, end + 1);
    return line;
  }

 private:
  std::string text_;
  bool open_ = true;
};

namespace run_detail {

inline std::atomic<bool> stop{false};

/// Waits for the bus or a line, for at most 100 ms.
inline void wait_for_either(const canopen::HostBus& bus, const StandardInput& input) {
  constexpr int look_at_stop = 100;  // ms
  std::array<pollfd, 2> waiting{{{bus.file_descriptor(), POLLIN, 0}, {input.file_descriptor(), POLLIN, 0}}};
  static_cast<void>(::poll(waiting.data(), waiting.size(), look_at_stop));
}

[[nodiscard]] inline bool readable(int descriptor) {
  pollfd waiting{descriptor, POLLIN, 0};
  return descriptor >= 0 && ::poll(&waiting, 1, 0) > 0;
}

/// Serves the bus, the timers and the inputs in one context. Returns true for the line `power-cycle`, false if stopped.
template <class Application>
[[nodiscard]] bool run_until_power_cycle(canopen::HostBus& bus, Application& application, StandardInput& input,
                                         Surroundings& around) {
  application.start(bus.now());
  while (!stop) {
    bus.serve(application);
    wait_for_either(bus, input);
    if (readable(input.file_descriptor())) input.read();
    while (const std::optional<std::string> text = input.next_line()) {
      const InputLine line{*text};
      if (line.is("power-cycle", 0)) return true;
      if (const auto status = bus_status_of(line)) {
        application.on_bus_status(*status, bus.now());
      } else if (!line.empty() && !application.input(line, bus.now())) {
        around.log("not understood: " + *text);
      }
    }
  }
  return false;
}

}  // namespace run_detail

/// Writes a line to standard output and flushes it, also into a pipe.
inline void log_to_standard_output(std::string_view line) {
  std::printf("%.*s\n", static_cast<int>(line.size()), line.data());
  std::fflush(stdout);
}

template <template <class Bus> class Application>
[[nodiscard]] int run_node(int argc, char** argv) {
  using App = Application<canopen::HostBus>;
  constexpr const Description& what = App::description;
  Arguments arguments;
  std::optional<canopen::HostBus> bus;
  try {
    arguments = parse_arguments(argc, argv, what.highest_node_id);
    if (arguments.help) {
      print_help(what);
      return exit_code::fine;
    }
    bus.emplace(arguments.bus);
  } catch (const std::exception& problem) {
    std::fprintf(stderr, "%s: %s\n", what.program, problem.what());
    return exit_code::usage;
  }
  std::signal(SIGINT, [](int) { run_detail::stop = true; });
  std::signal(SIGTERM, [](int) { run_detail::stop = true; });
  std::signal(SIGPIPE, SIG_IGN);
  Surroundings around{arguments.node_id, arguments.serial_number, arguments.store, log_to_standard_output};
  StandardInput input;
  try {
    for (bool again = true; again;) {
      around.log("power on: " + std::string{what.program} + " on " + arguments.bus);
      App application{*bus, around};
      again = run_detail::run_until_power_cycle(*bus, application, input, around);
      around.log("power off");
    }
  } catch (const std::exception& problem) {
    std::fprintf(stderr, "%s: %s\n", what.program, problem.what());
    return exit_code::failed;
  }
  return exit_code::fine;
}

}  // namespace nodes
