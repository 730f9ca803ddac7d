/// The bus server: its answers to clients, and how it separates them from each other.
#include "server/bus_server.hpp"

#include <gtest/gtest.h>
#include <netinet/in.h>
#include <sys/socket.h>
#include <unistd.h>

#include <algorithm>
#include <stdexcept>
#include <string>
#include <vector>

#include "server/candump_line.hpp"

namespace {

using namespace edsc;
using std::chrono::milliseconds;

/// A server in this thread, its log and its messages.
struct Bench {
  explicit Bench(BusLimits limits = {}, std::vector<std::string> buses = {"vcan0"})
      : server{{"127.0.0.1", 0},
               std::move(buses),
               limits,
               {[this](const canopen::Frame& frame, const std::string& bus, auto) {
                  log.push_back(candump_line(frame, bus, {}).substr(11));
                },
                [this](const std::string& message) { trouble.push_back(message); }}} {}

  /// Waits up to ten seconds until this many clients are connected.
  void expect_clients(std::size_t wanted) {
    for (int i = 0; i < 10'000 && server.clients() != wanted; ++i) server.poll_once(milliseconds{1});
    EXPECT_EQ(server.clients(), wanted);
  }

  std::vector<std::string> log;
  std::vector<std::string> trouble;
  BusServer server;
};

/// One connection; time stamps in what it receives are replaced by T.
class Client {
 public:
  explicit Client(Bench& bench, int receive_buffer = 0)
      : bench_{bench}, socket_{::socket(AF_INET, SOCK_STREAM | SOCK_CLOEXEC, 0)} {
    if (receive_buffer > 0) ::setsockopt(socket_, SOL_SOCKET, SO_RCVBUF, &receive_buffer, sizeof receive_buffer);
    sockaddr_in address{};
    address.sin_family = AF_INET;
    address.sin_port = htons(bench.server.address().port);
    address.sin_addr.s_addr = htonl(INADDR_LOOPBACK);
    if (::connect(socket_, reinterpret_cast<const sockaddr*>(&address), sizeof address) != 0)
      throw std::runtime_error{"connect"};
  }
  Client(const Client&) = delete;
  Client& operator=(const Client&) = delete;
  ~Client() { ::close(socket_); }

  void say(std::string_view text) const {
    EXPECT_EQ(::send(socket_, text.data(), text.size(), MSG_NOSIGNAL), static_cast<ssize_t>(text.size()));
  }

  /// Returns what it receives until that ends with `wanted`, for ten seconds at most.
  std::string hear_up_to(std::string_view wanted) {
    return hear_until([&](const std::string& heard) { return heard.ends_with(wanted); });
  }

  /// Returns what it receives until that has this many elements, for ten seconds at most.
  std::string hear_elements(std::ptrdiff_t wanted) {
    return hear_until([&](const std::string& heard) { return std::count(heard.begin(), heard.end(), '>') >= wanted; });
  }

  /// Returns what has been received after the server has processed all requests.
  std::string hear() {
    for (int i = 0; i < 5; ++i) bench_.server.poll_once(milliseconds{1});
    return take();
  }

  /// Returns true if the server has closed the connection.
  bool closed() {
    char byte = 0;
    static_cast<void>(hear_until([&](const std::string&) { return ::recv(socket_, &byte, 1, MSG_DONTWAIT) == 0; }));
    return ::recv(socket_, &byte, 1, MSG_DONTWAIT) == 0;
  }

  /// Returns what has been received, without running the server.
  std::string take() {
    std::string bytes(65536, '\0');
    const ssize_t size = ::recv(socket_, bytes.data(), bytes.size(), MSG_DONTWAIT);
    bytes.resize(size > 0 ? static_cast<std::size_t>(size) : 0);
    for (std::size_t point = bytes.find('.'); point != std::string::npos; point = bytes.find('.')) {
      const std::size_t start = bytes.rfind(' ', point) + 1;
      bytes.replace(start, bytes.find(' ', point) - start, "T");
    }
    return bytes;
  }

  void open_raw(const std::string& bus = "vcan0") {
    say("< open " + bus + " >< rawmode >");
    EXPECT_EQ(hear_up_to("< ok >< ok >"), "< hi >< ok >< ok >");
  }

 private:
  template <class Done>
  std::string hear_until(Done done) {
    std::string heard;
    const auto end = std::chrono::steady_clock::now() + milliseconds{10'000};
    while (!done(heard) && std::chrono::steady_clock::now() < end) {
      bench_.server.poll_once(milliseconds{1});
      heard += take();
    }
    return heard;
  }

  Bench& bench_;
  int socket_;
};

TEST(BusServer, GreetsOpensAndSwitchesToTheRawMode) {
  Bench bench;
  Client client{bench};
  EXPECT_EQ(client.hear_up_to("< hi >"), "< hi >");
  client.say("< open vcan0 >");
  EXPECT_EQ(client.hear_up_to("< ok >"), "< ok >");
  client.say("< rawmode >");
  EXPECT_EQ(client.hear_up_to("< ok >"), "< ok >");
  client.say("< echo >");
  EXPECT_EQ(client.hear_up_to("< echo >"), "< echo >");
}

TEST(BusServer, HandsAFrameToAllClientsOfTheBusButTheSender) {
  Bench bench{{}, {"vcan0", "vcan1"}};
  Client sender{bench}, first{bench}, second{bench}, elsewhere{bench};
  sender.open_raw();
  first.open_raw();
  second.open_raw();
  elsewhere.open_raw("vcan1");
  sender.say("< send 605 8 40 0 10 0 0 0 0 0 >");
  EXPECT_EQ(first.hear_up_to(" >"), "< frame 605 T 4000100000000000 >");
  EXPECT_EQ(second.hear_up_to(" >"), "< frame 605 T 4000100000000000 >");
  EXPECT_EQ(sender.hear(), "");
  EXPECT_EQ(elsewhere.hear(), "");
  elsewhere.say("< send 80 0 >< echo >");
  EXPECT_EQ(elsewhere.hear_up_to("< echo >"), "< echo >");
  EXPECT_EQ(first.hear(), "");
  EXPECT_EQ(bench.log, (std::vector<std::string>{"vcan0 605#4000100000000000", "vcan1 080#"}));
}

TEST(BusServer, CarriesExtendedAndRemoteFrames) {
  Bench bench;
  Client sender{bench}, other{bench};
  sender.open_raw();
  other.open_raw();
  sender.say("< send 00000123 1 FF >< sendrtr 705 1 >< sendrtr 705 0 >< send 80 0 >");
  EXPECT_EQ(other.hear_up_to("T  >"), "< frame 00000123 T FF >< rtr 705 T 1 >< rtr 705 T 0 >< frame 080 T  >");
  EXPECT_EQ(bench.log, (std::vector<std::string>{"vcan0 00000123#FF", "vcan0 705#R1", "vcan0 705#R", "vcan0 080#"}));
}

TEST(BusServer, DeliversNothingBeforeTheRawModeAndAfterIt) {
  Bench bench;
  Client sender{bench}, other{bench};
  sender.open_raw();
  other.say("< open vcan0 >");
  EXPECT_EQ(other.hear_up_to("< ok >"), "< hi >< ok >");
  sender.say("< send 1 0 >");
  EXPECT_EQ(other.hear(), "");
  other.say("< send 2 0 >");
  EXPECT_EQ(sender.hear_up_to(" >"), "< frame 002 T  >") << "sending needs no raw mode";
  other.say("< rawmode >< bcmmode >");
  EXPECT_EQ(other.hear_up_to("< ok >< ok >"), "< ok >< ok >");
  sender.say("< send 1 0 >");
  EXPECT_EQ(other.hear(), "");
}

TEST(BusServer, GivesAllClientsTheFramesInOneOrder) {
  Bench bench;
  constexpr int frames = 200;
  constexpr std::string_view element = "< frame 101 T 00 >", first_of_second = "< frame 102";
  Client first{bench}, second{bench}, third{bench}, fourth{bench};
  for (Client* client : {&first, &second, &third, &fourth}) client->open_raw();
  for (int i = 0; i < frames; ++i) {
    first.say("< send 101 1 " + std::to_string(i % 100) + " >");
    second.say("< send 102 1 " + std::to_string(i % 100) + " >");
    if (i % 10 == 0) bench.server.poll_once(milliseconds{0});
  }
  const std::string heard = third.hear_elements(2 * frames);
  EXPECT_TRUE(heard == fourth.hear_elements(2 * frames));
  EXPECT_EQ(bench.log.size(), 2u * frames);
  std::string of_first;
  for (std::size_t start = 0; start < heard.size(); start += element.size()) {
    if (heard.compare(start, first_of_second.size(), first_of_second) != 0)
      of_first += heard.substr(start, element.size());
  }
  EXPECT_TRUE(of_first == second.hear_elements(frames)) << "the second hears those of the first alone";
}

TEST(BusServer, CarriesMoreThanASocketHoldsWithoutLoss) {
  Bench bench;
  Client sender{bench}, other{bench, 4096};
  sender.open_raw();
  other.open_raw();
  std::string many;
  for (int i = 0; i < 1000; ++i) many += "< send 1FFFFFFF 8 0 0 0 0 0 0 0 0 >";
  constexpr int rounds = 20;
  std::size_t heard = 0;
  for (int i = 0; i < rounds; ++i) {
    for (std::string_view rest = many; !rest.empty();) {
      const std::string_view piece = rest.substr(0, 2000);
      sender.say(piece);
      rest.remove_prefix(piece.size());
      bench.server.poll_once(milliseconds{0});
      const std::string got = other.take();
      heard += static_cast<std::size_t>(std::count(got.begin(), got.end(), '>'));
    }
  }
  for (int i = 0; i < 10'000 && heard < 1000u * rounds; ++i) {
    bench.server.poll_once(milliseconds{1});
    const std::string got = other.take();
    heard += static_cast<std::size_t>(std::count(got.begin(), got.end(), '>'));
  }
  EXPECT_EQ(heard, 1000u * rounds);
  EXPECT_TRUE(bench.trouble.empty());
}

/// The server serves all other clients while one of them does not read, however long that one has been connected.
TEST(BusServer, SendsAClientAwayThatReadsTooSlowly) {
  Bench bench{{64, 100'000, std::chrono::hours{1}}};
  Client sender{bench}, deaf{bench, 4096}, other{bench};
  for (Client* client : {&sender, &deaf, &other}) client->open_raw();
  const auto end = std::chrono::steady_clock::now() + milliseconds{20'000};
  std::string many;
  for (int i = 0; i < 100; ++i) many += "< send 1FFFFFFF 8 0 0 0 0 0 0 0 0 >";
  std::size_t sent = 0, heard = 0;
  while (bench.trouble.empty() && std::chrono::steady_clock::now() < end) {
    if (bench.log.size() >= sent) {
      sender.say(many);
      sent += 100;
    }
    bench.server.poll_once(milliseconds{1});
    const std::string got = other.take();
    heard += static_cast<std::size_t>(std::count(got.begin(), got.end(), '>'));
  }
  ASSERT_EQ(bench.trouble.size(), 1u);
  EXPECT_NE(bench.trouble[0].find("is disconnected: it reads too slowly: "), std::string::npos) << bench.trouble[0];
  EXPECT_TRUE(bench.trouble[0].ends_with(" bytes are pending")) << bench.trouble[0];
  EXPECT_EQ(bench.server.clients(), 2u);
  for (int i = 0; i < 10'000 && heard < sent; ++i) {
    bench.server.poll_once(milliseconds{1});
    const std::string got = other.take();
    heard += static_cast<std::size_t>(std::count(got.begin(), got.end(), '>'));
  }
  EXPECT_EQ(heard, sent) << "the other one has lost nothing";
}

TEST(BusServer, AnswersNonsenseWithAnErrorAndGoesOn) {
  Bench bench;
  Client client{bench};
  EXPECT_EQ(client.hear_up_to("< hi >"), "< hi >");
  const std::vector<std::pair<std::string, std::string>> dialogue{
      {"< rawmode >", "< error no bus is open >"},
      {"< send 1 0 >", "< error no bus is open >"},
      {"<>", "< error unknown command >"},
      {"< subscribe 0 0 123 >", "< error unknown command >"},
      {"< open vcan0 vcan1 >", "< error syntax error in open command >"},
      {std::string("\0\xFF\r\n>>", 6) + "< open vcan0 >", "< ok >"},
      {"< open vcan0 >", "< error a bus is already open >"},
      {"< send 1 9 >", "< error syntax error in send command >"},
      {"< send zzz 0 >", "< error syntax error in send command >"},
      {"< echo >", "< echo >"},
  };
  for (const auto& [said, answer] : dialogue) {
    client.say(said);
    EXPECT_EQ(client.hear_up_to(answer), answer) << said;
  }
  EXPECT_TRUE(bench.log.empty());
}

TEST(BusServer, SendsAClientAwayThatOpensWhatIsNotThere) {
  Bench bench;
  Client client{bench};
  client.say("< open can7 >");
  EXPECT_EQ(client.hear_up_to("bus >"), "< hi >< error could not open bus >");
  EXPECT_TRUE(client.closed());
  ASSERT_EQ(bench.trouble.size(), 1u);
  EXPECT_TRUE(bench.trouble[0].ends_with("is disconnected: bus \"can7\" does not exist")) << bench.trouble[0];
}

TEST(BusServer, SendsAClientAwayWhoseElementHasNoEnd) {
  Bench bench;
  Client client{bench}, other{bench};
  other.open_raw();
  client.say("< open " + std::string(socketcand::longest_element, 'x'));
  EXPECT_EQ(client.hear_up_to("long >"), "< hi >< error element too long >");
  EXPECT_TRUE(client.closed());
  EXPECT_EQ(bench.trouble.size(), 1u);
  bench.expect_clients(1);
}

TEST(BusServer, SendsAwayWhomItHasNoRoomFor) {
  Bench bench{{2}};
  {
    Client first{bench}, second{bench}, third{bench};
    EXPECT_EQ(first.hear_up_to("< hi >"), "< hi >");
    EXPECT_EQ(second.hear_up_to("< hi >"), "< hi >");
    EXPECT_EQ(third.hear_up_to(" >"), "< error too many clients >");
    EXPECT_TRUE(third.closed());
    EXPECT_EQ(bench.trouble.size(), 1u);
  }
  bench.expect_clients(0);
  Client again{bench};
  EXPECT_EQ(again.hear_up_to("< hi >"), "< hi >");
}

TEST(BusServer, SendsSilentClientsAwayAndGivesTheirPlacesToOthers) {
  Bench bench{{64, 4096, milliseconds{1000}}};
  std::vector<std::unique_ptr<Client>> silent;
  for (int i = 0; i < 64; ++i) silent.push_back(std::make_unique<Client>(bench));
  for (int i = 0; i < 10'000 && bench.trouble.size() < silent.size(); ++i) bench.server.poll_once(milliseconds{1});
  ASSERT_EQ(bench.trouble.size(), 64u);
  EXPECT_EQ(bench.server.clients(), 0u);
  EXPECT_TRUE(bench.trouble[0].ends_with("is disconnected: it did not open a bus within 1000 ms")) << bench.trouble[0];
  EXPECT_EQ(silent[0]->hear_up_to("time >"), "< hi >< error no bus was opened in time >");
  EXPECT_TRUE(silent[0]->closed());
  Client other{bench};
  other.open_raw();
}

TEST(BusServer, KeepsClientsThatHaveOpenedABus) {
  Bench bench{{64, 4096, milliseconds{1000}}};
  Client listener{bench}, silent{bench};
  listener.say("< open vcan0 >");
  bench.expect_clients(2);
  bench.expect_clients(1);
  ASSERT_EQ(bench.trouble.size(), 1u);
  listener.say("< echo >");
  EXPECT_EQ(listener.hear_up_to("< echo >"), "< hi >< ok >< echo >");
}

TEST(BusServer, OutlivesClientsThatBreakOff) {
  Bench bench;
  Client stays{bench};
  stays.open_raw();
  for (int i = 0; i < 20; ++i) {
    Client leaves{bench};
    leaves.open_raw();
    leaves.say("< send 2 0 >< send 3");
    EXPECT_EQ(stays.hear_up_to(" >"), "< frame 002 T  >");
  }
  stays.say("< send 1 0 >< echo >");
  EXPECT_EQ(stays.hear_up_to("< echo >"), "< echo >");
  bench.expect_clients(1);
  EXPECT_EQ(bench.log.size(), 21u);
  EXPECT_TRUE(bench.trouble.empty());
}

TEST(BusServer, ServesManyClients) {
  Bench bench;
  std::vector<std::unique_ptr<Client>> clients;
  for (int i = 0; i < 64; ++i) {
    clients.push_back(std::make_unique<Client>(bench));
    clients.back()->open_raw();
  }
  for (const auto& client : clients) client->say("< send 1 1 7 >");
  std::string each;
  for (int i = 0; i < 63; ++i) each += "< frame 001 T 07 >";
  for (const auto& client : clients) EXPECT_EQ(client->hear_elements(63), each);
}

TEST(BusServer, ReportsAnAddressThatIsTaken) {
  Bench bench;
  const BusEvents none{[](const auto&, const auto&, auto) {}, [](const auto&) {}};
  EXPECT_THROW((BusServer{bench.server.address(), {"vcan0"}, {}, none}), std::system_error);
}

TEST(ListenAddress, IsHostAndPort) {
  EXPECT_EQ(to_text(parse_listen_address("127.0.0.1:29536")), "127.0.0.1:29536");
  EXPECT_EQ(to_text(parse_listen_address("localhost:0")), "localhost:0");
  EXPECT_EQ(to_text(parse_listen_address("[::1]:80")), "[::1]:80");
  for (const char* wrong : {"", "127.0.0.1", ":80", "127.0.0.1:", "127.0.0.1:65536", "127.0.0.1:x", "127.0.0.1:-1"})
    EXPECT_THROW(static_cast<void>(parse_listen_address(wrong)), std::invalid_argument) << wrong;
}

TEST(CandumpLine, IsThatOfTheTool) {
  canopen::Frame frame{0x123, 2, false, false, {0x11, 0xAB}};
  EXPECT_EQ(candump_line(frame, "vcan0", {1'700'000'000, 42}), "(1700000000.000042) vcan0 123#11AB");
  frame.extended = true;
  EXPECT_EQ(candump_line(frame, "can1", {}), "(0.000000) can1 00000123#11AB");
  frame.remote = true;
  EXPECT_EQ(candump_line(frame, "can1", {}), "(0.000000) can1 00000123#R2");
}

}  // namespace
