#include <gtest/gtest.h>

#include <canopen/lss/lss_slave.hpp>
#include <random>
#include <string>
#include <vector>

#include "lss_bench.hpp"

namespace {

using bench::LssDevice;
using bench::to_configuration;
using bench::to_waiting;
using canopen::LssOptions;
using canopen::LssState;
using canopen::NmtState;
using canopen::NodeId;
using canopen::unconfigured_node_id;
using namespace std::chrono_literals;

constexpr auto inquire_node_id = "7E5 5E 00 00 00 00 00 00 00";
constexpr auto identify_non_configured = "7E5 4C 00 00 00 00 00 00 00";
constexpr auto fastscan_reset = "7E5 51 00 00 00 00 80 00 00";
constexpr auto identified = "7E4 4F 00 00 00 00 00 00 00";
constexpr auto store = "7E5 17 00 00 00 00 00 00 00";

/// A slave in configuration state.
template <LssOptions options = LssOptions{}>
struct ConfiguredDevice : LssDevice<options> {
  explicit ConfiguredDevice(NodeId persistent = NodeId{5}) : LssDevice<options>{persistent} {
    this->ask(to_configuration);
  }
};

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

TEST(LssSlave, ConfiguresTheBitRatesOfItsDataSheet) {
  ConfiguredDevice<LssOptions{.bit_rates = 0b1'0001'0100}> device;  // 500, 125 and 10 kbit/s
  for (unsigned index = 0; index < 256; ++index) {
    canopen::Frame request = bench::frame("7E5 13 00 00 00 00 00 00 00");
    request.data[2] = static_cast<std::uint8_t>(index);
    const bool has = index == 2 || index == 4 || index == 8;
    EXPECT_EQ(device.ask(request), has ? "7E4 13 00 00 00 00 00 00 00" : "7E4 13 01 00 00 00 00 00 00") << index;
  }
}

TEST(LssSlave, HasAllRatesOfTheTableButTheReservedOneAndAutomaticDetection) {
  for (unsigned index = 0; index < 12; ++index) {
    const bool all = (canopen::lss::all_bit_rates >> index & 1) != 0;
    EXPECT_EQ(all, index < std::size(canopen::lss::bit_rates) && canopen::lss::bit_rates[index] != 0) << index;
  }
  ConfiguredDevice device;
  EXPECT_EQ(device.ask("7E5 13 00 05 00 00 00 00 00"), "7E4 13 01 00 00 00 00 00 00");
  EXPECT_EQ(device.ask("7E5 13 00 09 00 00 00 00 00"), "7E4 13 01 00 00 00 00 00 00");
  ConfiguredDevice<LssOptions{.bit_rates = 1 << canopen::lss::automatic_bit_rate}> detecting;
  EXPECT_EQ(detecting.ask("7E5 13 00 09 00 00 00 00 00"), "7E4 13 00 00 00 00 00 00 00");
}

TEST(LssSlave, HasNoOtherBitTimingTableUnlessTheManufacturerHas) {
  ConfiguredDevice device;
  EXPECT_EQ(device.ask("7E5 13 01 00 00 00 00 00 00"), "7E4 13 01 00 00 00 00 00 00");
  EXPECT_EQ(device.ask("7E5 13 80 00 00 00 00 00 00"), "7E4 13 01 00 00 00 00 00 00");
  ConfiguredDevice<LssOptions{.manufacturer_bit_timing = true}> own;
  EXPECT_EQ(own.ask("7E5 13 7F 00 00 00 00 00 00"), "7E4 13 01 00 00 00 00 00 00");
  EXPECT_EQ(own.ask("7E5 13 80 30 00 00 00 00 00"), "7E4 13 00 00 00 00 00 00 00");
  own.bit_timing_error = {canopen::lss::implementation_specific, 9};
  EXPECT_EQ(own.ask("7E5 13 80 31 00 00 00 00 00"), "7E4 13 FF 09 00 00 00 00 00");
  own.ask(store);
  EXPECT_EQ(own.stored_bit_timing, (canopen::LssBitTiming{128, 0x30}));
}

TEST(LssSlave, RefusesEveryBitRateWhereItIsFixed) {
  ConfiguredDevice<LssOptions{.bit_rates = 0}> device;
  EXPECT_EQ(device.ask("7E5 13 00 04 00 00 00 00 00"), "7E4 13 01 00 00 00 00 00 00");
  EXPECT_EQ(device.ask("7E5 15 0A 00 00 00 00 00 00"), "");
  EXPECT_FALSE(device.slave.next_deadline());
}

TEST(LssSlave, SwitchesTheBitRateBetweenTwoDelays) {
  ConfiguredDevice device;
  device.ask("7E5 13 00 02 00 00 00 00 00");
  EXPECT_TRUE(device.events.empty());
  EXPECT_EQ(device.ask("7E5 15 2C 01 00 00 00 00 00"), "");  // 300 ms
  device.pass(299ms);
  EXPECT_TRUE(device.events.empty());
  EXPECT_FALSE(device.slave.silent());
  device.pass(1ms);
  EXPECT_EQ(device.events, (std::vector<std::string>{"300 ms: stop"}));
  EXPECT_TRUE(device.slave.silent());
  EXPECT_EQ(device.slave.next_deadline(), canopen::TimePoint{600ms});
  device.pass(300ms);
  EXPECT_EQ(device.events, (std::vector<std::string>{"300 ms: stop", "600 ms: start 0.2"}));
  EXPECT_FALSE(device.slave.silent());
  EXPECT_FALSE(device.slave.next_deadline());
}

TEST(LssSlave, TalksBeforeTheSwitchAndAfterItButNotInTheMiddle) {
  ConfiguredDevice device;
  device.ask("7E5 15 0A 00 00 00 00 00 00");
  device.pass(9ms);
  EXPECT_EQ(device.ask(inquire_node_id), "7E4 5E 05 00 00 00 00 00 00");
  device.bus.room = 0;
  EXPECT_EQ(device.ask(inquire_node_id), "");
  device.pass(1ms);
  device.bus.room = 10;
  EXPECT_FALSE(device.slave.serve(device.bus));
  EXPECT_EQ(device.ask("7E5 5A 00 00 00 00 00 00 00"), "");
  EXPECT_EQ(device.pass(9ms), "");
  EXPECT_EQ(device.pass(1ms), "7E4 5E 05 00 00 00 00 00 00");
  EXPECT_EQ(device.ask(inquire_node_id), "7E4 5E 05 00 00 00 00 00 00");
}

TEST(LssSlave, ActivatesTheBitRateThatWasPendingWhenTheCommandCame) {
  ConfiguredDevice device;
  device.ask("7E5 13 00 02 00 00 00 00 00");
  device.ask("7E5 15 0A 00 00 00 00 00 00");
  device.ask("7E5 13 00 03 00 00 00 00 00");
  device.pass(20ms);
  EXPECT_EQ(device.events, (std::vector<std::string>{"10 ms: stop", "20 ms: start 0.2"}));
}

TEST(LssSlave, SwitchesTheBitRateAtOnceWithADelayOfZero) {
  ConfiguredDevice device;
  device.ask("7E5 15 00 00 00 00 00 00 00");
  device.pass(0ms);
  EXPECT_EQ(device.events, (std::vector<std::string>{"0 ms: stop", "0 ms: start 0.4"}));
}

TEST(LssSlave, EndsBothDelaysWhenServedLate) {
  ConfiguredDevice device;
  device.ask("7E5 15 0A 00 00 00 00 00 00");
  device.slave.on_time(LssDevice<>::Hooks{device}, canopen::TimePoint{25ms});
  EXPECT_EQ(device.events.size(), 2u);
  EXPECT_FALSE(device.slave.silent());
}

TEST(LssSlave, WaitsForTheLongestDelayOfAll) {
  ConfiguredDevice device;
  device.ask("7E5 15 FF FF 00 00 00 00 00");
  device.pass(131'069ms);
  EXPECT_TRUE(device.slave.silent());
  device.pass(1ms);
  EXPECT_EQ(device.events, (std::vector<std::string>{"65535 ms: stop", "131070 ms: start 0.4"}));
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

TEST(LssSlave, IgnoresFramesThatAreNoLssRequests) {
  LssDevice device;
  for (const char* frame : {"7E5 04 01", "7E5", "7E5 04 01 00 00 00 00 00", "7E4 04 01 00 00 00 00 00 00",
                            "000007E5 04 01 00 00 00 00 00 00", "7E5 R 8", "7E5 00 01 00 00 00 00 00 00",
                            "7E5 05 01 00 00 00 00 00 00", "7E5 FF 01 00 00 00 00 00 00"}) {
    EXPECT_EQ(device.ask(frame), "") << frame;
    EXPECT_EQ(device.slave.state(), LssState::waiting) << frame;
  }
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

// Fastscan

TEST(LssFastscan, AsksForTheBitsFromBitCheckOn) {
  LssDevice device{unconfigured_node_id};
  EXPECT_EQ(device.ask(fastscan_reset), identified);
  EXPECT_EQ(device.ask("7E5 51 00 00 00 00 1F 00 00"), identified);
  EXPECT_EQ(device.ask("7E5 51 00 00 00 80 1F 00 00"), "");
  EXPECT_EQ(device.ask("7E5 51 80 00 00 00 07 00 00"), identified);  // 93h = 1001 0011
  EXPECT_EQ(device.ask("7E5 51 80 00 00 00 04 00 00"), "");
  EXPECT_EQ(device.ask("7E5 51 90 00 00 00 04 00 00"), identified);
  EXPECT_EQ(device.ask("7E5 51 9F 00 00 00 04 00 00"), identified);
  EXPECT_EQ(device.ask("7E5 51 92 00 00 00 00 00 00"), "");
}

TEST(LssFastscan, GoesOnToTheNextNumberAndEndsInConfigurationState) {
  LssDevice device{unconfigured_node_id};
  device.ask(fastscan_reset);
  EXPECT_EQ(device.ask("7E5 51 93 00 00 00 00 00 01"), identified);
  EXPECT_EQ(device.ask("7E5 51 93 00 00 00 00 00 01"), "");
  EXPECT_EQ(device.ask("7E5 51 52 4B 35 43 00 01 02"), identified);
  EXPECT_EQ(device.ask("7E5 51 01 00 01 00 00 02 03"), identified);
  EXPECT_EQ(device.slave.state(), LssState::waiting);
  EXPECT_EQ(device.ask("7E5 51 34 12 01 15 00 03 00"), identified);
  EXPECT_EQ(device.slave.state(), LssState::configuration);
  EXPECT_EQ(device.ask(fastscan_reset), "");
}

TEST(LssFastscan, StaysWithANumberWhoseLastBitIsAskedFor) {
  LssDevice device{unconfigured_node_id};
  device.ask(fastscan_reset);
  EXPECT_EQ(device.ask("7E5 51 93 00 00 00 00 00 00"), identified);
  EXPECT_EQ(device.slave.state(), LssState::waiting);
  EXPECT_EQ(device.ask("7E5 51 93 00 00 00 00 00 01"), identified);
}

TEST(LssFastscan, BeginsAgainWithTheVendorIdAfterResetCommunication) {
  LssDevice device{unconfigured_node_id};
  device.ask("7E5 51 93 00 00 00 00 00 01");
  device.reset_communication();
  EXPECT_EQ(device.ask("7E5 51 93 00 00 00 00 00 01"), identified);
}

TEST(LssFastscan, TakesNoPartAnyMoreWhenANumberIsAnotherOne) {
  LssDevice device{unconfigured_node_id};
  device.ask(fastscan_reset);
  EXPECT_EQ(device.ask("7E5 51 92 00 00 00 00 00 01"), "");
  EXPECT_EQ(device.ask("7E5 51 52 4B 35 43 00 01 02"), "");
  EXPECT_EQ(device.ask("7E5 51 00 00 00 00 1F 01 01"), "");
  EXPECT_EQ(device.ask(fastscan_reset), identified);
  EXPECT_EQ(device.ask("7E5 51 93 00 00 00 00 00 01"), identified);
}

TEST(LssFastscan, BeginsAgainWithTheVendorIdAfterAReset) {
  LssDevice device{unconfigured_node_id};
  device.ask("7E5 51 93 00 00 00 00 00 01");
  EXPECT_EQ(device.ask(fastscan_reset), identified);
  EXPECT_EQ(device.ask("7E5 51 52 4B 35 43 00 01 02"), "");
  EXPECT_EQ(device.ask("7E5 51 93 00 00 00 00 00 01"), identified);
}

TEST(LssFastscan, IgnoresBitsAndNumbersThatDoNotExist) {
  LssDevice device{unconfigured_node_id};
  device.ask(fastscan_reset);
  EXPECT_EQ(device.ask("7E5 51 93 00 00 00 20 00 00"), "");
  EXPECT_EQ(device.ask("7E5 51 93 00 00 00 7F 00 00"), "");
  EXPECT_EQ(device.ask("7E5 51 93 00 00 00 81 00 00"), "");
  EXPECT_EQ(device.ask("7E5 51 93 00 00 00 00 04 00"), "");
  EXPECT_EQ(device.ask("7E5 51 93 00 00 00 00 00 04"), "");
  EXPECT_EQ(device.ask("7E5 51 93 00 00 00 00 00 01"), identified);
}

TEST(LssFastscan, IsNotServedWhereTheDeviceHasItNot) {
  LssDevice<LssOptions{.fastscan = false}> device{unconfigured_node_id};
  EXPECT_EQ(device.ask(fastscan_reset), "");
  EXPECT_EQ(device.ask(identify_non_configured), "7E4 50 00 00 00 00 00 00 00");
}

// Arbitrary frames

constexpr std::uint8_t commands[] = {0x04, 0x11, 0x13, 0x15, 0x17, 0x40, 0x41, 0x42, 0x43, 0x46, 0x47, 0x48,
                                     0x49, 0x4A, 0x4B, 0x4C, 0x51, 0x5A, 0x5B, 0x5C, 0x5D, 0x5E, 0x04, 0x51};

/// The command of the response that a slave may send to a request with this command; 0: no response.
std::uint8_t answer_to(std::uint8_t command) {
  switch (command) {
    case 0x11:
    case 0x13:
    case 0x17:
    case 0x5A:
    case 0x5B:
    case 0x5C:
    case 0x5D:
    case 0x5E: return command;
    case 0x43: return 0x44;
    case 0x4B:
    case 0x51: return 0x4F;
    case 0x4C: return 0x50;
    default: return 0;
  }
}

TEST(LssSlave, AnswersWellFormedFramesToWhateverComes) {
  std::mt19937 random{305};
  LssDevice device{unconfigured_node_id, {1, 2, 0x0001'0003, 4}};
  std::size_t answers = 0;
  for (int i = 0; i < 100'000; ++i) {
    canopen::Frame request{};
    request.id = random() % 16 == 0 ? random() % 0x800 : 0x7E5;
    request.size = random() % 16 == 0 ? static_cast<std::uint8_t>(random() % 9) : std::uint8_t{8};
    request.extended = random() % 64 == 0;
    request.remote = random() % 64 == 0;
    for (std::uint8_t& byte : request.data) byte = static_cast<std::uint8_t>(random() % 4 == 0 ? random() : 0);
    request.data[0] = commands[random() % std::size(commands)];
    if (random() % 8 == 0) request.data[0] = static_cast<std::uint8_t>(random());
    if (random() % 2 == 0) request.data[1] = static_cast<std::uint8_t>(random() % 5);
    const bool ours = request.id == 0x7E5 && request.size == 8 && !request.extended && !request.remote;
    const bool silent = device.slave.silent();
    const std::string answer = device.ask(request);
    if (!answer.empty()) {
      ++answers;
      ASSERT_TRUE(ours && !silent) << bench::text(request);
      const canopen::Frame frame = bench::frame(answer);
      ASSERT_EQ(frame.id, 0x7E4u);
      ASSERT_EQ(frame.size, 8);
      ASSERT_EQ(frame.data[0], answer_to(request.data[0])) << bench::text(request);
      for (const unsigned reserved : {5U, 6U, 7U}) ASSERT_EQ(frame.data[reserved], 0) << answer;
    }
    ASSERT_TRUE(device.slave.state() == LssState::waiting || device.slave.state() == LssState::configuration);
    for (const NodeId node_id : {device.slave.node_id(), device.slave.pending_node_id(), device.stored_node_id}) {
      ASSERT_TRUE(node_id.valid() || node_id == unconfigured_node_id) << int{node_id.value()};
    }
    ASSERT_EQ(device.state == NmtState::initialisation, device.slave.node_id() == unconfigured_node_id);
    ASSERT_EQ(device.slave.persistent_node_id(), device.stored_node_id);
    const auto deadline = device.slave.next_deadline();
    ASSERT_TRUE(!deadline || *deadline - device.now <= 65'535ms);
    if (random() % 512 == 0) device.reset_communication();
    device.pass(std::chrono::milliseconds{random() % 8192});
  }
  EXPECT_GT(answers, 3'000u);
}

}  // namespace
