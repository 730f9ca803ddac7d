/// The descriptor for a poll loop: when it is readable. Times have a lower limit only: the machine may be busy.
#include <gtest/gtest.h>
#include <canopen/host/event_descriptor.hpp>

#include <unistd.h>

#include <array>
#include <cerrno>
#include <string>
#include <system_error>
#include <thread>

namespace {

using canopen::Descriptor;
using canopen::Duration;
using canopen::EventDescriptor;
using canopen::TimePoint;
using namespace std::chrono_literals;

/// Both ends of a pipe.
struct Pipe {
  Pipe() {
    std::array<int, 2> ends{};
    if (::pipe(ends.data()) != 0) canopen::throw_errno("pipe");
    out = Descriptor{ends[0]};
    in = Descriptor{ends[1]};
  }
  Descriptor out, in;
};

/// Whether the descriptor is readable now, or within this time in milliseconds.
bool is_readable(const EventDescriptor& events, int milliseconds = 0) {
  pollfd waiting{events.number(), POLLIN, 0};
  return ::poll(&waiting, 1, milliseconds) == 1;
}

constexpr int long_enough = 60'000;

TEST(ToTimespec, HasSecondsAndNanoseconds) {
  const timespec span = canopen::to_timespec(2'000'003us);
  EXPECT_EQ(span.tv_sec, 2);
  EXPECT_EQ(span.tv_nsec, 3'000);
  EXPECT_EQ(canopen::to_timespec(999'999us).tv_sec, 0);
  EXPECT_EQ(canopen::to_timespec(999'999us).tv_nsec, 999'999'000);
}

TEST(ThrowErrno, NamesTheCallAndItsError) {
  errno = ENODEV;
  try {
    canopen::throw_errno("open");
    FAIL();
  } catch (const std::system_error& error) {
    EXPECT_EQ(error.code().value(), ENODEV);
    EXPECT_EQ(std::string{error.what()}.rfind("open", 0), 0U) << error.what();
  }
}

TEST(EventDescriptor, IsReadableWhenItsDescriptorIs) {
  const Pipe pipe;
  EventDescriptor events;
  events.watch(pipe.out.number());
  EXPECT_FALSE(is_readable(events));
  ASSERT_EQ(::write(pipe.in.number(), "x", 1), 1);
  EXPECT_TRUE(is_readable(events));
}

TEST(EventDescriptor, IsReadableOnRoomOnlyWhereItWaitsForIt) {
  const Pipe pipe;
  EventDescriptor events;
  events.watch(pipe.in.number());
  EXPECT_FALSE(is_readable(events));
  events.wait_for_room(true);
  EXPECT_TRUE(is_readable(events));
  events.wait_for_room(false);
  EXPECT_FALSE(is_readable(events));
}

TEST(EventDescriptor, IsReadableFromItsAlarmOn) {
  EventDescriptor events;
  const TimePoint begin = canopen::monotonic_now();
  events.set_alarm(begin + 20ms, begin);
  EXPECT_TRUE(is_readable(events, long_enough));
  EXPECT_GE((canopen::monotonic_now() - begin).count(), Duration{20ms}.count());
  EXPECT_TRUE(is_readable(events)) << "until it is set again";
  events.set_alarm(std::nullopt, canopen::monotonic_now());
  EXPECT_FALSE(is_readable(events));
  events.set_alarm(begin, canopen::monotonic_now());
  EXPECT_TRUE(is_readable(events, long_enough)) << "a time that has passed";
}

TEST(EventDescriptor, IsReadableFromAWakeOnUntilItIsTaken) {
  EventDescriptor events;
  EXPECT_FALSE(is_readable(events));
  std::thread{[&] {
    events.wake();
    events.wake();
  }}.join();
  EXPECT_TRUE(is_readable(events));
  events.take_wake();
  EXPECT_FALSE(is_readable(events));
  events.take_wake();
  EXPECT_FALSE(is_readable(events));
}

TEST(EventDescriptor, EndsItsWaitWhenItIsWoken) {
  const Pipe pipe;
  EventDescriptor events;
  events.watch(pipe.out.number());
  std::thread other{[&] { events.wake(); }};
  events.wait(Duration{1'000'000'000});
  other.join();
  EXPECT_FALSE(is_readable(events)) << "the wake is taken";
}

TEST(EventDescriptor, WaitsForAnEventOrTheTime) {
  const Pipe pipe;
  EventDescriptor events;
  events.watch(pipe.out.number());
  const TimePoint begin = canopen::monotonic_now();
  events.wait(20ms);
  EXPECT_GE((canopen::monotonic_now() - begin).count(), Duration{20ms}.count());
  ASSERT_EQ(::write(pipe.in.number(), "x", 1), 1);
  const TimePoint written = canopen::monotonic_now();
  events.wait(600s);
  EXPECT_LT((canopen::monotonic_now() - written).count(), Duration{600s}.count());
}

}  // namespace
