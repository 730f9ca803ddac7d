/// The client of socketcand, message by message.
#include <gtest/gtest.h>
#include <canopen/host/socketcand_codec.hpp>

#include <string>

#include "support/bench.hpp"

namespace {

using canopen::SocketcandClient;
using canopen::TimePoint;

std::string message_of(const std::string& frame) {
  std::array<char, canopen::socketcand::longest_message> message;
  const std::size_t size = canopen::socketcand::encode(bench::frame(frame), message);
  return {message.data(), size};
}

struct Client {
  SocketcandClient client;

  Client() { client.start("vcan0", TimePoint{}); }

  /// Returns the frames in these characters.
  std::string hear(std::string_view text) {
    std::string frames;
    for (const char character : text) {
      if (const auto frame = client.on_character(character, TimePoint{})) frames += bench::text(*frame) + ";";
    }
    return frames;
  }
  std::string written() {
    const std::string text{client.output()};
    client.output_taken();
    return text;
  }
  void open() {
    (void)hear("< hi >< ok >< ok >");
    client.output_taken();
  }
};

TEST(Socketcand, AsksTheServerToSendFrames) {
  EXPECT_EQ(message_of("123 11 22"), "< send 123 2 11 22 >");
  EXPECT_EQ(message_of("080"), "< send 080 0 >");
  EXPECT_EQ(message_of("1FFFFFFF 00 11 22 33 44 55 66 77"), "< send 1FFFFFFF 8 00 11 22 33 44 55 66 77 >");
  EXPECT_EQ(message_of("00000001 F1"), "< send 00000001 1 F1 >") << "eight digits: 29 bits";
  EXPECT_EQ(message_of("705 R 1"), "< sendrtr 705 1 >");
}

TEST(Socketcand, OpensABusInRawMode) {
  Client client;
  EXPECT_EQ(client.written(), "");
  (void)client.hear("< hi >");
  EXPECT_EQ(client.written(), "< open vcan0 >");
  (void)client.hear("< o");
  EXPECT_EQ(client.written(), "");
  (void)client.hear("k >");
  EXPECT_EQ(client.written(), "< rawmode >");
  EXPECT_EQ(client.client.state(), SocketcandClient::State::connecting);
  (void)client.hear("< ok >");
  EXPECT_EQ(client.client.state(), SocketcandClient::State::open);
}

TEST(Socketcand, TellsWhyABusIsRefused) {
  Client client;
  (void)client.hear("< hi >< error could not open bus >");
  EXPECT_EQ(client.client.state(), SocketcandClient::State::refused);
  EXPECT_EQ(client.client.problem(), " could not open bus ");
}

TEST(Socketcand, ReadsFrames) {
  Client client;
  client.open();
  EXPECT_EQ(client.hear("< frame 123 23.424242 11223344 >"), "123 11 22 33 44;");
  EXPECT_EQ(client.hear("< frame 123 23.424242 11 22 33 44 >"), "123 11 22 33 44;");
  EXPECT_EQ(client.hear("< frame 080 23.424242  >< frame 081 23.424242 >"), "080;081;");
  EXPECT_EQ(client.hear("< frame 00000123 23.424242 AB >"), "00000123 AB;");
  EXPECT_EQ(client.hear("< rtr 705 23.424242 1 >"), "705 R 1;");
}

TEST(Socketcand, SurvivesBrokenMessages) {
  Client client;
  client.open();
  EXPECT_EQ(client.hear("ok >< frame 12< frame 123 1.5 AA >"), "123 AA;") << "cut short";
  EXPECT_EQ(client.hear("< frame " + std::string(10'000, '1') + " >< frame 124 1.5 BB >"), "124 BB;") << "too long";
  for (const char* message : {"< frame >", "< frame 123 >", "< frame 123 AA >", "< frame 123 1.5 112233445566778899 >",
                              "< frame 123 1.5 GG >", "< frame FFFFFFFF 1.5 00 >", "< frame 123456789 1.5 00 >",
                              "< rtr 123 1.5 9 >", "< fdframe 123 00 1.5 11 >", "< >", "<>", ">"}) {
    EXPECT_EQ(client.hear(message), "") << message;
  }
  EXPECT_EQ(client.hear("< frame 125 1.5 CC >"), "125 CC;");
}

TEST(Socketcand, TakesErrorFramesForTheStateOfTheBus) {
  Client client;
  client.open();
  (void)client.hear("< error 040 1.5 >");
  EXPECT_EQ(client.client.status().state, canopen::BusState::off);
  (void)client.hear("< error 100 1.5 >");
  EXPECT_EQ(client.client.status().state, canopen::BusState::active);
  (void)client.hear("< error unknown command >");
  EXPECT_EQ(client.client.state(), SocketcandClient::State::open) << "a server without remote frames";
}

}  // namespace
