/// Where the objects of dynamically mapped PDOs lie: looked up when a mapping is made, so that sending and receiving
/// copy bytes.
#pragma once

#include <algorithm>
#include <array>
#include <cstdint>
#include <cstring>
#include <type_traits>

#include "canopen/bit_copy.hpp"
#include "canopen/dictionary.hpp"
#include "canopen/frame.hpp"
#include "canopen/object_store.hpp"
#include "canopen/pdo_list.hpp"
#include "canopen/pdo_mapping.hpp"

namespace canopen {

/// The mappings of all PDOs of one direction. `Pdos` is a PdoList; those whose mapping is static have no part in it.
template <class Device, PdoIndices Indices, class Pdos>
class MappedPlaces {
 public:
  static constexpr std::size_t count = Pdos::count;

  /// Objects that the mapping of each PDO has room for; 0: static.
  static constexpr std::array<std::uint8_t, count> capacities = [] {
    std::array<std::uint8_t, count> rows{};
    Pdos::for_each([&]<class Pdo, std::size_t I>() {
      rows[I] = mapping_capacity(Device::dictionary, Indices.mapping + Pdo::number - 1);
    });
    return rows;
  }();
  static constexpr bool any = std::ranges::any_of(capacities, [](std::uint8_t capacity) { return capacity != 0; });

  /// Looks up the objects of a PDO. Answers the data bytes of its frame; 0 when it carries nothing.
  /// `marked(word, mapped)` says of each object whether it is one for `is_marked`.
  template <class Marked>
  std::uint8_t look_up(std::size_t pdo, EntryAccess<Device> entries, Marked&& marked) {
    constexpr bool tpdo = Indices.mapping == tpdo_indices.mapping;
    const MappingParameter mapping = parameter(pdo, entries);
    const std::uint8_t objects = mapping.count();
    if (objects > capacities[pdo]) return 0;
    const std::uint8_t bits = mapping.template bits_of<Device>(tpdo, objects);
    if (bits == 0) return 0;
    for (std::uint8_t i = 0; i < objects; ++i) {
      const entry::Word word = can_be_mapped<Device>(tpdo, mapping[i]);
      Place place = no_place;
      if (word != mapped_dummy) {
        place = static_cast<Place>(entry::offset_of(word) | (marked(word, mapping[i]) ? mark : 0u));
      }
      places_[firsts[pdo] + i] = place;
    }
    return static_cast<std::uint8_t>((bits + 7) / 8);
  }

  /// The mapping parameter of a PDO.
  [[nodiscard]] static MappingParameter parameter(std::size_t pdo, EntryAccess<Device> entries) {
    return {entries, words[pdo].count, words[pdo].first};
  }

  /// Whether a PDO carries an object.
  [[nodiscard]] static bool carries(std::size_t pdo, EntryAccess<Device> entries, std::uint32_t key) {
    const MappingParameter mapping = parameter(pdo, entries);
    for (std::uint8_t i = 0; i < mapping.count() && i < capacities[pdo]; ++i) {
      if (mapping[i].key() == key) return true;
    }
    return false;
  }

  using Place = std::conditional_t<(sizeof(typename Device::Values) < 0x8000), std::uint16_t, std::uint32_t>;
  static constexpr Place mark = static_cast<Place>(Place{1} << (sizeof(Place) * 8 - 1));
  static constexpr Place no_place = static_cast<Place>(~Place{0});

  [[nodiscard]] Place place(std::size_t pdo, std::size_t i) const { return places_[firsts[pdo] + i]; }

  /// Whether an object of this device can stand at another place than a whole byte.
  static constexpr bool has_bits = [] {
    bool has = (Device::dummies & 2) != 0;
    Device::dictionary.for_each_entry([&](std::uint16_t, std::uint8_t, entry::Word word) {
      has = has || (entry::is_boolean(word) && (word & (entry::tpdo | entry::rpdo)) != 0);
    });
    return has;
  }();

 private:
  struct Words {
    entry::Word count;
    entry::Word first;
  };

  static constexpr std::array<Words, count> words = [] {
    std::array<Words, count> rows{};
    Pdos::for_each([&]<class Pdo, std::size_t I>() {
      constexpr std::uint16_t index = Indices.mapping + Pdo::number - 1;
      rows[I] = {Device::dictionary.find(index, 0), Device::dictionary.find(index, 1)};
    });
    return rows;
  }();

  /// Where the places of each PDO begin.
  static constexpr std::array<std::uint16_t, count + 1> firsts = [] {
    std::array<std::uint16_t, count + 1> rows{};
    for (std::size_t i = 0; i < count; ++i) rows[i + 1] = static_cast<std::uint16_t>(rows[i] + capacities[i]);
    return rows;
  }();

  std::array<Place, firsts[count]> places_{};
};

}  // namespace canopen
