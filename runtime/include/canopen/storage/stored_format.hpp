/// The bytes of an image of stored parameters: four bytes that identify the format, then one record for each value.
///
///     record   index (2 bytes), sub-index, type, value; a string has its length (2 bytes) before its bytes
///     context  the index 0000h, node-ID, version of the options: those of the records after it
///
/// The type is that of the entry's word (od/dictionary.hpp), from which the length of a number follows. Numbers are as
/// SDO sends them. Images of the first format have a header and the values of each section, in the order of memory.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <span>

#include "canopen/od/dictionary.hpp"

namespace canopen::stored_format {

inline constexpr std::array<std::uint8_t, 4> magic = {'P', 'a', 'r', 2};
inline constexpr std::size_t header_bytes = 4;  ///< of a record before its value, and of a context
inline constexpr std::size_t length_bytes = 2;  ///< of a string

// The byte of the type.
inline constexpr std::uint8_t type_mask = 0x3F;
inline constexpr std::uint8_t given_up = 0x80;  ///< valid until the next power-on

/// A stored value, without its bytes.
struct Record {
  std::uint32_t position = 0;  ///< of its bytes in the image
  std::uint16_t index = 0;
  std::uint8_t sub_index = 0;
  std::uint8_t type = 0;      ///< and `given_up`
  std::uint16_t size = 0;     ///< bytes
  std::uint16_t context = 0;  ///< node-ID and version, as in the image

  [[nodiscard]] constexpr std::uint8_t node_id() const { return static_cast<std::uint8_t>(context); }
  [[nodiscard]] constexpr std::uint8_t version() const { return static_cast<std::uint8_t>(context >> 8); }
  [[nodiscard]] constexpr bool is_given_up() const { return (type & given_up) != 0; }
};

[[nodiscard]] constexpr std::uint8_t type_of(entry::Word word) {
  return static_cast<std::uint8_t>(entry::type_of(word) >> entry::size_shift);
}
/// Returns the word of a type; its other bits are zero.
[[nodiscard]] constexpr entry::Word word_of(std::uint8_t type) {
  return entry::Word{type & std::uint32_t{type_mask}} << entry::size_shift;
}

[[nodiscard]] constexpr bool is_string(std::uint8_t type) { return entry::is_string(word_of(type)); }

/// Header of a section in an image of the first format. A section is identified by signature and size.
struct SectionHeader {
  std::uint32_t signature;
  std::uint16_t size;     ///< bytes of the values
  std::uint8_t node_id;   ///< node-ID when they were stored
  std::uint8_t given_up;  ///< 1: valid until the next power-on
};
static_assert(sizeof(SectionHeader) == 8);

}  // namespace canopen::stored_format
