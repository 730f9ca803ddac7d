/// Texts of error codes: each row of CiA 402-2 and CiA 401-1, written from the tables of the profiles, and names that a
/// device defines.
#include "device/error_code_text.hpp"

#include <fmt/format.h>
#include <gtest/gtest.h>

#include <canopen/emcy/emcy_consumer.hpp>
#include <cstdint>
#include <string>
#include <string_view>

#include "support/device_from_text.hpp"
#include "support/read_options.hpp"
#include "values/little_endian.hpp"

namespace edsc {
namespace {

constexpr std::uint16_t io_modules = 401, drives = 402;

struct Code {
  std::uint16_t code;
  std::string_view words;  ///< part of the text
};

constexpr Code codes_of_drives[] = {
    {0x2110, "short circuit or earth leakage"},
    {0x2120, "earth leakage"},
    {0x2121, "L1"},
    {0x2122, "L2"},
    {0x2123, "L3"},
    {0x2130, "short circuit"},
    {0x2131, "L1 and L2"},
    {0x2132, "L2 and L3"},
    {0x2133, "L3 and L1"},
    {0x2211, "internal current 1"},
    {0x2212, "internal current 2"},
    {0x2213, "ramp"},
    {0x2214, "sequence"},
    {0x2220, "continuous over-current"},
    {0x2221, "continuous over-current 1"},
    {0x2222, "continuous over-current 2"},
    {0x2230, "short circuit or earth leakage inside"},
    {0x2240, "earth leakage inside"},
    {0x2250, "short circuit inside"},
    {0x2310, "continuous over-current"},
    {0x2311, "continuous over-current 1"},
    {0x2312, "continuous over-current 2"},
    {0x2320, "short circuit or earth leakage, motor"},
    {0x2330, "earth leakage, motor"},
    {0x2331, "phase U"},
    {0x2332, "phase V"},
    {0x2333, "phase W"},
    {0x2340, "short circuit, motor"},
    {0x2341, "U and V"},
    {0x2342, "V and W"},
    {0x2343, "W and U"},
    {0x2350, "I2t"},
    {0x2351, "warning (I2t)"},
    {0x3110, "mains over-voltage"},
    {0x3111, "over-voltage, phase L1"},
    {0x3112, "over-voltage, phase L2"},
    {0x3113, "over-voltage, phase L3"},
    {0x3120, "mains under-voltage"},
    {0x3121, "under-voltage, phase L1"},
    {0x3122, "under-voltage, phase L2"},
    {0x3123, "under-voltage, phase L3"},
    {0x3130, "phase failure"},
    {0x3131, "failure, L1"},
    {0x3132, "failure, L2"},
    {0x3133, "failure, L3"},
    {0x3134, "phase sequence"},
    {0x3140, "mains frequency"},
    {0x3141, "too high"},
    {0x3142, "too low"},
    {0x3210, "DC link over-voltage"},
    {0x3211, "over-voltage 1"},
    {0x3212, "over-voltage 2"},
    {0x3220, "DC link under-voltage"},
    {0x3221, "under-voltage 1"},
    {0x3222, "under-voltage 2"},
    {0x3230, "load"},
    {0x3310, "output over-voltage"},
    {0x3311, "phase U"},
    {0x3312, "phase V"},
    {0x3313, "phase W"},
    {0x3320, "armature circuit"},
    {0x3321, "armature circuit interrupted"},
    {0x3330, "field circuit"},
    {0x3331, "field circuit interrupted"},
    {0x4110, "ambient temperature too high"},
    {0x4120, "ambient temperature too low"},
    {0x4130, "supply air"},
    {0x4140, "outlet air"},
    {0x4210, "device temperature too high"},
    {0x4220, "device temperature too low"},
    {0x4300, "drive temperature"},
    {0x4310, "drive temperature too high"},
    {0x4320, "drive temperature too low"},
    {0x4400, "supply temperature"},
    {0x4410, "supply temperature too high"},
    {0x4420, "supply temperature too low"},
    {0x5100, "supply"},
    {0x5110, "low voltage"},
    {0x5111, "15 V"},
    {0x5112, "24 V"},
    {0x5113, "5 V"},
    {0x5120, "DC link"},
    {0x5200, "control"},
    {0x5210, "measurement circuit"},
    {0x5220, "computing circuit"},
    {0x5300, "operating unit"},
    {0x5400, "power section"},
    {0x5410, "output stages"},
    {0x5420, "chopper"},
    {0x5430, "input stages"},
    {0x5440, "contacts"},
    {0x5450, "fuses"},
    {0x5500, "memory"},
    {0x5510, "RAM"},
    {0x5520, "ROM"},
    {0x5530, "non-volatile"},
    {0x6010, "watchdog"},
    {0x6310, "loss of parameters"},
    {0x6320, "parameter error"},
    {0x7100, "power"},
    {0x7110, "brake chopper"},
    {0x7111, "failure"},
    {0x7112, "over-current"},
    {0x7113, "protective"},
    {0x7120, "motor"},
    {0x7121, "blocked"},
    {0x7122, "commutation"},
    {0x7123, "tilted"},
    {0x7200, "measurement circuit"},
    {0x7300, "sensor"},
    {0x7301, "tachometer"},
    {0x7302, "polarity"},
    {0x7303, "resolver 1"},
    {0x7304, "resolver 2"},
    {0x7305, "encoder 1"},
    {0x7306, "encoder 2"},
    {0x7307, "encoder 3"},
    {0x7310, "speed"},
    {0x7320, "position"},
    {0x7400, "computation circuit"},
    {0x7500, "communication"},
    {0x7510, "serial interface 1"},
    {0x7520, "serial interface 2"},
    {0x7600, "data storage"},
    {0x8300, "torque"},
    {0x8311, "excess torque"},
    {0x8312, "start-up"},
    {0x8313, "standstill torque"},
    {0x8321, "torque too low"},
    {0x8331, "torque fault"},
    {0x8400, "speed"},
    {0x8500, "position"},
    {0x8600, "positioning"},
    {0x8611, "following error"},
    {0x8612, "reference limit"},
    {0x8700, "synchronisation"},
    {0x8800, "winding"},
    {0x8900, "process data"},
    {0x8A00, "control"},
    {0xF001, "deceleration"},
    {0xF002, "sub-synchronous"},
    {0xF003, "stroke"},
    {0xF004, "control"},
};

constexpr Code codes_of_io_modules[] = {
    {0x2310, "output current too high"},  {0x2320, "short circuit"},           {0x2330, "load dump"},
    {0x3110, "input voltage too high"},   {0x3120, "input voltage too low"},   {0x3210, "internal voltage too high"},
    {0x3220, "internal voltage too low"}, {0x3310, "output voltage too high"}, {0x3320, "output voltage too low"},
};

/// A device of a profile, with an error history and error codes of its axes.
struct DeviceOfProfile {
  explicit DeviceOfProfile(std::uint16_t profile, const std::string& meaning = "{}")
      : options(R"({ "meaning": )" + meaning + " }"),
        text(var("1000", "Device type", "7", "ro", fmt::format("DefaultValue=0x{:08X}\n", profile)) +
                 "[1003]\nParameterName=Error history\nObjectType=8\nSubNumber=2\n"
                 "[1003sub0]\nParameterName=Number\nDataType=5\nAccessType=rw\n"
                 "[1003sub1]\nParameterName=Newest\nDataType=7\nAccessType=ro\n" +
                 var("603F", "Error code", "6", "ro") + var("683F", "Error code 2", "6", "ro"),
             options.options) {
    EXPECT_TRUE(options.diagnostics.all().empty()) << meaning;
  }

  [[nodiscard]] std::string_view of(std::uint16_t code) const { return error_code_text(&text.device, code); }
  [[nodiscard]] std::string value(std::uint16_t index, std::uint8_t sub_index, std::uint64_t number) const {
    const Entry& entry = text.entry(index, sub_index);
    std::string result;
    append_device_value(result, text.device, entry, bytes_of(number, bytes_for(entry.type->bits)));
    return result;
  }

  ReadOptions options;
  DeviceFromText text;
};

void expect_text(const Code& row, const DeviceOfProfile& device) {
  EXPECT_NE(device.of(row.code).find(row.words), std::string_view::npos) << std::hex << row.code << device.of(row.code);
  EXPECT_NE(device.of(row.code), error_code_text(nullptr, row.code))
      << std::hex << row.code << "h is as precise as CiA 301";
}

TEST(ErrorCodeText, HasEachCodeOfADrive) {
  const DeviceOfProfile drive{drives};
  for (const Code& row : codes_of_drives) expect_text(row, drive);
}

TEST(ErrorCodeText, HasEachCodeOfAnIoModule) {
  const DeviceOfProfile module{io_modules};
  for (const Code& row : codes_of_io_modules) expect_text(row, module);
}

TEST(ErrorCodeText, IsTheClassOfCia301ForACodeWithoutAName) {
  for (const std::uint16_t profile : {std::uint16_t{0}, io_modules, drives}) {
    const DeviceOfProfile device{profile};
    EXPECT_EQ(device.of(0x2F01), "current");
    EXPECT_EQ(device.of(0x0000), "no error");
    EXPECT_EQ(device.of(0x8130), error_code_text(nullptr, 0x8130));
    EXPECT_EQ(device.of(0xA000), "unknown emergency error code");
  }
}

TEST(ErrorCodeText, OfTheRuntimeAndOfTheProfileOfCia301AreTheSame) {
  const DeviceOfProfile device{0};
  for (const canopen::EmergencyCodeText& row : canopen::emergency_code_texts) {
    EXPECT_EQ(device.of(row.code), row.text) << std::hex << row.code;
  }
}

TEST(ErrorCodeText, OfTheOptionsReplacesThatOfTheProfile) {
  const DeviceOfProfile drive{drives, R"({"emcy": {"8611h": "axis is blocked", "FF01h": "door is open"}})"};
  EXPECT_EQ(drive.of(0x8611), "axis is blocked");
  EXPECT_EQ(drive.of(0xFF01), "door is open");
  EXPECT_EQ(drive.of(0xFF02), "device specific");
  EXPECT_EQ(drive.of(0x8612), "reference limit");
}

TEST(ErrorCodeText, IsAnErrorUnlessItIsAResetCodeWithoutAName) {
  const DeviceOfProfile drive{drives, R"({"emcy": {"000Ah": "motor overcurrent", "0000h": "no alarm"}})"};
  const Device& device = drive.text.device;
  EXPECT_TRUE(is_error(&device, 0x000A));
  EXPECT_FALSE(is_error(&device, 0x0000));
  EXPECT_FALSE(is_error(&device, 0x000B));
  EXPECT_TRUE(is_error(&device, 0x1000));
  EXPECT_FALSE(is_error(nullptr, 0x000A));
  EXPECT_TRUE(is_error(nullptr, 0x0100));
}

TEST(ErrorCodeText, IsShownForTheErrorHistoryAndTheErrorCodesOfAxes) {
  const DeviceOfProfile drive{drives};
  EXPECT_EQ(drive.value(0x1003, 1, 0x0000'8611), "00008611h following error");
  EXPECT_EQ(drive.value(0x1003, 1, 0x0001'8611), "00018611h following error, additional_information=0001h");
  EXPECT_EQ(drive.value(0x1003, 0, 1), "1");
  EXPECT_EQ(drive.value(0x603F, 0, 0x8611), "8611h following error");
  EXPECT_EQ(drive.value(0x683F, 0, 0x2F01), "2F01h current");
}

TEST(ErrorCodeText, IsNotShownFor603FhOfAnotherProfileOrWithNamesOfItsOwn) {
  EXPECT_EQ(DeviceOfProfile{io_modules}.value(0x603F, 0, 0x8611), "34321 (8611h)");
  const DeviceOfProfile named{drives,
                              R"({"603Fh": {"bits": {"0..7": {"name": "alarm", "values": {"10": "overcurrent"}}}}})"};
  EXPECT_EQ(named.value(0x603F, 0, 10), "000Ah alarm=overcurrent");
}

}  // namespace
}  // namespace edsc
