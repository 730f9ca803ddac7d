/// A node with the clock of the runtime, which wraps every 71 minutes, against the same node with a clock of 64 bits:
/// both are called at the same times and must send the same frames and return the same deadlines.
///
/// This source is compiled twice. The program with the clock of 64 bits prints what its nodes do. The other one runs
/// the first one, whose path is its argument, and compares each line.
///
/// The nodes get random requests, errors and values. In between, nothing happens for 2^32 us or a multiple of that,
/// give or take seven seconds, and the nodes are only called as the runtime requires: at each deadline, and every half
/// hour.
#include <canopen/node.hpp>

#include <array>
#include <can_2017c/device.hpp>
#include <can_2024c/device.hpp>
#include <can_2053c/device.hpp>
#include <can_2057c/device.hpp>
#include <cpc_tc1/device.hpp>
#include <cpd/device.hpp>
#include <cstdio>
#include <cstdlib>
#include <deque>
#include <every_service/device.hpp>
#include <ezd_1136/device.hpp>
#include <random>
#include <rk5c/device.hpp>
#include <string>
#include <vector>

#include "support/omitting.hpp"

namespace {

using canopen::AbortCode;
using canopen::Frame;
using canopen::NodeId;
using canopen::TimePoint;

constexpr bool is_wide = sizeof(canopen::Duration::rep) == 8;

/// Prints each line, or compares it with the next one of the other program.
class Report {
 public:
  explicit Report(std::FILE* other) : other_{other} {}

  void line(const std::string& text) {
    if (other_ == nullptr) return static_cast<void>(std::printf("%s\n", text.c_str()));
    char expected[200] = "";
    if (std::fgets(expected, sizeof expected, other_) != nullptr && text + "\n" == expected) {
      past_.push_back(text);
      if (past_.size() > 30) past_.pop_front();
      return;
    }
    for (const std::string& before : past_) std::printf("%s\n", before.c_str());
    std::printf("with 64 bits:                  %swith the clock of the runtime: %s\n", expected, text.c_str());
    std::exit(1);
  }

 private:
  std::FILE* other_;
  std::deque<std::string> past_;  ///< the last lines
};

/// A bus that reports each frame.
struct Bus {
  Report& report;
  const std::uint64_t& now;
  bool has_room = true;

  bool send(const Frame& frame) {
    if (!has_room) return false;
    char text[80];
    int size =
        std::snprintf(text, sizeof text, "%llu us: %X", static_cast<unsigned long long>(now), unsigned(frame.id));
    for (unsigned i = 0; i < frame.size; ++i)
      size += std::snprintf(text + size, sizeof text - unsigned(size), " %02X", unsigned{frame.data[i]});
    report.line(text);
    return true;
  }
};

/// A port for LSS that accepts everything.
struct LssPort {
  [[nodiscard]] static canopen::LssError accept(NodeId) { return {}; }
  [[nodiscard]] static canopen::LssError accept(canopen::LssBitTiming) { return {}; }
  [[nodiscard]] static canopen::LssError store(NodeId, canopen::LssBitTiming) { return {}; }
  [[nodiscard]] static canopen::LssBitTiming bit_timing() { return {}; }
  static void stop_communication() {}
  static void start_communication(canopen::LssBitTiming) {}
};

/// An entry that is written at random.
struct Entry {
  std::uint16_t index;
  std::uint8_t sub_index;
  std::uint8_t size;
};

constexpr std::uint64_t second = 1'000'000;
constexpr std::uint64_t wrap = std::uint64_t{1} << 32;

template <class Device>
class Run {
 public:
  Run(Report& report, unsigned seed) : report_{report}, random_{seed} {
    Device::dictionary.for_each_entry([&](std::uint16_t index, std::uint8_t sub_index, canopen::entry::Word word) {
      const bool is_number = canopen::entry::class_of(word) != canopen::entry::Class::special;
      if (!is_number || canopen::entry::wire_bytes(word) > 4) return;
      const Entry entry{index, sub_index, static_cast<std::uint8_t>(canopen::entry::wire_bytes(word))};
      if (canopen::entry::place_of(word) == canopen::entry::Place::ram && (word & canopen::entry::tpdo) != 0 &&
          !canopen::is_communication_index(index))
        values_.push_back(entry);
      if ((word & canopen::entry::writable) == 0) return;
      const bool is_pdo = index >= 0x1400 && index < 0x1C00 && (index & 0x200) == 0;
      if ((index >= 0x1005 && index < 0x1030) || (is_pdo && sub_index != 0)) parameters_.push_back(entry);
    });
  }

  void run(unsigned steps) {
    node_.start(NodeId{5}, time());
    for (unsigned i = 0; i < steps; ++i) {
      step();
      report_deadline();
    }
  }

 private:
  [[nodiscard]] std::uint64_t pick(std::uint64_t below) { return random_() % below; }
  template <std::size_t N>
  [[nodiscard]] std::uint32_t one_of(const std::uint32_t (&values)[N]) {
    return values[pick(N)];
  }
  [[nodiscard]] TimePoint time() const {
    return TimePoint{canopen::Duration{static_cast<canopen::Duration::rep>(now_)}};
  }

  void step() {
    switch (pick(16)) {
      case 0:
      case 1:
      case 2: return write_parameter();
      case 3:
      case 4: return set_value();
      case 5:
        return node_.emergency(static_cast<std::uint16_t>(0x1000 + pick(0xF000)), canopen::ErrorRegister::generic);
      case 6: return node_.emergency_over(canopen::ErrorRegister::generic);
      case 7: return command();
      case 8: return receive();
      case 9: bus_.has_room = pick(4) != 0; return;
      case 10: return pass(pick(30'000), 1000);
      case 11: return pass(pick(10 * second), 1000);
      case 12: return pass(pick(10), 10);
      case 13: return be_quiet();
      case 14: node_.on_bus_status({static_cast<canopen::BusState>(pick(3)), false}, time()); return;
      case 15:
        if (pick(3) == 0) pass((1 + pick(3)) * wrap - 7 * second + pick(14 * second), 3000);
        return;
    }
  }

  void write_parameter() {
    if (parameters_.empty()) return;
    const Entry entry = parameters_[pick(parameters_.size())];
    std::uint32_t value = one_of({0, 1, 2, 5, 10, 100, 1000, 5000, 65535, 2'000'000'000});
    const bool is_pdo = entry.index >= 0x1400;
    if (entry.index == 0x1005) value = pick(2) == 0 ? 0x4000'0080 : 0x80;
    if (entry.index == 0x1016) value = 0x0002'0000 + static_cast<std::uint32_t>(pick(2) * 50);
    if (is_pdo && entry.sub_index == 1) value = node_.entries().number(entry.index, 1) ^ 0x8000'0000;
    if (is_pdo && entry.sub_index == 2) value = one_of({0, 1, 2, 254, 255});
    Frame frame{.id = 0x605, .size = 8};
    canopen::sdo::put_multiplexer(frame.data, entry.index, entry.sub_index);
    frame.data[0] = static_cast<std::uint8_t>(0x23 | (4 - entry.size) << 2);
    for (unsigned i = 0; i < entry.size; ++i) frame.data[4 + i] = static_cast<std::uint8_t>(value >> 8 * i);
    node_.on_frame(frame, time());
  }

  /// Ends what the node does periodically, so that it is idle afterwards.
  void be_quiet() {
    for (const Entry& entry : parameters_) {
      if (entry.index != 0x1017 && entry.index != 0x1006 && !(entry.index >= 0x1800 && entry.sub_index == 5)) continue;
      static_cast<void>(node_.set(entry.index, entry.sub_index, std::array<std::uint8_t, 4>{}));
      static_cast<void>(node_.set(entry.index, entry.sub_index, std::array<std::uint8_t, 2>{}));
    }
  }

  void set_value() {
    if (values_.empty()) return;
    const Entry entry = values_[pick(values_.size())];
    const std::array<std::uint8_t, 4> bytes{static_cast<std::uint8_t>(pick(256))};
    static_cast<void>(node_.set(entry.index, entry.sub_index, std::span{bytes}.first(entry.size)));
  }

  void command() {
    const std::uint32_t command = one_of({1, 1, 1, 1, 2, 128, 129, 130});
    node_.on_frame({.id = 0, .size = 2, .data = {static_cast<std::uint8_t>(command), 5}}, time());
  }

  void receive() {
    Frame frame{.id = one_of({0x80, 0x80, 0x80, 0x205, 0x305, 0x702, 0x702, 0x705, 0x185, 0x285, 0x7E5}), .size = 8};
    if (frame.id == 0x80) frame.size = 0;
    if (frame.id == 0x702) frame = {.id = 0x702, .size = 1, .data = {static_cast<std::uint8_t>(pick(2) == 0 ? 5 : 0)}};
    if (frame.id == 0x705 || frame.id == 0x185 || frame.id == 0x285) frame.remote = true;
    if (frame.id == 0x7E5) {
      const std::uint32_t bytes = one_of({0x0104, 0x0004, 0x0013, 0xC815, 0x0517});
      frame.data = {static_cast<std::uint8_t>(bytes), static_cast<std::uint8_t>(bytes >> 8)};
    }
    node_.on_frame(frame, time());
  }

  /// Lets time pass: `on_time` is called at each deadline, and at least every half hour. Ends after `calls`.
  void pass(std::uint64_t span, unsigned calls) {
    const std::uint64_t end = now_ + span;
    for (; now_ < end && calls != 0; --calls) {
      std::uint64_t next = std::min(end, now_ + 1 + pick(30 * 60 * second));
      const auto deadline = node_.next_deadline();
      // While the bus has no room, a node is called when it has room again.
      if (deadline && bus_.has_room) next = std::min(next, now_ + ahead(*deadline));
      now_ = next;
      node_.on_time(time());
      report_deadline();
      const auto after = node_.next_deadline();
      if (bus_.has_room && after && *after <= time()) break;  // it waits for its application
    }
  }

  /// Returns the time from now to a deadline in us.
  [[nodiscard]] std::uint64_t ahead(TimePoint deadline) const {
    return deadline > time() ? (deadline - time()).count() : 0;
  }

  void report_deadline() {
    const auto deadline = node_.next_deadline();
    report_.line(std::to_string(now_) + " us: next " + (deadline ? std::to_string(ahead(*deadline)) : "none"));
  }

  Report& report_;
  std::mt19937 random_;
  std::uint64_t now_ = 0;
  Bus bus_{report_, now_};
  LssPort port_;
  std::vector<Entry> parameters_;  ///< writable communication parameters of at most four bytes
  std::vector<Entry> values_;      ///< mappable values
  bench::NodeOf<Device, Bus, decltype(canopen::configured_by_lss(port_))> node_{bus_,
                                                                                canopen::configured_by_lss(port_)};
};

/// An EMCY whose inhibit time of 1 ms has elapsed 71 minutes ago is sent at once.
void run_late_emergency(Report& report) {
  std::uint64_t now = 0;
  Bus bus{report, now};
  const auto time = [&] { return TimePoint{canopen::Duration{static_cast<canopen::Duration::rep>(now)}}; };
  bench::NodeOf<every_service::Device, Bus> node{bus, NodeId{5}};
  node.start(time());
  const std::array<std::uint8_t, 2> ten{10, 0};
  if (node.set(0x1015, 0, ten) != canopen::ok) std::abort();
  node.emergency(0x1000, canopen::ErrorRegister::generic);
  node.on_time(time());
  for (const std::uint64_t minutes : {30U, 60U, 71U}) {
    now = minutes * 60 * second;
    node.on_time(time());
  }
  now = 4'288'500'000;
  node.emergency(0x2000, canopen::ErrorRegister::generic);
  node.on_time(time());
  report.line("late emergency: done");
}

template <class Device>
void run_device(Report& report, const char* name, unsigned seeds, unsigned steps) {
  for (unsigned seed = 1; seed <= seeds; ++seed) {
    report.line(std::string{name} + ", seed " + std::to_string(seed));
    Run<Device>{report, seed}.run(steps);
  }
}

}  // namespace

int main(int count, char** arguments) {
  std::FILE* const other = is_wide || count < 2 ? nullptr : popen(arguments[1], "r");
  if (!is_wide && other == nullptr) return 2;
  Report report{other};
  run_late_emergency(report);
  constexpr unsigned seeds = 20;
  constexpr unsigned steps = 1500;
  run_device<every_service::Device>(report, "every_service", seeds, steps);
  run_device<can_2017c::Device>(report, "can_2017c", seeds, steps);
  run_device<can_2024c::Device>(report, "can_2024c", seeds, steps);
  run_device<can_2053c::Device>(report, "can_2053c", seeds, steps);
  run_device<can_2057c::Device>(report, "can_2057c", seeds, steps);
  run_device<cpc_tc1::Device>(report, "cpc_tc1", seeds, steps);
  run_device<cpd::Device>(report, "cpd", seeds, steps);
  run_device<ezd_1136::Device>(report, "ezd_1136", seeds, steps);
  run_device<rk5c::Device>(report, "rk5c", seeds, steps);
  report.line("done");
  return other != nullptr ? pclose(other) : 0;
}
