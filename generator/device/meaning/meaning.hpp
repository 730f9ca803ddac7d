/// What the numbers of an entry mean: a quantity with its unit, names of values, named bits. From the options file, the
/// EDS and the device profile; resolved once with the device, so that all tools show the same.
#pragma once

#include <canopen/od/unit.hpp>
#include <cstdint>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "device/entry_address.hpp"
#include "device/meaning/rational.hpp"
#include "diagnostics/position.hpp"

namespace edsc {

/// Where a property comes from. The first one that has it is used.
enum class MeaningSource : std::uint8_t { options, eds, profile };

[[nodiscard]] std::string_view to_string(MeaningSource source);

/// Words of the manual, and where it has them.
struct MeaningText {
  std::string text;   ///< a sentence; may be empty
  std::string place;  ///< `4.3.2, table 12`; may be empty
  Position position;  ///< in the options file or EDS
  MeaningSource source = MeaningSource::options;
};

/// physical = raw * scale + offset, in the unit.
struct Quantity : MeaningText {
  const canopen::UnitRow* unit = nullptr;  ///< null if edsc does not know the unit: values are then not converted
  std::string symbol;                      ///< of the unit; as written if it is unknown; empty without one
  Rational scale{1};
  Rational offset{0};
  /// Entries that can change and whose default values state this unit and scale; empty for a fixed quantity.
  std::vector<EntryKey> stated_by;

  /// Whether a raw number is the number of units.
  [[nodiscard]] bool is_raw() const { return scale == Rational{1} && offset == Rational{0}; }
};

struct NamedValue : MeaningText {
  std::int64_t value = 0;  ///< of UNSIGNED64: its bits
  std::string name;        ///< snake_case
};

struct Enumeration : MeaningText {
  std::vector<NamedValue> values;  ///< ascending, each number once
  bool closed = false;             ///< other numbers are rejected

  [[nodiscard]] const NamedValue* find(std::int64_t value) const;
  [[nodiscard]] const NamedValue* find(std::string_view name) const;
};

/// Bits of an entry with a common name: a flag, a number, a quantity or an enumeration.
struct BitField : MeaningText {
  std::uint8_t first_bit = 0;
  std::uint8_t bits = 1;
  std::string name;  ///< snake_case; empty for reserved bits
  bool is_signed = false;
  std::optional<Enumeration> values;
  std::optional<Quantity> quantity;

  [[nodiscard]] bool is_reserved() const { return name.empty(); }
  [[nodiscard]] bool is_flag() const { return bits == 1 && !values && !quantity; }
  /// The bits of the field in the entry.
  [[nodiscard]] std::uint64_t mask() const;
  /// The number in the field of a value of the entry.
  [[nodiscard]] std::int64_t of(std::uint64_t raw) const;
};

/// A name for the values of some bits together, such as a state of a drive.
struct MaskedValue : MeaningText {
  std::uint64_t mask = 0, value = 0;
  std::string name;
};

/// Names for values of some bits, of which each value of the entry has at most one.
struct MaskedGroup {
  std::string name;
  std::vector<MaskedValue> values;

  /// The one that a value of the entry has; null if none.
  [[nodiscard]] const MaskedValue* find(std::uint64_t raw) const;
};

/// Fields for some values of the object on which they depend.
struct FieldCase : MeaningText {
  std::vector<std::int64_t> values;  ///< of the other object, ascending
  std::string name;
  std::vector<BitField> fields;
};

struct Meaning : MeaningText {
  std::optional<Quantity> quantity;
  std::optional<Enumeration> values;
  std::vector<BitField> fields;  ///< those that do not depend on another object, ascending
  std::vector<MaskedGroup> masked;
  std::optional<EntryKey> depends_on;
  std::vector<FieldCase> cases;
  std::optional<EntryKey> same_as;  ///< the entry whose values or fields these are

  /// The case for a value of the object on which fields depend; null if there is none.
  [[nodiscard]] const FieldCase* find_case(std::int64_t value) const;
  [[nodiscard]] bool has_fields() const { return !fields.empty() || !masked.empty() || !cases.empty(); }
};

/// The name of an error code of EMCY, 1003h and 603Fh.
struct ErrorCodeName : MeaningText {
  std::uint16_t code = 0;
};

}  // namespace edsc
