/// The runnable servo drive CPD as node 5 in Operational, in simulated time.
#pragma once

#include <gtest/gtest.h>
#include <canopen/base/bytes.hpp>

#include <cstdint>
#include <span>
#include <string>

#include "cpd/cpd.hpp"
#include "node_bench.hpp"

namespace bench {

/// Operational: T_PDO1 with the statusword.
struct Servo : NodeBench<cpd_node::Cpd> {
  explicit Servo(const std::string& store = {}) : NodeBench{canopen::NodeId{5}, store} { ask(start); }

  void enable(int mode) {
    set<cpd::od::modes_of_operation>(static_cast<std::int8_t>(mode));
    ask("205 0F 00");
    EXPECT_EQ(app->drive().state(), canopen::cia402::State::operation_enabled);
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
  /// Writes one to four bytes over SDO and returns the response.
  std::string write(std::uint16_t index, std::uint8_t sub_index, unsigned bytes, std::uint32_t value) {
    return ask(sdo(0x605, 0x23 | (4 - bytes) << 2, index, sub_index, value));
  }
  /// Reads an entry over SDO; fails if the response does not have this number of bytes.
  std::uint32_t read(std::uint16_t index, std::uint8_t sub_index, unsigned bytes) {
    const canopen::Frame answer = frame(ask(sdo(0x605, 0x40, index, sub_index, 0)));
    EXPECT_EQ(answer.data[0], 0x43 | (4 - bytes) << 2) << text(answer);
    return canopen::little_endian_number(std::span{answer.data}.subspan(4));
  }
  static std::string sdo(std::uint32_t can_id, unsigned command, std::uint16_t index, std::uint8_t sub_index,
                         std::uint32_t data) {
    const auto byte = [](std::uint32_t value) { return static_cast<std::uint8_t>(value); };
    return text({.id = can_id,
                 .size = 8,
                 .data = {byte(command), byte(index), byte(index >> 8), sub_index, byte(data), byte(data >> 8),
                          byte(data >> 16), byte(data >> 24)}});
  }
  [[nodiscard]] canopen::cia402::State state() const { return app->drive().state(); }
  [[nodiscard]] std::uint16_t statusword() { return get<cpd::od::statusword>(); }
};

}  // namespace bench
