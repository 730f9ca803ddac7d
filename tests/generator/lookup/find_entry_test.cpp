#include "lookup/find_entry.hpp"

#include <gtest/gtest.h>

#include "load/load_device.hpp"

namespace edsc {
namespace {

class FindEntry : public testing::Test {
 protected:
  static void SetUpTestSuite() {
    Diagnostics diagnostics;
    drive = load_device({EDSC_SOURCE_DIR "/eds/cpc-tc1.eds", "", "", 3}, diagnostics);
    inputs = load_device({EDSC_SOURCE_DIR "/eds/can-2053c.eds", "", "", 4}, diagnostics);
  }
  static void TearDownTestSuite() {
    drive.reset();
    inputs.reset();
  }

  /// The label of the entry or whole object that is found, otherwise the problem.
  static std::string find(std::string_view text, const LoadedDevice& device = *drive) {
    const FoundEntry found = find_entry(device.named(), text);
    if (!found.ok()) return found.problem;
    return found.entry != nullptr ? entry_label(found.entry->index, found.entry->sub_index)
                                  : index_label(found.object->index);
  }

  static std::unique_ptr<LoadedDevice> drive, inputs;
};

std::unique_ptr<LoadedDevice> FindEntry::drive, FindEntry::inputs;

TEST_F(FindEntry, TakesAddresses) {
  for (const char* text : {"6064h", "0x6064", "6064", "6064h:00", "0x6064:0", " 6064H "})
    EXPECT_EQ(find(text), "6064h:00") << text;
  for (const char* text : {"1018h:02", "0x1018:2", "0x1018:0x02", "1018:2"}) EXPECT_EQ(find(text), "1018h:02") << text;
  EXPECT_EQ(find("1018h"), "1018h");
}

TEST_F(FindEntry, TakesASubIndexAsHexadecimalBehindAnHAndAsDecimalBehind0x) {
  EXPECT_EQ(parse_entry_address("1003h:10"), (EntryAddress{0x1003, 0x10}));
  EXPECT_EQ(parse_entry_address("0x1003:10"), (EntryAddress{0x1003, 10}));
  EXPECT_EQ(parse_entry_address("0x1003:256"), std::nullopt);
  EXPECT_EQ(parse_entry_address("1003h:"), std::nullopt);
  EXPECT_EQ(parse_entry_address("10030h"), std::nullopt);
}

TEST_F(FindEntry, TakesNamesAsGeneratedAndAsInTheDataSheet) {
  for (const char* text : {"position_actual_value", "Position Actual Value", "POSITION_ACTUAL_VALUE"}) {
    EXPECT_EQ(find(text), "6064h:00") << text;
  }
  for (const char* text : {"identity_object.vendor_id", "Identity object.Vendor-ID", "identity_object, vendor_id",
                           "identity_object::vendor_id", "identity_object.1", "identity_object:1", "vendor_id"}) {
    EXPECT_EQ(find(text), "1018h:01") << text;
  }
  EXPECT_EQ(find("read_input_8_bit[1]", *inputs), "6000h:01");
  EXPECT_EQ(find("read_input_8_bit<1>", *inputs), "6000h:01");
}

TEST_F(FindEntry, SuggestsWhatWasMeant) {
  EXPECT_EQ(find("positon_actual_value"),
            "the device has no object \"positon_actual_value\"; did you mean position_actual_value (6064h)?");
  EXPECT_NE(find("vendr_id").find("did you mean 1018h:01 identity_object.vendor_id"), std::string::npos)
      << find("vendr_id");
  EXPECT_EQ(find("xyzzy"), "the device has no object \"xyzzy\"");
  EXPECT_NE(find("6065h:00").find("the nearest objects are 6064h position_actual_value and"), std::string::npos)
      << find("6065h:00");
  EXPECT_NE(find("1018h:09").find("has no sub-index 09h; it has 1018h:00"), std::string::npos) << find("1018h:09");
  EXPECT_NE(find("identity_object.serial").find("has no entry \"serial\"; it has 1018h:00"), std::string::npos);
}

TEST_F(FindEntry, AsksWhichEntryWhereANameIsTaken) {
  EXPECT_NE(find("transmission_type").find("\"transmission_type\" is ambiguous: 1400h:02"), std::string::npos)
      << find("transmission_type");
  const FoundEntry whole = find_one_entry(drive->named(), "1018h");
  EXPECT_NE(whole.problem.find("1018h \"Identity object\" has sub-indices: 1018h:00"), std::string::npos)
      << whole.problem;
  EXPECT_TRUE(find_one_entry(drive->named(), "6064h").ok());
}

}  // namespace
}  // namespace edsc
