/// The TPDOs of a device with static mapping: which objects they contain, and their data.
#pragma once

#include <algorithm>
#include <array>
#include <cstddef>
#include <cstdint>
#include <type_traits>
#include <utility>

#include "canopen/od/dictionary.hpp"
#include "canopen/od/object_store.hpp"
#include "canopen/pdo/mapped_places.hpp"
#include "canopen/pdo/pdo_list.hpp"

namespace canopen {

namespace pdo_detail {

// `inline` makes GCC inline them, as functions that are defined in a class.

template <class Pdo, class Device, std::size_t... Position>
inline void pack_objects([[maybe_unused]] const ObjectStore<Device>& store, std::array<std::uint8_t, 8>& data,
                         std::index_sequence<Position...>) {
  Pdo::pack_into_words(data, store.template get<typename Pdo::template Entry<Position>>()...);
}

template <class Pdo, bool IsStatic, class Device>
inline void pack_if([[maybe_unused]] bool it_is, [[maybe_unused]] const ObjectStore<Device>& store,
                    [[maybe_unused]] std::array<std::uint8_t, 8>& data) {
  if constexpr (IsStatic) {
    if (it_is) pack_objects<Pdo>(store, data, std::make_index_sequence<Pdo::entries>{});
  }
}

}  // namespace pdo_detail

/// The objects of the TPDOs of a device whose mapping is static.
template <class Device, class Pdos>
struct StaticTpdos {
  using Mapped = MappedPlaces<Device, tpdo_indices, Pdos>;  ///< tells which PDOs have a dynamic mapping
  using Data = std::array<std::uint8_t, 8>;
  static constexpr std::size_t count = Pdos::count;

  static constexpr std::size_t mapped_objects = [] {
    std::size_t sum = 0;
    for (std::size_t i = 0; i < count; ++i) sum += Mapped::capacities[i] == 0 ? Pdos::keys[i].size() : 0;
    return sum;
  }();

  /// The key of an object, then the position of its TPDO. The positions of more than 256 TPDOs have 9 bits, with which
  /// the key does not fit into 32 bits.
  using Row = std::conditional_t<(count > 0x100), std::uint64_t, std::uint32_t>;
  static constexpr unsigned place_bits = count > 0x100 ? 9 : 8;
  static_assert(count <= std::size_t{1} << place_bits, "a device has 512 TPDOs at most (CiA 301, 7.5.2.37)");

  [[nodiscard]] static constexpr std::uint32_t key_in(Row row) { return static_cast<std::uint32_t>(row >> place_bits); }
  [[nodiscard]] static constexpr std::size_t place_in(Row row) { return row & ((1U << place_bits) - 1U); }

  /// Each statically mapped object.
  static constexpr std::array<Row, mapped_objects> carriers = [] {
    std::array<Row, mapped_objects> rows{};
    std::size_t at = 0;
    for (std::size_t i = 0; i < count; ++i) {
      if (Mapped::capacities[i] != 0) continue;
      for (const std::uint32_t key : Pdos::keys[i]) rows[at++] = static_cast<Row>(Row{key} << place_bits | i);
    }
    return rows;
  }();

  /// The same, ascending: the TPDOs that map an object are neighbours.
  static constexpr std::array<Row, mapped_objects> sorted = [] {
    std::array<Row, mapped_objects> rows = carriers;
    std::sort(rows.begin(), rows.end());
    return rows;
  }();
  /// The position in `sorted` of the first TPDO that maps an object, and their number.
  [[nodiscard]] static constexpr std::size_t first_of(std::uint32_t key) {
    const Row lowest = static_cast<Row>(Row{key} << place_bits);
    return static_cast<std::size_t>(std::lower_bound(sorted.begin(), sorted.end(), lowest) - sorted.begin());
  }
  [[nodiscard]] static constexpr std::size_t count_of(std::uint32_t key) { return first_of(key + 1) - first_of(key); }

  /// Writes the values of the objects of one TPDO to data, which must be zero and aligned to four bytes.
  template <class... Pdo, std::size_t... Position>
  static void pack([[maybe_unused]] std::size_t which, [[maybe_unused]] const ObjectStore<Device>& store,
                   [[maybe_unused]] Data& data, PdoList<Pdo...>, std::index_sequence<Position...>) {
    // Not a fold: Clang accepts 256 operands at most.
    [[maybe_unused]] const bool tried[] = {
        true, (pdo_detail::pack_if<Pdo, Mapped::capacities[Position] == 0>(which == Position, store, data), true)...};
  }
};

}  // namespace canopen
