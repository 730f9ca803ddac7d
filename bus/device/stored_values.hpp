/// The stored values of a node with a sheet, in the format of generated devices (canopen/storage/stored_format.hpp): an
/// image that one of them has written can be read by the other.
#pragma once

#include <canopen/storage/parameter_ranges.hpp>
#include <canopen/storage/stored_format.hpp>
#include <cstdint>
#include <optional>
#include <span>
#include <vector>

#include "device/sheet.hpp"

namespace edsc {

/// A stored value.
struct StoredRow {
  canopen::stored_format::Record record;
  std::vector<std::uint8_t> bytes;
};

/// Returns the values of an image; nothing if it is not one of this format. Of a damaged image, the values before the
/// damage are in `rows`.
struct StoredImage {
  std::vector<StoredRow> rows;
  bool whole = true;
};
[[nodiscard]] StoredImage read_stored_image(std::span<const std::uint8_t> image);

/// Returns an image with these values.
[[nodiscard]] std::vector<std::uint8_t> stored_image(std::span<const StoredRow> rows);

/// Returns the entry that 1010h stores; null if it does not store it.
[[nodiscard]] const SheetStoredEntry* find_stored(const Sheet& sheet, std::uint16_t index, std::uint8_t sub_index);

/// Returns the sections of a sub-index of 1010h and 1011h; 0 if no entry belongs to a manufacturer-specific one.
[[nodiscard]] canopen::SectionSet stored_sections(const Sheet& sheet, std::uint8_t sub_index);

/// Whether a set has a section.
[[nodiscard]] constexpr bool has_section(canopen::SectionSet sections, unsigned section) {
  return (sections >> section & 1u) != 0;
}

}  // namespace edsc
