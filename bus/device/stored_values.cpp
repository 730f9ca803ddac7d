#include "device/stored_values.hpp"

#include <algorithm>
#include <canopen/od/dictionary.hpp>
#include <cstddef>

namespace edsc {
namespace {

using canopen::object_key;
using canopen::SectionSet;
using canopen::stored_format::Record;
namespace stored_format = canopen::stored_format;

std::uint32_t key_of(const SheetStoredEntry& entry) { return object_key(entry.index, entry.sub_index); }

std::uint32_t little_endian(std::span<const std::uint8_t> bytes) {
  std::uint32_t number = 0;
  for (std::size_t i = bytes.size(); i-- > 0;) number = number << 8 | bytes[i];
  return number;
}

void append(std::vector<std::uint8_t>& image, std::uint32_t number, unsigned bytes) {
  for (unsigned i = 0; i < bytes; ++i) image.push_back(static_cast<std::uint8_t>(number >> (8 * i)));
}

}  // namespace

StoredImage read_stored_image(std::span<const std::uint8_t> image) {
  StoredImage read;
  if (image.empty()) return read;
  read.whole = image.size() >= stored_format::magic.size() &&
               std::ranges::equal(image.first(stored_format::magic.size()), stored_format::magic);
  if (!read.whole) return read;
  std::uint16_t context = 0;
  for (std::size_t at = stored_format::magic.size(); at < image.size();) {
    read.whole = image.size() - at >= stored_format::header_bytes;
    if (!read.whole) break;
    const std::uint32_t header = little_endian(image.subspan(at, stored_format::header_bytes));
    at += stored_format::header_bytes;
    if ((header & 0xFFFF) == 0) {
      context = static_cast<std::uint16_t>(header >> 16);
      continue;
    }
    Record record;
    record.index = static_cast<std::uint16_t>(header);
    record.sub_index = static_cast<std::uint8_t>(header >> 16);
    record.type = static_cast<std::uint8_t>(header >> 24);
    record.context = context;
    record.size = canopen::entry::wire_bytes(stored_format::word_of(record.type));
    if (stored_format::is_string(record.type)) {
      read.whole = image.size() - at >= stored_format::length_bytes;
      if (!read.whole) break;
      record.size = static_cast<std::uint16_t>(little_endian(image.subspan(at, stored_format::length_bytes)));
      at += stored_format::length_bytes;
    }
    read.whole = image.size() - at >= record.size;
    if (!read.whole) break;
    const auto bytes = image.subspan(at, record.size);
    read.rows.push_back({record, {bytes.begin(), bytes.end()}});
    at += record.size;
  }
  return read;
}

std::vector<std::uint8_t> stored_image(std::span<const StoredRow> rows) {
  std::vector<std::uint8_t> image{stored_format::magic.begin(), stored_format::magic.end()};
  std::uint16_t context = 0;
  for (const auto& [record, bytes] : rows) {
    if (record.context != context) append(image, std::uint32_t{record.context} << 16, 4);
    context = record.context;
    append(image, record.index | std::uint32_t{record.sub_index} << 16 | std::uint32_t{record.type} << 24, 4);
    if (stored_format::is_string(record.type)) append(image, record.size, stored_format::length_bytes);
    image.insert(image.end(), bytes.begin(), bytes.end());
  }
  return image;
}

const SheetStoredEntry* find_stored(const Sheet& sheet, std::uint16_t index, std::uint8_t sub_index) {
  const std::uint32_t key = object_key(index, sub_index);
  const auto at = std::ranges::lower_bound(sheet.stored, key, {}, key_of);
  return at != sheet.stored.end() && key_of(*at) == key ? &*at : nullptr;
}

SectionSet stored_sections(const Sheet& sheet, std::uint8_t sub_index) {
  const SectionSet sections = canopen::sections_of(sub_index);
  if (sub_index < canopen::first_group_sub_index) return sections;
  const bool any = std::ranges::any_of(sheet.stored,
                                       [&](const SheetStoredEntry& entry) { return (sections >> entry.section) <= 1; });
  return any ? sections : SectionSet{0};
}

}  // namespace edsc
