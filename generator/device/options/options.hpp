/// The options file `NAME.options.json`: behaviour of a device that an EDS cannot express.
#pragma once

#include <algorithm>
#include <array>
#include <cstdint>
#include <map>
#include <memory>
#include <optional>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "device/entry_address.hpp"
#include "device/meaning/description.hpp"
#include "diagnostics/diagnostics.hpp"
#include "text/reading_choices.hpp"
#include "text/source_file.hpp"

namespace edsc {

/// Mapping parameters that are constants regardless of their access type in the EDS.
struct StaticMapping {
  bool all = false;
  std::vector<std::uint16_t> parameters;  ///< indices, ascending

  [[nodiscard]] bool applies_to(std::uint16_t index) const {
    return all || std::ranges::binary_search(parameters, index);
  }
};

/// The bytes of an EMCY message after error code and error register.
using EmergencyInfo = std::array<std::uint8_t, 5>;

/// LSS options of a device; values that are not given have the default of CiA 305.
struct LssSettings {
  std::optional<std::uint16_t> bit_rates;  ///< canopen::LssOptions::bit_rates; otherwise those of the EDS
  std::map<std::string, bool> flags;       ///< by member

  friend bool operator==(const LssSettings&, const LssSettings&) = default;
};

/// The value of 1021h: bound by the application, the text of the EDS, or the EDS as a gzip file.
enum class StoredEds : std::uint8_t { of_application, text, compressed };

/// A silenced rule.
struct SilencedRule {
  std::string rule;
  Position position;
};

/// Expected findings of a rule, with a reason: for one object or entry, or for the whole EDS.
struct AllowedFindings {
  std::string rule;
  std::optional<EntryAddress> object;
  std::string reason;
  Position position;
};

/// An option by its deprecated name, outside its group.
struct DeprecatedOption {
  Position position;
  std::string message;
};

struct OptionRow;

/// The unit of the inhibit times of PDOs in microseconds (CiA 301, 7.5.2.37), unless an option states another.
inline constexpr std::uint32_t usual_inhibit_time_unit = 100;

/// A deviation from CiA 301 for the runtime: a member of canopen::DeviceOptions.
struct RuntimeOption {
  const OptionRow* row;
  std::uint32_t value;     ///< 0 or 1 of a flag
  std::uint32_t last = 0;  ///< of a range; `value` is the first
};

/// Whether a text can be the name of an object in the generated code.
using NameCheck = bool (*)(std::string_view name);

struct Options {
  /// Names in the generated code that replace those made from ParameterName.
  std::map<EntryKey, std::string> names;
  /// Maximum bytes of a string in RAM.
  std::map<EntryKey, std::uint16_t> string_capacity;
  /// Constant or ro entries that the application sets at start-up: they are in RAM.
  std::vector<EntryKey> settable;  ///< ascending, without duplicates
  /// Rules that are not reported for this device.
  std::vector<SilencedRule> silence;
  /// The connected modules of a modular device: their numbers, by place. Empty: as in the DCF.
  std::vector<std::uint16_t> connected_modules;
  /// VISIBLE_STRINGs are uploaded with a trailing 00h.
  bool zero_terminated_strings = false;
  StaticMapping static_mapping;
  /// Entries whose new value does not trigger event-driven TPDOs.
  std::vector<EntryAddress> no_event;
  /// The manufacturer-specific bytes of EMCY messages that the services send themselves, by emergency error code.
  std::map<std::uint16_t, EmergencyInfo> emergency_info;
  /// Entries for which 1010h does not follow the access type, with their enumerator of canopen::Storing.
  std::vector<std::pair<EntryAddress, std::string>> storing;
  /// Entries that a sub-index of 1010h from 05h on stores.
  std::vector<std::pair<EntryAddress, std::uint8_t>> stored_by;
  /// Sub-indices of 1010h whose parameters the application stores by itself.
  std::vector<std::uint8_t> autonomous_storage;
  /// Set if the options file has the group `lss`: the device then supports LSS regardless of the EDS.
  std::optional<LssSettings> lss;
  StoredEds stored_eds = StoredEds::of_application;
  /// How the EDS is read.
  ReadingChoices reading;
  /// In the order of their members of canopen::DeviceOptions by name.
  std::vector<RuntimeOption> runtime;
  /// Expected findings.
  std::vector<AllowedFindings> allow;
  std::vector<DeprecatedOption> deprecated;
  /// What values mean: units, names of values and bits, error codes.
  MeaningDescriptions meaning;
  /// Values with a meaning have a type of their own in C++.
  bool typed_values = true;
  /// The file of the positions, if nothing else keeps it.
  std::shared_ptr<const SourceFile> source;

  [[nodiscard]] bool is_settable(std::uint16_t index, std::uint8_t sub_index) const {
    return std::ranges::binary_search(settable, EntryKey{index, sub_index});
  }

  /// Whether the options file, or an implied option, states an option of the runtime.
  [[nodiscard]] bool states(const OptionRow& row) const;
  /// Whether a flag of the runtime is true; false is its default.
  [[nodiscard]] bool is_set(const OptionRow& row) const;
  /// Adds an option of the runtime that is not stated.
  void set(const RuntimeOption& option);

  /// Whether PDOs may use an 11-bit CAN-ID although CiA 301 restricts it.
  [[nodiscard]] bool allows_for_pdo(std::uint32_t can_id) const;
  /// The unit of the inhibit times of PDOs in microseconds.
  [[nodiscard]] std::uint32_t inhibit_time_unit() const;
};

/// Reads an options file. Unknown members and invalid values are errors, with the path of the member. The deprecated
/// names are in `deprecated`, and not yet reported.
[[nodiscard]] Options read_options(const SourceFile& source, NameCheck is_name, Diagnostics& diagnostics);

}  // namespace edsc
