/// The player finds differences between nodes and a trace.
#include "player.hpp"

#include <gtest/gtest.h>

#include <sstream>

namespace {

/// A node with one object, 2000h:00, of one byte. After each change it sends the value with CAN-ID 100h + node-ID;
/// a frame with CAN-ID 300h + node-ID sets the value. 10 ms after power-on, and then every 10 ms, it sends 200h +
/// node-ID. For an error it sends 080h + node-ID with the first manufacturer-specific byte, or with the bits when
/// it is over.
class Echo final : public trace::Station {
 public:
  explicit Echo(std::uint8_t node_id) : node_id_{node_id} {}

  void power_on(canopen::TimePoint now) override {
    due_ = now + period;
    send_frame(0x700, 0);
  }
  void power_off() override {
    value_ = 0;
    due_.reset();
  }
  void on_frame(const canopen::Frame& frame, canopen::TimePoint) override {
    if (frame.id == 0x300u + node_id_ && frame.size == 1) change(frame.data[0]);
  }
  void on_time(canopen::TimePoint now) override {
    if (changed_) send_frame(0x100, value_);
    changed_ = false;
    if (!due_ || now < *due_) return;
    send_frame(0x200, value_);
    due_ = *due_ + period;
  }
  [[nodiscard]] std::optional<canopen::TimePoint> next_deadline() const override { return due_; }
  [[nodiscard]] canopen::AbortCode set(std::uint16_t index, std::uint8_t, const trace::Value& value) override {
    if (index != 0x2000) return canopen::AbortCode::no_object;
    change(value.bytes(1)[0]);
    return canopen::ok;
  }
  void emergency(const trace::Emergency& error) override { send_frame(0x080, error.info[0]); }
  void emergency_over(canopen::ErrorRegister bits) override { send_frame(0x080, static_cast<std::uint8_t>(bits)); }
  [[nodiscard]] std::optional<std::vector<std::uint8_t>> value(std::uint16_t index, std::uint8_t) override {
    if (index != 0x2000) return std::nullopt;
    return std::vector<std::uint8_t>{value_};
  }

 private:
  static constexpr canopen::Duration period{10'000};

  void change(std::uint8_t value) {
    value_ = value;
    changed_ = true;
  }
  void send_frame(std::uint32_t function, std::uint8_t byte) {
    canopen::Frame frame{};
    frame.id = function + node_id_;
    frame.size = 1;
    frame.data[0] = byte;
    static_cast<void>(send(frame));
  }

  std::uint8_t node_id_;
  std::uint8_t value_ = 0;
  bool changed_ = false;
  std::optional<canopen::TimePoint> due_;  ///< empty without power
};

/// `line: message` of each failure; the nodes have node-IDs 1 and 2.
std::vector<std::string> failures(const std::string& lines, const std::string& kind = "device") {
  std::istringstream text{kind + " a\nnode 1\n" + kind + " b\nnode 2\n" + lines};
  const trace::Trace trace = trace::read(text, "example.trace");
  std::vector<std::unique_ptr<trace::Station>> stations;
  stations.push_back(std::make_unique<Echo>(std::uint8_t{1}));
  stations.push_back(std::make_unique<Echo>(std::uint8_t{2}));
  std::vector<std::string> found;
  for (const trace::Failure& failure : trace::play(trace, stations))
    found.push_back(std::to_string(failure.line) + ": " + failure.message);
  return found;
}

using Found = std::vector<std::string>;

TEST(TracePlayer, FindsNothingWhereTheNodesDoWhatTheTraceSays) {
  EXPECT_EQ(failures("= node 2 2000h:00 7\n< 102 07\nread node 2 2000h:00 7\n+ 10 ms\n< 201 00\n< 202 07\n"), Found{});
}

TEST(TracePlayer, LeavesOutTheBootUpMessagesUnlessTheTraceBeginsWithPowerOn) {
  EXPECT_EQ(failures("+ 1 ms\n"), Found{});
  EXPECT_EQ(failures("power on\n< 701 00\n< 702 00\n"), Found{});
}

TEST(TracePlayer, FindsAFrameThatIsMissing) {
  EXPECT_EQ(failures("+ 9 ms\n< 201 00\n"), Found{"6: expected: 201  00\n  got:      nothing"});
}

TEST(TracePlayer, FindsAFrameThatIsTooMuchWhereTheTraceGoesOn) {
  EXPECT_EQ(failures("= node 1 2000h:00 7\n+ 1 ms\n"), Found{"6: up to here not expected: 101  07"});
  EXPECT_EQ(failures("= node 1 2000h:00 7\n"), Found{"5: up to here not expected: 101  07"});
}

TEST(TracePlayer, FindsAnotherFrameAnotherLengthAndAnotherValue) {
  EXPECT_EQ(failures("= node 1 2000h:00 7\n< 101 08\n"), Found{"6: expected: 101  08\n  got:      101  07"});
  EXPECT_EQ(failures("= node 1 2000h:00 7\n< 101 07 00\n"), Found{"6: expected: 101  07 00\n  got:      101  07"});
  EXPECT_EQ(failures("= node 1 2000h:00 7\n< 101 R 1\n"), Found{"6: expected: 101  R 1\n  got:      101  07"});
  EXPECT_EQ(failures("read node 1 2000h:00 7\n"), Found{"5: expected: 07 \n  got:      00 "});
}

TEST(TracePlayer, TakesAnyByteWhereTheTraceLeavesItOpen) {
  EXPECT_EQ(failures("= node 1 2000h:00 7\n< 101 --\n"), Found{});
}

TEST(TracePlayer, FindsAnObjectThatIsMissing) {
  EXPECT_EQ(failures("read node 1 2001h:00 7\n"), Found{"5: the device has no such object"});
  EXPECT_EQ(failures("= node 1 2001h:00 7\n").size(), 1u);
}

TEST(TracePlayer, SetsTheObjectsOfLinesThatFollowEachOtherAtOneMoment) {
  EXPECT_EQ(failures("= node 1 2000h:00 7\n# the node sees the last value alone\n= node 1 2000h:00 8\n< 101 08\n"),
            Found{});
}

TEST(TracePlayer, BringsAFrameToAllNodes) {
  EXPECT_EQ(failures("> 301 05\n< 101 05\n> 302 06\n< 102 06\nread node 1 2000h:00 5\n"), Found{});
}

TEST(TracePlayer, LooksAtFramesThatComeAtAnyTimeOnlyWhereTheyAreExpected) {
  EXPECT_EQ(failures("~ 201\n~ 202\n+ 1 s\n= node 1 2000h:00 7\n< 101 07\n"), Found{});
  EXPECT_EQ(failures("~ 201\n~ 202\n+ 20 ms\n= node 1 2000h:00 7\n< 101 07\n+ 10 ms\n< 201 07\n"), Found{});
  EXPECT_EQ(failures("~ 201\n~ 202\n+ 20 ms\n< 201 09\n"), Found{"8: expected: 201  09\n  got:      nothing"});
}

TEST(TracePlayer, TellsALineOfInputThatNoApplicationTakes) {
  EXPECT_EQ(failures("! node 2 word\n", "application"), Found{"5: the application knows no such line"});
}

TEST(TracePlayer, RaisesErrorsAndTakesThemBack) {
  EXPECT_EQ(failures("emergency node 2 0x1000 0x81 05\n< 082 05\nemergency node 2 over 0x81\n< 082 81\n"), Found{});
}

TEST(TracePlayer, TakesThePowerAwayFromAllNodes) {
  EXPECT_EQ(failures("= node 1 2000h:00 7\n< 101 07\npower off\n+ 30 ms\npower on\n< 701 00\n< 702 00\n"
                     "read node 1 2000h:00 0\n+ 10 ms\n< 201 00\n< 202 00\n"),
            Found{});
  EXPECT_EQ(failures("= node 1 2000h:00 7\npower off\n"), Found{"6: up to here not expected: 101  07"});
}

}  // namespace
