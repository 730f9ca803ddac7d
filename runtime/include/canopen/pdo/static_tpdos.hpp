/// The TPDOs of a device with static mapping: which objects they contain, and their data.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <utility>

#include "canopen/od/dictionary.hpp"
#include "canopen/od/object_store.hpp"
#include "canopen/pdo/mapped_places.hpp"
#include "canopen/pdo/pdo_list.hpp"

namespace canopen {

/// The objects of the TPDOs of a device whose mapping is static.
template <class Device, class Pdos>
struct StaticTpdos {
  using Mapped = MappedPlaces<Device, tpdo_indices, Pdos>;  ///< tells which PDOs have a dynamic mapping
  using Data = std::array<std::uint8_t, 8>;
  static constexpr std::size_t count = Pdos::count;

  static constexpr std::size_t mapped_objects = [] {
    std::size_t sum = 0;
    Pdos::for_each([&]<class Pdo, std::size_t I>() { sum += Mapped::capacities[I] == 0 ? Pdo::entries : 0; });
    return sum;
  }();

  /// index << 16 | sub-index << 8 | position of the TPDO, for each statically mapped object.
  static constexpr std::array<std::uint32_t, mapped_objects> carriers = [] {
    static_assert(count <= 0x100);
    std::array<std::uint32_t, mapped_objects> rows{};
    std::size_t at = 0;
    Pdos::for_each([&]<class Pdo, std::size_t I>() {
      if constexpr (Mapped::capacities[I] == 0) {
        Pdo::for_each([&]<class O, std::size_t>() {
          rows[at++] = (object_key(O::index, O::sub_index) << 8) | static_cast<std::uint32_t>(I);
        });
      }
    });
    return rows;
  }();

  /// Writes the values of the objects of one TPDO to data, which must be zero and aligned to four bytes.
  template <class... Pdo, std::size_t... I>
  static void pack([[maybe_unused]] std::size_t which, [[maybe_unused]] const ObjectStore<Device>& store,
                   [[maybe_unused]] Data& data, PdoList<Pdo...>, std::index_sequence<I...>) {
    (pack_if<Pdo, Mapped::capacities[I] == 0>(which == I, store, data), ...);
  }

 private:
  template <class Pdo, bool IsStatic>
  static void pack_if([[maybe_unused]] bool it_is, [[maybe_unused]] const ObjectStore<Device>& store,
                      [[maybe_unused]] Data& data) {
    if constexpr (IsStatic) {
      if (it_is) pack_objects<Pdo>(store, data, std::make_index_sequence<Pdo::entries>{});
    }
  }

  template <class Pdo, std::size_t... I>
  static void pack_objects([[maybe_unused]] const ObjectStore<Device>& store, Data& data, std::index_sequence<I...>) {
    Pdo::pack_into_words(data, store.template get<typename Pdo::template Entry<I>>()...);
  }
};

}  // namespace canopen
