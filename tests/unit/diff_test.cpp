/// Two versions of a data sheet: what changed, and whom that breaks.
#include <fmt/format.h>
#include <gtest/gtest.h>

#include <fstream>
#include <iterator>
#include <set>
#include <string>
#include <vector>

#include "compare/compare_devices.hpp"
#include "compare/print_changes.hpp"
#include "device_from_text.hpp"

namespace edsc {
namespace {

/// One change, in short: `access-reduced 2000h:00 master`.
std::string in_short(const Change& change) {
  std::string text{kind_of(change.id).name};
  text += " " + change.entry;
  if (change.breaks_master) text += " master";
  if (change.breaks_pdo) text += " pdo";
  return text;
}

struct Compared {
  Compared(std::string old_text, std::string new_text, std::optional<std::uint8_t> node_id = std::nullopt)
      : before(std::move(old_text), {}, {"device", node_id}, "old.eds"),
        after(std::move(new_text), {}, {"device", node_id}, "new.eds"),
        changes(compare_devices(before.device, after.device)) {}

  [[nodiscard]] std::vector<std::string> short_list() const {
    std::vector<std::string> list;
    for (const Change& change : changes.all()) list.push_back(in_short(change));
    return list;
  }

  DeviceFromText before;
  DeviceFromText after;
  Changes changes;
};

using List = std::vector<std::string>;

List compare(std::string old_text, std::string new_text) {
  return Compared(std::move(old_text), std::move(new_text)).short_list();
}

/// 2000h with these keys.
std::string with(std::string_view keys, std::string_view access = "rw", std::string_view type = "0x0006") {
  return var("2000", "Speed", type, access, keys);
}

/// A TPDO or RPDO 1 that carries 2000h and what else `mapping` says.
std::string pdo(std::string_view cob_id, std::string_view transmission_type, const std::vector<std::string>& mapping,
                bool transmit = true) {
  const std::string communication = transmit ? "1800" : "1400";
  const std::string parameter = transmit ? "1A00" : "1600";
  std::string text =
      group(communication, "PDO", "9", 3) + var(communication + "sub0", "n", "5", "ro", "DefaultValue=2\n") +
      var(communication + "sub1", "COB-ID", "7", "rw", "DefaultValue=" + std::string{cob_id} + "\n") +
      var(communication + "sub2", "type", "5", "rw", "DefaultValue=" + std::string{transmission_type} + "\n") +
      group(parameter, "Mapping", "9", 3) +
      var(parameter + "sub0", "n", "5", "rw", "DefaultValue=" + std::to_string(mapping.size()) + "\n");
  for (std::size_t i = 0; i < mapping.size(); ++i) {
    text += var(parameter + "sub" + std::to_string(i + 1), "entry " + std::to_string(i + 1), "7", "rw",
                "DefaultValue=" + mapping[i] + "\n");
  }
  return text + var("2000", "Speed", "6", "rw", "PDOMapping=1\n") + var("2001", "Torque", "3", "rw", "PDOMapping=1\n");
}

TEST(ChangeTable, HasEachNameOnceWithAReason) {
  std::set<std::string_view> names;
  for (const ChangeKind& kind : all_change_kinds()) {
    EXPECT_TRUE(names.insert(kind.name).second) << kind.name;
    EXPECT_FALSE(kind.what.empty() || kind.reason.empty()) << kind.name;
  }
}

TEST(ChangeTable, StandsInTheDocuments) {
  std::ifstream file(EDSC_SOURCE_DIR "/docs/command-line.md");
  const std::string document{std::istreambuf_iterator<char>{file}, {}};
  for (const ChangeKind& kind : all_change_kinds()) {
    std::string who = kind.breaks_master ? "master" : "";
    if (kind.breaks_pdo) who += who.empty() ? "pdo" : ", pdo";
    const std::string row =
        fmt::format("| `{}` | {} | {}: {} |\n", kind.name, who.empty() ? "-" : who, kind.what, kind.reason);
    EXPECT_NE(document.find(row), std::string::npos) << row;
  }
}

TEST(Diff, FindsNothingBetweenADeviceAndItself) {
  EXPECT_EQ(compare(with("DefaultValue=1\n"), with("DefaultValue=0x1\n")), List{});
}

TEST(Diff, KnowsObjectsThatCameAndWent) {
  EXPECT_EQ(compare(with(""), with("") + var("2001", "b", "5")), (List{"object-added 2001h"}));
  EXPECT_EQ(compare(with("") + var("1FFF", "b", "5"), with("")), (List{"object-removed 1FFFh master"}));
}

TEST(Diff, KnowsSubIndicesThatCameAndWent) {
  const std::string one =
      group("2000", "a", "9", 2) + var("2000sub0", "n", "5", "ro", "DefaultValue=1\n") + var("2000sub1", "x", "5");
  const std::string two = one + var("2000sub2", "y", "5");
  EXPECT_EQ(compare(one, two), (List{"entry-added 2000h:02"}));
  EXPECT_EQ(compare(two, one), (List{"entry-removed 2000h:02 master"}));
}

TEST(Diff, BreaksAMasterByAnotherType) {
  EXPECT_EQ(compare(with("DefaultValue=1\n"), with("DefaultValue=2\n", "rw", "0x0007")),
            (List{"data-type 2000h:00 master"}));
}

TEST(Diff, BreaksAMasterByAnotherObjectCode) {
  const std::string record = group("2000", "Speed", "9", 1) + var("2000sub0", "n", "6");
  const std::string array = group("2000", "Speed", "8", 1) + var("2000sub0", "n", "6");
  EXPECT_EQ(compare(record, array), (List{"object-type 2000h master"}));
}

TEST(Diff, BreaksAMasterByAccessThatIsTakenAway) {
  EXPECT_EQ(compare(with(""), with("", "ro")), (List{"access-reduced 2000h:00 master"}));
  EXPECT_EQ(compare(with("", "ro"), with("")), (List{"access-extended 2000h:00"}));
  EXPECT_EQ(compare(with("", "ro"), with("", "wo")), (List{"access-reduced 2000h:00 master"}));
  EXPECT_EQ(compare(with("", "ro"), with("", "const")), (List{"access-other 2000h:00"}));
}

TEST(Diff, BreaksPdosByMappingThatIsTakenAway) {
  EXPECT_EQ(compare(with("PDOMapping=1\n"), with("")), (List{"mapping-reduced 2000h:00 master pdo"}));
  EXPECT_EQ(compare(with(""), with("PDOMapping=1\n")), (List{"mapping-extended 2000h:00"}));
  EXPECT_EQ(compare(with("PDOMapping=1\n"), with("PDOMapping=1\n", "rww")),
            (List{"access-other 2000h:00", "mapping-reduced 2000h:00 master pdo"}));
}

TEST(Diff, TellsNarrowedLimitsFromWidenedOnes) {
  EXPECT_EQ(compare(with("LowLimit=1\nHighLimit=9\n"), with("LowLimit=2\nHighLimit=10\n")),
            (List{"limit-narrowed 2000h:00 master", "limit-widened 2000h:00"}));
  EXPECT_EQ(compare(with(""), with("HighLimit=9\n")), (List{"limit-narrowed 2000h:00 master"}));
  EXPECT_EQ(compare(with("HighLimit=9\n"), with("")), (List{"limit-widened 2000h:00"}));
  EXPECT_EQ(compare(with("", "ro"), with("HighLimit=9\n", "ro")), (List{"limit-read-only 2000h:00"}));
}

TEST(Diff, TakesTheTypesRangeForALimitThatIsMissing) {
  EXPECT_EQ(compare(with(""), with("LowLimit=0\nHighLimit=0xFFFF\n")), List{});
  EXPECT_EQ(compare(with("", "rw", "3"), with("LowLimit=-32768\nHighLimit=32767\n", "rw", "3")), List{});
}

TEST(Diff, HoldsTheDefaultForHarmless) {
  EXPECT_EQ(compare(with("DefaultValue=1\n"), with("")), (List{"default-value 2000h:00"}));
}

TEST(Diff, KnowsDefaultsThatAMasterReliesOn) {
  const auto change = [](const char* index, const char* name, const char* before, const char* after) {
    return compare(var(index, name, "7", "rw", "DefaultValue=" + std::string{before} + "\n"),
                   var(index, name, "7", "rw", "DefaultValue=" + std::string{after} + "\n"));
  };
  EXPECT_EQ(change("1000", "Device type", "0x00020192", "0x00010191"), (List{"identity 1000h:00 master"}));
  EXPECT_EQ(change("1005", "COB-ID SYNC", "0x80", "0x81"), (List{"service-cob-id 1005h:00 master"}));
  EXPECT_EQ(change("1017", "Heartbeat", "100", "200"), (List{"heartbeat-slowed 1017h:00 master"}));
  EXPECT_EQ(change("1017", "Heartbeat", "100", "0"), (List{"heartbeat-slowed 1017h:00 master"}));
  EXPECT_EQ(change("1017", "Heartbeat", "100", "50"), (List{"default-value 1017h:00"}));
}

TEST(Diff, TellsAMajorRevisionFromAMinorOne) {
  const auto revision = [](const char* number) {
    return "[DeviceInfo]\nRevisionNumber=" + std::string{number} + "\n" + with("");
  };
  EXPECT_EQ(compare(revision("0x00010001"), revision("0x00010002")), (List{"revision-minor device"}));
  EXPECT_EQ(compare(revision("0x00010001"), revision("0x00020000")), (List{"revision-major device master"}));
}

TEST(Diff, ComparesTheDevicesOwnData) {
  const std::string before = "[DeviceInfo]\nVendorName=a\nVendorNumber=1\nProductName=b\nProductNumber=2\n";
  const std::string after = "[DeviceInfo]\nVendorName=A\nVendorNumber=2\nProductName=b\nProductNumber=3\n";
  EXPECT_EQ(compare(before + with(""), after + with("")),
            (List{"device-name device", "identity device master", "identity device master"}));
}

TEST(Diff, ComparesDummiesAndNodeIds) {
  EXPECT_EQ(compare("[DummyUsage]\nDummy0005=1\n" + with(""), "[DummyUsage]\nDummy0005=0\nDummy0006=1\n" + with("")),
            (List{"dummy-removed device master", "dummy-added device"}));
  EXPECT_EQ(compare("[DeviceComissioning]\nNodeID=5\n" + with(""), "[DeviceComissioning]\nNodeID=6\n" + with("")),
            (List{"node-id device master pdo"}));
}

TEST(Diff, BreaksCodeByAnotherIdentifierOnly) {
  EXPECT_EQ(compare(var("2000", "Speed", "5"), var("2000", "speed", "5")), (List{"name 2000h"}));
  EXPECT_EQ(compare(var("2000", "Speed", "5"), var("2000", "Velocity", "5")), (List{"identifier 2000h master"}));
}

TEST(Diff, FindsNothingInPdosThatAreTheSame) {
  const std::string text = pdo("$NODEID+0x180", "255", {"0x20000010"});
  EXPECT_EQ(compare(text, text), List{});
}

TEST(Diff, BreaksThePartnerByCobIdAndTransmissionType) {
  EXPECT_EQ(compare(pdo("$NODEID+0x180", "255", {"0x20000010"}), pdo("$NODEID+0x280", "1", {"0x20000010"})),
            (List{"pdo-cob-id TPDO 1 master pdo", "pdo-transmission TPDO 1 pdo"}));
}

TEST(Diff, BreaksThePartnerBySwitchingAPdoOff) {
  const std::string on = pdo("$NODEID+0x180", "255", {"0x20000010"});
  const std::string off = pdo("$NODEID+0x80000180", "255", {"0x20000010"});
  EXPECT_EQ(compare(on, off), (List{"pdo-disabled TPDO 1 pdo"}));
  EXPECT_EQ(compare(off, on), (List{"pdo-enabled TPDO 1"}));
}

TEST(Diff, BreaksThePartnerByAnotherLayout) {
  const auto mapped = [](const std::vector<std::string>& mapping, bool transmit) {
    std::string text = pdo("$NODEID+0x180", "255", mapping, transmit);
    return text;
  };
  const std::vector<std::string> speed{"0x20000010"};
  const std::vector<std::string> torque{"0x20010010"};
  const auto of_pdo = [](const List& list) { return list.back(); };
  EXPECT_EQ(of_pdo(compare(mapped(speed, true), mapped(torque, true))), "pdo-layout TPDO 1 master pdo");
  EXPECT_EQ(of_pdo(compare(mapped(speed, true), mapped({"0x20000010", "0x20010010"}, true))),
            "pdo-layout-extended TPDO 1");
  EXPECT_EQ(of_pdo(compare(mapped(speed, false), mapped({"0x20000010", "0x20010010"}, false))),
            "pdo-layout RPDO 1 master pdo");
}

TEST(Diff, SeesTheTypeOfWhatAPdoCarries) {
  const std::string before = pdo("$NODEID+0x180", "255", {"0x20000010"});
  std::string after = before;
  after.replace(after.rfind("DataType=6"), 10, "DataType=3");
  EXPECT_EQ(compare(before, after), (List{"data-type 2000h:00 master", "pdo-layout TPDO 1 master pdo"}));
}

TEST(Diff, HoldsTheSenderOfAnRpdoToItsLimits) {
  const std::string before = pdo("$NODEID+0x200", "255", {"0x20000010"}, false);
  std::string after = before;
  after.insert(after.rfind("[2001]"), "HighLimit=9\n");
  EXPECT_EQ(compare(before, after), (List{"limit-narrowed 2000h:00 master pdo"}));
}

TEST(Diff, LeavesPartnersAloneOfAPdoThatIsOff) {
  EXPECT_EQ(compare(pdo("0x80000000", "255", {"0x20000010"}), pdo("0x80000000", "1", {"0x20010010"})),
            (List{"default-value TPDO 1", "pdo-layout TPDO 1 master"}));
}

TEST(Diff, SaysWhatAndWhereInOneLine) {
  const Compared compared(with(""), "\n" + with("", "ro"));
  EXPECT_EQ(changes_as_text(compared.changes, false),
            "new.eds:6: breaks master: 2000h:00 \"Speed\": access rw becomes ro: what was read or written is aborted "
            "[access-reduced] (was old.eds:5)\n1 breaking, 0 compatible\n");
}

TEST(Diff, HasJsonForPrograms) {
  const Compared compared(with("DefaultValue=1\n"), with("DefaultValue=2\n", "ro"));
  const auto json = changes_as_json(compared.changes);
  EXPECT_EQ(json["version"], 1);
  EXPECT_EQ(json["breaking"], 1);
  EXPECT_EQ(json["compatible"], 1);
  const auto& change = json["changes"][0];
  EXPECT_EQ(change["kind"], "access-reduced");
  EXPECT_EQ(change["entry"], "2000h:00");
  EXPECT_EQ(change["old"], "rw");
  EXPECT_EQ(change["new"], "ro");
  EXPECT_EQ(change["breaks"], nlohmann::ordered_json::array({"master"}));
  EXPECT_EQ(change["new_position"]["line"], 5);
  EXPECT_EQ(json["changes"][1]["breaks"], nlohmann::ordered_json::array());
}

}  // namespace
}  // namespace edsc
