#include <fmt/format.h>
#include <time.h>

#include <algorithm>
#include <cerrno>
#include <chrono>
#include <cstring>
#include <memory>
#include <system_error>

#include "commands/commands.hpp"
#include "online/live_bus.hpp"
#include "server/candump_line.hpp"
#include "shared/define_command.hpp"
#include "shared/exit_code.hpp"
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

struct Close {
  void operator()(std::FILE* file) const { std::fclose(file); }
};

std::string bad_interface(const std::string& name) {
  if (is_interface_name(name)) return "";
  return fmt::format("\"{}\" is not the name of an interface: up to 15 characters without blanks", name);
}

/// The time of day at which a frame was received, never earlier than that of the previous frame.
class Clock {
 public:
  socketcand::TimeStamp at(canopen::TimePoint received, canopen::TimePoint now) {
    timespec time{};
    ::clock_gettime(CLOCK_REALTIME, &time);
    const auto age = std::chrono::microseconds{(now - received).count()};
    std::int64_t present = std::int64_t{time.tv_sec} * 1'000'000 + time.tv_nsec / 1000 - age.count();
    last_ = std::max(last_, present);
    return {static_cast<std::time_t>(last_ / 1'000'000), static_cast<std::int32_t>(last_ % 1'000'000)};
  }

 private:
  std::int64_t last_ = 0;
};

/// Writes the frames of a bus to a file.
class Recorder {
 public:
  Recorder(LiveBus& bus, const Settings& settings, std::FILE* file)
      : bus_{bus},
        settings_{settings},
        interface_{settings.interface.empty() ? interface_of(settings.bus) : settings.interface},
        file_{file} {}

  /// Returns false if the file cannot be written.
  bool run() {
    using namespace std::chrono;
    const auto end = steady_clock::now() + microseconds{settings_.span_us};
    while (!Interruption::noted() && frames_ != settings_.count) {
      const auto left = duration_cast<milliseconds>(end - steady_clock::now());
      if (left <= milliseconds{0}) break;
      std::optional<canopen::Frame> frame = bus_.receive(canopen::Duration{0});
      if (!frame) {
        if (std::fflush(file_) != 0) return false;
        frame = bus_.receive(canopen::Duration{static_cast<std::uint32_t>(std::min(left, look_again).count()) * 1000U});
      }
      if (frame && !write(*frame)) return false;
    }
    return std::fflush(file_) == 0;
  }

  [[nodiscard]] std::uint64_t frames() const { return frames_; }

 private:
  static constexpr std::chrono::milliseconds look_again{100};

  bool write(const canopen::Frame& frame) {
    const std::string line = candump_line(frame, interface_, clock_.at(bus_.received_at(), bus_.now())) + "\n";
    ++frames_;
    return std::fwrite(line.data(), 1, line.size(), file_) == line.size();
  }

  LiveBus& bus_;
  const Settings& settings_;
  std::string interface_;
  std::FILE* file_;
  Clock clock_;
  std::uint64_t frames_ = 0;
};

int record(LiveBus& bus, const Settings& settings, std::FILE* file) {
  Recorder recorder{bus, settings, file};
  const auto report = [&] {
    if (!settings.output.empty())
      print_visibly(stdout, "{} frames written to {}\n", recorder.frames(), settings.output);
  };
  try {
    errno = 0;
    if (!recorder.run()) {
      // main reports write errors of standard output
      if (settings.output.empty()) throw std::system_error{errno, std::generic_category(), "standard output"};
      fail(fmt::format("{}: {}", settings.output, errno != 0 ? std::strerror(errno) : "cannot be written"));
    }
  } catch (const BusLost&) {
    std::fflush(file);
    report();
    throw;
  }
  report();
  return exit_fine;
}

int run_record(const Settings& settings) {
  return with_bus(settings.bus, [&](LiveBus& bus) {
    if (settings.output.empty()) return record(bus, settings, stdout);
    const std::unique_ptr<std::FILE, Close> file{std::fopen(settings.output.c_str(), "we")};
    if (!file) fail(fmt::format("{}: {}", settings.output, std::strerror(errno)));
    return record(bus, settings, file.get());
  });
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
