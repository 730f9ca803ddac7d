#include <gtest/gtest.h>
#include <canopen/can/cob_id_check.hpp>

#include <cstddef>
#include <iterator>
#include <optional>
#include <string>
#include <vector>

#include "backend/cpp/cpp_view.hpp"
#include "backend/cpp/views.hpp"
#include "device/cob_id_parameter.hpp"
#include "support/device_from_text.hpp"

namespace edsc {
namespace {

/// An EDS with one COB-ID, in a VAR or as a sub-index of a RECORD.
std::string sheet_with_cob_id(std::string_view index, int sub_index, const std::string& value) {
  const std::string key = "DefaultValue=" + value + "\n";
  if (sub_index == 0) return var(index, "COB-ID", "0x7", "rw", key);
  const std::string highest = std::to_string(sub_index);
  return group(index, "Group", "0x9", sub_index + 1) +
         var(std::string{index} + "sub0", "Count", "5", "const", "DefaultValue=" + highest + "\n") +
         var(std::string{index} + "sub" + highest, "COB-ID", "0x7", "rw", key);
}

struct CobIdCase {
  std::string index;
  int sub_index;
  std::string value;
  bool restricted;
};

// CiA 301, 7.3.5, table 41.
// clang-format off
const CobIdCase cob_id_cases[] = {
    {"1800", 1, "$NODEID+0x180", false},
    {"1800", 1, "$NODEID+0x580", true},   // the device's own SDO response
    {"1800", 1, "$NODEID+0x680", true},   // 6E0h for node 96
    {"1800", 1, "$NODEID+0x6C0", true},
    {"1800", 1, "0x180", true},
    {"1800", 1, "0x181", false},
    {"1800", 1, "0x40000705", true},      // heartbeat
    {"1800", 1, "0x80000705", false},     // not valid
    {"1800", 1, "0x20000705", false},     // 29 bits
    {"1400", 1, "0x7F", true},
    {"1400", 1, "0x80", false},
    {"1005", 0, "0x40000001", true},
    {"1005", 0, "0x80000080", false},
    {"1012", 0, "0x80000105", true},      // bit 31: consumes TIME
    {"1014", 0, "$NODEID+0x80", false},
    {"1014", 0, "0x80", true},            // SYNC
    {"1201", 1, "$NODEID+0x600", true},   // the default SDO
    {"1201", 2, "$NODEID+0x540", true},   // 581h for node 65
    {"1201", 2, "$NODEID+0x4C0", false},
    {"1280", 1, "0x605", false},          // a client uses the default SDO of other nodes
    {"1280", 2, "0x585", false},
    {"1280", 1, "0x701", true},
};
// clang-format on

TEST(CobIdRules, RefuseACanIdThatCia301Restricts) {
  for (const CobIdCase& row : cob_id_cases) {
    DeviceFromText text(sheet_with_cob_id(row.index, row.sub_index, row.value));
    check_device(text.named(), text.sheet, text.options, text.diagnostics);
    const auto found = findings(text.diagnostics, "cob-id-restricted");
    EXPECT_EQ(found.size(), row.restricted ? 1U : 0U) << row.index << " " << row.value;
    for (const Finding& one : found) EXPECT_EQ(one.severity, Severity::error);
  }
}

TEST(CobIdRules, KnowTheNodeId) {
  DeviceFromText text(sheet_with_cob_id("1800", 1, "$NODEID+0x680"), {}, {"", std::uint8_t{5}});
  check_device(text.named(), text.sheet, text.options, text.diagnostics);
  EXPECT_TRUE(findings(text.diagnostics, "cob-id-restricted").empty()) << "685h";
}

/// CiA 301, 7.3.5: 6E0h to 6FFh are reserved.
TEST(CobIdRules, SayForWhichNodeIdsAFormulaIsRestricted) {
  DeviceFromText text(sheet_with_cob_id("1800", 1, "$NODEID+0x680"));
  check_device(text.named(), text.sheet, text.options, text.diagnostics);
  EXPECT_NE(text.finding("cob-id-restricted").message.find("for node-IDs 96 to 127 (CAN-ID 6E0h"), std::string::npos)
      << text.finding("cob-id-restricted").message;
}

/// The findings of `rule` in an EDS with this COB-ID of TPDO 1.
std::vector<Finding> found_in_tpdo_1(const std::string& value, std::string_view rule,
                                     std::optional<std::uint8_t> node_id = std::nullopt, const std::string& more = "") {
  DeviceFromText text(sheet_with_cob_id("1800", 1, value) + more, {}, {"", node_id});
  check_device(text.named(), text.sheet, text.options, text.diagnostics);
  return findings(text.diagnostics, rule);
}

TEST(CobIdRules, FindANodeIdThatIsAddedTwice) {
  for (const std::string value : {"$NODEID+0x181", "$NODEID+0x40000181", "$NODEID+0x1FF"}) {
    EXPECT_EQ(found_in_tpdo_1(value, "cob-id-node-id").size(), 1U) << value;
    EXPECT_EQ(found_in_tpdo_1(value, "cob-id-node-id", std::uint8_t{5}).size(), 1U) << value << " of node 5";
  }
  for (const std::string value : {"$NODEID+0x180", "$NODEID+0x40000180", "$NODEID+0x280", "$NODEID+0x80000181"}) {
    EXPECT_TRUE(found_in_tpdo_1(value, "cob-id-node-id").empty()) << value;
    EXPECT_TRUE(found_in_tpdo_1(value, "cob-id-node-id", std::uint8_t{5}).empty()) << value << " of node 5";
  }
}

/// A number where CiA 301, 7.3.5 adds the node-ID, with and without a node-ID of the device.
TEST(CobIdRules, FindACanIdOfAnotherNode) {
  EXPECT_EQ(found_in_tpdo_1("0x181", "cob-id-node-id").size(), 1U);
  EXPECT_EQ(found_in_tpdo_1("0x181", "cob-id-node-id", std::uint8_t{3}).size(), 1U);
  EXPECT_TRUE(found_in_tpdo_1("0x183", "cob-id-node-id", std::uint8_t{3}).empty());
  EXPECT_TRUE(found_in_tpdo_1("0x80000181", "cob-id-node-id", std::uint8_t{3}).empty()) << "not valid";
  EXPECT_TRUE(found_in_tpdo_1("0x201", "cob-id-node-id", std::uint8_t{3}).empty()) << "of another service";
}

TEST(CobIdRules, FindACanIdThatIsTheSameForEachNode) {
  for (const std::optional<std::uint8_t> node_id : {std::optional<std::uint8_t>{}, std::optional{std::uint8_t{3}}}) {
    DeviceFromText text(sheet_with_cob_id("1400", 1, "0x200") + sheet_with_cob_id("1801", 1, "0x40000280"), {},
                        {{}, node_id});
    check_device(text.named(), text.sheet, text.options, text.diagnostics);
    EXPECT_EQ(text.finding("cob-id-node-id").places, 2U);
    EXPECT_EQ(text.finding("cob-id-node-id").message,
              "1400h:01 \"COB-ID\" is 200h for each node; use $NODEID+0x200 to add the node-ID");
  }
}

TEST(CobIdRules, RefuseToSendOnTheCanIdOfSync) {
  EXPECT_EQ(found_in_tpdo_1("0x80", "cob-id-twice").size(), 1U);
  EXPECT_EQ(found_in_tpdo_1("0x80", "cob-id-twice", std::nullopt, var("1005", "SYNC", "7", "rw", "DefaultValue=0x80\n"))
                .size(),
            1U);
  EXPECT_TRUE(found_in_tpdo_1("0x80000080", "cob-id-twice").empty()) << "off";
  EXPECT_TRUE(found_in_tpdo_1("$NODEID+0x80", "cob-id-twice").empty())
      << "that of EMCY, which the device does not have";
}

TEST(CobIdRules, ReportACanIdOfManyServicesOnce) {
  std::string sheet;
  for (const std::string_view index : {"1800", "1801", "1802", "1803"}) sheet += sheet_with_cob_id(index, 1, "0x280");
  DeviceFromText text(sheet + sheet_with_cob_id("1804", 1, "$NODEID+0x27B"));
  check_device(text.named(), text.sheet, text.options, text.diagnostics);
  const Diagnostic& finding = text.finding("cob-id-twice");
  EXPECT_EQ(findings(text.diagnostics, "cob-id-twice").size(), 1U);
  EXPECT_EQ(finding.message,
            "1800h:01 \"COB-ID\", 1801h:01 \"COB-ID\", 1802h:01 \"COB-ID\", 1803h:01 \"COB-ID\" and 1804h:01 "
            "\"COB-ID\" have the same CAN-ID for node-ID 5");
  EXPECT_EQ(finding.notes.size(), 4U);
}

TEST(CobIdRules, SayWhatIsMeantByAFunctionCodeAlone) {
  DeviceFromText text(sheet_with_cob_id("1800", 1, "0x40000180"));
  check_device(text.named(), text.sheet, text.options, text.diagnostics);
  EXPECT_EQ(
      text.finding("cob-id-restricted").message,
      "1800h:01 \"COB-ID\" is CAN-ID 180h, which is restricted (reserved); use $NODEID+0x40000180 to add the node-ID");
}

/// The compiler rejects what the rule rejects.
TEST(CobIdRules, AreThoseOfTheCompiler) {
  for (const CobIdCase& row : cob_id_cases) {
    const DeviceFromText text(sheet_with_cob_id(row.index, row.sub_index, row.value));
    const auto index = static_cast<std::uint16_t>(std::stoul(row.index, nullptr, 16));
    const Value& value = *text.entry(index, static_cast<std::uint8_t>(row.sub_index)).default_value;
    const canopen::StartCobId start{index, static_cast<std::uint8_t>(row.sub_index),
                                    static_cast<std::uint32_t>(value.bits), value.plus_node_id};
    EXPECT_EQ(canopen::is_legal(start), !row.restricted) << row.index << " " << row.value;
  }
  for (const std::uint8_t sub_index : {std::uint8_t{1}, std::uint8_t{2}}) {
    const std::uint32_t base = sub_index == 1 ? 0x600 : 0x580;
    EXPECT_TRUE(canopen::is_legal({0x1200, sub_index, base, true}));
    EXPECT_TRUE(canopen::is_legal({0x1200, sub_index, base + 127, false}));
    EXPECT_FALSE(canopen::is_legal({0x1200, sub_index, base, false}));
    EXPECT_FALSE(canopen::is_legal({0x1200, sub_index, 0x8000'0000, false})) << "it always exists";
  }
}

// ---- headers that are generated in spite of errors ----

TEST(CobIdRules, LeaveAPdoOutWhoseCobIdIsRestricted) {
  const std::string mapping = group("1A00", "Mapping", "0x9", 2) +
                              var("1A00sub0", "Count", "5", "const", "DefaultValue=1\n") +
                              var("1A00sub1", "Entry", "7", "const", "DefaultValue=0x20000008\n") +
                              var("2000", "Value", "5", "ro", "PDOMapping=1\n");
  Diagnostics ignored;
  for (const std::string& value : std::vector<std::string>{"$NODEID+0x180", "$NODEID+0x580", "0"}) {
    const DeviceFromText text(sheet_with_cob_id("1800", 1, value) + mapping);
    const nlohmann::ordered_json view = cpp_view(text.named(), text.options, ignored);
    const bool wrong = value == "$NODEID+0x580";
    EXPECT_EQ(view["tpdos"].size(), wrong ? 0U : 1U) << value;
    ASSERT_EQ(view["pdos"].size(), 1U);
    EXPECT_EQ(view["pdos"][0]["broken"], wrong) << value;
    EXPECT_EQ(view["pdos"][0]["checked"], !wrong) << value;
    if (wrong) continue;
    EXPECT_EQ(view["pdos"][0]["check_arguments"], ", canopen::PdoParameters{.cob_id = 0x180, .plus_node_id = true}");
    EXPECT_EQ(view["pdos"][0]["any_left_out"], false);
  }
}

TEST(CobIdRules, LeaveOutOnlyThePdosOfACanIdThatAnotherHas) {
  std::string sheet = var("2000", "Value", "5", "ro", "PDOMapping=1\n");
  const char* const cob_ids[] = {"$NODEID+0x180", "$NODEID+0x180", "$NODEID+0x280", "$NODEID+0x380"};
  for (std::size_t i = 0; i < std::size(cob_ids); ++i) {
    const std::string mapping = "1A0" + std::to_string(i);
    sheet += sheet_with_cob_id("180" + std::to_string(i), 1, cob_ids[i]) + group(mapping, "Mapping", "0x9", 2) +
             var(mapping + "sub0", "Count", "5", "const", "DefaultValue=1\n") +
             var(mapping + "sub1", "Entry", "7", "const", "DefaultValue=0x20000008\n");
  }
  const DeviceFromText text(sheet);
  std::vector<std::string> types;
  for (const auto& row : distinct_pdos(text.device)) types.push_back(row["type"].get<std::string>());
  EXPECT_EQ(types, (std::vector<std::string>{"Tpdo1", "Tpdo3", "Tpdo4"}));
}

TEST(CobIdRules, GiveTheCompilerTheCobIdsOfTheServicesThatAreOn) {
  Diagnostics ignored;
  const auto rows_of = [&](std::string emcy) {
    const DeviceFromText text(var("1005", "SYNC", "7") + sheet_with_cob_id("1014", 0, std::move(emcy)) +
                              sheet_with_cob_id("1201", 1, "0"));
    return cpp_view(text.named(), text.options, ignored)["cob_ids"]["rows"];
  };
  const nlohmann::ordered_json rows = rows_of("$NODEID+0x480");
  ASSERT_EQ(rows.size(), 2U);
  EXPECT_EQ(rows[0]["text"], "canopen::StartCobId{0x1005, 0x00, 0x80}");
  EXPECT_EQ(rows[1]["text"], "canopen::StartCobId{0x1014, 0x00, 0x480, true}");
  EXPECT_EQ(rows_of("$NODEID+0x580").size(), 1U) << "an error; with --keep-going the headers compile";
}

// The runtime and edsc each have a table of COB-IDs; both agree on every entry.
TEST(CobIdTables, AgreeOnEachEntryOfTheCommunicationProfile) {
  for (unsigned index = 0x1000; index <= 0x1FFF; ++index) {
    for (unsigned sub_index = 0; sub_index <= 0xFF; ++sub_index) {
      const auto number = static_cast<std::uint16_t>(index);
      const auto sub = static_cast<std::uint8_t>(sub_index);
      const CobIdParameter* const known = find_cob_id_parameter(number, sub);
      const std::optional<canopen::CobIdEntries> used = canopen::find_cob_id_entries(number, sub);
      if (used) {
        ASSERT_NE(known, nullptr) << std::hex << index << ":" << sub_index;
        EXPECT_EQ(used->has_valid_bit, known->has_valid_bit) << std::hex << index << ":" << sub_index;
      } else if (known != nullptr) {
        // CiA 301 fixes 1200h; the others do not belong to a service that the runtime configures by COB-ID.
        EXPECT_TRUE(index == 0x1200 || known->service == CobIdService::emcy_consumer ||
                    known->service == CobIdService::sdo_client)
            << std::hex << index << ":" << sub_index;
      }
    }
  }
}

}  // namespace
}  // namespace edsc
