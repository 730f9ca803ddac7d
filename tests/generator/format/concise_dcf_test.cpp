/// The concise DCF of object 1F22h (CiA 302-3).
#include "format/dcf/concise_dcf.hpp"

#include <fmt/format.h>
#include <gtest/gtest.h>

#include <string>

#include "support/device_from_text.hpp"

namespace edsc {
namespace {

constexpr const char* commissioning = "[DeviceComissioning]\nNodeID=5\n";

struct Concise {
  explicit Concise(std::string text, std::string file = "test.dcf")
      : device(std::move(text), {}, {}, std::move(file)),
        bytes(concise_dcf(device.sheet, device.device, diagnostics)) {}

  [[nodiscard]] std::string hex() const {
    std::string text;
    for (const char c : bytes) text += fmt::format("{}{:02X}", text.empty() ? "" : " ", static_cast<unsigned char>(c));
    return text;
  }

  DeviceFromText device;
  Diagnostics diagnostics;
  std::string bytes;
};

std::string configured(std::string_view data_type, std::string_view value, std::string_view access = "rw") {
  return commissioning + var("2000", "a", data_type, access, "ParameterValue=" + std::string{value} + "\n");
}

TEST(ConciseDcf, IsAnEmptyListWhenNothingDiffers) {
  EXPECT_EQ(Concise(commissioning + var("2000", "a", "7", "rw", "DefaultValue=0x10\nParameterValue=16\n")).hex(),
            "00 00 00 00");
}

TEST(ConciseDcf, HasIndexSubIndexLengthAndDataLowByteFirst) {
  EXPECT_EQ(Concise(configured("7", "0x12345678")).hex(), "01 00 00 00 00 20 00 04 00 00 00 78 56 34 12");
}

TEST(ConciseDcf, HasTheLengthOfTheType) {
  EXPECT_EQ(Concise(configured("1", "1")).hex(), "01 00 00 00 00 20 00 01 00 00 00 01");
  EXPECT_EQ(Concise(configured("3", "-2")).hex(), "01 00 00 00 00 20 00 02 00 00 00 FE FF");
  EXPECT_EQ(Concise(configured("0x16", "0x010203")).hex(), "01 00 00 00 00 20 00 03 00 00 00 03 02 01");
  EXPECT_EQ(Concise(configured("8", "1.0")).hex(), "01 00 00 00 00 20 00 04 00 00 00 00 00 80 3F");
  EXPECT_EQ(Concise(configured("0x1B", "1")).hex(), "01 00 00 00 00 20 00 08 00 00 00 01 00 00 00 00 00 00 00");
}

TEST(ConciseDcf, HasStringsWithoutTerminator) {
  EXPECT_EQ(Concise(configured("9", "ab")).hex(), "01 00 00 00 00 20 00 02 00 00 00 61 62");
  EXPECT_EQ(Concise(configured("0xA", "0A 0B")).hex(), "01 00 00 00 00 20 00 02 00 00 00 0A 0B");
  EXPECT_EQ(Concise(configured("0xB", "a\xC3\xA4")).hex(), "01 00 00 00 00 20 00 04 00 00 00 61 00 E4 00");
}

TEST(ConciseDcf, LeavesOutCommands) {
  const std::string commands = commissioning + group("1011", "Restore", "8", 2) +
                               var("1011sub0", "Highest sub-index", "5", "ro", "DefaultValue=1\n") +
                               var("1011sub1", "All", "7", "rw", "DefaultValue=1\nParameterValue=0x64616F6C\n") +
                               var("1023", "OS command", "5", "rw", "ParameterValue=1\n");
  EXPECT_EQ(Concise(commands).hex(), "00 00 00 00");
}

TEST(ConciseDcf, LeavesOutWhatCannotBeWritten) {
  EXPECT_EQ(Concise(configured("7", "1", "ro")).hex(), "00 00 00 00");
  EXPECT_EQ(Concise(configured("7", "1", "const")).hex(), "00 00 00 00");
}

TEST(ConciseDcf, ComparesFormulasAsNumbersOfTheNode) {
  const auto entry = [](const char* keys) { return commissioning + var("2000", "a", "7", "rw", keys); };
  EXPECT_EQ(Concise(entry("DefaultValue=$NODEID+0x180\nParameterValue=0x185\n")).hex(), "00 00 00 00");
  EXPECT_EQ(Concise(entry("DefaultValue=0x180\nParameterValue=$NODEID+0x180\n")).hex(),
            "01 00 00 00 00 20 00 04 00 00 00 85 01 00 00");
}

TEST(ConciseDcf, RefusesAFormulaWithoutNodeId) {
  const Concise concise(var("2000", "a", "7", "rw", "ParameterValue=$NODEID+1\n"));
  EXPECT_EQ(findings(concise.diagnostics), (std::vector<Finding>{error_at(6, 16, "node-id")}));
}

TEST(ConciseDcf, GoesUpByIndexAndSubIndex) {
  const std::string text = commissioning + var("2001", "b", "5", "rw", "ParameterValue=1\n") +
                           group("2000", "a", "9", 3) + var("2000sub0", "n", "5", "ro", "DefaultValue=2\n") +
                           var("2000sub2", "y", "5", "rw", "DefaultValue=1\nParameterValue=3\n") +
                           var("2000sub1", "x", "5", "rw", "DefaultValue=1\nParameterValue=2\n");
  EXPECT_EQ(Concise(text).hex(), "03 00 00 00 00 20 01 01 00 00 00 02 00 20 02 01 00 00 00 03 01 20 00 01 00 00 00 01");
}

/// Node 5 with TPDO 1: COB-ID 185h, one entry.
std::string tpdo(const char* cob_id, const char* type, const char* count, const char* entry) {
  const auto value = [](const char* keys, const char* parameter_value) {
    return std::string{keys} + (*parameter_value != 0 ? "ParameterValue=" + std::string{parameter_value} + "\n" : "");
  };
  return commissioning + group("1800", "TPDO 1", "9", 3) + var("1800sub0", "n", "5", "const", "DefaultValue=2\n") +
         var("1800sub1", "COB-ID", "7", "rw", value("DefaultValue=0x185\n", cob_id)) +
         var("1800sub2", "Type", "5", "rw", value("DefaultValue=255\n", type)) + group("1A00", "Mapping", "9", 3) +
         var("1A00sub0", "n", "5", "rw", value("DefaultValue=1\n", count)) +
         var("1A00sub1", "1", "7", "rw", value("DefaultValue=0x20000008\n", count[0] != 0 ? "0x20000008" : "")) +
         var("1A00sub2", "2", "7", "rw", value("DefaultValue=0\n", entry)) +
         var("2000", "a", "5", "ro", "PDOMapping=1\n") + var("2001", "b", "5", "ro", "PDOMapping=1\n");
}

TEST(ConciseDcf, DisablesAPdoWhileItsMappingChanges) {
  EXPECT_EQ(Concise(tpdo("0x40000285", "1", "2", "0x20010008")).hex(),
            "07 00 00 00"
            " 00 18 01 04 00 00 00 85 01 00 80"  // disabled, with the CAN-ID that the device has
            " 00 1A 00 01 00 00 00 00"           // number of mapped objects
            " 00 1A 01 04 00 00 00 08 00 00 20"
            " 00 1A 02 04 00 00 00 08 00 01 20"
            " 00 1A 00 01 00 00 00 02"
            " 00 18 02 01 00 00 00 01"  // transmission type
            " 00 18 01 04 00 00 00 85 02 00 40");
}

TEST(ConciseDcf, EnablesAPdoAgainWhoseCobIdRemains) {
  EXPECT_EQ(Concise(tpdo("", "1", "", "")).hex(),
            "03 00 00 00"
            " 00 18 01 04 00 00 00 85 01 00 80"
            " 00 18 02 01 00 00 00 01"
            " 00 18 01 04 00 00 00 85 01 00 00");
}

TEST(ConciseDcf, LeavesOutMappingEntriesAboveTheNumberOfMappedObjects) {
  const std::string hex = Concise(tpdo("", "", "0", "0x20010008")).hex();
  EXPECT_EQ(hex,
            "04 00 00 00"
            " 00 18 01 04 00 00 00 85 01 00 80"
            " 00 1A 00 01 00 00 00 00"
            " 00 1A 00 01 00 00 00 00"
            " 00 18 01 04 00 00 00 85 01 00 00");
}

TEST(ConciseDcf, ClearsTheSyncPeriodWhileTheOverflowChanges) {
  const std::string text = commissioning +
                           var("1005", "SYNC", "7", "rw", "DefaultValue=0x80\nParameterValue=0x40000080\n") +
                           var("1006", "Period", "7", "rw", "DefaultValue=5000\nParameterValue=10000\n") +
                           var("1019", "Overflow", "5", "rw", "DefaultValue=0\nParameterValue=10\n");
  EXPECT_EQ(Concise(text).hex(),
            "05 00 00 00"
            " 06 10 00 04 00 00 00 00 00 00 00"
            " 19 10 00 01 00 00 00 0A"
            " 06 10 00 04 00 00 00 10 27 00 00"
            " 05 10 00 04 00 00 00 80 00 00 00"
            " 05 10 00 04 00 00 00 80 00 00 40");
}

TEST(ConciseDcf, EndsWithTheDateOfTheConfiguration) {
  const std::string text = commissioning + group("1020", "Verify configuration", "8", 3) +
                           var("1020sub0", "n", "5", "ro", "DefaultValue=2\n") +
                           var("1020sub1", "Date", "7", "rw", "DefaultValue=0\nParameterValue=1\n") +
                           var("1020sub2", "Time", "7", "rw", "DefaultValue=0\nParameterValue=2\n") +
                           var("2000", "a", "5", "rw", "DefaultValue=0\nParameterValue=3\n");
  EXPECT_EQ(Concise(text).hex(),
            "03 00 00 00"
            " 00 20 00 01 00 00 00 03"
            " 20 10 01 04 00 00 00 01 00 00 00"
            " 20 10 02 04 00 00 00 02 00 00 00");
}

TEST(ConciseDcf, TakesTheValuesOfACompactForm) {
  const std::string text = std::string{commissioning} +
                           "[1016]\nParameterName=Consumer heartbeat time\nObjectType=8\nDataType=7\nAccessType=rw\n"
                           "DefaultValue=0\nCompactSubObj=3\n[1016Value]\nNrOfEntries=2\n2=0x7F0064\n3=0\n";
  EXPECT_EQ(Concise(text).hex(), "01 00 00 00 16 10 02 04 00 00 00 64 00 7F 00");
}

TEST(ConciseDcf, TakesTheParameterValuesOfAnEdsToo) {
  const std::string text = var("2000", "a", "5", "rw", "DefaultValue=1\nParameterValue=2\n");
  EXPECT_EQ(Concise(text, "test.eds").hex(), "01 00 00 00 00 20 00 01 00 00 00 02");
}

}  // namespace
}  // namespace edsc
