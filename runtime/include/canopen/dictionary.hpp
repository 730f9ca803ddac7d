/// The object dictionary in flash: sorted constexpr tables, and the search by index and sub-index.
///
/// One 32-bit word describes one entry. A VAR is its own entry; the word of an ARRAY or RECORD names a group, whose words
/// for the sub-indices may be shared by all groups of the same shape. Indices stand in runs of neighbours, so that the
/// search touches one pair of 16-bit numbers per run and not one per index.
#pragma once

#include <cstdint>
#include <span>

namespace canopen {

namespace entry {

using Word = std::uint32_t;

// Bits 0..15: where the value is: an offset into RAM or flash, or the value itself.
// Bits 16..19: bytes of the value; of the special class, which one.
// Bits 20..21: class. Bits 22..23: place. Bits 24..28: rights and limits. Bits 30..31: kind.
inline constexpr Word offset_mask = 0xFFFF;
inline constexpr unsigned size_shift = 16;
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
inline constexpr Word time48 = u48;  ///< TIME_OF_DAY and TIME_DIFFERENCE lie in memory as on the wire
inline constexpr Word visible_string = type_word(Class::special, 0);  ///< a StringStorage of text
inline constexpr Word octet_string = type_word(Class::special, 3);    ///< a StringStorage of bytes, UNICODE_STRINGs too
inline constexpr Word domain = type_word(Class::special, 1);   ///< a Domain
inline constexpr Word boolean = type_word(Class::special, 2);  ///< a bool: one byte, 0 or 1

// Rights.
inline constexpr Word readable = Word{1} << 24;
inline constexpr Word writable = Word{1} << 25;
inline constexpr Word tpdo = Word{1} << 26;
inline constexpr Word rpdo = Word{1} << 27;
inline constexpr Word limited = Word{1} << 28;  ///< a row in the table of limits, for strings the capacity
inline constexpr Word ro = readable;
inline constexpr Word wo = writable;
inline constexpr Word rw = readable | writable;

// Kinds and places: each row of a table names exactly one.
[[nodiscard]] constexpr Word var_at(Place place) {
  return (static_cast<Word>(Kind::var) << kind_shift) | (static_cast<Word>(place) << place_shift);
}
inline constexpr Word ram = var_at(Place::ram);
inline constexpr Word rom = var_at(Place::rom);
inline constexpr Word immediate = var_at(Place::immediate);
inline constexpr Word immediate_plus_node_id = var_at(Place::immediate_plus_node_id);
inline constexpr Word array = static_cast<Word>(Kind::array) << kind_shift;
inline constexpr Word record = static_cast<Word>(Kind::record) << kind_shift;
inline constexpr Word gap = 0;  ///< a sub-index of a record that does not exist

[[nodiscard]] constexpr std::uint16_t offset_of(Word word) { return static_cast<std::uint16_t>(word & offset_mask); }
[[nodiscard]] constexpr std::uint8_t size_of(Word word) { return static_cast<std::uint8_t>((word >> size_shift) & 0xF); }
[[nodiscard]] constexpr Class class_of(Word word) { return static_cast<Class>((word >> class_shift) & 3); }
[[nodiscard]] constexpr Place place_of(Word word) { return static_cast<Place>((word >> place_shift) & 3); }
[[nodiscard]] constexpr Kind kind_of(Word word) { return static_cast<Kind>(word >> kind_shift); }
[[nodiscard]] constexpr Word type_of(Word word) { return word & (Word{0x3F} << size_shift); }
[[nodiscard]] constexpr bool is_string(Word word) {
  return type_of(word) == visible_string || type_of(word) == octet_string;
}
[[nodiscard]] constexpr bool is_domain(Word word) { return type_of(word) == domain; }
[[nodiscard]] constexpr bool is_boolean(Word word) { return type_of(word) == boolean; }
/// Bytes of the value as SDO carries it; 0 where that varies.
[[nodiscard]] constexpr std::uint8_t wire_bytes(Word word) {
  if (class_of(word) != Class::special) return size_of(word);
  return is_boolean(word) ? std::uint8_t{1} : std::uint8_t{0};
}

}  // namespace entry

/// Neighbouring indices: the first one, and where its word stands in the table of entries.
struct Run {
  std::uint16_t first;
  std::uint16_t position;
};

/// An ARRAY or RECORD: where its values are and where the words of its sub-indices begin. The words' offsets count from
/// `ram` or `rom`. Of an array the second word serves all elements, `stride` bytes apart; of a record `stride` is 0.
struct Group {
  std::uint16_t ram;
  std::uint16_t rom;
  std::uint16_t subs;
  std::uint8_t highest;  ///< highest sub-index that exists
  std::uint8_t stride;
};

/// index << 8 | sub-index: how the table of limits is sorted. The elements of an array stand under sub-index 1.
[[nodiscard]] constexpr std::uint32_t object_key(std::uint16_t index, std::uint8_t sub_index) {
  return (static_cast<std::uint32_t>(index) << 8) | sub_index;
}

/// Lowest and highest value of an entry of up to 32 bits, as two's complement or REAL32 bits where the type is signed or real.
/// Of a string: 0 and its capacity in bytes.
struct Limits {
  std::uint32_t key;
  std::uint32_t low;
  std::uint32_t high;
};

/// The same for wider types.
struct WideLimits {
  std::uint32_t key;
  std::uint64_t low;
  std::uint64_t high;
};

/// A value in RAM whose default has the node-ID added at each reset.
struct NodeIdRelative {
  std::uint16_t offset;
  std::uint16_t size;  ///< bytes
};

namespace dictionary_detail {

/// Where the row with this key stands in a table sorted by key; at its end when there is none.
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

/// The row with this key; null when there is none.
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
  std::span<const Run> runs;  ///< ascending, and a last one {0xFFFF, number of entries} that ends the search
  std::span<const entry::Word> entries;
  std::span<const Group> groups;
  std::span<const entry::Word> subs;
  std::span<const Limits> limits;
  std::span<const WideLimits> wide_limits;
  const void* constants;  ///< what `rom` offsets count from
  bool zero_terminated_strings = false;  ///< VISIBLE_STRINGs go out with a trailing 00h, as manual 003 shows

  static constexpr entry::Word no_object = 0;
  static constexpr entry::Word no_sub_index = 1;

  /// The entry's word with its offset resolved, or `no_object`, or `no_sub_index`.
  [[nodiscard]] constexpr entry::Word find(std::uint16_t index, std::uint8_t sub_index) const {
    return sub_word(find_index(index), sub_index);
  }

  /// The same for an index whose word is known.
  [[nodiscard]] constexpr entry::Word sub_word(entry::Word word, std::uint8_t sub_index) const {
    const entry::Kind kind = entry::kind_of(word);
    if (kind <= entry::Kind::var) return sub_index == 0 || word == no_object ? word : no_sub_index;

    const Group& group = groups[entry::offset_of(word)];
    if (sub_index > group.highest) return no_sub_index;
    const unsigned of_array = sub_index != 0 ? 1 : 0;
    const entry::Word sub = subs[group.subs + (kind == entry::Kind::array ? of_array : sub_index)];
    if (sub == entry::gap) return no_sub_index;
    const entry::Place place = entry::place_of(sub);
    if (place > entry::Place::rom) return sub;
    const std::uint32_t base = place == entry::Place::ram ? group.ram : group.rom;
    return sub + base + (sub_index - of_array) * group.stride;
  }

  /// The word of an index as it stands in the table; `no_object` where there is none.
  [[nodiscard]] constexpr entry::Word find_index(std::uint16_t index) const {
    const Run* run = runs.data();
    for (std::size_t left = runs.size() - 1; left > 1;) {  // the last run is the end mark
      const std::size_t half = left / 2;
      if (run[half].first <= index) run += half;
      left -= half;
    }
    return word_in(*run, index);
  }

  /// The word of an index that stands in this run or nowhere.
  [[nodiscard]] constexpr entry::Word word_in(const Run& run, std::uint16_t index) const {
    // An index before the first run is far behind its end.
    const std::uint32_t position = run.position + static_cast<std::uint32_t>(index) - run.first;
    return position < (&run + 1)->position ? entries[position] : no_object;
  }

  /// Whether an entry exists.
  [[nodiscard]] constexpr bool has(std::uint16_t index, std::uint8_t sub_index) const {
    return find(index, sub_index) > no_sub_index;
  }

  /// Whether the bus can write an entry of these indices.
  [[nodiscard]] constexpr bool takes_writes(std::uint16_t first, std::uint16_t last) const {
    for (unsigned index = first; index <= last; ++index) {
      const entry::Word word = find_index(static_cast<std::uint16_t>(index));
      if (word == no_object) continue;
      const bool var = entry::kind_of(word) == entry::Kind::var;
      const unsigned highest = var ? 0u : groups[entry::offset_of(word)].highest;
      for (unsigned sub_index = 0; sub_index <= highest; ++sub_index) {
        if ((sub_word(word, static_cast<std::uint8_t>(sub_index)) & entry::writable) != 0) return true;
      }
    }
    return false;
  }

  /// Calls `visit(index, sub_index, word)` for each entry, in ascending order; words with their offset resolved.
  template <class Visit>
  constexpr void for_each_entry(Visit&& visit) const {
    for (std::size_t run = 0; run + 1 < runs.size(); ++run) {
      for (std::uint32_t at = runs[run].position; at < runs[run + 1].position; ++at) {
        const auto index = static_cast<std::uint16_t>(runs[run].first + at - runs[run].position);
        const entry::Word word = entries[at];
        const bool var = entry::kind_of(word) == entry::Kind::var;
        const unsigned highest = var ? 0u : groups[entry::offset_of(word)].highest;
        for (unsigned sub_index = 0; sub_index <= highest; ++sub_index) {
          const entry::Word found = sub_word(word, static_cast<std::uint8_t>(sub_index));
          if (found > no_sub_index) visit(index, static_cast<std::uint8_t>(sub_index), found);
        }
      }
    }
  }

  [[nodiscard]] constexpr const Limits* find_limits(std::uint32_t key) const { return dictionary_detail::find_by_key(limits, key); }
  [[nodiscard]] constexpr const WideLimits* find_wide_limits(std::uint32_t key) const {
    return dictionary_detail::find_by_key(wide_limits, key);
  }

  /// What the search relies on: runs in order and without overlap that cover the entries, groups inside their table,
  /// limits sorted. Generated code asserts it.
  [[nodiscard]] constexpr bool well_formed() const {
    if (runs.empty() || runs.back().first != 0xFFFF || runs.back().position != entries.size()) return false;
    if (runs.front().position != 0) return false;
    for (std::size_t i = 0; i + 1 < runs.size(); ++i) {
      const std::uint32_t length = static_cast<std::uint32_t>(runs[i + 1].position) - runs[i].position;
      if (runs[i + 1].position <= runs[i].position) return false;
      if (runs[i].first + length > runs[i + 1].first) return false;
    }
    for (const Group& group : groups) {
      if (group.subs >= subs.size()) return false;
    }
    return dictionary_detail::sorted_by_key(limits) && dictionary_detail::sorted_by_key(wide_limits);
  }
};

}  // namespace canopen
