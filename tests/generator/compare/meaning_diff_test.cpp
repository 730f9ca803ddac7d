/// The meaning of values in two versions of a device: units, names, bits, modes and error codes.
#include <gtest/gtest.h>

#include <string>
#include <vector>

#include "compare/compare_devices.hpp"
#include "compare/print_changes.hpp"
#include "support/device_from_text.hpp"
#include "support/read_options.hpp"

namespace edsc {
namespace {

/// A version of a device: its EDS, and the value of "meaning" in its options.
struct Version {
  Version(const std::string& eds, const std::string& meaning, std::string file)
      : options(R"({ "meaning": )" + meaning + " }"), text(eds, options.options, {"device", {}}, std::move(file)) {
    EXPECT_EQ(options.diagnostics.errors(), 0U) << meaning;
  }

  ReadOptions options;
  DeviceFromText text;
};

/// `quantity-changed 2000h:00 master source: unit or scale ...` without the reason.
std::vector<std::string> list_of(const Changes& changes) {
  std::vector<std::string> list;
  for (const Change& change : changes.all()) {
    std::string text{change.rule.text()};
    text += " " + change.entry;
    if (change.breaks.master) text += " master";
    if (change.breaks.pdo) text += " pdo";
    if (change.breaks.source) text += " source";
    const std::string message = message_of(change);
    list.push_back(text + ": " + message.substr(0, message.rfind(": ")));
  }
  return list;
}

using List = std::vector<std::string>;

const std::string word = var("2000", "Word", "6", "rw", "DefaultValue=5\n") + var("2001", "Mode", "2");

List compare_meaning(const std::string& before, const std::string& after, const std::string& eds = word) {
  const Version old_version(eds, before, "old.eds"), new_version(eds, after, "new.eds");
  return list_of(compare_devices(old_version.text.named(), new_version.text.named()));
}

TEST(MeaningDiff, OfADeviceAndItselfIsEmpty) {
  const std::string meaning = R"({ "2000h": { "bits": { "0": "a", "4..7": { "name": "b", "values": { "1": "c" } } },
    "masked": { "s": { "x": ["1", "1"] } }, "depends_on": "2001h", "cases": { "1": { "bits": { "3": "d" } } } },
    "2001h": { "values": { "1": "one" }, "closed": true }, "emcy": { "2310h": "current" } })";
  EXPECT_EQ(compare_meaning(meaning, meaning), List{});
}

TEST(MeaningDiff, AnotherScaleIsBreakingAndAnotherSpellingIsNot) {
  const auto compare = [](const char* before, const char* after) {
    return compare_meaning(before, after, var("2000", "Time", "6"));
  };
  EXPECT_EQ(
      compare(R"({ "2000h": { "unit": "s", "scale": "1/10" } })", R"({ "2000h": { "unit": "s", "scale": "1/100" } })"),
      List{"quantity-changed 2000h:00 master source: unit or scale 0.1 s becomes 0.01 s"});
  EXPECT_EQ(compare(R"({ "2000h": { "unit": "s", "scale": "1/1000" } })", R"({ "2000h": { "unit": "ms" } })"),
            List{"quantity-spelled 2000h:00: unit 0.001 s becomes ms"});
  EXPECT_EQ(compare(R"({ "2000h": { "unit": "s" } })", R"({ "2000h": { "unit": "V" } })"),
            List{"quantity-changed 2000h:00 master source: unit or scale s becomes V"});
  const char* const other = R"({ "emcy": { "FF01h": "door" } })";
  const char* const both = R"({ "2000h": { "unit": "s" }, "emcy": { "FF01h": "door" } })";
  EXPECT_EQ(compare(other, both), List{"quantity-added 2000h:00: unit or scale added s"});
  EXPECT_EQ(compare(both, other), List{"quantity-removed 2000h:00 source: unit or scale removed s"});
}

TEST(MeaningDiff, AnotherScaleOfAMappedEntryBreaksThePdo) {
  const std::string eds = var("2000", "Speed", "6", "rw", "PDOMapping=1\n") + group("1800", "PDO", "9", 2) +
                          var("1800sub0", "n", "5", "ro", "DefaultValue=1\n") +
                          var("1800sub1", "COB-ID", "7", "rw", "DefaultValue=$NODEID+0x180\n") +
                          group("1A00", "Mapping", "9", 2) + var("1A00sub0", "n", "5", "rw", "DefaultValue=1\n") +
                          var("1A00sub1", "first", "7", "rw", "DefaultValue=0x20000010\n");
  EXPECT_EQ(compare_meaning(R"({ "2000h": { "scale": "2" } })", R"({ "2000h": { "scale": "3" } })", eds),
            List{"quantity-changed 2000h:00 master pdo source: unit or scale 2 becomes 3"});
}

TEST(MeaningDiff, NamesOfValues) {
  const auto compare = [](const std::string& before, const std::string& after) {
    return compare_meaning(R"({ "2001h": { "values": {)" + before + "} } }",
                           R"({ "2001h": { "values": {)" + after + "} } }");
  };
  EXPECT_EQ(compare(R"("0": "off", "1": "on")", R"("0": "off", "1": "run")"),
            List{"value-renamed 2001h:00 source: name of a value 1 on becomes 1 run"});
  EXPECT_EQ(compare(R"("0": "off", "1": "on")", R"("0": "off", "2": "on")"),
            List{"value-changed 2001h:00 master source: number of a named value 1 on becomes 2 on"});
  EXPECT_EQ(compare(R"("0": "off", "1": "on")", R"("0": "off")"),
            List{"value-removed 2001h:00 source: named value removed 1 on"});
  EXPECT_EQ(compare(R"("0": "off")", R"("0": "off", "-1": "back")"),
            List{"value-added 2001h:00: named value added -1 back"});
  EXPECT_EQ(compare(R"("0": "off", "1": "on")", R"("0": "on", "1": "off")"),
            (List{"value-changed 2001h:00 master source: number of a named value 0 off becomes 1 off",
                  "value-changed 2001h:00 master source: number of a named value 1 on becomes 0 on"}));
  EXPECT_EQ(compare(R"("0": "off", "1": "on")", R"("1": "off")"),
            (List{"value-changed 2001h:00 master source: number of a named value 0 off becomes 1 off",
                  "value-removed 2001h:00 source: named value removed 1 on"}));
}

TEST(MeaningDiff, AClosedEnumerationRejectsWhatItDoesNotHave) {
  const std::string open = R"({ "2001h": { "values": { "0": "off", "1": "on" } } })";
  const std::string closed = R"({ "2001h": { "values": { "0": "off" }, "closed": true } })";
  EXPECT_EQ(compare_meaning(open, closed), (List{"value-removed 2001h:00 master source: named value removed 1 on",
                                                 "values-closed 2001h:00 master source: closed values"}));
  EXPECT_EQ(compare_meaning(closed, open),
            (List{"value-added 2001h:00: named value added 1 on", "values-opened 2001h:00: open values"}));
}

TEST(MeaningDiff, Fields) {
  const auto compare = [](const std::string& before, const std::string& after) {
    return compare_meaning(R"({ "2000h": { "bits": {)" + before + "} } }",
                           R"({ "2000h": { "bits": {)" + after + "} } }");
  };
  EXPECT_EQ(compare(R"("1": "a", "4..7": "gear")", R"("1": "a", "4..8": "gear")"),
            List{"field-moved 2000h:00 master source: bits of a field gear (bits 4..7) becomes gear (bits 4..8)"});
  EXPECT_EQ(compare(R"("1": "a", "2": "b")", R"("1": "a", "2": "c", "3": "d")"),
            (List{"field-renamed 2000h:00 source: name of a field b (bits 2) becomes c (bits 2)",
                  "field-added 2000h:00: field added d (bits 3)"}));
  EXPECT_EQ(compare(R"("1": "a", "2": "b")", R"("1": "a", "2": null)"),
            List{"field-removed 2000h:00 source: field removed b (bits 2)"});
  EXPECT_EQ(compare(R"("0..3": { "name": "t", "unit": "s" })", R"("0..3": { "name": "t", "unit": "min" })"),
            List{"quantity-changed 2000h:00 master source: unit or scale t: s becomes min"});
  EXPECT_EQ(compare(R"("0..1": { "name": "m", "values": { "0": "x" } })",
                    R"("0..1": { "name": "m", "values": { "0": "y" } })"),
            List{"value-renamed 2000h:00 source: name of a value m: 0 x becomes m: 0 y"});
}

TEST(MeaningDiff, StatesAndModes) {
  const auto compare = [](const std::string& before, const std::string& after) {
    return compare_meaning(R"({ "2000h": {)" + before + "} }", R"({ "2000h": {)" + after + "} }");
  };
  EXPECT_EQ(
      compare(R"("masked": { "state": { "on": ["3", "1"] } })", R"("masked": { "state": { "on": ["3", "2"] } })"),
      List{"field-moved 2000h:00 master source: bits of a field state=on (bits mask 3h, value 1h) becomes state=on "
           "(bits mask 3h, value 2h)"});
  EXPECT_EQ(compare(R"("depends_on": "2001h", "cases": { "1": { "name": "m", "bits": { "3": "a" } } })",
                    R"("depends_on": "2001h", "cases": { "1, 2": { "name": "m", "bits": { "4": "a" } } })"),
            (List{"field-moved 2000h:00 master source: bits of a field m.a (bits 3) becomes m.a (bits 4)",
                  "mode-values 2000h:00 master source: values of a mode m 1 becomes 1, 2"}));
  EXPECT_EQ(compare(R"("depends_on": "2001h", "cases": { "1": { "name": "m", "bits": { "3": "a" } } })",
                    R"("depends_on": "2001h", "cases": { "2": { "name": "n", "bits": { "3": "b" } } })"),
            (List{"field-removed 2000h:00 source: field removed m.a (bits 3)",
                  "field-added 2000h:00: field added n.b (bits 3)"}));
  const std::string two = word + var("2002", "Other mode", "2");
  const auto with_mode = [](const std::string& object) {
    return R"({ "2000h": { "depends_on": ")" + object +
           R"(", "cases": { "1": { "name": "m", "bits": { "3": "a" } } } } })";
  };
  EXPECT_EQ(compare_meaning(with_mode("2001h"), with_mode("2002h"), two),
            List{"mode-object 2000h:00 master source: object that selects the mode of bits 2001h:00 becomes 2002h:00"});
}

TEST(MeaningDiff, ErrorCodes) {
  EXPECT_EQ(compare_meaning(R"({ "emcy": { "FF01h": "door", "FF02h": "lamp" } })",
                            R"({ "emcy": { "FF01h": "hatch", "FF03h": "fan" } })"),
            (List{R"(error-code-text EMCY FF01h: error code "door" becomes "hatch")",
                  R"(error-code-removed EMCY FF02h: name of an error code removed "lamp")",
                  R"(error-code-added EMCY FF03h: name of an error code added "fan")"}));
}

TEST(MeaningDiff, DefaultsAndLimitsHaveTheirMeaning) {
  const auto compare = [](const std::string& meaning, const std::string& before, const std::string& after) {
    const Version old_version(var("2000", "A", "3", "rw", before), meaning, "old.eds");
    const Version new_version(var("2000", "A", "3", "rw", after), meaning, "new.eds");
    return list_of(compare_devices(old_version.text.named(), new_version.text.named()));
  };
  EXPECT_EQ(compare(R"({ "2000h": { "unit": "V", "scale": "1/10" } })", "DefaultValue=215\nHighLimit=300\n",
                    "DefaultValue=220\nHighLimit=250\n"),
            (List{"limit-narrowed 2000h:00 master source: limit high 300 (30 V) becomes 250 (25 V)",
                  "default-value 2000h:00: default 215 (21.5 V) becomes 220 (22 V)"}));
  EXPECT_EQ(
      compare(R"({ "2000h": { "values": { "1": "run", "2": "stop" } } })", "DefaultValue=1\n", "DefaultValue=2\n"),
      List{"default-value 2000h:00: default 1 run becomes 2 stop"});
}

TEST(MeaningDiff, WithoutOptionsOnOneSideComparesTheFilesAndTheProfile) {
  const std::string options = R"({ "2000h": { "bits": { "0": "a" } }, "emcy": { "FF01h": "door" } })";
  EXPECT_EQ(compare_meaning(options, "{}"), List{});
  EXPECT_EQ(compare_meaning("{}", options), List{});
  const Version before(var("2000", "Time", "6", "rw", "Unit=s\n"), "{}", "old.eds");
  const Version after(var("2000", "Time", "6", "rw", "Unit=min\n"), R"({ "emcy": { "FF01h": "door" } })", "new.eds");
  EXPECT_EQ(list_of(compare_devices(before.text.named(), after.text.named())),
            List{"quantity-changed 2000h:00 master source: unit or scale s becomes min"});
  const Version replaced(var("2000", "Time", "6", "rw", "Unit=s\n"), R"({ "2000h": { "unit": "s" } })", "old.eds");
  EXPECT_EQ(list_of(compare_devices(replaced.text.named(), before.text.named())), List{});
}

TEST(MeaningDiff, OfAnotherProfileIsTheDeviceType) {
  const auto drive = [](const char* type) {
    return var("1000", "Device type", "7", "ro", std::string{"DefaultValue="} + type + "\n") +
           var("6041", "Status", "6", "ro");
  };
  const Version before(drive("0x00020192"), "{}", "old.eds"), after(drive("0x00000191"), "{}", "new.eds");
  List rules;
  const Changes changes = compare_devices(before.text.named(), after.text.named());
  for (const Change& change : changes.all()) {
    rules.emplace_back(change.rule.text());
  }
  EXPECT_EQ(rules, List{"identity"});
}

TEST(MeaningDiff, PointsAtTheOptions) {
  const Version before(word, R"({ "2001h": { "values": { "1": "a" } } })", "old.eds");
  const Version after(word, R"({ "2001h": { "values": {
    "1": "b" } } })",
                      "new.eds");
  const Changes changes = compare_devices(before.text.named(), after.text.named());
  ASSERT_EQ(changes.all().size(), 1U);
  EXPECT_EQ(changes.all().front().new_position.file, &after.options.source);
  EXPECT_EQ(changes.all().front().new_position.line, 2U);
  EXPECT_EQ(changes_as_json(changes)["changes"][0]["old"], "1 a");
}

}  // namespace
}  // namespace edsc
