/// The output of the commands for a live bus: identities, tables, the state of a monitored bus.
#include <gtest/gtest.h>

#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "monitor/monitor_view.hpp"
#include "online/identity.hpp"
#include "online/live_entry.hpp"
#include "text/text_table.hpp"

namespace edsc {
namespace {

constexpr Identity sheet{0x192, 0x93, 5, 0x0001'0002, {}};

Identity with(std::optional<std::uint32_t> Identity::*number, std::optional<std::uint32_t> value) {
  Identity identity = sheet;
  identity.*number = value;
  return identity;
}

TEST(Identity, FitsByVendorProductAndRevision) {
  EXPECT_EQ(compare_identity(sheet, sheet), IdentityMatch::same);
  EXPECT_EQ(compare_identity(sheet, with(&Identity::serial_number, 7)), IdentityMatch::same);
  EXPECT_EQ(compare_identity(sheet, with(&Identity::revision_number, 0x0001'0003)), IdentityMatch::minor_revision);
  EXPECT_EQ(compare_identity(sheet, with(&Identity::revision_number, 0x0002'0002)), IdentityMatch::major_revision);
  EXPECT_EQ(compare_identity(sheet, with(&Identity::product_code, 6)), IdentityMatch::other);
  EXPECT_EQ(compare_identity(sheet, with(&Identity::vendor_id, 0x94)), IdentityMatch::other);
  EXPECT_EQ(compare_identity(sheet, with(&Identity::device_type, 0x191)), IdentityMatch::other);
}

/// An EDS without vendor-ID is common; the numbers that it contains must still match.
TEST(Identity, ComparesEachNumberThatBothState) {
  const Identity without_vendor = with(&Identity::vendor_id, {});
  EXPECT_EQ(compare_identity(without_vendor, sheet), IdentityMatch::same);
  EXPECT_EQ(compare_identity(without_vendor, with(&Identity::product_code, 6)), IdentityMatch::other);
  EXPECT_EQ(compare_identity(without_vendor, with(&Identity::device_type, 0x191)), IdentityMatch::other);
  EXPECT_EQ(compare_identity({0x192, {}, {}, {}, {}}, sheet), IdentityMatch::same);
  EXPECT_EQ(compare_identity({0x192, {}, {}, {}, {}}, with(&Identity::device_type, 0x191)), IdentityMatch::other);
  EXPECT_EQ(compare_identity({{}, {}, {}, 0x0002'0000, {}}, sheet), IdentityMatch::major_revision);
  EXPECT_EQ(compare_identity({}, sheet), IdentityMatch::unknown);
  EXPECT_EQ(compare_identity(sheet, {}), IdentityMatch::unknown);
}

TEST(Identity, NamesWhatDiffers) {
  EXPECT_EQ(identity_differences(sheet, {0x192, 0x94, 6, 0x0001'0002, 1}),
            "vendor-ID is 00000094h, expected 00000093h; product code is 00000006h, expected 00000005h");
}

TEST(Identity, NamesWhatIsNotCompared) {
  EXPECT_EQ(names_of(not_compared(sheet, sheet)), "");
  EXPECT_EQ(names_of(not_compared(with(&Identity::vendor_id, {}), with(&Identity::revision_number, {}))),
            "vendor-ID, revision number");
  EXPECT_EQ(names_of(not_compared(with(&Identity::serial_number, 7), sheet)), "serial number");
  EXPECT_TRUE(not_compared(sheet, {}).front().in_sheet);
}

TEST(TextTable, AlignsColumnsByCodePoints) {
  TextTable table;
  table.add({"a", "bb", "c"});
  table.add({"\xC3\xA4\xC3\xB6", "b", ""});
  EXPECT_EQ(table.lines(), (std::vector<std::string>{"a   bb  c", "\xC3\xA4\xC3\xB6  b"}));
}

TEST(CutToWidth, CountsCodePointsAndNoColours) {
  EXPECT_EQ(cut_to_width("abcdef", 4), "abcd");
  EXPECT_EQ(cut_to_width("\xC3\xA4\xC3\xB6\xC3\xBC", 2), "\xC3\xA4\xC3\xB6");
  EXPECT_EQ(cut_to_width("\x1B[1mabcdef\x1B[0m", 4), "\x1B[1mabcd\x1B[0m");
  EXPECT_EQ(cut_to_width("\x1B[1mab\x1B[0m", 4), "\x1B[1mab\x1B[0m");
}

TEST(CutToWidth, LeavesNoControlCharacterOfADevice) { EXPECT_EQ(cut_to_width("a\tb\x7F", 9), "a.b."); }

using canopen::NmtState;

Message message_of(Service service, std::uint8_t node_id, std::optional<NmtState> state = {}) {
  Message message;
  message.service = service;
  message.node_id = node_id;
  message.state = state;
  return message;
}

canopen::Frame nmt(std::uint8_t command, std::uint8_t node_id) { return {0, 2, false, false, {command, node_id}}; }

/// A node does not confirm NMT commands and need not send heartbeats.
TEST(MonitorState, AssumesWhereNmtCommandsAndTpdosLead) {
  MonitorState state;
  const auto shown = [&](std::uint8_t node_id) {
    const MonitoredNode& node = state.nodes().at(node_id);
    const auto text = [](std::optional<NmtState> one) { return std::string{one ? to_text(*one) : ""}; };
    return text(node.state) + "/" + text(node.assumed);
  };
  state.set_name(5, "drive");
  state.add(nmt(0x01, 5), message_of(Service::nmt, 5), 0);
  EXPECT_EQ(shown(5), "/operational");
  state.add(nmt(0x80, 0), message_of(Service::nmt, 0), 1);
  EXPECT_EQ(shown(5), "/pre-operational");
  state.add({0x185, 1, false, false, {}}, message_of(Service::tpdo, 5), 2);
  EXPECT_EQ(shown(5), "/operational");
  state.add({0x705, 1, false, false, {}}, message_of(Service::heartbeat, 5, NmtState::operational), 3);
  EXPECT_EQ(shown(5), "operational/");
  state.add(nmt(0x02, 5), message_of(Service::nmt, 5), 4);
  EXPECT_EQ(shown(5), "operational/stopped");
  state.add(nmt(0x81, 5), message_of(Service::nmt, 5), 5);
  EXPECT_EQ(shown(5), "operational/");
  EXPECT_FALSE(state.nodes().contains(7)) << "a command does not show that a node is there";
  state.add(nmt(0x01, 7), message_of(Service::nmt, 7), 6);
  state.add({0x87, 8, false, false, {}}, message_of(Service::emcy, 7), 7);
  EXPECT_EQ(shown(7), "/operational");
  const auto lines = monitor_lines(state, {}, 8);
  EXPECT_NE(lines[4].find("operational?"), std::string::npos) << lines[4];
  EXPECT_EQ(monitor_json(state, {}, 8)["nodes"][1]["assumed_state"], "operational");
}

TEST(FindType, TakesShortNamesAndThoseOfCia301) {
  EXPECT_EQ(find_type("u16"), canopen::find_data_type(6));
  EXPECT_EQ(find_type("unsigned16"), canopen::find_data_type(6));
  EXPECT_EQ(find_type("f32"), canopen::find_data_type(8));
  EXPECT_EQ(find_type("u17"), nullptr);
}

TEST(Rate, IsThatOfTheLastSpan) {
  Rate rate;
  rate.count(10);
  rate.take(2);
  EXPECT_EQ(rate.per_second(), 5);
  rate.take(1);
  EXPECT_EQ(rate.per_second(), 0);
  EXPECT_EQ(rate.total(), 10U);
}

Message heartbeat(NmtState state, Service service = Service::heartbeat) {
  Message message;
  message.service = service;
  message.node_id = 5;
  message.state = state;
  return message;
}

constexpr canopen::Frame frame{0x705, 1, false, false, {5}};

TEST(MonitorState, TellsAChangeOfStateAndNoOtherHeartbeat) {
  MonitorState state;
  EXPECT_TRUE(state.add(frame, heartbeat(NmtState::operational), 0));
  EXPECT_FALSE(state.add(frame, heartbeat(NmtState::operational), 100'000));
  EXPECT_TRUE(state.add(frame, heartbeat(NmtState::stopped), 200'000));
  EXPECT_EQ(state.nodes().at(5).heartbeats, 3U);
}

TEST(MonitorState, KnowsALateHeartbeatByTheOnesBefore) {
  MonitorState state;
  state.add(frame, heartbeat(NmtState::operational), 0);
  EXPECT_FALSE(state.nodes().at(5).is_late(60'000'000));  // the period is unknown after a single heartbeat
  state.add(frame, heartbeat(NmtState::operational), 500'000);
  EXPECT_FALSE(state.nodes().at(5).is_late(1'600'000));
  EXPECT_TRUE(state.nodes().at(5).is_late(1'600'001));
  EXPECT_TRUE(state.add(frame, heartbeat(NmtState::operational), 3'000'000));  // back again
  EXPECT_FALSE(state.nodes().at(5).is_late(9'000'000));
}

TEST(MonitorState, StartsAnewWithABootUpMessage) {
  MonitorState state;
  state.add(frame, heartbeat(NmtState::operational), 0);
  EXPECT_TRUE(state.add(frame, heartbeat(NmtState::initialisation, Service::boot_up), 10'000));
  EXPECT_TRUE(state.add(frame, heartbeat(NmtState::initialisation, Service::boot_up), 20'000));
  EXPECT_EQ(state.nodes().at(5).heartbeats, 1U);
}

Message tpdo(std::string text) {
  Message message;
  message.service = Service::tpdo;
  message.node_id = 5;
  message.number = 1;
  message.text = std::move(text);
  return message;
}

canopen::Frame pdo_frame(std::uint8_t size, std::uint8_t last) {
  canopen::Frame one{0x185, size, false, false, {}};
  one.data[size - 1U] = last;
  return one;
}

TEST(MonitorState, TellsAPdoWhenItsOctetsChange) {
  MonitorState state;
  EXPECT_TRUE(state.add(pdo_frame(1, 1), tpdo("Speed = 1"), 0));
  EXPECT_FALSE(state.add(pdo_frame(1, 1), tpdo("Speed = 1"), 1));
  EXPECT_TRUE(state.add(pdo_frame(1, 2), tpdo("Speed = 2"), 2));
  EXPECT_TRUE(state.add(pdo_frame(2, 2), tpdo("Speed = 2, 1 byte more than mapped"), 3));
  EXPECT_TRUE(state.add(pdo_frame(2, 3), tpdo("Speed = 2, 1 byte more than mapped"), 4)) << "the text is the same";
  EXPECT_FALSE(state.add(pdo_frame(2, 3), tpdo("in other words"), 5));
  EXPECT_EQ(state.pdos().begin()->second.text, "in other words");
  EXPECT_EQ(state.pdos().begin()->second.frames.total(), 6U);
}

TEST(MonitorState, TellsAPdoWhenItsMappingChanges) {
  MonitorState state;
  Message message = tpdo("A = 0");
  MessageValue value;
  value.index = 0x2000;
  value.name = "A";
  value.bits = 8;
  value.text_begin = 4;
  value.text_end = 5;
  message.values.push_back(value);
  EXPECT_TRUE(state.add(pdo_frame(1, 0), message, 0));
  EXPECT_FALSE(state.add(pdo_frame(1, 0), message, 1));
  message.values.front().index = 0x2001;
  EXPECT_TRUE(state.add(pdo_frame(1, 0), message, 2));
  EXPECT_EQ(state.pdos().begin()->second.values.front().index, 0x2001);
  message.text = "A = x";
  EXPECT_FALSE(state.add(pdo_frame(1, 0), message, 3));
  EXPECT_EQ(state.pdos().begin()->second.values.front().text, "x");
}

TEST(MonitorState, HasThePhysicalValueOfAQuantity) {
  Quantity quantity;
  quantity.symbol = "degC";
  quantity.scale = *Rational::of(1, 10);
  MonitorState state;
  Message message = tpdo("T = 21.5 degC");
  MessageValue value;
  value.type = canopen::find_data_type(static_cast<std::uint32_t>(canopen::DataType::integer16));
  value.quantity = &quantity;
  value.number = 215;
  value.bits = 16;
  value.text_begin = 4;
  value.text_end = message.text.size();
  message.values.push_back(value);
  state.add(pdo_frame(2, 0), message, 0);
  const MonitoredValue& shown = state.pdos().begin()->second.values.front();
  EXPECT_EQ(shown.text, "21.5 degC");
  EXPECT_EQ(shown.unit, "degC");
  EXPECT_EQ(shown.number, 21.5);
}

TEST(MonitorView, ShowsNodesPdosAndLoad) {
  MonitorState state;
  state.start(0);
  state.set_name(5, "Drive");
  state.add(frame, heartbeat(NmtState::operational), 500'000);
  state.add(frame, tpdo("Speed = 1 rpm"), 600'000);
  state.end(1'000'000);
  const MonitorView view{"socketcan:can0", 125, false};
  EXPECT_EQ(monitor_lines(state, view, 1'000'000), (std::vector<std::string>{
                                                       "socketcan:can0  1.0 s  2 frames  2.0 per s  load 0.1 %",
                                                       "",
                                                       "node  name   state        heard  last EMCY",
                                                       "   5  Drive  operational  0.5 s  -",
                                                       "",
                                                       "node  PDO     per s  values",
                                                       "   5  TPDO 1  1.0    Speed = 1 rpm",
                                                   }));
}

}  // namespace
}  // namespace edsc
