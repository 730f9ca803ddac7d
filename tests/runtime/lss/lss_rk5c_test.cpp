/// LSS as manual 004 shows it, frame by frame, with a slave that has the options of that device. Line numbers are those
/// of the manual's text.
#include <gtest/gtest.h>

#include <rk5c/device.hpp>
#include <string>
#include <vector>

#include "lss_bench.hpp"

namespace {

using canopen::LssState;
using canopen::NmtState;
using canopen::NodeId;
using canopen::unconfigured_node_id;
using namespace std::chrono_literals;

/// Node-ID 1..127 only (L280); all communication objects in Operational, none in Stopped (L1371..L1379); the bit rates
/// of Table 2; no Fastscan.
using Rk5c = bench::LssDevice<rk5c::Device::lss_options>;

struct Row {
  int line;  ///< of the request
  std::string request;
  std::string answer;
};

void replay(Rk5c& device, const std::vector<Row>& rows) {
  for (const Row& row : rows) EXPECT_EQ(device.ask(row.request), row.answer) << "L" << row.line;
}

const Row configuration_state{76, "7E5 04 01 00 00 00 00 00 00", ""};

TEST(LssRk5c, SectionTwoSetsNodeIdAndBitRate) {
  Rk5c device;
  replay(device, {
                     {76, "7E5 04 01 00 00 00 00 00 00", ""},                              // Figure 1
                     {87, "7E5 11 7E 00 00 00 00 00 00", "7E4 11 00 00 00 00 00 00 00"},   // Figure 2
                     {101, "7E5 13 00 02 00 00 00 00 00", "7E4 13 00 00 00 00 00 00 00"},  // Figure 3
                     {117, "7E5 17 00 00 00 00 00 00 00", "7E4 17 00 00 00 00 00 00 00"},  // Figure 4
                 });
  EXPECT_EQ(device.stored_node_id, NodeId{126});
  EXPECT_EQ(device.stored_bit_timing, (canopen::LssBitTiming{0, 2}));
  EXPECT_EQ(device.slave.node_id(), NodeId{5});
  device.power_on();
  EXPECT_EQ(device.slave.node_id(), NodeId{126});
}

TEST(LssRk5c, Figures9And10SwitchTheStateOfAllSlaves) {
  Rk5c device;
  EXPECT_EQ(device.ask("7E5 04 01 00 00 00 00 00 00"), "");  // L212
  EXPECT_EQ(device.slave.state(), LssState::configuration);
  EXPECT_EQ(device.ask("7E5 04 00 00 00 00 00 00 00"), "");  // L220
  EXPECT_EQ(device.slave.state(), LssState::waiting);
}

TEST(LssRk5c, Figure12SelectsTheDevice) {
  Rk5c device;
  replay(device, {
                     {252, "7E5 40 93 00 00 00 00 00 00", ""},
                     {253, "7E5 41 52 4B 35 43 00 00 00", ""},  // misprinted as 52 4B 35 53; see Figure 11 (L234)
                     {254, "7E5 42 01 00 01 00 00 00 00", ""},
                     {255, "7E5 43 34 12 01 15 00 00 00", "7E4 44 00 00 00 00 00 00 00"},
                 });
  EXPECT_EQ(device.slave.state(), LssState::configuration);
}

// shows 004.114
TEST(LssRk5c, Figure12AsPrintedIsForAnotherProduct) {
  Rk5c device;
  replay(device, {
                     {252, "7E5 40 93 00 00 00 00 00 00", ""},
                     {253, "7E5 41 52 4B 35 53 00 00 00", ""},
                     {254, "7E5 42 01 00 01 00 00 00 00", ""},
                     {255, "7E5 43 34 12 01 15 00 00 00", ""},
                 });
  EXPECT_EQ(device.slave.state(), LssState::waiting);
}

TEST(LssRk5c, Figure13ConfiguresTheNodeId) {
  Rk5c device;
  replay(device, {
                     configuration_state,
                     {284, "7E5 11 01 00 00 00 00 00 00", "7E4 11 00 00 00 00 00 00 00"},
                     {284, "7E5 11 7F 00 00 00 00 00 00", "7E4 11 00 00 00 00 00 00 00"},
                     {284, "7E5 11 00 00 00 00 00 00 00", "7E4 11 01 00 00 00 00 00 00"},
                     {284, "7E5 11 80 00 00 00 00 00 00", "7E4 11 01 00 00 00 00 00 00"},
                     {284, "7E5 11 FF 00 00 00 00 00 00", "7E4 11 01 00 00 00 00 00 00"},
                 });
  EXPECT_EQ(device.slave.pending_node_id(), NodeId{127});
}

TEST(LssRk5c, TheNodeIdBecomesActiveAfterResetCommunication) {  // L291
  Rk5c device;
  replay(device, {configuration_state,
                  {284, "7E5 11 7E 00 00 00 00 00 00", "7E4 11 00 00 00 00 00 00 00"},
                  {386, "7E5 5E 00 00 00 00 00 00 00", "7E4 5E 05 00 00 00 00 00 00"},
                  {220, "7E5 04 00 00 00 00 00 00 00", ""}});
  EXPECT_EQ(device.slave.node_id(), NodeId{5});
  device.reset_communication();
  EXPECT_EQ(device.slave.node_id(), NodeId{126});
  device.power_on();  // L301
  EXPECT_EQ(device.slave.node_id(), NodeId{5});
}

TEST(LssRk5c, Figure14AndTable2ConfigureTheBitRate) {
  Rk5c device;
  const std::string accepted = "7E4 13 00 00 00 00 00 00 00";
  const std::string refused = "7E4 13 01 00 00 00 00 00 00";
  replay(device, {
                     configuration_state,
                     {310, "7E5 13 00 00 00 00 00 00 00", accepted},  // 1000 kbit/s
                     {311, "7E5 13 00 01 00 00 00 00 00", accepted},  // 800
                     {312, "7E5 13 00 02 00 00 00 00 00", accepted},  // 500
                     {313, "7E5 13 00 03 00 00 00 00 00", accepted},  // 250
                     {314, "7E5 13 00 04 00 00 00 00 00", accepted},  // 125
                     {315, "7E5 13 00 05 00 00 00 00 00", refused},   // reserved
                     {316, "7E5 13 00 06 00 00 00 00 00", accepted},  // 50
                     {317, "7E5 13 00 07 00 00 00 00 00", accepted},  // 20
                     {318, "7E5 13 00 08 00 00 00 00 00", accepted},  // 10
                     {320, "7E5 13 00 09 00 00 00 00 00", refused},
                 });
}

TEST(LssRk5c, Figure15ActivatesTheBitRateAfterTwoDelays) {
  Rk5c device;
  replay(device, {configuration_state,
                  {326, "7E5 13 00 03 00 00 00 00 00", "7E4 13 00 00 00 00 00 00 00"},
                  {349, "7E5 15 64 00 00 00 00 00 00", ""}});
  device.pass(99ms);
  EXPECT_TRUE(device.events.empty());
  device.pass(1ms);  // L357
  EXPECT_EQ(device.events, (std::vector<std::string>{"100 ms: stop"}));
  EXPECT_EQ(device.ask("7E5 5E 00 00 00 00 00 00 00"), "");
  device.pass(100ms);  // L359
  EXPECT_EQ(device.events, (std::vector<std::string>{"100 ms: stop", "200 ms: start 0.3"}));
  EXPECT_EQ(device.stored_bit_timing, (canopen::LssBitTiming{0, 4}));  // L335
}

// shows 004.19
TEST(LssRk5c, Figure16Stores) {
  Rk5c device;
  replay(device, {configuration_state, {369, "7E5 17 00 00 00 00 00 00 00", "7E4 17 00 00 00 00 00 00 00"}});
  device.store_error = canopen::lss::storage_access_error;
  replay(device, {{374, "7E5 17 00 00 00 00 00 00 00", "7E4 17 02 00 00 00 00 00 00"}});
}

TEST(LssRk5c, Figures17To21InquireNodeIdAndAddress) {
  Rk5c device;
  replay(device, {
                     configuration_state,
                     {386, "7E5 5E 00 00 00 00 00 00 00", "7E4 5E 05 00 00 00 00 00 00"},
                     {401, "7E5 5A 00 00 00 00 00 00 00", "7E4 5A 93 00 00 00 00 00 00"},
                     {412, "7E5 5B 00 00 00 00 00 00 00", "7E4 5B 52 4B 35 43 00 00 00"},
                     {423, "7E5 5C 00 00 00 00 00 00 00", "7E4 5C 01 00 01 00 00 00 00"},
                     {434, "7E5 5D 00 00 00 00 00 00 00", "7E4 5D 34 12 01 15 00 00 00"},
                 });
}

TEST(LssRk5c, Figures22And23IdentifyTheDevice) {
  Rk5c device;
  replay(device, {
                     {451, "7E5 46 93 00 00 00 00 00 00", ""},
                     {452, "7E5 47 52 4B 35 43 00 00 00", ""},
                     {453, "7E5 48 00 00 01 00 00 00 00", ""},
                     {454, "7E5 49 FF FF 01 00 00 00 00", ""},
                     {455, "7E5 4A 01 00 01 15 00 00 00", ""},
                     {456, "7E5 4B FF FF 01 15 00 00 00", "7E4 4F 00 00 00 00 00 00 00"},
                 });
}

TEST(LssRk5c, Figures24And25IdentifyTheDeviceThatHasNoNodeId) {
  Rk5c configured;
  replay(configured, {{490, "7E5 4C 00 00 00 00 00 00 00", ""}});
  Rk5c stuck{unconfigured_node_id};
  EXPECT_EQ(stuck.state, NmtState::initialisation);
  replay(stuck, {{490, "7E5 4C 00 00 00 00 00 00 00", "7E4 50 00 00 00 00 00 00 00"}});
}

TEST(LssRk5c, ServesLssInPreOperationalAndOperationalButNotInStopped) {
  Rk5c device;
  const std::vector<Row> inquiry = {configuration_state,
                                    {386, "7E5 5E 00 00 00 00 00 00 00", "7E4 5E 05 00 00 00 00 00 00"}};
  replay(device, inquiry);
  device.enter(NmtState::operational);
  replay(device, inquiry);
  device.enter(NmtState::stopped);
  replay(device, {configuration_state, {386, "7E5 5E 00 00 00 00 00 00 00", ""}});
}

}  // namespace
