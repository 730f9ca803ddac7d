#include "decode/emergency_text.hpp"

#include <algorithm>
#include <canopen/emcy/emcy_consumer.hpp>
#include <iterator>

namespace edsc {
namespace {

struct ProfileCode {
  std::uint16_t profile;
  std::uint16_t code;
  std::string_view text;
};

constexpr std::uint16_t io_modules = 401, drives = 402;

constexpr ProfileCode profile_codes[] = {
    // CiA 401-1
    {io_modules, 0x2310, "output current too high"},
    {io_modules, 0x2320, "short circuit at an output"},
    {io_modules, 0x2330, "load dump at an output"},
    {io_modules, 0x3110, "input voltage too high"},
    {io_modules, 0x3120, "input voltage too low"},
    {io_modules, 0x3210, "internal voltage too high"},
    {io_modules, 0x3220, "internal voltage too low"},
    {io_modules, 0x3310, "output voltage too high"},
    {io_modules, 0x3320, "output voltage too low"},
    // CiA 402-2
    {drives, 0x2110, "short circuit or earth leakage, input"},
    {drives, 0x2120, "earth leakage, input"},
    {drives, 0x2121, "earth leakage, phase L1"},
    {drives, 0x2122, "earth leakage, phase L2"},
    {drives, 0x2123, "earth leakage, phase L3"},
    {drives, 0x2130, "short circuit, input"},
    {drives, 0x2131, "short circuit, phases L1 and L2"},
    {drives, 0x2132, "short circuit, phases L2 and L3"},
    {drives, 0x2133, "short circuit, phases L3 and L1"},
    {drives, 0x2211, "internal current 1"},
    {drives, 0x2212, "internal current 2"},
    {drives, 0x2213, "over-current in ramp function"},
    {drives, 0x2214, "over-current in the sequence"},
    {drives, 0x2220, "continuous over-current inside the device"},
    {drives, 0x2221, "continuous over-current 1 inside the device"},
    {drives, 0x2222, "continuous over-current 2 inside the device"},
    {drives, 0x2230, "short circuit or earth leakage inside the device"},
    {drives, 0x2240, "earth leakage inside the device"},
    {drives, 0x2250, "short circuit inside the device"},
    {drives, 0x2310, "continuous over-current"},
    {drives, 0x2311, "continuous over-current 1"},
    {drives, 0x2312, "continuous over-current 2"},
    {drives, 0x2320, "short circuit or earth leakage, motor side"},
    {drives, 0x2330, "earth leakage, motor side"},
    {drives, 0x2331, "earth leakage, phase U"},
    {drives, 0x2332, "earth leakage, phase V"},
    {drives, 0x2333, "earth leakage, phase W"},
    {drives, 0x2340, "short circuit, motor side"},
    {drives, 0x2341, "short circuit, phases U and V"},
    {drives, 0x2342, "short circuit, phases V and W"},
    {drives, 0x2343, "short circuit, phases W and U"},
    {drives, 0x2350, "load level fault (I2t)"},
    {drives, 0x2351, "load level warning (I2t)"},
    {drives, 0x3110, "mains over-voltage"},
    {drives, 0x3111, "mains over-voltage, phase L1"},
    {drives, 0x3112, "mains over-voltage, phase L2"},
    {drives, 0x3113, "mains over-voltage, phase L3"},
    {drives, 0x3120, "mains under-voltage"},
    {drives, 0x3121, "mains under-voltage, phase L1"},
    {drives, 0x3122, "mains under-voltage, phase L2"},
    {drives, 0x3123, "mains under-voltage, phase L3"},
    {drives, 0x3130, "phase failure"},
    {drives, 0x3131, "phase failure, L1"},
    {drives, 0x3132, "phase failure, L2"},
    {drives, 0x3133, "phase failure, L3"},
    {drives, 0x3134, "phase sequence"},
    {drives, 0x3140, "mains frequency"},
    {drives, 0x3141, "mains frequency too high"},
    {drives, 0x3142, "mains frequency too low"},
    {drives, 0x3210, "DC link over-voltage"},
    {drives, 0x3211, "DC link over-voltage 1"},
    {drives, 0x3212, "DC link over-voltage 2"},
    {drives, 0x3220, "DC link under-voltage"},
    {drives, 0x3221, "DC link under-voltage 1"},
    {drives, 0x3222, "DC link under-voltage 2"},
    {drives, 0x3230, "load error"},
    {drives, 0x3310, "output over-voltage"},
    {drives, 0x3311, "output over-voltage, phase U"},
    {drives, 0x3312, "output over-voltage, phase V"},
    {drives, 0x3313, "output over-voltage, phase W"},
    {drives, 0x3320, "armature circuit"},
    {drives, 0x3321, "armature circuit interrupted"},
    {drives, 0x3330, "field circuit"},
    {drives, 0x3331, "field circuit interrupted"},
    {drives, 0x4110, "ambient temperature too high"},
    {drives, 0x4120, "ambient temperature too low"},
    {drives, 0x4130, "temperature of supply air"},
    {drives, 0x4140, "temperature of outlet air"},
    {drives, 0x4210, "device temperature too high"},
    {drives, 0x4220, "device temperature too low"},
    {drives, 0x4300, "drive temperature"},
    {drives, 0x4310, "drive temperature too high"},
    {drives, 0x4320, "drive temperature too low"},
    {drives, 0x4400, "supply temperature"},
    {drives, 0x4410, "supply temperature too high"},
    {drives, 0x4420, "supply temperature too low"},
    {drives, 0x5100, "supply"},
    {drives, 0x5110, "supply, low voltage"},
    {drives, 0x5111, "supply, 15 V"},
    {drives, 0x5112, "supply, 24 V"},
    {drives, 0x5113, "supply, 5 V"},
    {drives, 0x5120, "supply, DC link"},
    {drives, 0x5200, "control"},
    {drives, 0x5210, "measurement circuit"},
    {drives, 0x5220, "computing circuit"},
    {drives, 0x5300, "operating unit"},
    {drives, 0x5400, "power section"},
    {drives, 0x5410, "output stages"},
    {drives, 0x5420, "chopper"},
    {drives, 0x5430, "input stages"},
    {drives, 0x5440, "contacts"},
    {drives, 0x5450, "fuses"},
    {drives, 0x5500, "hardware memory"},
    {drives, 0x5510, "RAM"},
    {drives, 0x5520, "ROM"},
    {drives, 0x5530, "non-volatile memory"},
    {drives, 0x6010, "software reset by watchdog"},
    {drives, 0x6310, "loss of parameters"},
    {drives, 0x6320, "parameter error"},
    {drives, 0x7100, "power"},
    {drives, 0x7110, "brake chopper"},
    {drives, 0x7111, "brake chopper failure"},
    {drives, 0x7112, "brake chopper over-current"},
    {drives, 0x7113, "brake chopper protective circuit"},
    {drives, 0x7120, "motor"},
    {drives, 0x7121, "motor blocked"},
    {drives, 0x7122, "motor error or wrong commutation"},
    {drives, 0x7123, "motor tilted"},
    {drives, 0x7200, "measurement circuit"},
    {drives, 0x7300, "sensor"},
    {drives, 0x7301, "tachometer fault"},
    {drives, 0x7302, "tachometer, wrong polarity"},
    {drives, 0x7303, "resolver 1"},
    {drives, 0x7304, "resolver 2"},
    {drives, 0x7305, "incremental encoder 1"},
    {drives, 0x7306, "incremental encoder 2"},
    {drives, 0x7307, "incremental encoder 3"},
    {drives, 0x7310, "speed sensor"},
    {drives, 0x7320, "position sensor"},
    {drives, 0x7400, "computation circuit"},
    {drives, 0x7500, "communication"},
    {drives, 0x7510, "serial interface 1"},
    {drives, 0x7520, "serial interface 2"},
    {drives, 0x7600, "external data storage"},
    {drives, 0x8300, "torque control"},
    {drives, 0x8311, "excess torque"},
    {drives, 0x8312, "difficult start-up"},
    {drives, 0x8313, "standstill torque"},
    {drives, 0x8321, "torque too low"},
    {drives, 0x8331, "torque fault"},
    {drives, 0x8400, "speed controller"},
    {drives, 0x8500, "position controller"},
    {drives, 0x8600, "positioning controller"},
    {drives, 0x8611, "following error"},
    {drives, 0x8612, "reference limit"},
    {drives, 0x8700, "synchronisation controller"},
    {drives, 0x8800, "winding controller"},
    {drives, 0x8900, "process data monitoring"},
    {drives, 0x8A00, "control monitoring"},
    {drives, 0xF001, "deceleration"},
    {drives, 0xF002, "sub-synchronous run"},
    {drives, 0xF003, "stroke operation"},
    {drives, 0xF004, "control, additional functions"},
};

/// The bits of 1001h, from bit 0 (CiA 301, 7.5.2.2).
constexpr std::string_view register_bits[] = {"generic",       "current",        "voltage",        "temperature",
                                              "communication", "device profile", "reserved bit 6", "manufacturer"};

}  // namespace

std::string_view emergency_text(std::uint16_t code, std::uint16_t profile) {
  for (const ProfileCode& row : profile_codes) {
    if (row.profile == profile && row.code == code) return row.text;
  }
  // Other profiles define their own codes in the error classes of CiA 301.
  const auto is_known = [](std::uint16_t wanted) {
    return std::ranges::any_of(canopen::emergency_code_texts,
                               [&](const canopen::EmergencyCodeText& row) { return (wanted & row.mask) == row.code; });
  };
  return canopen::emergency_text(is_known(code) ? code : static_cast<std::uint16_t>(code & 0xF000));
}

void append_error_register(std::string& text, std::uint8_t error_register) {
  if (error_register == 0) text += "no error";
  std::string_view separator;
  for (std::size_t bit = 0; bit < std::size(register_bits); ++bit) {
    if ((error_register >> bit & 1) == 0) continue;
    text += separator;
    text += register_bits[bit];
    separator = ", ";
  }
}

}  // namespace edsc
