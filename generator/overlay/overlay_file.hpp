/// An overlay file: corrections of an EDS, DCF, XDD or XDC, in the syntax of an EDS.
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "change/sheet_text.hpp"
#include "diagnostics/diagnostics.hpp"
#include "eds/data_sheet.hpp"
#include "eds/ini.hpp"
#include "text/reading_choices.hpp"

namespace edsc {

/// The section [Overlay]. `overlay_keys` has its keys.
struct OverlayHeader {
  bool present = false;
  Position position;
  Field version;
  Field base;                                            ///< path of the file to change, relative to the overlay
  Field vendor_number, product_number, revision_number;  ///< of the files to change, for the folders of EDSC_OVERLAYS
  Field encoding, sub_indices, access_types;             ///< how the base is read
};

/// `Key=old => new`, or `Key=new`. An empty value means that the key is missing, or does not have a value.
struct OverlayLine {
  IniEntry entry;
  CountedName key;
  bool has_arrow = false;
  std::string_view old_value;
  std::string_view new_value;
  std::uint32_t new_column = 0;
  std::string reason;  ///< the comment before it, else that of the section
};

/// The indices of a section such as [2000-5FFF].
struct IndexSpan {
  std::uint16_t first = 0;
  std::uint16_t last = 0;
};

struct OverlaySection {
  const IniSection* section = nullptr;
  CountedName name;
  std::optional<IndexSpan> range;
  std::vector<OverlayLine> lines;  ///< without the reserved keys
  std::optional<IniEntry> remove, rename, count;
  std::string reason;
  bool has_reason = false;  ///< a comment before the section, or before each of its keys
};

struct OverlayFile {
  const SourceFile* source = nullptr;
  IniFile ini;
  OverlayHeader header;
  std::vector<OverlaySection> sections;
};

/// Distinguishes an overlay by its first section, [Overlay], or by its name, `*.overlay`.
[[nodiscard]] bool is_overlay(const SourceFile& source);

/// The key of [Overlay] for a reading choice.
[[nodiscard]] const Field& reading_choice(const OverlayHeader& header, const ReadingChoiceRow& row);

[[nodiscard]] OverlayFile read_overlay(const SourceFile& source, Diagnostics& diagnostics);

/// A value to compare others with: numbers and formulas by their value, other texts exactly.
class OverlayValue {
 public:
  explicit OverlayValue(std::string_view text);

  [[nodiscard]] bool is_same(std::string_view other) const;

 private:
  struct Number {
    bool is_negative = false;
    std::uint64_t magnitude = 0;
    friend bool operator==(const Number&, const Number&) = default;
  };
  [[nodiscard]] static std::optional<Number> number_in(std::string_view text);

  std::string_view text_;
  std::optional<Number> number_;
};

[[nodiscard]] bool is_same_value(std::string_view a, std::string_view b);

[[nodiscard]] Position position_of(const OverlayFile& file, const OverlayLine& line);

}  // namespace edsc
