/// The meaning of entries and error codes in the JSON view. docs/schema/device.schema.json has the names of members.
#include "backend/json/meaning_view.hpp"

#include <gtest/gtest.h>

#include <string>

#include "backend/json/device_view.hpp"
#include "support/device_from_text.hpp"
#include "support/read_options.hpp"

namespace edsc {
namespace {

using nlohmann::json;

/// The view of a device with these sections, and this option "meaning".
json view_of(const std::string& sections, const std::string& meaning) {
  const ReadOptions options(R"({ "meaning": )" + meaning + " }");
  EXPECT_TRUE(options.diagnostics.all().empty()) << meaning;
  const DeviceFromText text(sections, options.options);
  return device_view(text.device, text.names.identifiers());
}

/// The meaning of the last object, a VAR.
json meaning_of(const std::string& sections, const std::string& meaning) {
  return view_of(sections, meaning)["objects"].back()["entries"][0].value("meaning", json{});
}

TEST(MeaningView, IsNotThereIfNothingIsKnown) { EXPECT_EQ(meaning_of(var("2000", "Value", "5"), "{}"), json{}); }

TEST(MeaningView, HasTheQuantityExactly) {
  EXPECT_EQ(meaning_of(var("2000", "Value", "3"),
                       R"({"2000h": {"unit": "degC", "scale": 0.1, "offset": -40, "place": "4.2"}})"),
            json::parse(R"({"quantity": {"unit": "°C", "ascii_unit": "degC", "scale": "1/10", "offset": "-40",
                            "source": "options"}, "place": "4.2", "source": "options"})"));
}

TEST(MeaningView, HasAUnitOfTheEdsThatIsUnknownAsWritten) {
  const json quantity = meaning_of(var("2000", "Value", "3", "rw", "Unit=furlong\n"), "{}")["quantity"];
  EXPECT_EQ(quantity, json::parse(R"({"unit": "furlong", "ascii_unit": null, "scale": "1", "offset": "0",
                                      "source": "eds"})"));
}

TEST(MeaningView, HasNamesOfValues) {
  const json meaning = meaning_of(
      var("2000", "Value", "2"),
      R"({"2000h": {"values": {"-1": {"name": "homing", "text": "Moves.", "place": "t. 3"}, "0": "off"}, "closed": true}})");
  EXPECT_EQ(meaning["values"], json::parse(R"([{"value": -1, "name": "homing", "text": "Moves.", "place": "t. 3",
                                               "source": "options"}, {"value": 0, "name": "off",
                                               "source": "options"}])"));
  EXPECT_EQ(meaning["closed"], true);
}

TEST(MeaningView, HasTheHighestValueOfUnsigned64) {
  EXPECT_EQ(meaning_of(var("2000", "Value", "0x1B"),
                       R"({"2000h": {"values": {"0xFFFFFFFFFFFFFFFF": "all"}}})")["values"][0]["value"],
            18446744073709551615U);
}

TEST(MeaningView, HasFieldsAndReservedBits) {
  const json fields = meaning_of(var("2000", "Value", "6"),
                                 R"({"2000h": {"bits": {"0": "open", "1..2": {"name": "zone", "values": {"0": "hall"}},
                                     "7": null, "8..15": {"name": "t", "unit": "K", "signed": true}}}})")["fields"];
  ASSERT_EQ(fields.size(), 4U);
  EXPECT_EQ(fields[0], json::parse(R"({"first_bit": 0, "bits": 1, "name": "open", "signed": false,
                                       "source": "options"})"));
  EXPECT_EQ(fields[1]["bits"], 2);
  EXPECT_EQ(fields[1]["values"][0]["name"], "hall");
  EXPECT_EQ(fields[2]["name"], nullptr);
  EXPECT_EQ(fields[3]["signed"], true);
  EXPECT_EQ(fields[3]["quantity"]["unit"], "K");
}

TEST(MeaningView, HasMaskedValuesAndCases) {
  const json meaning =
      meaning_of(var("2000", "Mode", "5") + var("2001", "Value", "6"),
                 R"({"2000h": {"values": {"1": "slow"}}, "2001h": {"masked": {"state": {"fault": ["0x4F", "0x08"]}},
                     "depends_on": "2000h", "cases": {"1": {"bits": {"12": "late"}}}}})");
  EXPECT_EQ(meaning["masked"], json::parse(R"([{"name": "state", "values": [{"mask": 79, "value": 8, "name": "fault",
                                               "source": "options"}]}])"));
  EXPECT_EQ(meaning["depends_on"], json::parse(R"({"index": 8192, "sub_index": 0})"));
  ASSERT_EQ(meaning["cases"].size(), 1U);
  EXPECT_EQ(meaning["cases"][0]["values"], json{1});
  EXPECT_EQ(meaning["cases"][0]["fields"][0]["name"], "late");
}

TEST(MeaningView, HasTheEntryWithTheSameValues) {
  const json meaning = meaning_of(var("2000", "Mode", "5") + var("2001", "Value", "5"),
                                  R"({"2000h": {"values": {"1": "slow"}}, "2001h": {"same_as": "2000h"}})");
  EXPECT_EQ(meaning["same_as"], json::parse(R"({"index": 8192, "sub_index": 0})"));
  EXPECT_EQ(meaning["values"][0]["name"], "slow");
}

TEST(MeaningView, HasErrorCodesOfTheOptionsAndOfProfiles) {
  const json codes =
      view_of(var("2000", "Value", "5"), R"({"emcy": {"2310h": {"text": "too hot", "place": "6"}}})")["error_codes"];
  const auto find = [&](int code) {
    for (const json& one : codes) {
      if (one["code"] == code) return one;
    }
    return json{};
  };
  EXPECT_EQ(find(0x2310), json::parse(R"({"code": 8976, "text": "too hot", "place": "6", "source": "options"})"));
  EXPECT_EQ(find(0x8130)["source"], "profile");
}

}  // namespace
}  // namespace edsc
