/// The runnable servo drive cpc TC1 as node 5, for tests of its application.
#pragma once

#include <gtest/gtest.h>

#include <cstdint>
#include <string>

#include "cpc_tc1/cpc_tc1.hpp"
#include "node_bench.hpp"

namespace cpc_tc1_bench {

using canopen::cia402::State;
namespace od = cpc_tc1::od;

/// Operational; the first TPDO1 to TPDO4 have been removed. RPDO2 and RPDO3 are valid.
struct Servo : bench::NodeBench<cpc_tc1_node::CpcTc1> {
  Servo() {
    ask("605 23 01 14 01 05 03 00 00");
    ask("605 23 02 14 01 05 04 00 00");
    ask(bench::start);
  }
  void enable() {
    for (const char* frame : {"205 06 00", "205 07 00", "205 0F 00"}) ask(frame);
    EXPECT_EQ(app->drive().state(), State::operation_enabled);
  }
  [[nodiscard]] std::uint32_t status() { return app->node().template get<od::manufacturer_status_register>().raw(); }
  [[nodiscard]] std::uint16_t statusword() { return app->node().template get<od::statusword>().raw(); }

  /// The four bytes of a number that is read by SDO; the whole response if it is an abort.
  [[nodiscard]] std::string read(const std::string& place) {
    const std::string response = ask("605 40 " + place + " 00 00 00 00").substr(0, 27);
    return response.starts_with("585 80") ? response : response.substr(16);
  }
};

/// Pre-operational: no PDO is sent.
struct QuietServo : bench::NodeBench<cpc_tc1_node::CpcTc1> {
  /// "save" or "load" to a sub-index.
  [[nodiscard]] std::string save(unsigned sub_index) { return command("10 10", sub_index, "73 61 76 65"); }
  [[nodiscard]] std::string load(unsigned sub_index) { return command("11 10", sub_index, "6C 6F 61 64"); }

 private:
  [[nodiscard]] std::string command(const std::string& index, unsigned sub_index, const std::string& signature) {
    return ask("605 23 " + index + " 0" + std::to_string(sub_index) + " " + signature);
  }
};

}  // namespace cpc_tc1_bench
