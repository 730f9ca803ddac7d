#include <gtest/gtest.h>

#include <canopen/node/mailbox.hpp>
#include <canopen_sim/virtual_bus.hpp>

#include <type_traits>

#include "support/bench.hpp"

namespace {

using canopen::AbortCode;
using canopen::Mailbox;
using canopen::TimePoint;
using canopen::values_from;
namespace od = sample::od;
using namespace std::chrono_literals;

TEST(Mailbox, APostedValueIsSentWithTheNextOnTime) {
  Mailbox<od::statusword> mailbox;
  auto device = bench::with(values_from(mailbox));
  device.ask(bench::start);
  mailbox.post<od::statusword>(0x1234);
  EXPECT_EQ(device.node.get<od::statusword>(), 0);
  EXPECT_EQ(device.pass(0ms), "185 34 12 00 00 00 00");
  EXPECT_EQ(device.node.get<od::statusword>(), 0x1234);
}

TEST(Mailbox, TheNodeIsDueWhileAValueWaits) {
  Mailbox<od::statusword, od::unsigned64_value> mailbox;
  auto device = bench::with(values_from(mailbox));
  EXPECT_EQ(device.node.next_deadline(), std::nullopt);
  EXPECT_FALSE(mailbox.pending());
  mailbox.post<od::unsigned64_value>(1);
  EXPECT_TRUE(mailbox.pending());
  EXPECT_EQ(device.node.next_deadline(), device.now);
  device.node.on_time(device.now);
  EXPECT_FALSE(mailbox.pending());
  EXPECT_EQ(device.node.next_deadline(), std::nullopt);
}

/// A loop sleeps while nothing is pending or due, also without node-ID.
TEST(Mailbox, AValueForANodeWithoutNodeIdIsSetAndNotLost) {
  Mailbox<od::statusword> mailbox;
  bench::RecordingBus bus;
  auto node = bench::make_node<sample::Device>(bus, canopen::NodeId{}, values_from(mailbox));
  node.start(TimePoint{});
  mailbox.post<od::statusword>(0x1234);
  EXPECT_EQ(node.next_deadline(), TimePoint{});
  node.on_time(TimePoint{});
  EXPECT_FALSE(mailbox.pending());
  EXPECT_EQ(node.next_deadline(), std::nullopt);
  EXPECT_EQ(node.get<od::statusword>(), 0x1234);
  EXPECT_EQ(bus.take(), "");
}

TEST(Mailbox, TheLatestValueReplacesThoseBefore) {
  Mailbox<od::statusword> mailbox;
  auto device = bench::with(values_from(mailbox));
  device.ask(bench::start);
  for (std::uint16_t value = 1; value < 1000; ++value) mailbox.post<od::statusword>(value);
  EXPECT_EQ(device.pass(0ms), "185 E7 03 00 00 00 00");
  mailbox.post<od::statusword>(999);  // the same value is not sent again
  EXPECT_EQ(device.pass(0ms), "");
}

TEST(Mailbox, AnObjectThatIsNotPostedKeepsItsValue) {
  Mailbox<od::statusword, od::integer16_value> mailbox;
  auto device = bench::with(values_from(mailbox));
  device.node.set<od::integer16_value>(-7);
  mailbox.post<od::statusword>(1);
  device.pass(0ms);
  EXPECT_EQ(device.node.get<od::integer16_value>(), -7);
}

TEST(Mailbox, AValueOutsideItsLimitsIsRejectedAtOnce) {
  Mailbox<od::integer8_value, od::integer64_value, od::real32_value> mailbox;
  auto device = bench::with(values_from(mailbox));
  EXPECT_EQ(mailbox.post<od::integer8_value>(100), canopen::ok);
  EXPECT_EQ(mailbox.post<od::integer8_value>(std::int8_t{101}), AbortCode::value_too_high);
  EXPECT_EQ(mailbox.post<od::integer8_value>(std::int8_t{-101}), AbortCode::value_too_low);
  EXPECT_EQ(mailbox.post<od::integer64_value>(-4'999'999'999'999), canopen::ok);
  EXPECT_EQ(mailbox.post<od::real32_value>(-1.25f), canopen::ok);
  device.pass(0ms);
  EXPECT_EQ(device.node.get<od::integer8_value>(), 100);
  EXPECT_EQ(device.node.get<od::integer64_value>(), -4'999'999'999'999);
  EXPECT_EQ(device.node.get<od::real32_value>(), -1.25f);
}

TEST(Mailbox, CarriesStringsAndTimes) {
  Mailbox<od::visible_string_value, od::time_of_day_value, od::boolean_value> mailbox;
  auto device = bench::with(values_from(mailbox));
  mailbox.post<od::visible_string_value>("a text");
  mailbox.post<od::time_of_day_value>({.milliseconds = 12'345'678, .days = 15'000});
  mailbox.post<od::boolean_value>(true);
  device.pass(0ms);
  EXPECT_EQ(device.node.get<od::visible_string_value>().view(), "a text");
  EXPECT_EQ(device.node.get<od::time_of_day_value>(), (canopen::TimeOfDay{12'345'678, 15'000}));
  EXPECT_TRUE(device.node.get<od::boolean_value>());
}

TEST(Mailbox, ANodeHasSeveral) {
  Mailbox<od::statusword> of_the_drive;
  Mailbox<od::integer16_value> of_the_converter;
  auto device = bench::with(values_from(of_the_drive), values_from(of_the_converter));
  of_the_drive.post<od::statusword>(1);
  of_the_converter.post<od::integer16_value>(2);
  device.pass(0ms);
  EXPECT_EQ(device.node.get<od::statusword>(), 1);
  EXPECT_EQ(device.node.get<od::integer16_value>(), 2);
}

TEST(Mailbox, AValuePostedBeforeTheStartReplacesTheDefaultValue) {
  Mailbox<od::integer16_value> mailbox;
  mailbox.post<od::integer16_value>(11);
  auto device = bench::with(values_from(mailbox));
  device.pass(0ms);
  EXPECT_EQ(device.node.get<od::integer16_value>(), 11);
  device.ask(bench::reset_node);  // and no longer after a reset
  device.pass(0ms);
  EXPECT_EQ(device.node.get<od::integer16_value>(), 0);
}

TEST(Mailbox, ANodeWithoutOneIsNotLarger) {
  using Plain = bench::NodeOf<sample::Device, bench::RecordingBus>;
  using WithMailbox = bench::NodeOf<sample::Device, bench::RecordingBus, canopen::ValuesFrom<Mailbox<od::statusword>>>;
  static_assert(!canopen::service::PostedValues<sample::Device>::exists);
  EXPECT_LE(sizeof(WithMailbox), sizeof(Plain) + sizeof(void*));
}

}  // namespace
