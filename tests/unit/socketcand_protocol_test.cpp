/// The text of the socketcand protocol: elements, and the frames in them.
#include "canopen/port/socketcand_protocol.hpp"

#include <gtest/gtest.h>

#include <string>
#include <vector>

namespace {

using canopen::Frame;
using namespace canopen::socketcand;

/// What a reader finds in a stream; "!" stands for an element that is too long.
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

TEST(SocketcandFrames, AreSentAsTheProtocolSpellsThem) {
  EXPECT_EQ(send_text(data_frame(0x123, false, {0x11, 0xF2})).view(), "< send 123 2 11 F2 >");
  EXPECT_EQ(send_text(data_frame(0, false, {})).view(), "< send 000 0 >");
  EXPECT_EQ(send_text(data_frame(0x123, true, {1})).view(), "< send 00000123 1 01 >");
  EXPECT_EQ(send_text(remote_frame(0x705, false, 1)).view(), "< sendrtr 705 1 >");
}

TEST(SocketcandFrames, AreReceivedAsTheProtocolSpellsThem) {
  EXPECT_EQ(received_text(data_frame(0x123, false, {0x11, 0xF2}), {23, 424242}).view(), "< frame 123 23.424242 11F2 >");
  EXPECT_EQ(received_text(data_frame(0x7F, false, {}), {1, 5}).view(), "< frame 07F 1.000005  >")
      << "both blanks: clients look for the data behind the second one";
  EXPECT_EQ(received_text(data_frame(0x1FFF'FFFF, true, {0, 1, 2, 3, 4, 5, 6, 7}), {9'999'999'999, 999'999}).view(),
            "< frame 1FFFFFFF 9999999999.999999 0001020304050607 >");
  EXPECT_EQ(received_text(remote_frame(0x123, false, 4), {23, 424242}).view(), "< rtr 123 23.424242 4 >");
}

TEST(SocketcandFrames, AreTheSameAfterBothWays) {
  for (const Frame& frame : all_kinds) {
    const auto sent = send_text(frame);
    EXPECT_EQ(parse_send(elements(sent.view()).at(0)), frame) << sent.view();
    const auto received = received_text(frame, {1'700'000'000, 1});
    EXPECT_EQ(parse_received(elements(received.view()).at(0)), frame) << received.view();
  }
}

TEST(SocketcandFrames, AreReadHoweverClientsSpellThem) {
  EXPECT_EQ(parse_send("send 5 1 a"), data_frame(5, false, {0x0A})) << "without leading zeros, small letters";
  EXPECT_EQ(parse_send("  send  0123  0  "), data_frame(0x123, false, {}));
  EXPECT_EQ(parse_send("send 00000005 0"), data_frame(5, true, {})) << "eight digits are 29 bits";
  EXPECT_EQ(parse_send("send 18000 0"), data_frame(0x18000, true, {})) << "so is what 11 bits do not hold";
  EXPECT_EQ(parse_received("frame 123 23.424242 11 22 33"), data_frame(0x123, false, {0x11, 0x22, 0x33}));
  EXPECT_EQ(parse_received("frame 123 23 1122"), data_frame(0x123, false, {0x11, 0x22}));
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
  for (const std::string_view wrong :
       {"", "frame", "frame 123", "frame 123 x 11", "frame 123 1.x 11", "frame 123 . 11", "frame 123 1.0 1",
        "frame 123 1.0 112233445566778899", "frame 123 1.0 1g", "rtr 123 1.0", "rtr 123 1.0 9", "rtr 123 1.0 1 1",
        "rtr 123 1", "error 123 1.0", "ok"}) {
    EXPECT_EQ(parse_received(wrong), std::nullopt) << wrong;
  }
}

}  // namespace
