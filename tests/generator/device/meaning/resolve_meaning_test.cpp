/// Which source gives an entry its meaning: the options, then the keys of the EDS, then the profiles.
#include "device/meaning/resolve_meaning.hpp"

#include <gtest/gtest.h>

#include <string>
#include <vector>

#include "support/device_from_text.hpp"
#include "support/read_options.hpp"

namespace edsc {
namespace {

/// A device, and the options that give it a meaning.
struct Described {
  explicit Described(const std::string& eds, const std::string& meaning)
      : options(R"({ "meaning": )" + meaning + " }"), text(eds, options.options) {
    EXPECT_TRUE(options.diagnostics.all().empty()) << meaning;
  }

  [[nodiscard]] const Meaning& of(std::uint16_t index, std::uint8_t sub_index = 0) const {
    const auto& meaning = text.entry(index, sub_index).meaning;
    if (!meaning) throw std::runtime_error{"no meaning"};
    return *meaning;
  }

  ReadOptions options;
  DeviceFromText text;
};

const std::string drive = var("1000", "Device type", "7", "ro", "DefaultValue=0x00020192\n");

TEST(Meaning, OfTheEdsIsItsUnitFactorAndOffset) {
  const Described device(var("2000", "Temperature", "3", "rw", "Unit=\xC2\xB0\x43\nFactor=0.1\nOffset=-40\n"), "{}");
  const Quantity& quantity = device.of(0x2000).quantity.value();
  EXPECT_EQ(quantity.unit->ascii, "degC");
  EXPECT_EQ(quantity.scale, Rational::of(1, 10));
  EXPECT_EQ(quantity.offset, Rational{-40});
  EXPECT_EQ(quantity.source, MeaningSource::eds);
}

TEST(Meaning, OfAFactorThatIsNotANumberIsNone) {
  for (const char* const factor : {"tenths", "0", "0,1", "1/0"}) {
    const DeviceFromText text(var("2000", "Supply", "6", "rw", std::string{"Unit=V\nFactor="} + factor + "\n"));
    EXPECT_FALSE(text.entry(0x2000).meaning) << factor;
    EXPECT_EQ(text.line_of("meaning-scale"), std::string{"Factor="} + factor);
  }
}

TEST(Meaning, OfTheOptionsReplacesSingleProperties) {
  const Described device(var("2000", "Temperature", "3", "rw", "Unit=K\n"), R"({"2000h": {"scale": "1/10"}})");
  const Quantity& quantity = device.of(0x2000).quantity.value();
  EXPECT_EQ(quantity.symbol, "K");
  EXPECT_EQ(quantity.scale, Rational::of(1, 10));
  EXPECT_EQ(quantity.source, MeaningSource::options);
  EXPECT_EQ(rules_of(device.text.diagnostics), std::vector<std::string>{});
}

TEST(Meaning, ThatContradictsTheEdsIsReportedOnceAndTheOptionsAreUsed) {
  const Described device(var("2000", "Supply", "6", "rw", "Unit=A\nFactor=0.1\n"),
                         R"({"2000h": {"unit": "V", "scale": "1/100"}})");
  EXPECT_EQ(device.of(0x2000).quantity->symbol, "V");
  EXPECT_EQ(device.of(0x2000).quantity->scale, Rational::of(1, 100));
  EXPECT_EQ(rules_of(device.text.diagnostics), std::vector<std::string>{"meaning-contradicts-eds"});
}

TEST(Meaning, MayBeTheExactNumberOfARoundedFactor) {
  const Described rounded(var("2000", "Supply", "6", "rw", "Factor=0.333\n"), R"({"2000h": {"scale": "1/3"}})");
  EXPECT_EQ(rules_of(rounded.text.diagnostics), std::vector<std::string>{});
  const Described other(var("2000", "Supply", "6", "rw", "Factor=0.332\n"), R"({"2000h": {"scale": "1/3"}})");
  EXPECT_EQ(rules_of(other.text.diagnostics), std::vector<std::string>{"meaning-contradicts-eds"});
}

TEST(Meaning, OfAnEntryIsBeforeThatOfItsObject) {
  const std::string eds = group("2001", "Channels", "0x8", 3) + sub("2001", 0, "Count", "5", "DefaultValue=2\n") +
                          sub("2001", 1, "One", "6") + sub("2001", 2, "Two", "6");
  const Described device(eds, R"({"2001h": {"unit": "V"}, "2001h:02": {"unit": "A", "scale": "1/2"}})");
  EXPECT_EQ(device.of(0x2001, 1).quantity->symbol, "V");
  EXPECT_EQ(device.of(0x2001, 2).quantity->symbol, "A");
  EXPECT_FALSE(device.text.entry(0x2001, 0).meaning) << "sub-index 0 is not an element";
}

TEST(Meaning, ElementsOfAnArrayShareOne) {
  const std::string eds = group("2001", "Channels", "0x8", 3) + sub("2001", 0, "Count", "5", "DefaultValue=2\n") +
                          sub("2001", 1, "One", "6") + sub("2001", 2, "Two", "6");
  const Described device(eds, R"({"2001h": {"unit": "V"}})");
  EXPECT_EQ(device.text.entry(0x2001, 1).meaning, device.text.entry(0x2001, 2).meaning);
}

TEST(Meaning, OfAProfileAppliesToItsDevicesOnly) {
  const std::string statusword = var("6041", "Statusword", "6", "ro");
  const Described with_profile(drive + statusword, "{}");
  EXPECT_TRUE(with_profile.of(0x6041).has_fields());
  EXPECT_EQ(with_profile.of(0x6041).depends_on, (EntryKey{0x6061, 0}));
  const DeviceFromText io_module(var("1000", "Device type", "7", "ro", "DefaultValue=0x00030191\n") + statusword);
  EXPECT_FALSE(io_module.entry(0x6041).meaning);
}

TEST(Meaning, OfAProfileIsRepeatedForEachAxis) {
  const Described device(drive + var("6841", "Statusword 2", "6", "ro"), "{}");
  EXPECT_EQ(device.of(0x6841).depends_on, (EntryKey{0x6861, 0}));
}

TEST(Meaning, OfAProfileNeedsATypeWithItsBits) {
  const DeviceFromText narrow(drive + var("6041", "Statusword", "5", "ro"));
  const auto& meaning = narrow.entry(0x6041).meaning;
  EXPECT_TRUE(!meaning || (meaning->fields.empty() && meaning->cases.empty()));
}

TEST(Meaning, NamesOfTheOptionsReplaceThoseOfTheProfile) {
  const Described device(drive + var("6060", "Modes of operation", "2"), R"({"6060h": {"values": {"1": "only"}}})");
  ASSERT_TRUE(device.of(0x6060).values);
  EXPECT_EQ(device.of(0x6060).values->values.size(), 1U);
  EXPECT_EQ(device.of(0x6060).values->find(1)->name, "only");
}

TEST(Meaning, MayBeThatOfAnotherObject) {
  const Described device(var("2000", "Mode", "5") + var("2001", "Mode display", "5", "ro"),
                         R"({"2000h": {"values": {"1": "slow"}}, "2001h": {"same_as": "2000h"}})");
  ASSERT_TRUE(device.of(0x2001).values);
  EXPECT_EQ(device.of(0x2001).values->find(1)->name, "slow");
  EXPECT_EQ(device.of(0x2001).same_as, (EntryKey{0x2000, 0}));
}

TEST(Meaning, OfAMissingObjectIsAnError) {
  const Described device(var("2000", "Mode", "5"), R"({"2001h": {"unit": "V"}})");
  EXPECT_EQ(rules_of(device.text.diagnostics), std::vector<std::string>{"options"});
  const Described other(var("2000", "Mode", "5"), R"({"2000h": {"same_as": "2001h"}})");
  EXPECT_EQ(rules_of(other.text.diagnostics), std::vector<std::string>{"options"});
}

TEST(Meaning, ErrorCodesOfTheOptionsAreBeforeThoseOfTheProfile) {
  const Described device(drive, R"({"emcy": {"2310h": "motor current too high", "F001h": "door open"}})");
  const auto text_of = [&](std::uint16_t code) {
    for (const ErrorCodeName& one : device.text.device.error_codes) {
      if (one.code == code) return one.text;
    }
    return std::string{};
  };
  EXPECT_EQ(text_of(0x2310), "motor current too high");
  EXPECT_EQ(text_of(0xF001), "door open");
  EXPECT_NE(text_of(0x8130), "") << "of CiA 301";
}

// ---- faults in the options ----

TEST(MeaningOptions, AreReportedWhereTheyAre) {
  struct Row {
    std::string meaning;
    std::string_view place;  ///< what the finding points at
  };
  const Row rows[] = {
      {R"([])", "\"meaning\""},
      {R"({"x": {}})", "\"x\""},
      {R"({"2000h..2001h": {}})", "\"2000h.."},
      {R"({"2000h": {"units": "V"}})", "\"units\""},
      {R"({"2000h": {"unit": 1}})", "\"unit\""},
      {R"({"2000h": {"scale": "one"}})", "\"scale\""},
      {R"({"2000h": {"values": {"a": "b"}}})", "\"a\""},
      {R"({"2000h": {"values": {"1": "Not snake"}}})", "\"1\""},
      {R"({"2000h": {"values": {"1": "a", "2": "a"}}})", "\"2\""},
      {R"({"2000h": {"values": {"1": "a", "0x1": "b"}}})", "\"values\""},
      {R"({"2000h": {"bits": {"x": "a"}}})", "\"x\""},
      {R"({"2000h": {"bits": {"64": "a"}}})", "\"64\""},
      {R"({"2000h": {"bits": {"7..4": "a"}}})", "\"7..4\""},
      {R"({"2000h": {"masked": {"state": {"a": ["0x1", "0x2"]}}}})", "\"a\""},
      {R"({"2000h": {"cases": {"x": {}}}})", "\"x\""},
      {R"({"2000h": {"same_as": "x"}})", "\"same_as\""},
      {R"({"emcy": {"x": "y"}})", "\"x\""},
      {R"({"emcy": {"2310h": ""}})", "\"2310h\""},
  };
  for (const Row& row : rows) {
    const std::string text = R"({ "meaning": )" + row.meaning + " }";
    const ReadOptions read(text);
    ASSERT_EQ(read.diagnostics.all().size(), 1U) << row.meaning;
    const Diagnostic& finding = read.diagnostics.all().front();
    EXPECT_EQ(finding.rule.text(), "options") << row.meaning;
    EXPECT_TRUE(text.substr(finding.position.column - 1).starts_with(row.place))
        << row.meaning << finding.position.column;
  }
}

}  // namespace
}  // namespace edsc
