/// Dynamic mapping: SDO changes the objects of a PDO at run time (CiA 301, 7.5.2.36 and 7.5.2.38). Only devices whose
/// mapping parameters are writable have this code in their image.
#pragma once

#include <array>  // std::size: <iterator> would bring streams with it
#include <cstdint>
#include <cstring>
#include <span>
#include <type_traits>

#include "canopen/base/abort_code.hpp"
#include "canopen/base/assume_aligned.hpp"
#include "canopen/can/cob_id.hpp"
#include "canopen/od/data_type.hpp"
#include "canopen/od/device_options.hpp"
#include "canopen/od/object_store.hpp"
#include "canopen/od/sheet.hpp"
#include "canopen/pdo/pdo_list.hpp"

namespace canopen {

/// One entry of a mapping parameter: index, sub-index and length in bits, from the high byte to the low byte.
class MappedObject {
 public:
  constexpr explicit MappedObject(std::uint32_t value) : value_{value} {}

  [[nodiscard]] constexpr std::uint16_t index() const { return static_cast<std::uint16_t>(value_ >> 16); }
  [[nodiscard]] constexpr std::uint8_t sub_index() const { return static_cast<std::uint8_t>(value_ >> 8); }
  [[nodiscard]] constexpr std::uint8_t bits() const { return static_cast<std::uint8_t>(value_); }
  [[nodiscard]] constexpr std::uint32_t key() const { return value_ >> 8; }  ///< in the format of `object_key`
  [[nodiscard]] constexpr bool empty() const { return value_ == 0; }
  [[nodiscard]] constexpr bool is_dummy() const { return index() < 0x20; }

 private:
  std::uint32_t value_;
};

/// Numbers of mapped objects that make the PDO a multiplex PDO (CiA 301, 7.2.2.5): in source and in destination
/// addressing mode.
inline constexpr std::uint8_t source_multiplexed = 254;
inline constexpr std::uint8_t destination_multiplexed = 255;

[[nodiscard]] constexpr bool is_rpdo_mapping(std::uint16_t index) { return index >> 9 == rpdo_indices.mapping >> 9; }
[[nodiscard]] constexpr bool is_tpdo_mapping(std::uint16_t index) { return index >> 9 == tpdo_indices.mapping >> 9; }

inline constexpr entry::Word not_mappable = 0;
inline constexpr entry::Word mapped_dummy = 1;

/// Returns the word of an object that can be mapped: it exists, is mappable in this direction, and has this length, a
/// multiple of Granularity in the EDS. A BOOLEAN has one bit or eight. `mapped_dummy` for a dummy, `not_mappable` for
/// all others. `of_node`: the EntryAccess of a device with a sheet, nothing for others.
template <class Device, class... OfNode>
[[nodiscard, gnu::noinline]] entry::Word can_be_mapped(bool tpdo, MappedObject mapped, OfNode... of_node) {
  const unsigned bits = mapped.bits();
  if constexpr (has_sheet<Device>) {
    if (const unsigned unit = (Device::sheet_of(of_node), ...).granularity; unit > 1 && bits % unit != 0)
      return not_mappable;
  } else if constexpr (Device::granularity > 1) {
    if (bits % Device::granularity != 0) return not_mappable;
  }
  if (mapped.is_dummy()) {
    if constexpr (Device::dummies != 0) {
      const std::uint32_t dummies = [&] {
        if constexpr (has_sheet<Device>) return (Device::sheet_of(of_node), ...).dummies;
        return Device::dummies;
      }();
      const bool allowed = !tpdo && mapped.sub_index() == 0 && ((dummies >> mapped.index()) & 1) != 0;
      if (allowed && mapped.index() < std::size(dummy_bits) && bits == dummy_bits[mapped.index()]) return mapped_dummy;
    }
    return not_mappable;
  }
  const entry::Word word = [&] {
    if constexpr (has_sheet<Device>)
      return (of_node, ...).find(mapped.index(), mapped.sub_index());
    else
      return EntryAccess<Device>::find(mapped.index(), mapped.sub_index());
  }();
  if ((word & (tpdo ? entry::tpdo : entry::rpdo)) == 0) return not_mappable;  // also if it does not exist
  if (entry::place_of(word) > entry::Place::rom) return not_mappable;         // an immediate value has no address
  if (EntryAccess<Device>::kinds.booleans && entry::is_boolean(word) && bits == 1) return word;
  return bits != 0 && bits == EntryAccess<Device>::bytes_of(word) * 8u ? word : not_mappable;
}

/// A mapping after it has been looked up: values that are consecutive both in RAM and in the frame are one run, a word
/// with their offset and length.
template <class Device>
struct MappedRun {
  /// Whether an object of this device can begin within a byte.
  static constexpr bool has_bits = [] {
    bool has = (Device::dummies & 2) != 0;
    Device::dictionary.for_each_word(
        [&](entry::Word word) { has = has || (entry::is_boolean(word) && (word & (entry::tpdo | entry::rpdo)) != 0); });
    return has;
  }();
  static constexpr unsigned unit = has_bits ? 1 : 8;  ///< unit of lengths, in bits

  /// Whether 12 bits are enough for the offsets of all mappable objects.
  static constexpr bool has_short_offsets = !Device::dictionary.any_of_entries([](entry::Word word) {
    return (word & (entry::tpdo | entry::rpdo)) != 0 && entry::place_of(word) <= entry::Place::rom &&
           entry::offset_of(word) >= 0xFFF;
  });

  using Word = std::conditional_t<has_short_offsets && !has_bits, std::uint16_t, std::uint32_t>;
  static constexpr unsigned length_shift = sizeof(Word) == 2 ? 12 : 24;
  static constexpr Word offset_mask = static_cast<Word>((Word{1} << length_shift) - 1);

  /// Not only values in RAM: a constant, or a value that needs more than to be stored.
  static constexpr Word apart = static_cast<Word>(Word{1} << (8 * sizeof(Word) - 1));
  static constexpr Word nothing = apart | offset_mask;  ///< a dummy, without its length

  [[nodiscard]] static constexpr Word word_of(entry::Word word, unsigned bits) {
    const Word length = static_cast<Word>((bits / unit - 1) << length_shift);
    if (word == mapped_dummy) return length | nothing;
    return length | entry::offset_of(word) | (entry::place_of(word) == entry::Place::rom ? apart : Word{0});
  }
  [[nodiscard]] static constexpr unsigned length(Word run) {
    return static_cast<unsigned>((run & static_cast<Word>(~apart)) >> length_shift) + 1;
  }
  [[nodiscard]] static constexpr Word offset(Word run) { return run & offset_mask; }

  /// Joins consecutive values. If `bits` is not a multiple of 8, a dummy fills the last byte.
  [[gnu::noinline]] static void join(Word* runs, unsigned count, unsigned bits) {
    Word* last = runs;
    for (const Word *run = runs + 1, *const end = runs + count; run != end; ++run) {
      const bool both_plain = ((*last | *run) & apart) == 0;
      const bool whole_bytes = !has_bits || ((length(*last) | length(*run)) & 7) == 0;
      if (both_plain && whole_bytes && offset(*last) + length(*last) * unit / 8 == offset(*run)) {
        *last = static_cast<Word>(*last + (length(*run) << length_shift));
      } else {
        *++last = *run;
      }
    }
    if (has_bits && bits % 8 != 0) *++last = word_of(mapped_dummy, 8 - bits % 8);
  }
};

/// The mapping parameter of one PDO in RAM.
class MappingParameter {
 public:
  /// Takes the addresses of sub-indices 0 and 1.
  MappingParameter(const std::uint8_t* count, const std::uint8_t* first) : count_{count}, first_{first} {}

  [[nodiscard]] std::uint8_t count() const { return *count_; }

  /// Returns the length of entry `i`, counted from 0, in bits.
  [[nodiscard]] unsigned bits(std::size_t i) const { return first_[sizeof(std::uint32_t) * i]; }

  /// Returns entry `i`, counted from 0.
  [[nodiscard]] MappedObject operator[](std::size_t i) const {
    std::uint32_t value;
    std::memcpy(&value, assume_aligned<alignof(std::uint32_t)>(first_ + sizeof value * i), sizeof value);
    return MappedObject{value};
  }

  /// Returns the total length of the first `count` objects in bits; 0 if the mapping is invalid: one of them cannot be
  /// mapped, or they are longer than 64 bits. Stores their runs, unless `runs` is null.
  template <class Device, class... OfNode>
  [[nodiscard, gnu::noinline]] std::uint8_t look_up(bool tpdo, std::uint8_t count,
                                                    typename MappedRun<Device>::Word* runs, OfNode... of_node) const {
    unsigned bits = 0;
    for (std::uint8_t i = 0; i < count; ++i) {
      const MappedObject mapped = (*this)[i];
      const entry::Word word = can_be_mapped<Device>(tpdo, mapped, of_node...);
      bits += mapped.bits();
      if (bits > 64 || word == not_mappable) return 0;
      if (runs != nullptr) runs[i] = MappedRun<Device>::word_of(word, mapped.bits());
    }
    return static_cast<std::uint8_t>(bits);
  }

 private:
  const std::uint8_t* count_;
  const std::uint8_t* first_;
};

/// Whether the first `count` objects of a mapping parameter for up to `capacity` objects are a valid mapping, including
/// an empty one.
template <class Device, class... OfNode>
[[nodiscard]] bool is_possible_mapping(const MappingParameter& mapping, bool tpdo, std::uint8_t count,
                                       std::uint8_t capacity, OfNode... of_node) {
  if (count == 0 || (options_of<Device>(of_node...).mpdo && count >= source_multiplexed)) return true;
  return count <= capacity && mapping.look_up<Device>(tpdo, count, nullptr, of_node...) != 0;
}

/// Checks whether these bytes, whose length is correct, may be written to a mapping parameter for up to `capacity`
/// objects. A PDO is remapped in five steps: disable it with bit 31 of its COB-ID, set sub-index 0 to 0, write the
/// entries, set sub-index 0 to their number, enable it.
///   0601 0000h  the PDO is valid, or sub-index 0 is not 0
///   0604 0041h  the object does not exist, cannot be mapped, or has another length
///   0604 0042h  too many objects or bits, or one that cannot be mapped (or the abort code of the device options)
template <class Device>
[[nodiscard]] AbortCode check_pdo_mapping(EntryAccess<Device> entries, std::uint8_t capacity, std::uint16_t index,
                                          std::uint8_t sub_index, std::span<const std::uint8_t> bytes) {
  const bool tpdo = is_tpdo_mapping(index);
  if (!options_of<Device>(entries).pdo_mapping_writable_while_valid) {
    const auto communication = static_cast<std::uint16_t>(index - (rpdo_indices.mapping - rpdo_indices.communication));
    const entry::Word cob_id = entries.find(communication, pdo_parameter::cob_id);
    if (cob_id > Dictionary::no_sub_index && CobId{entries.number(cob_id)}.valid())
      return AbortCode::unsupported_access;
  }
  const MappingParameter mapping{entries.ram(entries.find(index, 0)), entries.ram(entries.find(index, 1))};
  if (sub_index == 0) {
    if constexpr (has_sheet<Device>) {
      if (is_possible_mapping<Device>(mapping, tpdo, bytes[0], capacity, entries)) return ok;
    } else {
      if (is_possible_mapping<Device>(mapping, tpdo, bytes[0], capacity)) return ok;
    }
    return static_cast<AbortCode>(options_of<Device>(entries).pdo_mapping_abort_code);
  }
  if (mapping.count() != 0) return AbortCode::unsupported_access;
  const MappedObject mapped{number_in(bytes)};
  if constexpr (has_sheet<Device>) {
    return mapped.empty() || can_be_mapped<Device>(tpdo, mapped, entries) != not_mappable ? ok
                                                                                          : AbortCode::not_mappable;
  } else {
    return mapped.empty() || can_be_mapped<Device>(tpdo, mapped) != not_mappable ? ok : AbortCode::not_mappable;
  }
}

}  // namespace canopen
