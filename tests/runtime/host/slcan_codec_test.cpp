/// SLCAN character by character: the adapter, the host, and both connected to each other.
#include <gtest/gtest.h>
#include <canopen/host/slcan_host.hpp>
#include <canopen/port/slcan_adapter.hpp>
#include <canopen/port/slcan_codec.hpp>

#include <string>
#include <vector>

#include "support/bench.hpp"

namespace {

using canopen::Frame;
using canopen::SlcanAdapter;
using canopen::SlcanChannel;
using canopen::SlcanHost;
using canopen::TimePoint;
using namespace std::chrono_literals;

std::string line_of(const std::string& frame) {
  std::array<char, canopen::slcan::longest_line> line;
  const std::size_t size = canopen::slcan::encode(bench::frame(frame), line);
  return {line.data(), size};
}

std::string frame_of(std::string_view line) {
  const auto frame = canopen::slcan::decode(line);
  return frame ? bench::text(*frame) : "none";
}

TEST(Slcan, WritesFramesAsLines) {
  EXPECT_EQ(line_of("605 40 00 10 00 00 00 00 00"), "t60584000100000000000\r");
  EXPECT_EQ(line_of("080"), "t0800\r");
  EXPECT_EQ(line_of("185 R 8"), "r1858\r");
  EXPECT_EQ(line_of("12345678 AA BB"), "T123456782AABB\r");
  EXPECT_EQ(line_of("1FFFFFFF R 2"), "R1FFFFFFF2\r");
}

TEST(Slcan, ReadsLinesAsFrames) {
  EXPECT_EQ(frame_of("t60584000100000000000"), "605 40 00 10 00 00 00 00 00");
  EXPECT_EQ(frame_of("t0800"), "080");
  EXPECT_EQ(frame_of("r1858"), "185 R 8");
  EXPECT_EQ(frame_of("T123456782aabb"), "12345678 AA BB") << "small letters";
  EXPECT_EQ(frame_of("t1852310212AB"), "185 31 02") << "a time stamp behind it";
  EXPECT_EQ(frame_of("r185212AB"), "185 R 2");
}

TEST(Slcan, RefusesWhatIsNoFrame) {
  for (const char* line : {"", "t", "t18", "t185", "t8001AA", "t1859", "t18523102F", "t185231020", "t1852310200000",
                           "t185231G2", "T200000000", "x1850", "t185 2", "t1852 10 2"}) {
    EXPECT_EQ(frame_of(line), "none") << line;
  }
}

/// An adapter that records its serial line and its CAN bus.
struct Adapter {
  std::string line;
  bench::RecordingBus bus;
  std::vector<SlcanChannel> opened;
  bool refuses = false;
  int closed = 0;
  SlcanAdapter adapter{"E001"};
  TimePoint now{1'234'567us};

  void write(std::span<const char> text) { line.append(text.data(), text.size()); }
  bool open(const SlcanChannel& channel) {
    opened.push_back(channel);
    return !refuses;
  }
  void close() { ++closed; }
  bool send(const Frame& frame) { return bus.send(frame); }
  std::uint8_t status() { return 0x28; }

  /// Returns its answer to these characters.
  std::string ask(std::string_view text) {
    line.clear();
    for (const char character : text) adapter.on_character(character, *this);
    return line;
  }

  /// Returns what it sends to the host for a frame.
  std::string hear(const std::string& frame) {
    line.clear();
    adapter.on_frame(bench::frame(frame), now, *this);
    return line;
  }
};

TEST(SlcanAdapter, OpensItsChannelWithABitRate) {
  Adapter device;
  EXPECT_EQ(device.ask("S6\r"), "\r");
  EXPECT_EQ(device.ask("O\r"), "\r");
  ASSERT_EQ(device.opened.size(), 1u);
  EXPECT_EQ(device.opened[0], (SlcanChannel{SlcanChannel::Rate::code, 6, false}));
  EXPECT_EQ(device.ask("C\r"), "\r");
  EXPECT_EQ(device.closed, 1);
  EXPECT_EQ(device.ask("s031C\rL\r"), "\r\r");
  EXPECT_EQ(device.opened[1], (SlcanChannel{SlcanChannel::Rate::registers, 0x031C, true}));
}

TEST(SlcanAdapter, RefusesCommandsThatItsChannelDoesNotAllow) {
  Adapter device;
  for (const char* command :
       {"C\r", "F\r", "t1000\r", "S9\r", "S\r", "S66\r", "s12\r", "Z2\r", "Q1\r", "O1\r", "P\r"}) {
    EXPECT_EQ(device.ask(command), "\a") << command;
  }
  EXPECT_EQ(device.ask("O\r"), "\r");
  for (const char* command : {"O\r", "S6\r", "s031C\r", "L\r", "Z1\r", "M00000000\r"}) {
    EXPECT_EQ(device.ask(command), "\a") << command << "while it is open";
  }
  device.refuses = true;
  EXPECT_EQ(device.ask("C\rO\r"), "\r\a") << "a controller that does not go on the bus";
  EXPECT_FALSE(device.adapter.is_open());
}

TEST(SlcanAdapter, TellsVersionSerialNumberAndFlags) {
  Adapter device;
  EXPECT_EQ(device.ask("V\r"), "V1013\r");
  EXPECT_EQ(device.ask("N\r"), "NE001\r");
  EXPECT_EQ(device.ask("O\rF\r"), "\rF28\r");
}

TEST(SlcanAdapter, SendsTheFramesOfTheHost) {
  Adapter device;
  (void)device.ask("O\r");
  EXPECT_EQ(device.ask("t60584000100000000000\r"), "z\r");
  EXPECT_EQ(device.ask("T123456782AABB\r"), "Z\r");
  EXPECT_EQ(device.ask("r7050\rR000000010\r"), "z\rZ\r");
  EXPECT_EQ(device.bus.take(), "605 40 00 10 00 00 00 00 00 | 12345678 AA BB | 705 R 0 | 00000001 R 0");
  device.bus.room = 0;
  EXPECT_EQ(device.ask("t0800\r"), "\a") << "no room";
  device.bus.room = 1;
  EXPECT_EQ(device.ask("C\rL\rt0800\r"), "\r\r\a") << "it listens only";
}

TEST(SlcanAdapter, TellsTheHostWhatItHears) {
  Adapter device;
  EXPECT_EQ(device.hear("585 60 17 10 00 00 00 00 00"), "") << "closed";
  (void)device.ask("O\r");
  EXPECT_EQ(device.hear("585 60 17 10 00 00 00 00 00"), "t58586017100000000000\r");
  EXPECT_EQ(device.hear("12345678 AA BB"), "T123456782AABB\r");
  (void)device.ask("C\rZ1\rO\r");
  EXPECT_EQ(device.hear("705 05"), "t70510504D2\r") << "1234 ms";
  device.now = TimePoint{61'000'000us};
  EXPECT_EQ(device.hear("705 R 0"), "r705003E8\r") << "the time begins again every minute";
}

TEST(SlcanAdapter, FiltersByAcceptanceCodeAndMask) {
  Adapter device;
  EXPECT_EQ(device.ask("M60A0E0A0\rm00100010\rO\r"), "\r\r\r");
  EXPECT_NE(device.hear("305 01"), "") << "filter 1: 305h";
  EXPECT_NE(device.hear("705 05"), "") << "filter 2: 705h";
  EXPECT_NE(device.hear("705 R 0"), "") << "data or remote";
  EXPECT_EQ(device.hear("306 01"), "");
  EXPECT_EQ(device.ask("C\rmFFFFFFFF\rO\r"), "\r\r\r");
  EXPECT_NE(device.hear("306 01"), "") << "any";
}

TEST(SlcanAdapter, FindsTheNextLineAfterRubbish) {
  Adapter device;
  (void)device.ask("O\r");
  EXPECT_EQ(device.ask("\xFF\x7Ft0800\r"), "z\r");
  EXPECT_EQ(device.ask(std::string(1000, 't') + "\r"), "\a") << "a line of any length";
  EXPECT_EQ(device.ask("t0800\r\r\n\r"), "z\r") << "empty lines are not commands";
  EXPECT_EQ(device.bus.take(), "080 | 080");
}

/// A host; the test writes the answers of the adapter.
struct Host {
  SlcanHost host;
  TimePoint now{};

  std::string written() {
    const std::string text{host.output()};
    host.output_taken();
    return text;
  }
  std::string hear(std::string_view text) {
    std::string frames;
    for (const char character : text) {
      if (const auto frame = host.on_character(character, now)) frames += bench::text(*frame) + ";";
    }
    return frames;
  }
  std::string pass(canopen::Duration span) {
    now = now + span;
    host.on_time(now);
    return written();
  }
  void open() {
    host.start(std::nullopt, now);
    (void)written();
    (void)pass(100ms);
    (void)hear("\r");
  }
};

TEST(SlcanHost, OpensTheChannelStepByStep) {
  Host host;
  host.host.start(std::uint8_t{6}, host.now);
  EXPECT_EQ(host.written(), "\r\r\rC\r");
  EXPECT_EQ(host.hear("\a\a\rt1230\r"), "") << "what was on its way does not count";
  EXPECT_EQ(host.pass(100ms), "S6\r");
  EXPECT_EQ(host.hear("\r"), "");
  EXPECT_EQ(host.written(), "O\r");
  EXPECT_EQ(host.host.state(), SlcanHost::State::connecting);
  EXPECT_EQ(host.hear("\r"), "");
  EXPECT_EQ(host.host.state(), SlcanHost::State::open);
  EXPECT_EQ(host.hear("t70510\r"), "");
  EXPECT_EQ(host.hear("t705105\r"), "705 05;");
}

TEST(SlcanHost, TellsWhatTheAdapterRefuses) {
  for (const auto& [answers, problem] : {std::pair{"\a", "the adapter refuses the bit rate"},
                                         std::pair{"\r\a", "the adapter does not open its channel"}}) {
    Host host;
    host.host.start(std::uint8_t{8}, host.now);
    for (int attempt = 1; attempt <= 3; ++attempt) {
      EXPECT_EQ(host.host.state(), SlcanHost::State::connecting) << attempt;
      (void)host.pass(100ms);
      (void)host.hear(answers);
    }
    EXPECT_EQ(host.host.state(), SlcanHost::State::refused);
    EXPECT_EQ(host.host.problem(), problem);
  }
}

TEST(SlcanHost, TakesALateAnswerForNoRefusal) {
  Host host;
  host.host.start(std::nullopt, host.now);
  (void)host.written();
  EXPECT_EQ(host.pass(100ms), "O\r");
  EXPECT_EQ(host.hear("\a"), "") << "to the C before";
  EXPECT_EQ(host.written(), "C\r");
  EXPECT_EQ(host.hear("\r\r"), "");
  EXPECT_EQ(host.pass(100ms), "O\r");
  EXPECT_EQ(host.hear("\r"), "");
  EXPECT_EQ(host.host.state(), SlcanHost::State::open);
}

TEST(SlcanHost, DoesWithoutAnswers) {
  Host host;
  host.host.start(std::uint8_t{4}, host.now);
  (void)host.written();
  EXPECT_EQ(host.pass(100ms), "S4\r");
  EXPECT_EQ(host.pass(500ms), "O\r");
  EXPECT_EQ(host.pass(500ms), "");
  EXPECT_EQ(host.host.state(), SlcanHost::State::open);
}

TEST(SlcanHost, FindsTheNextFrameAfterRubbish) {
  Host host;
  host.open();
  EXPECT_EQ(host.hear("234\rt123\xF0t0800\r"), "080;");
  EXPECT_EQ(host.hear(std::string(100'000, 'T') + "\rt0810\r"), "081;");
  EXPECT_EQ(host.hear("z\rZ\r\rt0820\r"), "082;") << "answers to what was sent";
}

TEST(SlcanHost, AsksForTheFlagsAfterARefusal) {
  Host host;
  host.open();
  (void)host.hear("\a");
  EXPECT_EQ(host.pass(0ms), "F\r");
  (void)host.hear("F20\r");
  EXPECT_EQ(host.host.status(), (canopen::BusStatus{canopen::BusState::passive, false}));
  EXPECT_EQ(host.pass(1s), "F\r") << "until all is well";
  (void)host.hear("F08\r");
  EXPECT_EQ(host.host.status(), (canopen::BusStatus{canopen::BusState::active, true}));
  (void)host.pass(1s);
  (void)host.hear("F00\r");
  EXPECT_EQ(host.host.status(), canopen::BusStatus{});
  EXPECT_EQ(host.pass(10s), "");
}

TEST(SlcanHost, AsksAnAdapterWithoutFlagsOnce) {
  Host host;
  host.open();
  (void)host.hear("\a");
  EXPECT_EQ(host.pass(0ms), "F\r");
  (void)host.hear("\a");
  (void)host.pass(500ms);
  (void)host.hear("\a");
  EXPECT_EQ(host.pass(10s), "");
}

}  // namespace
