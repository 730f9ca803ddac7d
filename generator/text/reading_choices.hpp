/// How a file is read where its text does not say it: choices of a person, in the options file of an EDS or as keys of
/// an overlay.
#pragma once

#include <cstdint>
#include <optional>
#include <span>
#include <string>
#include <string_view>

#include "text/encoding.hpp"

namespace edsc {

/// How the sub-index in a section name is written: `[2022sub10]` is sub-index 10h or 0Ah.
enum class SubIndexNotation : std::uint8_t { hexadecimal, decimal };

/// Whether `rwr` and `rww` have the meaning of CiA 306 or are exchanged.
enum class AccessConvention : std::uint8_t { cia306, swapped };

struct ReadingChoices {
  std::optional<Encoding> encoding;  ///< nothing: detected
  SubIndexNotation sub_indices = SubIndexNotation::hexadecimal;
  AccessConvention access_types = AccessConvention::cia306;

  friend bool operator==(const ReadingChoices&, const ReadingChoices&) = default;
};

struct ReadingChoiceRow {
  std::string_view option;   ///< in an options file: `sub_indices`
  std::string_view key;      ///< in an overlay: `SubIndices`
  std::string_view meaning;  ///< for the help of a command
  /// Sets the choice. Returns false, and changes nothing, if it does not have this value.
  bool (*set)(std::string_view value, ReadingChoices& choices);
  std::string (*expected)();  ///< the values: `hexadecimal or decimal`
};

[[nodiscard]] std::span<const ReadingChoiceRow> reading_choice_rows();

[[nodiscard]] const ReadingChoiceRow* find_reading_option(std::string_view option);

/// Ignores letter case.
[[nodiscard]] const ReadingChoiceRow* find_reading_key(std::string_view key);

}  // namespace edsc
