/// The input of the rules, and the destination of their findings.
#pragma once

#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

#include "device/device.hpp"
#include "device/meaning/profiles.hpp"
#include "device/options/options.hpp"
#include "diagnostics/diagnostics.hpp"
#include "eds/data_sheet.hpp"

namespace edsc {

inline constexpr unsigned last_node_id = 127;

struct RuleContext {
  const Device& device;
  const DataSheet& sheet;
  const Options& options;
  Diagnostics& diagnostics;
  const MeaningProfile* user_profile = nullptr;  ///< rows that replace and complete those of the device profile

  /// Reports a finding with the severity of the rule.
  void report(AnyRule rule, const Position& position, std::string message, std::vector<Note> notes = {},
              std::string cause = {}) const;

  /// The whole file.
  [[nodiscard]] Position whole_file() const { return Position{device.source}; }

  /// The section that describes an entry; for an element of a compact object, that of the object.
  [[nodiscard]] const EntryDescription* describe(const Entry& entry) const;

  /// What the value with which an entry starts is called: its default value, or the ParameterValue of a DCF.
  [[nodiscard]] std::string_view value_word(const Entry& entry) const;

  /// The position of a key of an entry, or of its section if the key is missing.
  [[nodiscard]] Position place_of(const Entry& entry, Field EntryDescription::*key) const;
};

}  // namespace edsc
