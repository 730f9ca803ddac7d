/// Values for another context: the newest one arrives, and whole.
#include <gtest/gtest.h>
#include <canopen/base/shared_value.hpp>

#include <algorithm>
#include <array>
#include <atomic>
#include <cstdint>
#include <optional>
#include <thread>

namespace {

using canopen::SharedValue;

TEST(SharedValue, IsTakenOnce) {
  SharedValue<std::uint32_t> value;
  EXPECT_FALSE(value.is_new());
  EXPECT_EQ(value.take(), std::nullopt);
  value.publish(7);
  value.publish(8);
  EXPECT_TRUE(value.is_new());
  EXPECT_EQ(value.take(), 8u);
  EXPECT_FALSE(value.is_new());
  EXPECT_EQ(value.take(), std::nullopt);
}

/// A value so long that a thread is most likely suspended in the middle of a copy.
using Wide = std::array<std::uint32_t, 4096>;

TEST(SharedValue, IsNeverTornByAThreadThatPublishesMeanwhile) {
  constexpr int taken_values = 50;
  static SharedValue<Wide> value;
  std::atomic<bool> done = false;
  std::thread writer{[&] {
    static Wide next{};
    while (!done) {
      next.fill(next.front() + 1);
      value.publish(next);
    }
  }};
  int torn = 0;
  for (int taken = 0; taken < taken_values;) {
    static std::optional<Wide> latest;
    latest = value.take();
    if (!latest) continue;
    ++taken;
    const auto is_other = [](std::uint32_t word) { return word != latest->front(); };
    if (std::any_of(latest->begin(), latest->end(), is_other)) ++torn;
  }
  done = true;
  writer.join();
  EXPECT_EQ(torn, 0);
}

}  // namespace
