/// Two versions of an EDS: the changes, and who is affected by them.
#include <fmt/format.h>
#include <gtest/gtest.h>

#include <fstream>
#include <iterator>
#include <set>
#include <string>
#include <vector>

#include "compare/compare_devices.hpp"
#include "compare/print_changes.hpp"
#include "support/device_from_text.hpp"

namespace edsc {
namespace {

/// One change, in short: `access-reduced 2000h:00 master`.
std::string in_short(const Change& change) {
  std::string text{change.rule.text()};
  text += " " + change.entry;
  if (change.breaks.master) text += " master";
  if (change.breaks.pdo) text += " pdo";
  if (change.breaks.source) text += " source";
  return text;
}

struct Compared {
  Compared(std::string old_text, std::string new_text, std::optional<std::uint8_t> node_id = std::nullopt)
      : before(std::move(old_text), {}, {"device", node_id}, "old.eds"),
        after(std::move(new_text), {}, {"device", node_id}, "new.eds"),
        changes(compare_devices(before.named(), after.named())) {}

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

/// 2000h with these keys and attributes.
std::string with(std::string_view keys, std::string_view access = "rw", std::string_view type = "0x0006") {
  return var("2000", "Speed", type, access, keys);
}

/// A TPDO or RPDO 1 that maps 2000h and the other entries of `mapping`.
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
  for (const Rule& rule : change_rules) {
    EXPECT_TRUE(names.insert(rule.id).second) << rule.id;
    EXPECT_FALSE(rule.title.empty() || rule.explanation.empty()) << rule.id;
  }
}

TEST(ChangeTable, StandsInTheDocuments) {
  std::ifstream file(EDSC_SOURCE_DIR "/docs/command-line.md");
  const std::string document{std::istreambuf_iterator<char>{file}, {}};
  for (const Rule& rule : change_rules) {
    std::string who = rule.breaks.master ? "master" : "";
    if (rule.breaks.pdo) who += who.empty() ? "pdo" : ", pdo";
    if (rule.breaks.source) who += who.empty() ? "source" : ", source";
    if (rule.breaks.storage) who = "storage";
    const std::string row =
        fmt::format("| `{}` | {} | {}: {} |\n", rule.id, who.empty() ? "-" : who, rule.title, rule.explanation);
    EXPECT_NE(document.find(row), std::string::npos) << row;
  }
}

TEST(Diff, FindsNothingBetweenADeviceAndItself) {
  EXPECT_EQ(compare(with("DefaultValue=1\n"), with("DefaultValue=0x1\n")), List{});
}

TEST(Diff, KnowsObjectsThatCameAndWent) {
  EXPECT_EQ(compare(with(""), with("") + var("2001", "b", "5")), (List{"object-added 2001h"}));
  EXPECT_EQ(compare(with("") + var("1FFF", "b", "5"), with("")), (List{"object-removed 1FFFh master source"}));
}

TEST(Diff, KnowsSubIndicesThatCameAndWent) {
  const std::string one =
      group("2000", "a", "9", 2) + var("2000sub0", "n", "5", "ro", "DefaultValue=1\n") + var("2000sub1", "x", "5");
  const std::string two = one + var("2000sub2", "y", "5");
  EXPECT_EQ(compare(one, two), (List{"entry-added 2000h:02"}));
  EXPECT_EQ(compare(two, one), (List{"entry-removed 2000h:02 master source"}));
}

TEST(Diff, BreaksAMasterByAnotherType) {
  EXPECT_EQ(compare(with("DefaultValue=1\n"), with("DefaultValue=2\n", "rw", "0x0007")),
            (List{"data-type 2000h:00 master source"}));
}

TEST(Diff, BreaksAMasterByAnotherObjectCode) {
  const std::string record = group("2000", "Speed", "9", 1) + var("2000sub0", "n", "6");
  const std::string array = group("2000", "Speed", "8", 1) + var("2000sub0", "n", "6");
  EXPECT_EQ(compare(record, array), (List{"object-type 2000h master source"}));
}

TEST(Diff, BreaksAMasterByAccessThatIsTakenAway) {
  EXPECT_EQ(compare(with(""), with("", "ro")), (List{"access-reduced 2000h:00 master source"}));
  EXPECT_EQ(compare(with("", "ro"), with("")), (List{"access-extended 2000h:00"}));
  EXPECT_EQ(compare(with("", "ro"), with("", "wo")), (List{"access-reduced 2000h:00 master source"}));
  EXPECT_EQ(compare(with("", "ro"), with("", "const")), (List{"access-other 2000h:00"}));
}

TEST(Diff, BreaksPdosByMappingThatIsTakenAway) {
  EXPECT_EQ(compare(with("PDOMapping=1\n"), with("")), (List{"mapping-reduced 2000h:00 master pdo source"}));
  EXPECT_EQ(compare(with(""), with("PDOMapping=1\n")), (List{"mapping-extended 2000h:00"}));
  EXPECT_EQ(compare(with("PDOMapping=1\n"), with("PDOMapping=1\n", "rww")),
            (List{"access-other 2000h:00", "mapping-reduced 2000h:00 master pdo source"}));
}

TEST(Diff, TellsNarrowedLimitsFromWidenedOnes) {
  EXPECT_EQ(compare(with("LowLimit=1\nHighLimit=9\n"), with("LowLimit=2\nHighLimit=10\n")),
            (List{"limit-narrowed 2000h:00 master source", "limit-widened 2000h:00"}));
  EXPECT_EQ(compare(with(""), with("HighLimit=9\n")), (List{"limit-narrowed 2000h:00 master source"}));
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

/// The changes if the default value of a COB-ID changes.
List compare_cob_ids(const char* index, const char* before, const char* after) {
  return compare(var(index, "COB-ID", "7", "rw", "DefaultValue=" + std::string{before} + "\n"),
                 var(index, "COB-ID", "7", "rw", "DefaultValue=" + std::string{after} + "\n"));
}

TEST(Diff, TellsTheFlagsOfACobIdFromItsCanId) {  // CiA 301, 7.5.2.5, 7.5.2.15, 7.5.2.17
  // 1005h: bit 31 has no meaning; bit 30: the device generates SYNC.
  EXPECT_EQ(compare_cob_ids("1005", "0x80", "0x80000080"), (List{"cob-id-flag 1005h:00"}));
  EXPECT_EQ(compare_cob_ids("1005", "0x80", "0x40000080"), (List{"sync-started 1005h:00 master pdo"}));
  EXPECT_EQ(compare_cob_ids("1005", "0x40000080", "0x80"), (List{"sync-stopped 1005h:00 master pdo"}));
  EXPECT_EQ(compare_cob_ids("1005", "0x80", "0x20000080"), (List{"frame-format 1005h:00 master"}));
  EXPECT_EQ(compare_cob_ids("1005", "0x80000080", "0x81"),
            (List{"service-cob-id 1005h:00 master", "cob-id-flag 1005h:00"}));
  // 1012h: bit 31: consumes TIME; bit 30: produces TIME.
  EXPECT_EQ(compare_cob_ids("1012", "0x80000100", "0x100"), (List{"time-ignored 1012h:00 master"}));
  EXPECT_EQ(compare_cob_ids("1012", "0x100", "0x80000100"), (List{"time-consumed 1012h:00"}));
  EXPECT_EQ(compare_cob_ids("1012", "0x100", "0x40000100"), (List{"time-started 1012h:00 master"}));
  EXPECT_EQ(compare_cob_ids("1012", "0x40000100", "0x100"), (List{"time-stopped 1012h:00 master"}));
  // 1014h: bit 31: EMCY does not exist; its CAN-ID is then unused.
  EXPECT_EQ(compare_cob_ids("1014", "$NODEID+0x80", "$NODEID+0x80000080"), (List{"service-disabled 1014h:00 master"}));
  EXPECT_EQ(compare_cob_ids("1014", "$NODEID+0x80000080", "$NODEID+0x80"), (List{"service-enabled 1014h:00"}));
  EXPECT_EQ(compare_cob_ids("1014", "$NODEID+0x80", "0x85"), (List{"service-cob-id 1014h:00 master"}));
  EXPECT_EQ(compare_cob_ids("1014", "0x80000081", "0x80000082"), (List{"default-value 1014h:00"}));
}

TEST(Diff, KnowsTheFlagsOfAnSdoServer) {  // CiA 301, 7.5.2.33
  const auto server = [](const char* cob_id) {
    return group("1201", "SDO server", "9", 3) + var("1201sub0", "n", "5", "ro", "DefaultValue=2\n") +
           var("1201sub1", "request", "7", "rw", "DefaultValue=" + std::string{cob_id} + "\n") +
           var("1201sub2", "answer", "7", "rw", "DefaultValue=0x5C1\n");
  };
  EXPECT_EQ(compare(server("0x6C1"), server("0x800006C1")), (List{"service-disabled 1201h:01 master"}));
  EXPECT_EQ(compare(server("0x6C1"), server("0x400006C1")), (List{"sdo-dynamic 1201h:01"}));
  EXPECT_EQ(compare(server("0x6C1"), server("0x6C2")), (List{"service-cob-id 1201h:01 master"}));
}

TEST(Diff, KnowsTheFlagsOfAPdo) {  // CiA 301, 7.5.2.35 and 7.5.2.37
  const auto tpdo = [](const char* cob_id) { return pdo(cob_id, "255", {"0x20000010"}); };
  const auto rpdo = [](const char* cob_id) { return pdo(cob_id, "255", {"0x20000010"}, false); };
  EXPECT_EQ(compare(tpdo("0x181"), tpdo("0x40000181")), (List{"rtr-disabled TPDO 1 pdo"}));
  EXPECT_EQ(compare(tpdo("0x40000181"), tpdo("0x181")), (List{"rtr-enabled TPDO 1"}));
  EXPECT_EQ(compare(tpdo("0x181"), tpdo("0x20000181")), (List{"frame-format TPDO 1 master pdo"}));
  EXPECT_EQ(compare(rpdo("0x201"), rpdo("0x40000201")), (List{"cob-id-flag RPDO 1"}));
  EXPECT_EQ(compare(tpdo("0x80000181"), tpdo("0xC0000182")), (List{"default-value TPDO 1"}));
  EXPECT_EQ(compare(tpdo("0x80000181"), tpdo("0x182")), (List{"pdo-enabled TPDO 1", "default-value TPDO 1"}));
}

TEST(Diff, NamesTheFlagAndShowsCanIds) {
  const Compared flag(pdo("0x181", "255", {"0x20000010"}), pdo("0x40000181", "255", {"0x20000010"}));
  EXPECT_EQ(message_of(flag.changes.all().front()),
            "bit 30 (no remote frames) set 0x00000181 becomes 0x40000181: a remote frame for the PDO is not answered");
  const Compared can_id(pdo("$NODEID+0x40000180", "255", {"0x20000010"}), pdo("0x40000281", "255", {"0x20000010"}));
  EXPECT_EQ(message_of(can_id.changes.all().front()),
            "CAN-ID $NODEID+0x180 becomes 0x281: the partner uses the old one");
}

TEST(Diff, SeesAnotherLengthOfATypeOfTheSameNumber) {
  const auto sheet = [](const char* bits) {
    return "[0042]\nParameterName=Label\nObjectType=5\nDataType=9\nDefaultValue=" + std::string{bits} + "\n" +
           var("2000", "Label", "0x42");
  };
  const Compared compared(sheet("64"), sheet("128"));
  ASSERT_EQ(compared.short_list(), (List{"data-type 2000h:00 master source"}));
  EXPECT_EQ(compared.changes.all().front().old_value, "VISIBLE_STRING of 8 bytes");
  EXPECT_EQ(compared.changes.all().front().new_value, "VISIBLE_STRING of 16 bytes");
}

TEST(Diff, KeepsWhatConcernsAnAudience) {
  const std::string before = var("2000", "Speed", "5") + var("2001", "b", "5");
  const std::string after = var("2000", "Velocity", "5", "ro") + var("2001", "b", "5") + var("2002", "c", "5");
  Compared wire(before, after);
  wire.changes.keep(Audience::wire);
  EXPECT_EQ(wire.short_list(), (List{"access-reduced 2000h:00 master", "object-added 2002h"}));
  Compared source(before, after);
  source.changes.keep(Audience::source);
  EXPECT_EQ(source.short_list(),
            (List{"identifier 2000h source", "access-reduced 2000h:00 source", "object-added 2002h"}));
  Compared node_id(var("1014", "EMCY", "7", "rw", "DefaultValue=0x81\n"),
                   var("1014", "EMCY", "7", "rw", "DefaultValue=0x82\n"));
  node_id.changes.keep(Audience::source);
  EXPECT_EQ(node_id.short_list(), List{});
}

TEST(Diff, KeepsAChangeForAPdoPartnerOnTheWireOnly) {
  const auto changes_for = [](Audience audience) {
    Compared compared(pdo("0x181", "255", {"0x20000010"}), pdo("0x281", "255", {"0x20000010"}));
    compared.changes.keep(audience);
    return compared.short_list();
  };
  ASSERT_EQ(changes_for(Audience::all).size(), 1U);
  EXPECT_NE(changes_for(Audience::all).front().find(" pdo"), std::string::npos);
  EXPECT_EQ(changes_for(Audience::wire), changes_for(Audience::all));
  EXPECT_EQ(changes_for(Audience::source), List{});
}

/// 1018h with these numbers.
std::string identity(const std::string& product, const std::string& revision) {
  return group("1018", "Identity", "9", 4) + var("1018sub0", "n", "5", "ro", "DefaultValue=3\n") +
         var("1018sub1", "Vendor-ID", "7", "ro", "DefaultValue=1\n") +
         var("1018sub2", "Product code", "7", "ro", "DefaultValue=" + product + "\n") +
         var("1018sub3", "Revision number", "7", "ro", "DefaultValue=" + revision + "\n");
}

TEST(Diff, WantsAHigherMajorRevisionForABreakingChange) {  // CiA 301, 7.5.2.21: bits 31..16
  const std::string missing = "revision-unchanged 1018h:03 master";
  const auto changed = [](const std::string& old_revision, const std::string& new_revision) {
    return compare(identity("1", old_revision) + with("", "rw"), identity("1", new_revision) + with("", "ro")).back();
  };
  EXPECT_EQ(changed("0x00010002", "0x00010002"), missing);
  EXPECT_EQ(changed("0x00010002", "0x00010003"), missing);
  EXPECT_EQ(changed("0x00010002", "0x00020000"), "access-reduced 2000h:00 master source");
  // Compatible changes, and those of the generated code alone, need no new revision; revisions of another product
  // have no order.
  EXPECT_EQ(compare(identity("1", "0x10000") + with(""), identity("1", "0x10000") + with("") + var("2001", "b", "5")),
            (List{"object-added 2001h"}));
  EXPECT_EQ(compare(identity("1", "0x10000") + with(""), identity("1", "0x10000") + var("2000", "Velocity", "6")),
            (List{"identifier 2000h source"}));
  EXPECT_EQ(compare(identity("1", "0x10000") + with(""), identity("2", "0x10000") + with("")),
            (List{"identity 1018h:02 master"}));
  // A configuration of a node is not a new revision of its device.
  EXPECT_EQ(compare(identity("1", "0x10000") + with("", "rw"),
                    "[DeviceComissioning]\nNodeName=a\n" + identity("1", "0x10000") + with("", "ro")),
            (List{"access-reduced 2000h:00 master source"}));
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
            (List{"dummy-removed device master source", "dummy-added device"}));
  EXPECT_EQ(compare("[DeviceComissioning]\nNodeID=5\n" + with(""), "[DeviceComissioning]\nNodeID=6\n" + with("")),
            (List{"node-id device master pdo"}));
}

TEST(Diff, BreaksCodeByAnotherIdentifierOnly) {
  EXPECT_EQ(compare(var("2000", "Speed", "5"), var("2000", "speed", "5")), (List{"name 2000h"}));
  EXPECT_EQ(compare(var("2000", "Speed", "5"), var("2000", "Velocity", "5")), (List{"identifier 2000h source"}));
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
  EXPECT_EQ(of_pdo(compare(mapped(speed, true), mapped(torque, true))), "pdo-layout TPDO 1 master pdo source");
  EXPECT_EQ(of_pdo(compare(mapped(speed, true), mapped({"0x20000010", "0x20010010"}, true))),
            "pdo-layout-extended TPDO 1");
  EXPECT_EQ(of_pdo(compare(mapped(speed, false), mapped({"0x20000010", "0x20010010"}, false))),
            "pdo-layout RPDO 1 master pdo source");
}

TEST(Diff, SeesTheTypeOfWhatAPdoCarries) {
  const std::string before = pdo("$NODEID+0x180", "255", {"0x20000010"});
  std::string after = before;
  after.replace(after.rfind("DataType=6"), 10, "DataType=3");
  EXPECT_EQ(compare(before, after), (List{"data-type 2000h:00 master source", "pdo-layout TPDO 1 master pdo source"}));
}

TEST(Diff, HoldsTheSenderOfAnRpdoToItsLimits) {
  const std::string before = pdo("$NODEID+0x200", "255", {"0x20000010"}, false);
  std::string after = before;
  after.insert(after.rfind("[2001]"), "HighLimit=9\n");
  EXPECT_EQ(compare(before, after), (List{"limit-narrowed 2000h:00 master pdo source"}));
}

TEST(Diff, LeavesPartnersAloneOfAPdoThatIsOff) {
  EXPECT_EQ(compare(pdo("0x80000000", "255", {"0x20000010"}), pdo("0x80000000", "1", {"0x20010010"})),
            (List{"default-value TPDO 1", "pdo-layout TPDO 1 master source"}));
}

TEST(Diff, SaysWhatAndWhereInOneLine) {
  const Compared compared(with(""), "\n" + with("", "ro"));
  EXPECT_EQ(changes_as_text(compared.changes, false),
            "new.eds:6: breaks master and source code: 2000h:00 \"Speed\": access rw becomes ro: an access that was "
            "allowed is aborted "
            "[access-reduced] (was old.eds:5)\n1 breaking, 0 compatible\n");
}

TEST(Diff, HasJsonForPrograms) {
  const Compared compared(with("DefaultValue=1\n"), with("DefaultValue=2\n", "ro"));
  const auto json = changes_as_json(compared.changes);
  EXPECT_EQ(json["schema"], 2);
  EXPECT_EQ(json["breaking"], 1);
  EXPECT_EQ(json["compatible"], 1);
  const auto& change = json["changes"][0];
  EXPECT_EQ(change["kind"], "access-reduced");
  EXPECT_EQ(change["entry"], "2000h:00");
  EXPECT_EQ(change["old"], "rw");
  EXPECT_EQ(change["new"], "ro");
  EXPECT_EQ(change["breaks"], nlohmann::ordered_json::array({"master", "source"}));
  EXPECT_EQ(change["new_position"]["line"], 5);
  EXPECT_EQ(json["changes"][1]["breaks"], nlohmann::ordered_json::array());
}

}  // namespace
}  // namespace edsc
