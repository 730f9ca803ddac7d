/// FDCAN of an STM32G4 or STM32H7 whose registers and message RAM are simulated.
#pragma once

#include <gtest/gtest.h>

#include <canopen/port/fdcan.hpp>
#include <optional>
#include <string>

#include "fake_m_can.hpp"
#include "support/bench.hpp"

namespace fdcan_bench {

template <class Kind>
inline constexpr fake::Chip chip = std::is_same_v<Kind, canopen::FdcanOfG4> ? fake::Chip::g4 : fake::Chip::h7;

/// `Kind` of chip: FdcanOfG4 or FdcanOfH7.
template <class Kind>
struct Fdcan : testing::Test {
  using Bus = canopen::Fdcan<Kind, fake::MCan>;
  static constexpr std::uint32_t clock = 80'000'000;

  void go_on_the_bus() { ASSERT_TRUE(bus.start(clock, 500'000)); }
  [[nodiscard]] bool send(const std::string& text) { return bus.send(bench::frame(text)); }
  void arrive(const std::string& text) { EXPECT_TRUE(controller.arrive(bench::frame(text))) << text; }
  [[nodiscard]] bool accepts(const std::string& text) {
    const bool taken = controller.arrive(bench::frame(text));
    EXPECT_EQ(received(), taken ? text : "nothing");
    return taken;
  }
  [[nodiscard]] std::string received() {
    const std::optional<canopen::Frame> got = bus.receive();
    return got ? bench::text(*got) : "nothing";
  }
  /// The frames that other nodes have received.
  [[nodiscard]] std::string sent() {
    controller.send_all();
    std::string text;
    for (const canopen::Frame& one : controller.sent) text += (text.empty() ? "" : " | ") + bench::text(one);
    controller.sent.clear();
    return text;
  }

  fake::MCan controller{chip<Kind>};
  Bus bus{controller, controller.ram};
};

}  // namespace fdcan_bench
