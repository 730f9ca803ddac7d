/// The server's text of the socketcand protocol: elements, and the frames in them; compatible with the client's codec.
#include "server/socketcand_text.hpp"

#include <gtest/gtest.h>

#include <array>
#include <string>
#include <vector>

#include "canopen/host/socketcand_codec.hpp"

namespace {

using canopen::Frame;
using namespace edsc::socketcand;

/// The elements that a reader finds in a stream; "!" is an element that is too long.
std::vector<std::string> elements(std::string_view stream) {
  ElementReader reader;
  std::vector<std::string> found;
  for (const char c : stream) {
    switch (reader.take(c)) {
      case ElementReader::Found::nothing: break;
      case ElementReader::Found::element: found.emplace_back(reader.element()); break;
      case ElementReader::Found::too_long: found.emplace_back("!"); break;
    }
  }
  return found;
}

Frame data_frame(std::uint32_t id, bool extended, std::vector<std::uint8_t> data) {
  Frame frame;
  frame.id = id;
  frame.extended = extended;
  frame.size = static_cast<std::uint8_t>(data.size());
  std::copy(data.begin(), data.end(), frame.data.begin());
  return frame;
}

Frame remote_frame(std::uint32_t id, bool extended, std::uint8_t size) {
  Frame frame;
  frame.id = id;
  frame.extended = extended;
  frame.remote = true;
  frame.size = size;
  return frame;
}

const std::vector<Frame> all_kinds{
    data_frame(0x000, false, {0x01, 0x05}),
    data_frame(0x7FF, false, {}),
    data_frame(0x605, false, {0x40, 0x00, 0x10, 0x00, 0x00, 0x00, 0x0A, 0xFF}),
    data_frame(0x123, true, {0xAB}),
    data_frame(0x1FFF'FFFF, true, {0, 1, 2, 3, 4, 5, 6, 7}),
    remote_frame(0x705, false, 1),
    remote_frame(0x185, false, 8),
    remote_frame(0x185, true, 0),
};

TEST(SocketcandElements, StandBetweenAnglesWhateverIsAround) {
  EXPECT_EQ(elements("< hi >< ok >\n\r\tjunk > <open vcan0>"),
            (std::vector<std::string>{" hi ", " ok ", "open vcan0"}));
  EXPECT_EQ(elements("< send 1 < echo >"), (std::vector<std::string>{" echo "})) << "the first has no end";
  EXPECT_EQ(elements("<>"), (std::vector<std::string>{""}));
}

TEST(SocketcandElements, OfTooManyBytesAreReportedAndPassedOver) {
  const std::string longest(longest_element, 'x');
  EXPECT_EQ(elements("<" + longest + ">< ok >"), (std::vector<std::string>{longest, " ok "}));
  EXPECT_EQ(elements("<" + longest + "xxx>< ok >"), (std::vector<std::string>{"!", " ok "}));
}

TEST(SocketcandFrames, AreReceivedAsTheProtocolSpellsThem) {
  EXPECT_EQ(received_text(data_frame(0x123, false, {0x11, 0xF2}), {23, 424242}), "< frame 123 23.424242 11F2 >");
  EXPECT_EQ(received_text(data_frame(0x7F, false, {}), {1, 5}), "< frame 07F 1.000005  >")
      << "both blanks: clients look for the data behind the second one";
  EXPECT_EQ(received_text(data_frame(0x1FFF'FFFF, true, {0, 1, 2, 3, 4, 5, 6, 7}), {9'999'999'999, 999'999}),
            "< frame 1FFFFFFF 9999999999.999999 0001020304050607 >");
  EXPECT_EQ(received_text(remote_frame(0x123, false, 4), {23, 424242}), "< rtr 123 23.424242 4 >");
}

/// The frame that the client's codec reads.
std::optional<Frame> client_reads(std::string_view element) {
  const std::string_view kind = canopen::socketcand::take_word(element);
  return kind == "frame" || kind == "rtr" ? canopen::socketcand::decode(element, kind == "rtr") : std::nullopt;
}

TEST(SocketcandFrames, AreThoseOfTheClientsCodecBothWays) {
  for (const Frame& frame : all_kinds) {
    std::array<char, canopen::socketcand::longest_message> sent{};
    const std::string_view text{sent.data(), canopen::socketcand::encode(frame, sent)};
    EXPECT_EQ(parse_send(elements(text).at(0)), frame) << text;
    const auto received = received_text(frame, {1'700'000'000, 1});
    EXPECT_EQ(client_reads(elements(received).at(0)), frame) << received;
  }
}

TEST(SocketcandFrames, AreReadHoweverClientsSpellThem) {
  EXPECT_EQ(parse_send("send 5 1 a"), data_frame(5, false, {0x0A})) << "without leading zeros, small letters";
  EXPECT_EQ(parse_send("  send  0123  0  "), data_frame(0x123, false, {}));
  EXPECT_EQ(parse_send("send 00000005 0"), data_frame(5, true, {})) << "eight digits are 29 bits";
  EXPECT_EQ(parse_send("send 18000 0"), data_frame(0x18000, true, {})) << "so is what 11 bits do not hold";
}

TEST(SocketcandFrames, ThatAreNoneAreRefused) {
  for (const std::string_view wrong : {"",
                                       "send",
                                       "send 123",
                                       "send 123 9 1 2 3 4 5 6 7 8 9",
                                       "send 123 2 11",
                                       "send 123 1 11 22",
                                       "send 123 1 111",
                                       "send 123 1 x",
                                       "send 20000000 0",
                                       "send 000000123 0",
                                       "send -1 0",
                                       "send 0x12 0",
                                       "send 123 -1",
                                       "send 123 1 ",
                                       "frame 123 1.0 11",
                                       "sendrtr 123",
                                       "sendrtr 123 9",
                                       "sendrtr 123 1 11",
                                       "SEND 123 0",
                                       "sendx 123 0"}) {
    EXPECT_EQ(parse_send(wrong), std::nullopt) << wrong;
  }
}

}  // namespace
