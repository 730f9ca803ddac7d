/// A bus over a pseudo-terminal: HostBus on one side, an SLCAN adapter with a node on the other.
#include <fcntl.h>
#include <gtest/gtest.h>
#include <poll.h>
#include <termios.h>
#include <unistd.h>

#include <atomic>
#include <canopen/host/blocking_sdo.hpp>
#include <canopen/host/host_bus.hpp>
#include <canopen/node/locked.hpp>
#include <canopen/port/slcan_adapter.hpp>
#include <cstdlib>
#include <mutex>
#include <optional>
#include <sample/device.hpp>
#include <span>
#include <string>
#include <thread>
#include <utility>

#include "runtime/host/stream_bench.hpp"
#include "support/omitting.hpp"

namespace {

using bench::read_some;
using bench::text_of;
using canopen::Descriptor;
using canopen::Frame;
using canopen::HostBus;
using namespace std::chrono_literals;

/// A thread that works until its owner is destroyed.
class Worker {
 public:
  template <class Work>
  explicit Worker(Work work)
      : thread_{[this, work] {
          while (!stop_) work();
        }} {}
  ~Worker() {
    stop_ = true;
    thread_.join();
  }

 private:
  std::atomic<bool> stop_{false};
  std::thread thread_;
};

/// A device that contains an SLCAN adapter and node 5.
class Device {
 public:
  Device() : line_{canopen::opened(::posix_openpt(O_RDWR | O_NOCTTY), "posix_openpt")} {
    if (::grantpt(line_.number()) != 0 || ::unlockpt(line_.number()) != 0) canopen::throw_errno("pseudo-terminal");
    name_ = ::ptsname(line_.number());
    keeper_ = canopen::opened(::open(name_.c_str(), O_RDWR | O_NOCTTY), name_);
    termios settings{};
    ::tcgetattr(keeper_.number(), &settings);
    ::cfmakeraw(&settings);
    ::tcsetattr(keeper_.number(), TCSANOW, &settings);
  }

  [[nodiscard]] const std::string& name() const { return name_; }

  void write(std::span<const char> text) {
    ASSERT_EQ(::write(line_.number(), text.data(), text.size()), static_cast<ssize_t>(text.size()));
  }
  bool open(const canopen::SlcanChannel& asked) {
    channel = asked;
    start_due_ = !refuses;
    return !refuses;
  }
  void close() { ++closed; }
  bool send(const Frame& frame) {
    node_.on_frame(frame, HostBus::now());
    if (frame.id == heard_id) ++heard;
    return true;
  }
  std::uint8_t status() { return 0; }

  /// Serves the line once.
  void work() {
    for (const char character : read_some(line_.number())) adapter_.on_character(character, *this);
    if (std::exchange(start_due_, false)) node_.start(HostBus::now());
    node_.on_time(HostBus::now());
  }

  [[nodiscard]] int line() const { return line_.number(); }
  void hang_up() { line_ = Descriptor{}; }

  canopen::SlcanChannel channel;
  bool refuses = false;
  std::atomic<int> closed{0};
  std::uint32_t heard_id = 0x700;  ///< frames with this CAN-ID are counted
  std::atomic<int> heard{0};

 private:
  struct NodeBus {
    Device* device;
    bool send(const Frame& frame) {
      device->adapter_.on_frame(frame, HostBus::now(), *device);
      return true;
    }
  };

  bool start_due_ = false;  ///< the channel has been opened
  Descriptor line_;
  Descriptor keeper_;
  std::string name_;
  canopen::SlcanAdapter adapter_;
  NodeBus bus_{this};
  bench::NodeOf<sample::Device, NodeBus> node_{bus_, canopen::NodeId{5}};
};

TEST(SlcanPort, CarriesSdoOverAPseudoTerminal) {
  Device device;
  {
    const Worker worker{[&] { device.work(); }};
    HostBus bus{"slcan:" + device.name() + "@500000"};
    EXPECT_EQ(device.channel, (canopen::SlcanChannel{canopen::SlcanChannel::Rate::code, 6, false}));
    EXPECT_EQ(text_of(bus.receive(60s)), "705 00") << "the node starts with its channel";
    canopen::BlockingSdo master{bus, {.timeout = 60s}};
    auto node = master.remote<sample::Device>(canopen::NodeId{5});
    EXPECT_TRUE(node.write<sample::od::producer_heartbeat_time>(canopen::raw(std::uint16_t{20})));
    const auto time = node.read<sample::od::producer_heartbeat_time>();
    ASSERT_TRUE(time);
    EXPECT_EQ(canopen::to_raw(*time), 20);
    EXPECT_EQ(text_of(bus.receive(60s)), "705 7F");
  }
  for (int i = 0; i < 30'000 && device.closed == 0; ++i) device.work();
  EXPECT_EQ(device.closed, 1) << "a port closes its channel in the end";
}

TEST(SlcanPort, HandsOverEachFrameOfOneRead) {
  Device device;
  std::optional<HostBus> bus;
  {
    const Worker worker{[&] { device.work(); }};
    bus.emplace("slcan:" + device.name());
  }
  EXPECT_EQ(text_of(bus->receive(60s)), "705 00");
  device.write(std::string_view{"t1851AA\rt1851BB\rt1851CC\r"});
  for (const char* frame : {"185 AA", "185 BB", "185 CC"}) {
    pollfd readable{bus->file_descriptor(), POLLIN, 0};
    ASSERT_EQ(::poll(&readable, 1, 60'000), 1) << frame << ": the descriptor is readable while frames are queued";
    EXPECT_EQ(text_of(bus->receive(0us)), frame);
  }
  EXPECT_EQ(text_of(bus->receive(0us)), "none");
  pollfd readable{bus->file_descriptor(), POLLIN, 0};
  EXPECT_EQ(::poll(&readable, 1, 0), 0);
}

void wait_until(const auto& condition) {
  for (int i = 0; i < 60'000 && !condition(); ++i) std::this_thread::sleep_for(1ms);
}

TEST(SlcanPort, RunsALockedNodeThatOtherThreadsUse) {
  Device device;
  device.heard_id = 0x706;
  const Worker worker{[&] { device.work(); }};
  HostBus bus{"slcan:" + device.name()};
  auto node = bench::make_node<sample::Device>(bus, canopen::NodeId{6});
  std::mutex mutex;
  canopen::Locked locked{node, mutex};
  std::atomic<bool> stop{false};
  std::thread loop{[&] { bus.run(locked, stop); }};
  wait_until([&] { return device.heard > 0; });
  EXPECT_EQ(device.heard, 1) << "the boot-up";
  static_cast<void>(locked.set<sample::od::producer_heartbeat_time>(canopen::raw(std::uint16_t{1})));
  bus.wake();
  wait_until([&] { return device.heard > 3; });
  EXPECT_GT(device.heard, 3) << "heartbeats";
  stop = true;
  bus.wake();
  loop.join();
}

TEST(SlcanPort, IsReadableAfterAWakeUntilItIsServed) {
  Device device;
  std::optional<HostBus> bus;
  {
    const Worker worker{[&] { device.work(); }};
    bus.emplace("slcan:" + device.name());
  }
  auto node = bench::make_node<sample::Device>(*bus, canopen::NodeId{6});
  node.start(HostBus::now());
  bus->serve(node);
  pollfd readable{bus->file_descriptor(), POLLIN, 0};
  EXPECT_EQ(::poll(&readable, 1, 0), 0);
  std::thread{[&] { bus->wake(); }}.join();
  EXPECT_EQ(::poll(&readable, 1, 0), 1);
  bus->serve(node);
  EXPECT_EQ(::poll(&readable, 1, 0), 0);
  bus->wake();
  while (bus->receive(0us)) {
  }
  EXPECT_EQ(::poll(&readable, 1, 0), 0) << "nor after a program without a node has found no frame";
}

TEST(SlcanPort, TellsWhatCannotBeOpened) {
  Device device;
  device.refuses = true;
  const Worker worker{[&] { device.work(); }};
  try {
    const HostBus bus{"slcan:" + device.name()};
    FAIL() << "opened";
  } catch (const std::system_error& problem) {
    EXPECT_EQ(problem.code(), std::errc::connection_refused);
    EXPECT_NE(std::string{problem.what()}.find("the adapter does not open its channel"), std::string::npos);
  }
  EXPECT_THROW(HostBus{"slcan:/dev/null"}, std::system_error);
  EXPECT_THROW(HostBus{"slcan:/dev/no-such-line"}, std::system_error);
  EXPECT_THROW(HostBus{"slcan:" + device.name() + "@333"}, std::invalid_argument);
  EXPECT_THROW(HostBus{"slcan:" + device.name() + "@500000,7"}, std::invalid_argument);
  EXPECT_THROW(HostBus{"slcan:" + device.name() + "@fast"}, std::invalid_argument);
}

TEST(SlcanPort, SendsUrgentFramesFirstWhenTheLineIsFull) {
  Device device;
  std::optional<HostBus> bus;
  {
    const Worker worker{[&] { device.work(); }};
    bus.emplace("slcan:" + device.name());
  }
  int late = 0;
  for (; bus->waiting() < 40; ++late) ASSERT_TRUE(bus->send(bench::frame("705 05")));  // the line is no longer read
  EXPECT_TRUE(bus->send(bench::frame("080")));
  for (; bus->waiting() < 64; ++late) ASSERT_TRUE(bus->send(bench::frame("705 05")));
  EXPECT_FALSE(bus->send(bench::frame("705 05"))) << "the queue is full";
  std::string line;
  const std::string_view heartbeat = "t705105\r";
  const std::size_t whole = static_cast<std::size_t>(late) * heartbeat.size() + std::string_view{"t0800\r"}.size();
  for (int i = 0; i < 100'000 && line.size() < whole; ++i) {
    line += read_some(device.line());
    (void)bus->receive(0us);
  }
  EXPECT_EQ(line.size(), whole);
  ASSERT_NE(line.find("t0800\r"), std::string::npos);
  EXPECT_GE(line.size() - line.find("t0800\r"), 63 * heartbeat.size()) << "it has overtaken those that waited";
}

TEST(SlcanPort, LeavesTheFramesOfAnEarlierPortOnTheLine) {
  Device device;
  const std::string_view heartbeat = "t705105\r";
  constexpr std::size_t frames = 700;  // more than the adapter's end holds: flushing the line discards the rest
  {
    std::optional<HostBus> bus;
    {
      const Worker worker{[&] { device.work(); }};
      bus.emplace("slcan:" + device.name());
    }
    for (std::size_t i = 0; i < frames; ++i) ASSERT_TRUE(bus->send(bench::frame("705 05")));
    ASSERT_EQ(bus->waiting(), 0u) << "all are on the line";
  }
  const HostBus next{"slcan:" + device.name()};
  std::string line;
  for (std::string part = read_some(device.line()); !part.empty(); part = read_some(device.line())) line += part;
  std::size_t found = 0;
  for (std::size_t at = line.find(heartbeat); at != line.npos; at = line.find(heartbeat, at + 1)) ++found;
  EXPECT_EQ(found, frames);
  EXPECT_TRUE(line.ends_with("\rC\rO\r")) << "and the next port opens the channel after them";
}

TEST(SlcanPort, HasAnEventWhenAFullLineHasRoomAgain) {
  Device device;
  std::optional<HostBus> bus;
  {
    const Worker worker{[&] { device.work(); }};
    bus.emplace("slcan:" + device.name());
  }
  while (bus->receive(10ms)) {
  }
  while (bus->waiting() < 10) ASSERT_TRUE(bus->send(bench::frame("705 05")));  // the line is no longer read
  pollfd event{bus->file_descriptor(), POLLIN, 0};
  EXPECT_EQ(::poll(&event, 1, 0), 0);
  while (!read_some(device.line()).empty()) {
  }
  EXPECT_EQ(::poll(&event, 1, 60'000), 1);
  EXPECT_EQ(text_of(bus->receive(0us)), "none");
  EXPECT_EQ(bus->waiting(), 0u);
}

TEST(SlcanPort, ThrowsWhenTheLineIsGone) {
  Device device;
  std::optional<HostBus> bus;
  {
    const Worker worker{[&] { device.work(); }};
    bus.emplace("slcan:" + device.name());
  }
  device.hang_up();
  EXPECT_THROW(
      {
        for (int i = 0; i < 10; ++i) (void)bus->receive(10ms);
      },
      std::system_error);
}

}  // namespace
