#include <fmt/format.h>

#include <algorithm>
#include <cerrno>
#include <chrono>
#include <cstring>
#include <system_error>

#include "commands/commands.hpp"
#include "online/live_bus.hpp"
#include "server/candump_line.hpp"
#include "shared/define_command.hpp"
#include "shared/exit_code.hpp"
#include "shared/frame_log.hpp"
#include "shared/live_options.hpp"
#include "shared/with_bus.hpp"
#include "text/duration.hpp"
#include "text/printable.hpp"

namespace edsc {
namespace {

constexpr const char* examples = R"(Examples:
  edsc record socketcan:can0 -o bus.log                      until Ctrl-C; decode, canplayer and log2asc read it
  edsc record slcan:/dev/ttyACM0@500000 -o bus.log --for 1m
  edsc record socketcand:127.0.0.1:29536/vcan0 --count 1000  on standard output
  edsc record socketcan:can0 | edsc decode --node 5=drive.eds -)";

struct Settings {
  std::string bus;
  std::string output;
  std::string interface;
  std::uint64_t span_us = max_duration_us;
  std::optional<std::uint64_t> count;
};

std::string bad_interface(const std::string& name) {
  if (is_interface_name(name)) return "";
  return fmt::format("\"{}\" is not the name of an interface: up to 15 characters without blanks", name);
}

/// Writes the frames of a bus to a file.
class Recorder {
 public:
  Recorder(LiveBus& bus, const Settings& settings)
      : bus_{bus},
        settings_{settings},
        log_{settings.output, settings.interface.empty() ? interface_of(settings.bus) : settings.interface} {}

  /// Returns false if the file cannot be written.
  bool run() {
    using namespace std::chrono;
    const auto end = steady_clock::now() + microseconds{settings_.span_us};
    while (!Interruption::noted() && log_.frames() != settings_.count) {
      const auto left = duration_cast<milliseconds>(end - steady_clock::now());
      if (left <= milliseconds{0}) break;
      std::optional<canopen::Frame> frame = bus_.receive(canopen::Duration{0});
      if (!frame) {
        if (!log_.flush()) return false;
        frame = bus_.receive(canopen::Duration{static_cast<std::uint32_t>(std::min(left, look_again).count()) * 1000U});
      }
      if (frame && !log_.write(*frame, bus_.received_at(), bus_.now())) return false;
    }
    return log_.flush();
  }

  [[nodiscard]] FrameLog& log() { return log_; }

 private:
  static constexpr std::chrono::milliseconds look_again{100};

  LiveBus& bus_;
  const Settings& settings_;
  FrameLog log_;
};

int record(LiveBus& bus, const Settings& settings) {
  Recorder recorder{bus, settings};
  const auto report = [&] {
    if (!settings.output.empty())
      print_visibly(stdout, "{} frames written to {}\n", recorder.log().frames(), settings.output);
  };
  try {
    errno = 0;
    if (!recorder.run()) {
      // main reports write errors of standard output
      if (settings.output.empty()) throw std::system_error{errno, std::generic_category(), "standard output"};
      fail(fmt::format("{}: {}", settings.output, errno != 0 ? std::strerror(errno) : "cannot be written"));
    }
  } catch (const BusLost&) {
    static_cast<void>(recorder.log().flush());
    report();
    throw;
  }
  report();
  return exit_fine;
}

int run_record(const Settings& settings) {
  return with_bus(settings.bus, [&](LiveBus& bus) { return record(bus, settings); });
}

}  // namespace

void add_record_options(Command command, int& exit_code) {
  Settings& settings = define_command(command, examples, run_record, exit_code);
  add_bus_argument(command, settings.bus);
  command.add_option("--output", settings.output, "emptied at the start (default: standard output)");
  command.add_duration("--for", 10'000, max_duration_us, [&settings](std::uint64_t us) { settings.span_us = us; });
  command.add_option("--count", settings.count).range(1, std::uint64_t{1} << 62);
  command.add_option("--log-interface", settings.interface).check(bad_interface);
}

}  // namespace edsc
