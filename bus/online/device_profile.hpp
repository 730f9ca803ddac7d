/// The device profile in the low word of the device type (CiA 301, 7.5.2.1).
#pragma once

#include <cstdint>
#include <string>
#include <string_view>

namespace edsc {

struct DeviceProfile {
  std::uint16_t number;
  std::string_view name;
};

inline constexpr DeviceProfile device_profiles[] = {
    {401, "I/O modules"},
    {402, "drives and motion control"},
    {404, "measuring devices and closed-loop controllers"},
    {405, "IEC 61131-3 programmable devices"},
    {406, "encoders"},
    {408, "fluid power technology"},
    {410, "inclinometers"},
    {412, "medical devices"},
    {413, "truck gateways"},
    {414, "weaving machines"},
    {415, "road construction machinery"},
    {416, "building doors"},
    {417, "lift control systems"},
    {418, "battery modules"},
    {419, "battery chargers"},
    {420, "extruder downstream devices"},
    {421, "train vehicle control networks"},
    {422, "municipal vehicles"},
    {423, "rail vehicle power drives"},
    {424, "rail vehicle doors"},
    {425, "medical diagnostic add-on modules"},
    {430, "auxiliary operating devices in rail vehicles"},
    {434, "laboratory automation systems"},
    {436, "construction machinery"},
    {437, "photovoltaic systems"},
    {442, "IEC 61915-2 motor management"},
    {443, "subsea instruments"},
    {444, "container-handling machines"},
    {445, "RFID devices"},
    {446, "AS-Interface gateways"},
    {447, "special-purpose car add-on devices"},
    {450, "pumps"},
    {452, "drives with the profile of PLCopen"},
    {453, "power supplies"},
    {454, "energy management systems"},
    {455, "drilling machines"},
    {458, "energy measurements"},
    {459, "on-board weighing"},
    {460, "service robot controllers"},
    {461, "weighing devices"},
    {462, "item detection devices"},
};

/// `CiA 402, drives and motion control`
[[nodiscard]] inline std::string profile_text(std::uint32_t device_type) {
  const auto number = static_cast<std::uint16_t>(device_type & 0xFFFF);
  if (number == 0) return "no profile";
  for (const DeviceProfile& profile : device_profiles) {
    if (profile.number == number) return "CiA " + std::to_string(number) + ", " + std::string{profile.name};
  }
  return "CiA " + std::to_string(number);
}

}  // namespace edsc
