/// Buses over a pseudo-terminal and over TCP, as a host uses them: HostBus on one side; on the other side an SLCAN
/// adapter with a node, or a small socketcand server.
#include <arpa/inet.h>
#include <fcntl.h>
#include <gtest/gtest.h>
#include <poll.h>
#include <sys/socket.h>
#include <termios.h>
#include <unistd.h>
#include <canopen/host/blocking_sdo.hpp>
#include <canopen/host/host_bus.hpp>
#include <canopen/port/slcan_adapter.hpp>

#include <atomic>
#include <cstdlib>
#include <optional>
#include <sample/device.hpp>
#include <string>
#include <thread>
#include <utility>

#include "support/bench.hpp"

namespace {

using canopen::Descriptor;
using canopen::Frame;
using canopen::HostBus;
using namespace std::chrono_literals;

std::string text_of(const std::optional<Frame>& frame) { return frame ? bench::text(*frame) : "none"; }

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

/// What can be read within 2 ms.
std::string read_some(int descriptor) {
  pollfd waiting{descriptor, POLLIN, 0};
  char bytes[256];
  if (::poll(&waiting, 1, 2) <= 0) return "";
  const ssize_t count = ::read(descriptor, bytes, sizeof bytes);
  return count > 0 ? std::string(bytes, static_cast<std::size_t>(count)) : "";
}

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
  canopen::Node<sample::Device, NodeBus> node_{bus_, canopen::NodeId{5}};
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
    EXPECT_TRUE(node.write<sample::od::producer_heartbeat_time>(std::uint16_t{20}));
    const auto time = node.read<sample::od::producer_heartbeat_time>();
    ASSERT_TRUE(time);
    EXPECT_EQ(*time, 20);
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

/// A server that sends given text and records what it receives.
class Server {
 public:
  Server() : listener_{canopen::opened(::socket(AF_INET, SOCK_STREAM, 0), "socket")} {
    sockaddr_in address{};
    address.sin_family = AF_INET;
    address.sin_addr.s_addr = htonl(INADDR_LOOPBACK);
    socklen_t size = sizeof address;
    if (::bind(listener_.number(), reinterpret_cast<sockaddr*>(&address), size) != 0 ||
        ::listen(listener_.number(), 1) != 0 ||
        ::getsockname(listener_.number(), reinterpret_cast<sockaddr*>(&address), &size) != 0) {
      canopen::throw_errno("server");
    }
    port_ = ntohs(address.sin_port);
  }

  [[nodiscard]] std::string address(const std::string& bus) const {
    return "socketcand:127.0.0.1:" + std::to_string(port_) + "/" + bus;
  }

  void accept() { client_ = canopen::opened(::accept(listener_.number(), nullptr, nullptr), "accept"); }
  void say(std::string_view text) const {
    EXPECT_EQ(::send(client_.number(), text.data(), text.size(), MSG_NOSIGNAL), static_cast<ssize_t>(text.size()));
  }
  /// Sends as much of it as the connection accepts, if it is still open.
  void try_to_say(std::string_view text) const {
    pollfd room{client_.number(), POLLOUT, 0};
    if (::poll(&room, 1, 10) == 1)
      (void)::send(client_.number(), text.data(), text.size(), MSG_NOSIGNAL | MSG_DONTWAIT);
  }
  /// Returns whether exactly these characters are received.
  [[nodiscard]] bool hears(std::string_view wanted) {
    for (int i = 0; i < 300'000 && heard_.size() < wanted.size(); ++i) heard_ += read_some(client_.number());
    const bool right = heard_ == wanted;
    heard_.clear();
    return right;
  }
  void greet() {
    accept();
    say("< hi >");
    EXPECT_TRUE(hears("< open vcan0 >"));
    say("< o");
    say("k >");
    EXPECT_TRUE(hears("< rawmode >"));
    say("< ok >");
  }
  void hang_up() { client_ = Descriptor{}; }

 private:
  Descriptor listener_;
  Descriptor client_;
  std::uint16_t port_ = 0;
  std::string heard_;
};

TEST(SocketcandPort, SendsAndReceivesFrames) {
  Server server;
  std::thread greeting{[&] { server.greet(); }};
  HostBus bus{server.address("vcan0")};
  greeting.join();
  EXPECT_TRUE(bus.send(bench::frame("605 40 00 10 00 00 00 00 00")));
  EXPECT_TRUE(bus.send(bench::frame("12345678 R 2")));
  EXPECT_TRUE(server.hears("< send 605 8 40 00 10 00 00 00 00 00 >< sendrtr 12345678 2 >"));
  server.say("< frame 585 1.000001 43001000910");
  EXPECT_EQ(text_of(bus.receive(10ms)), "none") << "half of it";
  server.say("10F00 >< frame 705 1.5 05 >");
  EXPECT_EQ(text_of(bus.receive(60s)), "585 43 00 10 00 91 01 0F 00");
  EXPECT_EQ(text_of(bus.receive(60s)), "705 05");
}

TEST(SocketcandPort, HasFramesThatComeWithTheEndOfTheHandshake) {
  Server server;
  std::thread greeting{[&] {
    server.accept();
    server.say("< hi >");
    EXPECT_TRUE(server.hears("< open vcan0 >"));
    server.say("< ok >");
    EXPECT_TRUE(server.hears("< rawmode >"));
    server.say("< ok >< frame 585 1.5 4300 >< frame 705 1.5 05 >");
  }};
  HostBus bus{server.address("vcan0")};
  greeting.join();
  pollfd waiting{bus.file_descriptor(), POLLIN, 0};
  EXPECT_EQ(::poll(&waiting, 1, 10'000), 1) << "a poll loop of the application learns of them";
  EXPECT_EQ(text_of(bus.receive(0us)), "585 43 00");
  EXPECT_EQ(text_of(bus.receive(0us)), "705 05");
}

/// Sends elements that are not frames until it is destroyed, for half a minute at most; a test has failed by then.
class Flood {
 public:
  explicit Flood(const Server& server)
      : thread_{[this, &server] {
          const auto end = std::chrono::steady_clock::now() + 30s;
          while (!stop_ && !over_) {
            server.try_to_say(elements_);
            over_ = std::chrono::steady_clock::now() > end;
          }
        }} {}
  ~Flood() {
    stop_ = true;
    thread_.join();
  }

  [[nodiscard]] bool is_over() const { return over_; }

 private:
  static std::string many(std::string_view element) {
    std::string text;
    for (int i = 0; i < 1000; ++i) text += element;
    return text;
  }

  std::string elements_ = many("< echo >");
  std::atomic<bool> stop_{false};
  std::atomic<bool> over_{false};
  std::thread thread_;
};

TEST(SocketcandPort, LetsTimePassWhileBytesComeButNoFrame) {
  Server server;
  std::thread greeting{[&] { server.greet(); }};
  HostBus bus{server.address("vcan0")};
  greeting.join();
  const Flood flood{server};
  EXPECT_EQ(text_of(bus.receive(50ms)), "none");
  EXPECT_FALSE(flood.is_over()) << "it has returned when nothing came any more";
}

TEST(SocketcandPort, GivesUpAServerThatSaysMuchAndNeverOpensTheBus) {
  Server server;
  std::optional<Flood> flood;
  std::thread noise{[&] {
    server.accept();
    flood.emplace(server);
  }};
  try {
    const HostBus bus{server.address("vcan0")};
    FAIL() << "opened";
  } catch (const std::system_error& problem) {
    EXPECT_EQ(problem.code(), std::errc::timed_out);
  }
  noise.join();
  EXPECT_FALSE(flood->is_over());
}

TEST(SocketcandPort, DiscardsWaitingFramesWhenTheBusIsOff) {
  Server server;
  std::thread greeting{[&] { server.greet(); }};
  HostBus bus{server.address("vcan0")};
  greeting.join();
  while (bus.waiting() < 10) ASSERT_TRUE(bus.send(bench::frame("705 05")));  // the server does not read
  server.say("< error 040 1.5 >");
  EXPECT_EQ(text_of(bus.receive(100ms)), "none");
  EXPECT_EQ(bus.waiting(), 0u);
  EXPECT_FALSE(bus.send(bench::frame("705 05")));
}

TEST(SocketcandPort, TellsOfALostServer) {
  Server server;
  std::thread greeting{[&] { server.greet(); }};
  HostBus bus{server.address("vcan0")};
  greeting.join();
  server.hang_up();
  EXPECT_THROW((void)bus.receive(60s), std::system_error);
}

TEST(SocketcandPort, TellsOfARefusal) {
  Server server;
  std::thread refusal{[&] {
    server.accept();
    server.say("< hi >< error could not open bus >");
  }};
  EXPECT_THROW(HostBus{server.address("vcan9")}, std::system_error);
  refusal.join();
  EXPECT_THROW(HostBus{"socketcand:127.0.0.1:1/vcan0"}, std::system_error) << "no server";
  EXPECT_THROW(HostBus{"socketcand:127.0.0.1/vcan0"}, std::invalid_argument) << "no port";
}

}  // namespace
