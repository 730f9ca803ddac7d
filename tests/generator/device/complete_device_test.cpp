#include "device/complete_device.hpp"

#include <gtest/gtest.h>

#include <sstream>
#include <string>
#include <vector>

#include "backend/json/device_view.hpp"
#include "support/device_from_text.hpp"

namespace edsc {
namespace {

using Rules = std::vector<std::string>;

/// A RECORD or ARRAY with sub-index 0 and UNSIGNED32s; `values` are their DefaultValues, "-" if there is none.
std::string record(std::string_view index, const std::vector<std::string>& values, std::string_view type = "0x7") {
  const auto key = [](const std::string& value) { return value == "-" ? "" : "DefaultValue=" + value + "\n"; };
  const int highest = static_cast<int>(values.size());
  std::string text = group(index, "Group", "0x9", highest + 1) +
                     var(std::string{index} + "sub0", "Count", "0x5", "const", key(std::to_string(highest)));
  for (int i = 0; i < highest; ++i) {
    text += var(std::string{index} + "sub" + std::to_string(i + 1), "Value", type, "rw",
                key(values[static_cast<std::size_t>(i)]));
  }
  return text;
}

/// `600h`, `600h + node-ID`
std::string cob_id(const DeviceFromText& text, std::uint16_t index, std::uint8_t sub_index) {
  const auto& value = text.entry(index, sub_index).default_value;
  if (!value) return "none";
  std::ostringstream out;
  out << std::hex << std::uppercase << value->bits << "h" << (value->plus_node_id ? " + node-ID" : "");
  return out.str();
}

// ---- COB-IDs: CiA 301, 7.3.5, tables 39 and 40 ----

struct Predefined {
  std::string index;
  int sub_index;
  std::string cob_id;
};

const Predefined predefined[] = {
    {"1005", 0, "80h"},
    {"1012", 0, "100h"},
    {"1014", 0, "80h + node-ID"},
    {"1200", 1, "600h + node-ID"},
    {"1200", 2, "580h + node-ID"},
    {"1201", 1, "80000000h"},
    {"127F", 2, "80000000h"},
    {"1280", 1, "80000000h"},
    {"12FF", 2, "80000000h"},
    {"1028", 1, "80000000h"},
    {"1400", 1, "200h + node-ID"},
    {"1401", 1, "300h + node-ID"},
    {"1402", 1, "400h + node-ID"},
    {"1403", 1, "500h + node-ID"},
    {"1404", 1, "80000000h"},
    {"15FF", 1, "80000000h"},
    {"1800", 1, "180h + node-ID"},
    {"1801", 1, "280h + node-ID"},
    {"1802", 1, "380h + node-ID"},
    {"1803", 1, "480h + node-ID"},
    {"1804", 1, "80000000h"},
    {"19FF", 1, "80000000h"},
};

std::string object_with(const Predefined& row, const std::string& value) {
  const std::string key = value == "-" ? "" : "DefaultValue=" + value + "\n";
  return row.sub_index == 0 ? var(row.index, "COB-ID", "0x7", "rw", key) : record(row.index, {value, value});
}

TEST(CompleteDevice, HasThePredefinedCobIdsWhereTheFileHasNone) {
  for (const Predefined& row : predefined) {
    const auto index = static_cast<std::uint16_t>(std::stoul(row.index, nullptr, 16));
    const auto sub_index = static_cast<std::uint8_t>(row.sub_index);
    for (const std::string& missing : std::vector<std::string>{"-", "0", "0x0"}) {
      const DeviceFromText text(object_with(row, missing));
      EXPECT_EQ(cob_id(text, index, sub_index), row.cob_id) << row.index << " " << missing;
      EXPECT_FALSE(text.entry(index, sub_index).default_value->clause.empty()) << row.index;
    }
  }
}

TEST(CompleteDevice, NotesACobIdThatItSupplies) {
  const DeviceFromText missing(var("1014", "COB-ID EMCY", "0x7"));
  const Diagnostic& note = missing.finding("cob-id-missing");
  EXPECT_EQ(note.severity, Severity::note);
  EXPECT_EQ(note.position.line, 1U);
  EXPECT_EQ(note.message, "1014h:00 \"COB-ID EMCY\" has no default value; using $NODEID+0x80 (CiA 301, 7.5.2.17)");
  const DeviceFromText zero(record("1201", {"0", "-"}));
  EXPECT_EQ(zero.line_of("cob-id-missing"), "DefaultValue=0");
  EXPECT_EQ(zero.finding("cob-id-missing").message,
            "1201h:01 \"Value\" is CAN-ID 000h, which is NMT; using 0x80000000, which is disabled (CiA 301, 7.5.2.33)");
}

TEST(CompleteDevice, AddsAKnownNodeId) {
  const DeviceFromText text(var("1014", "COB-ID EMCY", "0x7") + record("1200", {"-", "-"}), {}, {"", std::uint8_t{5}});
  EXPECT_EQ(cob_id(text, 0x1014, 0), "85h");
  EXPECT_EQ(cob_id(text, 0x1200, 1), "605h");
  EXPECT_EQ(cob_id(text, 0x1200, 2), "585h");
}

TEST(CompleteDevice, KeepsFlagsBesideCanId0) {
  const DeviceFromText text(var("1005", "SYNC", "0x7", "rw", "DefaultValue=0x40000000\n") +
                            var("1012", "TIME", "0x7", "rw", "DefaultValue=0x80000000\n") +
                            record("1800", {"0x40000000"}) + record("1804", {"0x40000000"}));
  EXPECT_EQ(cob_id(text, 0x1005, 0), "40000080h") << "produces SYNC";
  EXPECT_EQ(cob_id(text, 0x1012, 0), "80000100h") << "consumes TIME";
  EXPECT_EQ(cob_id(text, 0x1800, 1), "40000180h + node-ID") << "no remote frame";
  EXPECT_EQ(cob_id(text, 0x1804, 1), "C0000000h");
}

TEST(CompleteDevice, KeepsCobIdsThatTheFileHas) {
  const DeviceFromText text(var("1014", "EMCY", "0x7", "rw", "DefaultValue=0x80000000\n") +
                            record("1201", {"$NODEID+0x540", "$NODEID+0x4C0"}) + record("1400", {"0x80000000"}) +
                            record("1800", {"0x20000000"}));
  EXPECT_EQ(cob_id(text, 0x1014, 0), "80000000h");
  EXPECT_EQ(cob_id(text, 0x1201, 1), "540h + node-ID");
  EXPECT_EQ(cob_id(text, 0x1400, 1), "80000000h");
  EXPECT_EQ(cob_id(text, 0x1800, 1), "20000000h") << "29 bits, all 0";
  EXPECT_EQ(rules_of(text.diagnostics), Rules{});
}

TEST(CompleteDevice, HasTheDefaultSdoOfItsNodeWhateverTheFileSays) {
  for (const std::string& wrong : std::vector<std::string>{"0x80000000", "0x605", "$NODEID+0x640", "0x600"}) {
    const DeviceFromText text(record("1200", {wrong, "$NODEID+0x580"}));
    EXPECT_EQ(cob_id(text, 0x1200, 1), "600h + node-ID") << wrong;
    EXPECT_EQ(cob_id(text, 0x1200, 2), "580h + node-ID") << wrong;
    ASSERT_EQ(findings(text.diagnostics, "default-sdo-cob-id").size(), 1U) << wrong;
    EXPECT_EQ(text.line_of("default-sdo-cob-id"), "DefaultValue=" + wrong);
    EXPECT_EQ(text.finding("default-sdo-cob-id").severity, Severity::warning);
  }
  const DeviceFromText right(record("1200", {"$NODEID+0x600", "$NODEID+0x580"}));
  EXPECT_EQ(rules_of(right.diagnostics), Rules{});
  EXPECT_TRUE(right.entry(0x1200, 1).default_value->clause.empty()) << "the file has it";
}

TEST(CompleteDevice, HasTheDefaultSdoOfItsNodeInACopiedDcf) {
  const std::string commissioning = "[DeviceComissioning]\nNodeID=9\n";
  const DeviceFromText copied(commissioning + record("1200", {"0x605", "0x585"}));
  EXPECT_EQ(cob_id(copied, 0x1200, 1), "609h");
  EXPECT_EQ(cob_id(copied, 0x1200, 2), "589h");
  ASSERT_EQ(findings(copied.diagnostics, "default-sdo-cob-id").size(), 1U);
  EXPECT_EQ(copied.finding("default-sdo-cob-id").places, 2U);
  const DeviceFromText own(commissioning + record("1200", {"0x609", "$NODEID+0x580"}));
  EXPECT_EQ(rules_of(own.diagnostics), Rules{});
}

TEST(CompleteDevice, TakesAParameterValueOf0ForNone) {
  const DeviceFromText text("[DeviceComissioning]\nNodeID=9\n" + record("1800", {"$NODEID+0x180\nParameterValue=0"}));
  EXPECT_EQ(cob_id(text, 0x1800, 1), "189h");
}

TEST(CompleteDevice, CompletesModules) {
  const DeviceFromText text(
      "[SupportedModules]\nNrOfEntries=1\n[M1ModuleInfo]\nProductName=M\n[M1FixedObjects]\nNrOfEntries=1\n1=0x1801\n"
      "[M1Fixed1801]\nParameterName=TPDO\nObjectType=0x9\nSubNumber=2\n"
      "[M1Fixed1801sub0]\nParameterName=Count\nDataType=5\nAccessType=const\nDefaultValue=1\n"
      "[M1Fixed1801sub1]\nParameterName=COB-ID\nDataType=7\nAccessType=rw\n"
      "[ConnectedModules]\nNrOfEntries=1\n1=1\n" +
      var("2000", "Value", "5"));
  EXPECT_EQ(cob_id(text, 0x1801, 1), "280h + node-ID");
}

// ---- other values ----

TEST(CompleteDevice, SendsPdosWithoutTransmissionTypeAtAnEvent) {
  for (const std::string& index : std::vector<std::string>{"1400", "1800"}) {
    const DeviceFromText text(group(index, "PDO", "0x9", 3) +
                              var(index + "sub0", "Count", "5", "const", "DefaultValue=2\n") +
                              var(index + "sub1", "COB-ID", "7", "rw", "DefaultValue=0x80000000\n") +
                              var(index + "sub2", "Transmission type", "5"));
    EXPECT_EQ(text.entry(index == "1400" ? 0x1400 : 0x1800, 2).default_value->bits, 255U);
    EXPECT_EQ(rules_of(text.diagnostics), Rules{"implied-default"});
  }
}

TEST(CompleteDevice, TakesNoReservedTransmissionType) {
  const auto type_of = [](std::string_view index, const std::string& type) {
    const std::string sub{index};
    const DeviceFromText text(group(index, "PDO", "0x9", 3) +
                              var(sub + "sub0", "Count", "5", "const", "DefaultValue=2\n") +
                              var(sub + "sub1", "COB-ID", "7", "rw", "DefaultValue=0x80000000\n") +
                              var(sub + "sub2", "Transmission type", "5", "rw", "DefaultValue=" + type + "\n"));
    return text.device.objects.front().find(2)->default_value->bits;
  };
  EXPECT_EQ(type_of("1800", "0"), 0U);
  EXPECT_EQ(type_of("1800", "240"), 240U);
  EXPECT_EQ(type_of("1800", "241"), 255U);
  EXPECT_EQ(type_of("1800", "253"), 253U);
  EXPECT_EQ(type_of("1400", "253"), 255U) << "remote frames are for TPDOs";
}

TEST(CompleteDevice, StartsWithoutErrors) {
  const DeviceFromText text(var("1001", "Error register", "5", "ro", "DefaultValue=0x81\n") +
                            group("1003", "Errors", "0x8", 2) +
                            var("1003sub0", "Number of errors", "5", "rw", "DefaultValue=8\n") +
                            var("1003sub1", "Error", "7", "ro", "DefaultValue=0x1000\n"));
  EXPECT_EQ(text.entry(0x1001).default_value->bits, 0U);
  EXPECT_EQ(text.entry(0x1003, 0).default_value->bits, 0U);
  EXPECT_EQ(text.entry(0x1003, 1).default_value->bits, 0U);
  EXPECT_EQ(findings(text.diagnostics, "live-default").size(), 3U);
  EXPECT_EQ(text.finding("live-default").severity, Severity::note);
}

TEST(CompleteDevice, HasTheHighestSubIndexInSubIndex0) {
  const auto count_of = [](std::string_view index, const std::string& value) {
    const std::string sub{index};
    const DeviceFromText text(group(index, "Group", "0x9", 3) + var(sub + "sub0", "Count", "5", "const", value) +
                              var(sub + "sub1", "A", "7", "rw", "DefaultValue=0x80000000\n") +
                              var(sub + "sub2", "B", "7", "rw", "DefaultValue=0x80000000\n"));
    return text.device.objects.front().find(0)->default_value->bits;
  };
  EXPECT_EQ(count_of("1018", ""), 2U);
  EXPECT_EQ(count_of("1018", "DefaultValue=1\n"), 2U);
  EXPECT_EQ(count_of("1201", "DefaultValue=3\n"), 2U);
  EXPECT_EQ(count_of("2000", "DefaultValue=1\n"), 1U) << "may count something else";
  EXPECT_EQ(count_of("1600", "DefaultValue=1\n"), 1U) << "counts mapped objects";
}

TEST(CompleteDevice, HasNoReservedValues) {
  const DeviceFromText text(record("1010", {"0x65766173", "0x1"}) + record("1011", {"0x64616F6C", "0x0"}) +
                            var("1019", "Counter", "5", "rw", "DefaultValue=1\n") +
                            record("1029", {"3", "0x80"}, "0x5"));
  EXPECT_EQ(text.entry(0x1010, 1).default_value->bits, 1U) << "the signature means: on command";
  EXPECT_EQ(text.entry(0x1010, 2).default_value->bits, 1U);
  EXPECT_EQ(text.entry(0x1011, 1).default_value->bits, 1U);
  EXPECT_EQ(text.entry(0x1011, 2).default_value->bits, 0U);
  EXPECT_EQ(text.entry(0x1019).default_value->bits, 0U);
  EXPECT_EQ(text.entry(0x1029, 1).default_value->bits, 0U);
  EXPECT_EQ(text.entry(0x1029, 2).default_value->bits, 0x80U);
  EXPECT_EQ(rules_of(text.diagnostics), (Rules{"storage-capability", "sync-counter", "error-behavior"}));
}

TEST(CompleteDevice, StoresOnCommand) {
  const DeviceFromText text(record("1010", {"-", "0x3", "0x0", "0x2"}) + record("1011", {"-"}));
  EXPECT_EQ(text.entry(0x1010, 1).default_value->bits, 1U) << "no default value";
  EXPECT_EQ(text.entry(0x1010, 2).default_value->bits, 1U) << "a node does not store by itself";
  EXPECT_EQ(text.entry(0x1010, 3).default_value->bits, 0U);
  EXPECT_EQ(text.entry(0x1010, 4).default_value->bits, 0U);
  EXPECT_EQ(text.entry(0x1011, 1).default_value->bits, 1U);
  EXPECT_EQ(rules_of(text.diagnostics), (Rules{"storage-default", "storage-autonomous"}));
}

TEST(CompleteDevice, KeepsTheBitOfAnApplicationThatStoresByItself) {
  Options options;
  options.autonomous_storage = {2};
  const DeviceFromText text(record("1010", {"0x3", "0x3"}), options);
  EXPECT_EQ(text.entry(0x1010, 1).default_value->bits, 1U);
  EXPECT_EQ(text.entry(0x1010, 2).default_value->bits, 3U);
}

// A sub-index from 05h on stores what the options assign to it, or belongs to the application.
TEST(CompleteDevice, ReportsASubIndexOf1010hWithoutEntries) {
  const std::string sheet = record("1010", {"1", "1", "1", "1", "1"}) + var("2100", "Recipe", "5", "rw", "");
  const DeviceFromText unassigned(sheet);
  EXPECT_EQ(rules_of(unassigned.diagnostics), (Rules{"storage-sub-index"}));
  Options options;
  options.stored_by = {{{0x2100, {}}, 5}};
  const DeviceFromText assigned(sheet, options);
  EXPECT_EQ(rules_of(assigned.diagnostics), (Rules{}));
}

// ---- defaults that a running device does not have ----

std::vector<std::string> live_defaults(const std::string& sheet) {
  DeviceFromText text(sheet);
  check_device(text.named(), text.sheet, text.options, text.diagnostics);
  std::vector<std::string> lines;
  for (const Diagnostic& diagnostic : text.diagnostics.all()) {
    if (diagnostic.rule.text() == "live-default") lines.emplace_back(text.source.line(diagnostic.position.line));
  }
  return lines;
}

TEST(LiveDefaults, AreNoted) {
  const std::string mappable = "PDOMapping=1\n";
  EXPECT_EQ(live_defaults(var("6041", "Statusword", "6", "ro", mappable + "DefaultValue=0x250\n")),
            Rules{"DefaultValue=0x250"});
  EXPECT_EQ(live_defaults(var("1002", "Status", "7", "ro", "DefaultValue=3\n")), Rules{"DefaultValue=3"});
  EXPECT_EQ(live_defaults(record("1018", {"1", "2", "3", "4"})), Rules{"DefaultValue=4"}) << "the serial number";
  EXPECT_EQ(live_defaults(var("6041", "Statusword", "6", "ro", mappable + "DefaultValue=0\n")), Rules{});
  EXPECT_EQ(live_defaults(var("6040", "Controlword", "6", "rww", mappable + "DefaultValue=6\n")), Rules{});
  EXPECT_EQ(live_defaults(var("6502", "Modes", "7", "ro", "DefaultValue=5\n")), Rules{}) << "cannot be mapped";
}

TEST(LiveDefaults, MayRepeatASetting) {
  const auto sheet = [](const std::string& display) {
    return var("6060", "Modes of operation", "2", "rww", "PDOMapping=1\nDefaultValue=1\n") +
           var("6061", "Modes of operation display", "2", "ro", "PDOMapping=1\nDefaultValue=" + display + "\n");
  };
  EXPECT_EQ(live_defaults(sheet("1")), Rules{});
  EXPECT_EQ(live_defaults(sheet("3")), Rules{"DefaultValue=3"});
}

// ---- dump ----

TEST(CompleteDevice, SaysInTheDumpWhichValuesAreByCia301) {
  const DeviceFromText text(var("1005", "SYNC", "7", "rw", "DefaultValue=0x80\n") + var("1014", "EMCY", "7"));
  const nlohmann::ordered_json view = device_view(text.device, text.names.identifiers());
  EXPECT_FALSE(view["objects"][0]["entries"][0].contains("default_by"));
  EXPECT_EQ(view["objects"][1]["entries"][0]["default_value"], "$NODEID+0x80");
  EXPECT_EQ(view["objects"][1]["entries"][0]["default_by"], "CiA 301, 7.5.2.17");
}

}  // namespace
}  // namespace edsc
