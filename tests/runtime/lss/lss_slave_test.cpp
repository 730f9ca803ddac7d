/// The LSS slave: LSS states, node-ID, inquiry, identification, and NMT states.
#include <gtest/gtest.h>

#include <canopen/lss/lss_slave.hpp>
#include <string>
#include <vector>

#include "lss_bench.hpp"

namespace {

using bench::ConfiguredDevice;
using bench::LssDevice;
using bench::to_configuration;
using bench::to_waiting;
using canopen::LssOptions;
using canopen::LssState;
using canopen::NmtState;
using canopen::NodeId;
using canopen::unconfigured_node_id;

constexpr auto inquire_node_id = "7E5 5E 00 00 00 00 00 00 00";
constexpr auto identify_non_configured = "7E5 4C 00 00 00 00 00 00 00";
constexpr auto fastscan_reset = "7E5 51 00 00 00 00 80 00 00";
constexpr auto identified = "7E4 4F 00 00 00 00 00 00 00";
constexpr auto store = "7E5 17 00 00 00 00 00 00 00";

TEST(LssSlave, SwitchesToConfigurationAndBackWithoutAnAnswer) {
  LssDevice device;
  EXPECT_EQ(device.slave.state(), LssState::waiting);
  EXPECT_EQ(device.ask(to_configuration), "");
  EXPECT_EQ(device.slave.state(), LssState::configuration);
  EXPECT_EQ(device.ask(to_waiting), "");
  EXPECT_EQ(device.slave.state(), LssState::waiting);
}

TEST(LssSlave, IgnoresAnUnknownModeOfSwitchStateGlobal) {
  LssDevice device;
  EXPECT_EQ(device.ask("7E5 04 02 00 00 00 00 00 00"), "");
  EXPECT_EQ(device.slave.state(), LssState::waiting);
  device.ask(to_configuration);
  EXPECT_EQ(device.ask("7E5 04 FF 00 00 00 00 00 00"), "");
  EXPECT_EQ(device.slave.state(), LssState::configuration);
}

/// CiA 305: the slave is waiting after a reset, also in Initialisation, where a slave without node-ID is served.
TEST(LssSlave, WaitsAfterAResetWithoutANodeId) {
  LssDevice device{unconfigured_node_id};
  device.ask(to_configuration);
  EXPECT_EQ(device.slave.state(), LssState::configuration);
  device.reset_communication();
  EXPECT_EQ(device.slave.state(), LssState::waiting);
}

const std::vector<std::string> selection = {"7E5 40 93 00 00 00 00 00 00", "7E5 41 52 4B 35 43 00 00 00",
                                            "7E5 42 01 00 01 00 00 00 00", "7E5 43 34 12 01 15 00 00 00"};

TEST(LssSlave, AnswersSwitchStateSelectiveWhenItIsMeant) {
  LssDevice device;
  EXPECT_EQ(device.ask(selection[0]), "");
  EXPECT_EQ(device.ask(selection[1]), "");
  EXPECT_EQ(device.ask(selection[2]), "");
  EXPECT_EQ(device.slave.state(), LssState::waiting);
  EXPECT_EQ(device.ask(selection[3]), "7E4 44 00 00 00 00 00 00 00");
  EXPECT_EQ(device.slave.state(), LssState::configuration);
}

TEST(LssSlave, IsSilentWhenOneOfTheFourNumbersIsAnotherOne) {
  for (std::size_t wrong = 0; wrong < 4; ++wrong) {
    LssDevice device;
    for (std::size_t i = 0; i < 4; ++i) {
      canopen::Frame frame = bench::frame(selection[i]);
      if (i == wrong) frame.data[4] ^= 0x80;
      EXPECT_EQ(device.ask(frame), "") << wrong;
    }
    EXPECT_EQ(device.slave.state(), LssState::waiting) << wrong;
  }
}

TEST(LssSlave, IsSelectedByTheFourNumbersInTheirOrderOnly) {
  LssDevice device;
  for (const unsigned i : {1U, 2U, 3U}) EXPECT_EQ(device.ask(selection[i]), "");
  for (const unsigned i : {0U, 2U, 3U}) EXPECT_EQ(device.ask(selection[i]), "");
  for (const unsigned i : {0U, 1U, 3U}) EXPECT_EQ(device.ask(selection[i]), "");
  for (const unsigned i : {0U, 1U, 2U, 1U, 3U}) EXPECT_EQ(device.ask(selection[i]), "");
  EXPECT_EQ(device.slave.state(), LssState::waiting);
  for (const unsigned i : {0U, 1U, 0U, 1U, 2U}) EXPECT_EQ(device.ask(selection[i]), "");
  EXPECT_EQ(device.ask(selection[3]), "7E4 44 00 00 00 00 00 00 00");
}

TEST(LssSlave, IsNotSelectedInConfigurationState) {
  ConfiguredDevice device;
  for (const std::string& frame : selection) EXPECT_EQ(device.ask(frame), "");
}

TEST(LssSlave, ConfiguresEveryNodeIdAndNoOther) {
  ConfiguredDevice device;
  for (unsigned node_id = 0; node_id < 256; ++node_id) {
    canopen::Frame request = bench::frame("7E5 11 00 00 00 00 00 00 00");
    request.data[1] = static_cast<std::uint8_t>(node_id);
    const bool allowed = (node_id >= 1 && node_id <= 127) || node_id == 255;
    EXPECT_EQ(device.ask(request), allowed ? "7E4 11 00 00 00 00 00 00 00" : "7E4 11 01 00 00 00 00 00 00") << node_id;
    if (allowed) {
      EXPECT_EQ(device.slave.pending_node_id().value(), node_id);
    }
  }
}

TEST(LssSlave, KeepsThePendingNodeIdWhenAnotherOneIsRefused) {
  ConfiguredDevice device;
  device.ask("7E5 11 20 00 00 00 00 00 00");
  EXPECT_EQ(device.ask("7E5 11 80 00 00 00 00 00 00"), "7E4 11 01 00 00 00 00 00 00");
  device.node_id_error = {canopen::lss::implementation_specific, 0x42};
  EXPECT_EQ(device.ask("7E5 11 21 00 00 00 00 00 00"), "7E4 11 FF 42 00 00 00 00 00");
  EXPECT_EQ(device.slave.pending_node_id(), NodeId{0x20});
}

TEST(LssSlave, KeepsItsNodeIdWhereItCannotBeTakenAway) {
  ConfiguredDevice<LssOptions{.unconfigurable = false}> device;
  EXPECT_EQ(device.ask("7E5 11 FF 00 00 00 00 00 00"), "7E4 11 01 00 00 00 00 00 00");
  EXPECT_EQ(device.slave.pending_node_id(), NodeId{5});
}

TEST(LssSlave, UsesANewNodeIdAfterResetCommunication) {
  ConfiguredDevice device;
  device.ask("7E5 11 20 00 00 00 00 00 00");
  EXPECT_EQ(device.ask(inquire_node_id), "7E4 5E 05 00 00 00 00 00 00");
  device.ask(to_waiting);
  EXPECT_EQ(device.slave.node_id(), NodeId{5});
  device.reset_communication();
  EXPECT_EQ(device.slave.node_id(), NodeId{0x20});
  EXPECT_EQ(device.ask(inquire_node_id), "");
  device.ask(to_configuration);
  EXPECT_EQ(device.ask(inquire_node_id), "7E4 5E 20 00 00 00 00 00 00");
}

TEST(LssSlave, ForgetsANodeIdThatIsNotStoredAtResetApplication) {
  ConfiguredDevice device;
  device.ask("7E5 11 20 00 00 00 00 00 00");
  device.slave.reset_application();
  device.reset_communication();
  EXPECT_EQ(device.slave.node_id(), NodeId{5});
}

TEST(LssSlave, KeepsAStoredNodeIdBeyondPowerOff) {
  ConfiguredDevice device;
  device.ask("7E5 11 20 00 00 00 00 00 00");
  device.ask("7E5 13 00 02 00 00 00 00 00");
  EXPECT_EQ(device.ask(store), "7E4 17 00 00 00 00 00 00 00");
  EXPECT_EQ(device.stored_node_id, NodeId{0x20});
  EXPECT_EQ(device.stored_bit_timing, (canopen::LssBitTiming{0, 2}));
  EXPECT_EQ(device.slave.persistent_node_id(), NodeId{0x20});
  EXPECT_EQ(device.slave.node_id(), NodeId{5});
  device.power_on();
  EXPECT_EQ(device.slave.node_id(), NodeId{0x20});
}

TEST(LssSlave, TellsWhyItCannotStore) {
  ConfiguredDevice device;
  device.ask("7E5 11 20 00 00 00 00 00 00");
  device.store_error = canopen::lss::store_not_supported;
  EXPECT_EQ(device.ask(store), "7E4 17 01 00 00 00 00 00 00");
  device.store_error = canopen::lss::storage_access_error;
  EXPECT_EQ(device.ask(store), "7E4 17 02 00 00 00 00 00 00");
  device.store_error = {canopen::lss::implementation_specific, 7};
  EXPECT_EQ(device.ask(store), "7E4 17 FF 07 00 00 00 00 00");
  EXPECT_EQ(device.slave.persistent_node_id(), NodeId{5});
}

TEST(LssSlave, TellsItsAddress) {
  ConfiguredDevice device;
  EXPECT_EQ(device.ask("7E5 5A 00 00 00 00 00 00 00"), "7E4 5A 93 00 00 00 00 00 00");
  EXPECT_EQ(device.ask("7E5 5B 00 00 00 00 00 00 00"), "7E4 5B 52 4B 35 43 00 00 00");
  EXPECT_EQ(device.ask("7E5 5C 00 00 00 00 00 00 00"), "7E4 5C 01 00 01 00 00 00 00");
  EXPECT_EQ(device.ask("7E5 5D 00 00 00 00 00 00 00"), "7E4 5D 34 12 01 15 00 00 00");
  EXPECT_EQ(device.ask(inquire_node_id), "7E4 5E 05 00 00 00 00 00 00");
}

TEST(LssSlave, LeavesReservedBytesOfARequestAlone) {
  ConfiguredDevice device;
  EXPECT_EQ(device.ask("7E5 5E FF FF FF FF FF FF FF"), "7E4 5E 05 00 00 00 00 00 00");
  EXPECT_EQ(device.ask("7E5 11 06 FF FF FF FF FF FF"), "7E4 11 00 00 00 00 00 00 00");
}

TEST(LssSlave, ServesConfigurationAndInquiryInConfigurationStateOnly) {
  LssDevice device;
  for (const char* request :
       {"7E5 11 20 00 00 00 00 00 00", "7E5 13 00 02 00 00 00 00 00", "7E5 15 0A 00 00 00 00 00 00", store,
        "7E5 5A 00 00 00 00 00 00 00", "7E5 5B 00 00 00 00 00 00 00", "7E5 5C 00 00 00 00 00 00 00",
        "7E5 5D 00 00 00 00 00 00 00", inquire_node_id}) {
    EXPECT_EQ(device.ask(request), "") << request;
  }
  EXPECT_EQ(device.slave.pending_node_id(), NodeId{5});
  EXPECT_FALSE(device.slave.next_deadline());
}

/// Sends an identify remote slave service with these ranges of revision and serial numbers.
std::string identify(LssDevice<>& device, std::uint32_t revision_low, std::uint32_t revision_high,
                     std::uint32_t serial_low, std::uint32_t serial_high, std::uint32_t vendor_id = 0x93,
                     std::uint32_t product_code = 0x4335'4B52) {
  const std::uint32_t words[] = {vendor_id, product_code, revision_low, revision_high, serial_low, serial_high};
  std::string answers;
  for (std::uint8_t i = 0; i < 6; ++i) {
    const auto command = static_cast<canopen::lss::Command>(0x46 + i);
    answers += device.ask(canopen::lss::make_frame(0x7E5, command, words[i]));
  }
  return answers;
}

TEST(LssSlave, IdentifiesItselfWithinTheRangesAndAtTheirEnds) {
  LssDevice device;
  EXPECT_EQ(identify(device, 0, 0xFFFF'FFFF, 0, 0xFFFF'FFFF), identified);
  EXPECT_EQ(identify(device, 0x0001'0001, 0x0001'0001, 0x1501'1234, 0x1501'1234), identified);
  EXPECT_EQ(identify(device, 0x0001'0000, 0x0001'FFFF, 0x1501'1234, 0x1501'1235), identified);
  device.ask(to_configuration);
  EXPECT_EQ(identify(device, 0, 0xFFFF'FFFF, 0, 0xFFFF'FFFF), identified);
}

TEST(LssSlave, ComparesTheMajorRevisionNumber) {
  LssDevice device;
  EXPECT_EQ(identify(device, 0x0001'0002, 0x0001'0000, 0, 0xFFFF'FFFF), identified);
  EXPECT_EQ(identify(device, 0x0002'0000, 0xFFFF'FFFF, 0, 0xFFFF'FFFF), "");
  EXPECT_EQ(identify(device, 0, 0x0000'FFFF, 0, 0xFFFF'FFFF), "");
}

TEST(LssSlave, DoesNotIdentifyItselfForAnother) {
  LssDevice device;
  EXPECT_EQ(identify(device, 0, 0xFFFF'FFFF, 0x1501'1235, 0xFFFF'FFFF), "");
  EXPECT_EQ(identify(device, 0, 0xFFFF'FFFF, 0, 0x1501'1233), "");
  EXPECT_EQ(identify(device, 0, 0xFFFF'FFFF, 0, 0xFFFF'FFFF, 0x94), "");
  EXPECT_EQ(identify(device, 0, 0xFFFF'FFFF, 0, 0xFFFF'FFFF, 0x93, 0x4335'4B53), "");
}

TEST(LssSlave, DoesNotMixSelectionAndIdentification) {
  LssDevice device;
  for (const char* request :
       {"7E5 40 93 00 00 00 00 00 00", "7E5 47 52 4B 35 43 00 00 00", "7E5 48 00 00 00 00 00 00 00",
        "7E5 49 FF FF FF FF 00 00 00", "7E5 4A 00 00 00 00 00 00 00", "7E5 4B FF FF FF FF 00 00 00",
        "7E5 44 00 00 00 00 00 00 00", "7E5 45 00 00 00 00 00 00 00"}) {
    EXPECT_EQ(device.ask(request), "") << request;
  }
}

TEST(LssSlave, IdentifiesItselfAsNonConfiguredWithoutNodeIdOnly) {
  LssDevice configured;
  EXPECT_EQ(configured.ask(identify_non_configured), "");
  EXPECT_EQ(configured.ask(fastscan_reset), "");
  LssDevice device{unconfigured_node_id};
  EXPECT_EQ(device.state, NmtState::initialisation);
  EXPECT_EQ(device.ask(identify_non_configured), "7E4 50 00 00 00 00 00 00 00");
  device.ask(to_configuration);
  EXPECT_EQ(device.ask(identify_non_configured), "7E4 50 00 00 00 00 00 00 00");
  device.ask("7E5 11 20 00 00 00 00 00 00");
  EXPECT_EQ(device.ask(identify_non_configured), "");
}

TEST(LssSlave, LeavesInitialisationWhenItHasANodeIdAndIsSwitchedBackToWaiting) {
  LssDevice device{unconfigured_node_id};
  device.ask(to_configuration);
  EXPECT_EQ(device.ask(inquire_node_id), "7E4 5E FF 00 00 00 00 00 00");
  device.ask(to_waiting);
  EXPECT_EQ(device.state, NmtState::initialisation);
  device.ask(to_configuration);
  EXPECT_EQ(device.ask("7E5 11 20 00 00 00 00 00 00"), "7E4 11 00 00 00 00 00 00 00");
  EXPECT_EQ(device.ask(inquire_node_id), "7E4 5E FF 00 00 00 00 00 00");
  EXPECT_EQ(device.state, NmtState::initialisation);
  device.ask(to_waiting);
  EXPECT_EQ(device.state, NmtState::pre_operational);
  EXPECT_EQ(device.slave.node_id(), NodeId{0x20});
}

TEST(LssSlave, GoesBackToInitialisationWhenItsNodeIdIsTakenAway) {
  ConfiguredDevice device;
  EXPECT_EQ(device.ask("7E5 11 FF 00 00 00 00 00 00"), "7E4 11 00 00 00 00 00 00 00");
  EXPECT_EQ(device.ask(identify_non_configured), "");
  device.ask(to_waiting);
  EXPECT_EQ(device.state, NmtState::pre_operational);
  device.reset_communication();
  EXPECT_EQ(device.state, NmtState::initialisation);
  EXPECT_EQ(device.ask(identify_non_configured), "7E4 50 00 00 00 00 00 00 00");
}

TEST(LssSlave, ServesPreOperationalAndStopped) {
  LssDevice device;
  device.ask(to_configuration);
  EXPECT_EQ(device.ask(inquire_node_id), "7E4 5E 05 00 00 00 00 00 00");
  device.enter(NmtState::stopped);
  EXPECT_EQ(device.ask(inquire_node_id), "7E4 5E 05 00 00 00 00 00 00");
  device.enter(NmtState::operational);
  EXPECT_EQ(device.ask(inquire_node_id), "");
  EXPECT_EQ(device.ask(to_configuration), "");
  device.enter(NmtState::pre_operational);
  EXPECT_EQ(device.slave.state(), LssState::waiting);
  EXPECT_EQ(device.ask(inquire_node_id), "");
}

TEST(LssSlave, ServesWhatItsOptionsSay) {
  LssDevice<LssOptions{.served_in_stopped = false, .served_in_operational = true}> device;
  device.ask(to_configuration);
  device.enter(NmtState::operational);
  EXPECT_EQ(device.ask(inquire_node_id), "7E4 5E 05 00 00 00 00 00 00");
  device.enter(NmtState::stopped);
  EXPECT_EQ(device.ask(inquire_node_id), "");
}

TEST(LssSlave, ServesNothingBetweenResetAndPreOperational) {
  LssDevice device;
  device.slave.enter(NmtState::initialisation);
  EXPECT_EQ(device.ask(to_configuration), "");
  EXPECT_EQ(device.slave.state(), LssState::waiting);
}

TEST(LssSlave, IsDeafBeforeItIsStarted) {
  canopen::LssSlave<> slave;
  LssDevice device;
  slave.on_frame(bench::frame(to_configuration), LssDevice<>::Hooks{device}, canopen::TimePoint{});
  slave.on_frame(bench::frame(identify_non_configured), LssDevice<>::Hooks{device}, canopen::TimePoint{});
  EXPECT_EQ(slave.state(), LssState::waiting);
  EXPECT_FALSE(slave.has_reply());
}

TEST(LssSlave, KeepsItsAnswerUntilTheBusHasRoom) {
  ConfiguredDevice device;
  device.bus.room = 0;
  EXPECT_EQ(device.ask(inquire_node_id), "");
  EXPECT_TRUE(device.slave.has_reply());
  device.bus.room = 1;
  EXPECT_TRUE(device.slave.serve(device.bus));
  EXPECT_EQ(device.bus.take(), "7E4 5E 05 00 00 00 00 00 00");
  EXPECT_FALSE(device.slave.has_reply());
  EXPECT_TRUE(device.slave.serve(device.bus));
  EXPECT_EQ(device.bus.take(), "");
}

TEST(LssSlave, ForgetsItsAnswerAtResetCommunication) {
  ConfiguredDevice device;
  device.bus.room = 0;
  device.ask(inquire_node_id);
  device.reset_communication();
  EXPECT_FALSE(device.slave.has_reply());
}

}  // namespace
