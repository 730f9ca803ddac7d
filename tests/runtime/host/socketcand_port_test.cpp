/// A bus over TCP: HostBus on one side, a small socketcand server on the other.
#include <arpa/inet.h>
#include <gtest/gtest.h>
#include <poll.h>
#include <sys/socket.h>
#include <unistd.h>

#include <atomic>
#include <canopen/host/host_bus.hpp>
#include <optional>
#include <sample/device.hpp>
#include <string>
#include <thread>
#include <vector>

#include "runtime/host/stream_bench.hpp"
#include "support/omitting.hpp"

namespace {

using bench::read_some;
using bench::text_of;
using canopen::Descriptor;
using canopen::Frame;
using canopen::HostBus;
using namespace std::chrono_literals;

/// A server that sends given text and records what it receives.
class Server {
 public:
  Server() : Server{Started::now} {}
  /// Has a port, at which connections are refused until `listen`.
  [[nodiscard]] static Server started_later() { return Server{Started::later}; }

  void listen() const {
    if (::listen(listener_.number(), 1) != 0) canopen::throw_errno("listen");
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
  enum class Started { now, later };

  explicit Server(Started started) : listener_{canopen::opened(::socket(AF_INET, SOCK_STREAM, 0), "socket")} {
    sockaddr_in address{};
    address.sin_family = AF_INET;
    address.sin_addr.s_addr = htonl(INADDR_LOOPBACK);
    socklen_t size = sizeof address;
    if (::bind(listener_.number(), reinterpret_cast<sockaddr*>(&address), size) != 0 ||
        ::getsockname(listener_.number(), reinterpret_cast<sockaddr*>(&address), &size) != 0) {
      canopen::throw_errno("server");
    }
    port_ = ntohs(address.sin_port);
    if (started == Started::now) listen();
  }

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

/// The start of a node and the times of a periodic function, until it has been called five times.
struct Application {
  void start(auto& node) {
    ++starts;
    started = node.now();
  }
  void every(canopen::Milliseconds<10>, auto& node) {
    calls.push_back(node.now() - started);
    if (calls.size() == 5) *stop = true;
  }
  std::atomic<bool>* stop;
  int starts = 0;
  canopen::TimePoint started{};
  std::vector<canopen::Duration> calls{};
};

void check(const Application& application) {
  EXPECT_EQ(application.starts, 1);
  ASSERT_EQ(application.calls.size(), 5u);
  canopen::Duration period{0};
  for (const canopen::Duration call : application.calls) {
    EXPECT_GE(call, period + 10ms) << "a busy computer may delay calls and leave some out";
    period += 10ms;
  }
}

TEST(SocketcandPort, CallsStartAndPeriodicFunctions) {
  std::atomic<bool> stop = false;
  Server server;
  std::thread greeting{[&] { server.greet(); }};
  HostBus bus{server.address("vcan0")};
  greeting.join();
  bench::NodeOf<sample::Device, HostBus, Application> node{bus, canopen::NodeId{5}, Application{&stop}};
  bus.run(node, stop);
  check(node.application<Application>());

  Application lambdas{&stop};
  stop = false;
  auto other = bench::make_node<sample::Device>(bus, canopen::NodeId{6},
                                                canopen::on_start([&](auto& starting) { lambdas.start(starting); }),
                                                canopen::every<canopen::Milliseconds<10>>([&](auto& running) {
                                                  lambdas.every(canopen::Milliseconds<10>{}, running);
                                                }));
  bus.run(other, stop);
  check(lambdas);
}

TEST(SocketcandPort, WaitsForAServerThatIsStartedTogetherWithIt) {
  Server server = Server::started_later();
  std::thread greeting{[&] {
    std::this_thread::sleep_for(100ms);
    server.listen();
    server.greet();
  }};
  HostBus bus{server.address("vcan0")};
  greeting.join();
  EXPECT_TRUE(bus.send(bench::frame("605")));
  EXPECT_TRUE(server.hears("< send 605 0 >"));
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
