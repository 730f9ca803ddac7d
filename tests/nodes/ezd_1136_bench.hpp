/// The runnable stepper drive of manual 001, in Operational.
#pragma once

#include "ezd_1136/ezd_1136.hpp"

#include <gtest/gtest.h>

#include <cstdint>
#include <string>

#include "manuals/manual_bench.hpp"
#include "node_bench.hpp"

namespace ezd_1136_bench {

/// Operational. TPDO1 is 6041h, 603Fh, 6061h; TPDO2 and TPDO3 are not valid.
struct Stepper : bench::NodeBench<ezd_1136_node::Ezd1136> {
  Stepper() {
    set<ezd_1136::od::profile_velocity>(1'000);
    set<ezd_1136::od::profile_acceleration>(100);
    set<ezd_1136::od::profile_deceleration>(100);
    ask("605 23 01 18 01 85 02 00 80");
    ask("605 23 02 18 01 85 03 00 80");
    ask(bench::start);
  }

  /// Writes 6040h over SDO; returns what follows the answer.
  std::string control(std::uint16_t word) {
    const canopen::Frame frame{
        .id = 0x605,
        .size = 8,
        .data = {0x2B, 0x40, 0x60, 0x00, static_cast<std::uint8_t>(word), static_cast<std::uint8_t>(word >> 8)}};
    const std::string got = ask(bench::text(frame));
    const std::string answer = "585 60 40 60 00 00 00 00 00";
    EXPECT_EQ(got.substr(0, answer.size()), answer);
    return got.size() > answer.size() ? got.substr(answer.size() + 3) : "";
  }
  /// Writes an entry over SDO; returns what follows the answer.
  std::string put(std::uint16_t index, std::uint8_t sub_index, unsigned bytes, std::uint32_t value) {
    const std::string got = manual::write(*this, index, sub_index, bytes, value);
    const std::string answer = manual::taken(index, sub_index);
    EXPECT_EQ(got.substr(0, answer.size()), answer);
    return got.size() > answer.size() ? got.substr(answer.size() + 3) : "";
  }
  /// Reads an entry of up to four bytes over SDO; its sign is that of an integer of its size.
  std::int32_t read(std::uint16_t index, std::uint8_t sub_index = 0) {
    const canopen::Frame answer = bench::frame(ask(manual::sdo("605", 0x40, index, sub_index, 0)));
    EXPECT_EQ(answer.id, 0x585u);
    EXPECT_EQ(answer.data[0] & 0xE3, 0x43);
    const unsigned unused = 8 * ((answer.data[0] >> 2 & 3u));
    std::uint32_t bits = 0;
    for (unsigned i = 0; i < 4; ++i) bits |= std::uint32_t{answer.data[4 + i]} << (8 * i);
    return static_cast<std::int32_t>(bits << unused) >> unused;
  }
  void enable() {
    control(0x06);
    control(0x07);
    control(0x0F);
    EXPECT_EQ(state(), canopen::cia402::State::operation_enabled);
  }
  /// The raw numbers of objects, as in the manual.
  template <class O>
  void set(canopen::RawOf<typename O::type> number) {
    EXPECT_EQ(app->node().template set<O>(canopen::from_raw<typename O::type>(number)), canopen::ok);
    app->on_time(now);
    bus.take();
  }
  template <class O>
  [[nodiscard]] canopen::RawOf<typename O::type> get() {
    return canopen::to_raw(app->node().template get<O>());
  }
  [[nodiscard]] canopen::cia402::State state() const { return app->drive().state(); }
  [[nodiscard]] std::uint16_t statusword() { return get<ezd_1136::od::statusword>(); }
};

}  // namespace ezd_1136_bench
