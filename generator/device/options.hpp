/// The options file `NAME.options.json`: what a device does that an EDS has no words for.
#pragma once

#include <algorithm>
#include <array>
#include <cstdint>
#include <map>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "diagnostics/diagnostics.hpp"
#include "text/source_file.hpp"

namespace edsc {

using EntryKey = std::pair<std::uint16_t, std::uint8_t>;

/// One entry, or all of an object where no sub-index is given.
struct EntrySelector {
  std::uint16_t index = 0;
  std::optional<std::uint8_t> sub_index;

  friend bool operator==(const EntrySelector&, const EntrySelector&) = default;
};

/// Mapping parameters that are constants whatever access the data sheet gives them.
struct StaticMapping {
  bool all = false;
  std::vector<std::uint16_t> parameters;  ///< indices

  [[nodiscard]] bool applies_to(std::uint16_t index) const {
    return all || std::ranges::find(parameters, index) != parameters.end();
  }
};

/// The bytes of an EMCY behind error code and error register.
using EmergencyInfo = std::array<std::uint8_t, 5>;

/// Members of canopen::LssOptions that are true or false, in its order.
inline constexpr std::array lss_flags = {"manufacturer_bit_timing", "unconfigurable", "fastscan", "served_in_stopped",
                                         "served_in_operational"};

/// How a device is configured by LSS, as far as the options say; what they do not is the default of CiA 305.
struct LssSettings {
  std::optional<std::uint16_t> bit_rates;  ///< canopen::LssOptions::bit_rates; else those of the data sheet
  std::map<std::string, bool> flags;       ///< by member

  friend bool operator==(const LssSettings&, const LssSettings&) = default;
};

/// What 1021h holds: what the application binds to it, the data sheet's text, or the same as a gzip file.
enum class StoredEds : std::uint8_t { of_application, text, compressed };

/// A rule whose findings are not reported.
struct SilencedRule {
  std::string rule;
  Position position;
};

/// Findings of a rule that are expected, and why: of one object or entry, or of the whole data sheet.
struct AllowedFindings {
  std::string rule;
  std::optional<EntrySelector> object;
  std::string reason;
  Position position;
};

struct Options {
  /// C++ names to use in place of the one made from ParameterName.
  std::map<EntryKey, std::string> names;
  /// Bytes that a string in RAM can hold.
  std::map<EntryKey, std::uint16_t> string_capacity;
  /// Constant or ro entries that the application sets at start-up: they live in RAM.
  std::vector<EntryKey> settable;
  /// Rules that are not reported for this device.
  std::vector<SilencedRule> silence;
  /// What is plugged into a modular device: the numbers of the modules, by place. Empty: what the DCF says.
  std::vector<std::uint16_t> connected_modules;
  /// VISIBLE_STRINGs go out with a trailing 00h.
  bool zero_terminated_strings = false;
  StaticMapping static_mapping;
  /// Entries whose new value sends no event-driven TPDO.
  std::vector<EntrySelector> no_event;
  /// What the EMCYs that the services send by themselves carry, by emergency error code.
  std::map<std::uint16_t, EmergencyInfo> emergency_info;
  /// Entries that 1010h stores otherwise than their access says, by enumerator of canopen::Storing.
  std::vector<std::pair<EntrySelector, std::string>> storing;
  /// Set where the options speak of LSS: the device has it then, whatever the data sheet says.
  std::optional<LssSettings> lss;
  StoredEds stored_eds = StoredEds::of_application;
  /// Departures from CiA 301 that the runtime knows: member of canopen::DeviceOptions and its value in C++.
  std::vector<std::pair<std::string, std::string>> runtime;
  /// Findings that are expected.
  std::vector<AllowedFindings> allow;

  [[nodiscard]] bool is_settable(std::uint16_t index, std::uint8_t sub_index) const {
    return std::ranges::find(settable, EntryKey{index, sub_index}) != settable.end();
  }
};

/// Reads an options file. Unknown members and values of a wrong type are errors, with the member's path.
[[nodiscard]] Options read_options(const SourceFile& source, Diagnostics& diagnostics);

}  // namespace edsc
