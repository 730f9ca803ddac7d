/// What the rules look at, and where their findings go.
#pragma once

#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

#include "device/device.hpp"
#include "device/options.hpp"
#include "diagnostics/diagnostics.hpp"
#include "eds/data_sheet.hpp"

namespace edsc {

inline constexpr unsigned last_node_id = 127;

struct RuleContext {
  const Device& device;
  const DataSheet& sheet;
  const Options& options;
  Diagnostics& diagnostics;

  /// A finding of a rule, as bad as the rule's row says.
  void report(AnyRule rule, const Position& position, std::string message, std::vector<Note> notes = {},
              std::string cause = {}) const;

  /// The file as a whole.
  [[nodiscard]] Position whole_file() const { return Position{device.source}; }

  /// What the data sheet says of an object; null when it does not stand there.
  [[nodiscard]] const ObjectDescription* describe(std::uint16_t index) const;
  /// The section that describes an entry: of an element of a compact object, the object's own.
  [[nodiscard]] const EntryDescription* describe(const Entry& entry) const;

  /// Where a key of an entry stands, or its section when it is missing.
  [[nodiscard]] Position place_of(const Entry& entry, Field EntryDescription::*key) const;
};

/// Where the default of an entry stands, or its section when there is none.
[[nodiscard]] Position default_place(const Entry& entry);

/// `6040h:00 "Controlword"`
[[nodiscard]] std::string named(const Entry& entry);
/// `1018h "Identity object"`
[[nodiscard]] std::string named(const Object& object);

}  // namespace edsc
