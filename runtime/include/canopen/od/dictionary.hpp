/// The object dictionary in flash: sorted constexpr tables, and the search by index and sub-index.
///
/// Each entry is described by one 32-bit word. A VAR is its own entry; the word of an ARRAY or RECORD holds where its
/// values begin and its shape, which has the words of the sub-indices and is shared by all objects of the same
/// structure. Indices are stored in runs of consecutive numbers: the search reads one pair of 16-bit numbers per run
/// instead of one per index.
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>

#include "canopen/od/accepted_values.hpp"

namespace canopen {

namespace entry {

using Word = std::uint32_t;

// Bits 0..15: location of the value: an offset in RAM or flash, or the value itself.
// Bits 16..19: size of the value in bytes; in the special class, which type.
// Bits 20..21: class. Bits 22..23: place. Bits 24..28: access rights and limits. Bits 30..31: kind.
// Of an ARRAY or RECORD, bits 0..15 are the offset to which those of its sub-indices are added, and bits 16..29 its
// shape.
inline constexpr Word offset_mask = 0xFFFF;
inline constexpr unsigned size_shift = 16;
inline constexpr unsigned shape_shift = 16;
inline constexpr unsigned class_shift = 20;
inline constexpr unsigned place_shift = 22;
inline constexpr unsigned kind_shift = 30;

enum class Class : std::uint8_t { unsigned_integer, signed_integer, real, special };
enum class Place : std::uint8_t { ram, rom, immediate, immediate_plus_node_id };
enum class Kind : std::uint8_t { none, var, array, record };

[[nodiscard]] constexpr Word type_word(Class c, Word size) {
  return (static_cast<Word>(c) << class_shift) | (size << size_shift);
}

// Types.
inline constexpr Word u8 = type_word(Class::unsigned_integer, 1);
inline constexpr Word u16 = type_word(Class::unsigned_integer, 2);
inline constexpr Word u24 = type_word(Class::unsigned_integer, 3);
inline constexpr Word u32 = type_word(Class::unsigned_integer, 4);
inline constexpr Word u40 = type_word(Class::unsigned_integer, 5);
inline constexpr Word u48 = type_word(Class::unsigned_integer, 6);
inline constexpr Word u56 = type_word(Class::unsigned_integer, 7);
inline constexpr Word u64 = type_word(Class::unsigned_integer, 8);
inline constexpr Word i8 = type_word(Class::signed_integer, 1);
inline constexpr Word i16 = type_word(Class::signed_integer, 2);
inline constexpr Word i24 = type_word(Class::signed_integer, 3);
inline constexpr Word i32 = type_word(Class::signed_integer, 4);
inline constexpr Word i40 = type_word(Class::signed_integer, 5);
inline constexpr Word i48 = type_word(Class::signed_integer, 6);
inline constexpr Word i56 = type_word(Class::signed_integer, 7);
inline constexpr Word i64 = type_word(Class::signed_integer, 8);
inline constexpr Word r32 = type_word(Class::real, 4);
inline constexpr Word r64 = type_word(Class::real, 8);
inline constexpr Word time48 = u48;  ///< TIME_OF_DAY and TIME_DIFFERENCE have the same layout in memory and on the wire
inline constexpr Word visible_string = type_word(Class::special, 0);  ///< a StringStorage of text
inline constexpr Word octet_string = type_word(Class::special, 3);    ///< a StringStorage of bytes, also UNICODE_STRING
inline constexpr Word domain = type_word(Class::special, 1);          ///< a Domain
inline constexpr Word boolean = type_word(Class::special, 2);         ///< a bool: one byte, 0 or 1

// Access rights.
inline constexpr Word readable = Word{1} << 24;
inline constexpr Word writable = Word{1} << 25;
inline constexpr Word tpdo = Word{1} << 26;
inline constexpr Word rpdo = Word{1} << 27;
inline constexpr Word limited = Word{1} << 28;  ///< has a row in the table of limits; of a string, its capacity
inline constexpr Word ro = readable;
inline constexpr Word wo = writable;
inline constexpr Word rw = readable | writable;

// Kinds and places: each row of a table has exactly one.
[[nodiscard]] constexpr Word var_at(Place place) {
  return (static_cast<Word>(Kind::var) << kind_shift) | (static_cast<Word>(place) << place_shift);
}
inline constexpr Word ram = var_at(Place::ram);
inline constexpr Word rom = var_at(Place::rom);
inline constexpr Word immediate = var_at(Place::immediate);
inline constexpr Word immediate_plus_node_id = var_at(Place::immediate_plus_node_id);
inline constexpr Word array = static_cast<Word>(Kind::array) << kind_shift;
inline constexpr Word record = static_cast<Word>(Kind::record) << kind_shift;
[[nodiscard]] constexpr Word shape(Word position) { return position << shape_shift; }
inline constexpr Word gap = 0;  ///< a sub-index of a record that does not exist

[[nodiscard]] constexpr std::uint16_t offset_of(Word word) { return static_cast<std::uint16_t>(word & offset_mask); }
[[nodiscard]] constexpr std::uint8_t size_of(Word word) {
  return static_cast<std::uint8_t>((word >> size_shift) & 0xF);
}
[[nodiscard]] constexpr Class class_of(Word word) { return static_cast<Class>((word >> class_shift) & 3); }
[[nodiscard]] constexpr Place place_of(Word word) { return static_cast<Place>((word >> place_shift) & 3); }
[[nodiscard]] constexpr Kind kind_of(Word word) { return static_cast<Kind>(word >> kind_shift); }
/// Position of the shape of an ARRAY or RECORD.
[[nodiscard]] constexpr std::size_t shape_of(Word word) { return (word >> shape_shift) & 0x3FFF; }
[[nodiscard]] constexpr Word type_of(Word word) { return word & (Word{0x3F} << size_shift); }
[[nodiscard]] constexpr bool is_string(Word word) {
  return type_of(word) == visible_string || type_of(word) == octet_string;
}
[[nodiscard]] constexpr bool is_domain(Word word) { return type_of(word) == domain; }
[[nodiscard]] constexpr bool is_boolean(Word word) { return type_of(word) == boolean; }
/// Bytes of the value as SDO transfers it; 0: variable length.
[[nodiscard]] constexpr std::uint8_t wire_bytes(Word word) {
  if (class_of(word) != Class::special) return size_of(word);
  return is_boolean(word) ? std::uint8_t{1} : std::uint8_t{0};
}

}  // namespace entry

/// Consecutive indices: the first one, and the position of its word in the table of entries.
struct Run {
  std::uint16_t first;
  std::uint16_t position;
};

/// The structure of an ARRAY or RECORD. The offsets of the sub-indices are relative to that of the object: all of them
/// are in RAM, or all in flash; an object with values in both has the offset 0. In an array the second word serves all
/// elements, which are `stride` bytes apart; `stride` of a record is 0.
struct Shape {
  std::uint16_t subs;    ///< position of the first word
  std::uint8_t highest;  ///< highest sub-index that exists
  std::uint8_t stride;
};

/// index << 8 | sub-index: the sort key of the table of limits. All elements of an array share sub-index 1.
[[nodiscard]] constexpr std::uint32_t object_key(std::uint16_t index, std::uint8_t sub_index) {
  return (static_cast<std::uint32_t>(index) << 8) | sub_index;
}

/// Lowest and highest value of an entry of up to 32 bits, as two's complement for signed types and as REAL32 bits for
/// real ones. Of a string: 0 and its capacity in bytes.
struct Limits {
  std::uint32_t key;
  std::uint32_t low;
  std::uint32_t high;
};

/// Lowest and highest value of an entry of more than 32 bits.
struct WideLimits {
  std::uint32_t key;
  std::uint64_t low;
  std::uint64_t high;
};

/// A value in RAM to whose default value the node-ID is added at each reset.
struct NodeIdRelative {
  std::uint16_t offset;
  std::uint16_t size;  ///< bytes
};

namespace dictionary_detail {

/// Returns the position of a row in a table sorted by key; the table's size if it does not exist.
template <class Row>
[[nodiscard]] constexpr std::size_t position_of_key(std::span<const Row> rows, std::uint32_t key) {
  std::size_t low = 0;
  std::size_t high = rows.size();
  while (low < high) {
    const std::size_t middle = (low + high) / 2;
    if (rows[middle].key < key) {
      low = middle + 1;
    } else {
      high = middle;
    }
  }
  return low < rows.size() && rows[low].key == key ? low : rows.size();
}

/// Finds a row by its key; null if it does not exist.
template <class Row>
[[nodiscard]] constexpr const Row* find_by_key(std::span<const Row> rows, std::uint32_t key) {
  const std::size_t position = position_of_key(rows, key);
  return position < rows.size() ? &rows[position] : nullptr;
}

template <class Row>
[[nodiscard]] constexpr bool sorted_by_key(std::span<const Row> rows) {
  for (std::size_t i = 0; i + 1 < rows.size(); ++i) {
    if (rows[i].key >= rows[i + 1].key) return false;
  }
  return true;
}

}  // namespace dictionary_detail

struct Dictionary {
  std::span<const Run> runs;  ///< ascending; the last one, {0xFFFF, number of entries}, ends the search
  std::span<const entry::Word> entries;
  std::span<const Shape> shapes;
  std::span<const entry::Word> subs;
  std::span<const Limits> limits;
  std::span<const WideLimits> wide_limits;
  const void* constants;                      ///< base of `rom` offsets
  bool zero_terminated_strings = false;       ///< VISIBLE_STRINGs are sent with a trailing 00h, as in manual 003
  std::span<const AcceptedRange> accepted{};  ///< of an index without rows: all values

  static constexpr entry::Word no_object = 0;
  static constexpr entry::Word no_sub_index = 1;

  /// Finds the word of an entry, with its offset resolved; `no_object` or `no_sub_index` if it does not exist.
  [[nodiscard]] constexpr entry::Word find(std::uint16_t index, std::uint8_t sub_index) const {
    return sub_word(find_index(index), sub_index);
  }

  /// Finds the word of a sub-index, for an index whose word is known.
  [[nodiscard]] constexpr entry::Word sub_word(entry::Word word, std::uint8_t sub_index) const {
    const entry::Kind kind = entry::kind_of(word);
    if (kind <= entry::Kind::var) return sub_index == 0 || word == no_object ? word : no_sub_index;

    const Shape& shape = shapes[entry::shape_of(word)];
    if (sub_index > shape.highest) return no_sub_index;
    const unsigned of_array = sub_index != 0 ? 1 : 0;
    const entry::Word sub = subs[shape.subs + (kind == entry::Kind::array ? of_array : sub_index)];
    if (sub == entry::gap) return no_sub_index;
    if (entry::place_of(sub) > entry::Place::rom) return sub;
    return sub + entry::offset_of(word) + (sub_index - of_array) * shape.stride;
  }

  /// Finds the word of an index as it is in the table; `no_object` if it does not exist.
  [[nodiscard]] constexpr entry::Word find_index(std::uint16_t index) const {
    const Run* run = runs.data();
    for (std::size_t left = runs.size() - 1; left > 1;) {  // the last run is the end marker
      const std::size_t half = left / 2;
      if (run[half].first <= index) run += half;
      left -= half;
    }
    return word_in(*run, index);
  }

  /// Finds the word of an index that only this run can contain.
  [[nodiscard]] constexpr entry::Word word_in(const Run& run, std::uint16_t index) const {
    // For an index before the first run, the position is far past the end of the run.
    const std::uint32_t position = run.position + static_cast<std::uint32_t>(index) - run.first;
    return position < (&run + 1)->position ? entries[position] : no_object;
  }

  /// Returns the highest sub-index of an object whose word is known.
  [[nodiscard]] constexpr std::uint8_t highest_sub_index(entry::Word word) const {
    return entry::kind_of(word) <= entry::Kind::var ? std::uint8_t{0} : shapes[entry::shape_of(word)].highest;
  }

  /// Whether an entry exists.
  [[nodiscard]] constexpr bool has(std::uint16_t index, std::uint8_t sub_index) const {
    return find(index, sub_index) > no_sub_index;
  }

  /// Whether any entry with an index in this range can be written over the bus.
  [[nodiscard]] constexpr bool takes_writes(std::uint16_t first, std::uint16_t last) const {
    for (unsigned index = first; index <= last; ++index) {
      const entry::Word word = find_index(static_cast<std::uint16_t>(index));
      if (word == no_object) continue;
      for (unsigned sub_index = 0; sub_index <= highest_sub_index(word); ++sub_index) {
        if ((sub_word(word, static_cast<std::uint8_t>(sub_index)) & entry::writable) != 0) return true;
      }
    }
    return false;
  }

  /// Calls `visit(index, sub_index, word)` for each entry, in ascending order, with the offset of the word resolved.
  template <class Visit>
  constexpr void for_each_entry(Visit&& visit) const {
    for (std::size_t run = 0; run + 1 < runs.size(); ++run) {
      for (std::uint32_t at = runs[run].position; at < runs[run + 1].position; ++at) {
        const auto index = static_cast<std::uint16_t>(runs[run].first + at - runs[run].position);
        const entry::Word word = entries[at];
        for (unsigned sub_index = 0; sub_index <= highest_sub_index(word); ++sub_index) {
          const entry::Word found = sub_word(word, static_cast<std::uint8_t>(sub_index));
          if (found > no_sub_index) visit(index, static_cast<std::uint8_t>(sub_index), found);
        }
      }
    }
  }

  /// The same for the communication profile, 1000h..1FFFh. A device may have thousands of other entries.
  template <class Visit>
  constexpr void for_each_communication_entry(Visit&& visit) const {
    for (std::size_t run = 0; run + 1 < runs.size(); ++run) {
      for (std::uint32_t at = runs[run].position; at < runs[run + 1].position; ++at) {
        const auto index = static_cast<std::uint16_t>(runs[run].first + at - runs[run].position);
        if (index > 0x1FFF) return;
        const entry::Word word = entries[at];
        for (unsigned sub_index = 0; sub_index <= highest_sub_index(word); ++sub_index) {
          const entry::Word found = sub_word(word, static_cast<std::uint8_t>(sub_index));
          if (found > no_sub_index) visit(index, static_cast<std::uint8_t>(sub_index), found);
        }
      }
    }
  }

  /// Whether `is_it(word)` is true for any entry, with the offset of the word resolved.
  template <class Predicate>
  [[nodiscard]] constexpr bool any_of_entries(Predicate is_it) const {
    for (const entry::Word word : entries) {
      for (unsigned sub_index = 0; sub_index <= highest_sub_index(word); ++sub_index) {
        const entry::Word found = sub_word(word, static_cast<std::uint8_t>(sub_index));
        if (found > no_sub_index && is_it(found)) return true;
      }
    }
    return false;
  }

  /// Calls `visit(word)` for each word of the tables that describes an entry, without order; objects that share a shape
  /// share the words of their sub-indices, whose offsets are not resolved.
  template <class Visit>
  constexpr void for_each_word(Visit&& visit) const {
    for (const entry::Word word : entries) {
      if (word > no_sub_index && entry::kind_of(word) <= entry::Kind::var) visit(word);
    }
    for (const entry::Word word : subs) {
      if (word != entry::gap) visit(word);
    }
  }

  [[nodiscard]] constexpr const Limits* find_limits(std::uint32_t key) const {
    return dictionary_detail::find_by_key(limits, key);
  }
  [[nodiscard]] constexpr const WideLimits* find_wide_limits(std::uint32_t key) const {
    return dictionary_detail::find_by_key(wide_limits, key);
  }

  /// Whether an object accepts a value of 8 bits.
  [[nodiscard]] constexpr bool accepts(std::uint16_t index, std::int8_t value) const {
    bool all = true;
    for (const AcceptedRange& row : accepted) {
      if (row.index != index) continue;
      if (row.values.has(value)) return true;
      all = false;
    }
    return all;
  }

  /// Whether the tables are as the search requires: runs in order, without overlap, covering the entries; shapes inside
  /// their table; limits sorted. Generated code asserts it.
  [[nodiscard]] constexpr bool well_formed() const {
    if (runs.empty() || runs.back().first != 0xFFFF || runs.back().position != entries.size()) return false;
    if (runs.front().position != 0) return false;
    for (std::size_t i = 0; i + 1 < runs.size(); ++i) {
      const std::uint32_t length = static_cast<std::uint32_t>(runs[i + 1].position) - runs[i].position;
      if (runs[i + 1].position <= runs[i].position) return false;
      if (runs[i].first + length > runs[i + 1].first) return false;
    }
    for (const Shape& shape : shapes) {
      if (shape.subs >= subs.size()) return false;
    }
    return dictionary_detail::sorted_by_key(limits) && dictionary_detail::sorted_by_key(wide_limits);
  }
};

}  // namespace canopen
