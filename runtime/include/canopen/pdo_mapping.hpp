/// Dynamic mapping: which objects a PDO carries, changed by SDO while the device runs (CiA 301, 7.5.2.36 and 7.5.2.38).
/// Only devices whose mapping parameters are writable have any of it in their image.
#pragma once

#include <cstdint>
#include <cstring>
#include <iterator>
#include <memory>
#include <span>

#include "canopen/abort_code.hpp"
#include "canopen/cob_id.hpp"
#include "canopen/device_options.hpp"
#include "canopen/object_store.hpp"
#include "canopen/pdo_list.hpp"

namespace canopen {

/// One entry of a mapping parameter: index, sub-index and length in bits, from the high byte to the low one.
class MappedObject {
 public:
  constexpr explicit MappedObject(std::uint32_t value) : value_{value} {}

  [[nodiscard]] constexpr std::uint16_t index() const { return static_cast<std::uint16_t>(value_ >> 16); }
  [[nodiscard]] constexpr std::uint8_t sub_index() const { return static_cast<std::uint8_t>(value_ >> 8); }
  [[nodiscard]] constexpr std::uint8_t bits() const { return static_cast<std::uint8_t>(value_); }
  [[nodiscard]] constexpr std::uint32_t key() const { return value_ >> 8; }  ///< as `object_key` makes it
  [[nodiscard]] constexpr bool empty() const { return value_ == 0; }
  [[nodiscard]] constexpr bool is_dummy() const { return index() < 0x20; }

 private:
  std::uint32_t value_;
};

/// Numbers of mapped objects that make a multiplex PDO of it (CiA 301, 7.2.2.5): in source and in destination addressing
/// mode.
inline constexpr std::uint8_t source_multiplexed = 254;
inline constexpr std::uint8_t destination_multiplexed = 255;

/// Bits of the data types 0001h..0008h, which an RPDO may map as dummies (CiA 301, 7.4.7.1).
inline constexpr std::uint8_t dummy_bits[] = {0, 1, 8, 16, 32, 8, 16, 32, 32};

[[nodiscard]] constexpr bool is_rpdo_mapping(std::uint16_t index) { return (index & 0xFE00) == rpdo_indices.mapping; }
[[nodiscard]] constexpr bool is_tpdo_mapping(std::uint16_t index) { return (index & 0xFE00) == tpdo_indices.mapping; }

inline constexpr entry::Word not_mappable = 0;
inline constexpr entry::Word mapped_dummy = 1;

/// The word of an object that a PDO may carry: it exists, may be mapped in this direction, and has this length, a
/// multiple of what the data sheet maps by (Granularity). A BOOLEAN has one bit, or eight. `mapped_dummy` for a dummy,
/// `not_mappable` for all others.
template <class Device>
[[nodiscard, gnu::noinline]] entry::Word can_be_mapped(bool tpdo, MappedObject mapped) {
  const unsigned bits = mapped.bits();
  if constexpr (Device::granularity > 1) {
    if (bits % Device::granularity != 0) return not_mappable;
  }
  if (mapped.is_dummy()) {
    if constexpr (Device::dummies != 0) {
      const bool allowed = !tpdo && mapped.sub_index() == 0 && ((Device::dummies >> mapped.index()) & 1) != 0;
      if (allowed && mapped.index() < std::size(dummy_bits) && bits == dummy_bits[mapped.index()]) return mapped_dummy;
    }
    return not_mappable;
  }
  const entry::Word word = EntryAccess<Device>::find(mapped.index(), mapped.sub_index());
  if ((word & (tpdo ? entry::tpdo : entry::rpdo)) == 0) return not_mappable;  // so are those that do not exist
  // An immediate value has no address, and MappedPlaces keeps 15 bits of that of a constant.
  if (entry::place_of(word) > entry::Place::rom) return not_mappable;
  if (entry::place_of(word) == entry::Place::rom && entry::offset_of(word) >= 0x8000) return not_mappable;
  if (EntryAccess<Device>::kinds.booleans && entry::is_boolean(word) && bits == 1) return word;
  return bits != 0 && bits == EntryAccess<Device>::bytes_of(word) * 8u ? word : not_mappable;
}

/// The mapping parameter of one PDO as it stands in RAM.
class MappingParameter {
 public:
  /// Where sub-indices 0 and 1 lie.
  MappingParameter(const std::uint8_t* count, const std::uint8_t* first) : count_{count}, first_{first} {}

  [[nodiscard]] std::uint8_t count() const { return *count_; }

  /// Length of entry `i`, counted from 0.
  [[nodiscard]] unsigned bits(std::size_t i) const { return first_[sizeof(std::uint32_t) * i]; }

  /// Entry `i`, counted from 0.
  [[nodiscard]] MappedObject operator[](std::size_t i) const {
    std::uint32_t value;
    std::memcpy(&value, std::assume_aligned<alignof(std::uint32_t)>(first_ + sizeof value * i), sizeof value);
    return MappedObject{value};
  }

  /// Bits of the first `count` objects together; 0 when they make no PDO: one of them cannot be mapped, or they are
  /// longer than 64 bits.
  template <class Device>
  [[nodiscard, gnu::noinline]] std::uint8_t bits_of(bool tpdo, std::uint8_t count) const {
    unsigned bits = 0;
    for (std::uint8_t i = 0; i < count; ++i) {
      const MappedObject mapped = (*this)[i];
      bits += mapped.bits();
      if (bits > 64 || can_be_mapped<Device>(tpdo, mapped) == not_mappable) return 0;
    }
    return static_cast<std::uint8_t>(bits);
  }

  /// Puts down where the objects lie, all bits set for a dummy, with the highest bit set for those among the constants.
  /// Answers the data bytes that they take; 0 when they make no PDO.
  template <class Device, class Place>
  [[gnu::noinline]] std::uint8_t look_up(bool tpdo, Place* places) const {
    const std::uint8_t bits = bits_of<Device>(tpdo, count());
    if (bits == 0) return 0;
    for (std::uint8_t i = 0; i < count(); ++i) {
      const entry::Word word = can_be_mapped<Device>(tpdo, (*this)[i]);
      constexpr Place mark = static_cast<Place>(Place{1} << (sizeof(Place) * 8 - 1));
      Place place = static_cast<Place>(entry::offset_of(word));
      if (entry::place_of(word) == entry::Place::rom) place = static_cast<Place>(place | mark);
      places[i] = word == mapped_dummy ? static_cast<Place>(~Place{0}) : place;
    }
    return static_cast<std::uint8_t>((bits + 7) / 8);
  }

 private:
  const std::uint8_t* count_;
  const std::uint8_t* first_;
};

/// What speaks against writing these bytes, whose length is right, to a mapping parameter, which has room for
/// `capacity` objects. A PDO is remapped in five steps: disable it by bit 31 of its COB-ID, set sub-index 0 to 0, write
/// the entries, set sub-index 0 to their number, enable it.
///   0800 0022h  the PDO is valid
///   0601 0000h  sub-index 0 is not 0
///   0604 0041h  the object does not exist, cannot be mapped, or has another length
///   0604 0042h  too many objects or bits, or one that cannot be mapped (or what the device answers instead)
template <class Device>
[[nodiscard]] AbortCode check_pdo_mapping(EntryAccess<Device> entries, std::uint8_t capacity, std::uint16_t index,
                                          std::uint8_t sub_index, std::span<const std::uint8_t> bytes) {
  const bool tpdo = is_tpdo_mapping(index);
  if constexpr (!Device::options.pdo_mapping_writable_while_valid) {
    const auto communication = static_cast<std::uint16_t>(index - (rpdo_indices.mapping - rpdo_indices.communication));
    const entry::Word cob_id = entries.find(communication, pdo_parameter::cob_id);
    if (cob_id > Dictionary::no_sub_index && CobId{entries.number(cob_id)}.valid()) return AbortCode::device_state;
  }
  const MappingParameter mapping{entries.ram(entries.find(index, 0)), entries.ram(entries.find(index, 1))};
  if (sub_index == 0) {
    const std::uint8_t count = bytes[0];
    if (count == 0) return ok;
    if (Device::options.mpdo && count >= source_multiplexed) return ok;
    if (count <= capacity && mapping.bits_of<Device>(tpdo, count) != 0) return ok;
    return static_cast<AbortCode>(Device::options.pdo_mapping_abort_code);
  }
  if (mapping.count() != 0) return AbortCode::unsupported_access;
  const MappedObject mapped{number_in(bytes)};
  return mapped.empty() || can_be_mapped<Device>(tpdo, mapped) != not_mappable ? ok : AbortCode::not_mappable;
}

}  // namespace canopen
