/// The PDOs of a device, by number, and the location of their parameters in its dictionary.
#pragma once

#include <array>
#include <cstdint>
#include <type_traits>
#include <utility>

#include "canopen/od/dictionary.hpp"
#include "canopen/pdo/pdo.hpp"

namespace canopen {

/// Indices of the parameters of the first PDO of each direction (CiA 301, 7.5.2.35 to 7.5.2.38).
struct PdoIndices {
  std::uint16_t communication;
  std::uint16_t mapping;
};
inline constexpr PdoIndices rpdo_indices{0x1400, 0x1600};
inline constexpr PdoIndices tpdo_indices{0x1800, 0x1A00};

/// Sub-indices of a PDO communication parameter.
namespace pdo_parameter {
inline constexpr std::uint8_t cob_id = 1;
inline constexpr std::uint8_t transmission_type = 2;
inline constexpr std::uint8_t inhibit_time = 3;
inline constexpr std::uint8_t event_timer = 5;
inline constexpr std::uint8_t sync_start = 6;
}  // namespace pdo_parameter

/// A PDO of a device: its number (from 1) and its layout. The parameters are objects 1400h or 1800h + number - 1.
template <std::uint16_t Number, class Layout>
struct NumberedPdo : Layout {
  static constexpr std::uint16_t number = Number;
};

template <class... Pdos>
struct PdoList {
  static constexpr std::size_t count = sizeof...(Pdos);

  /// Calls `visit.template operator()<Pdo, I>()` for each PDO in order.
  template <class Visit>
  static constexpr void for_each([[maybe_unused]] Visit&& visit) {
    visit_all(visit, std::index_sequence_for<Pdos...>{});
  }

 private:
  template <class Visit, std::size_t... I>
  [[gnu::always_inline]] static constexpr void visit_all([[maybe_unused]] Visit& visit, std::index_sequence<I...>) {
    (visit.template operator()<Pdos, I>(), ...);
  }
};

/// Returns how many objects can be mapped into a PDO by SDO; 0: the mapping is static. It is dynamic if the mapping
/// parameter is in RAM, with consecutive entries from sub-index 1 on.
[[nodiscard]] constexpr std::uint8_t mapping_capacity(const Dictionary& dictionary, std::uint16_t mapping) {
  const auto in_ram = [](entry::Word word) {
    return word > Dictionary::no_sub_index && entry::place_of(word) == entry::Place::ram;
  };
  const entry::Word first = dictionary.find(mapping, 1);
  if (!in_ram(dictionary.find(mapping, 0)) || !in_ram(first)) return 0;
  constexpr std::uint8_t most = 64;
  std::uint8_t capacity = 1;
  while (capacity < most) {
    const entry::Word next = dictionary.find(mapping, static_cast<std::uint8_t>(capacity + 1));
    if (!in_ram(next) || entry::offset_of(next) != entry::offset_of(first) + 4u * capacity) break;
    ++capacity;
  }
  return capacity;
}

namespace pdo_detail {

template <const Dictionary& D, PdoIndices Indices, class Taken, class List>
struct Served;
template <const Dictionary& D, PdoIndices Indices, class... Taken>
struct Served<D, Indices, PdoList<Taken...>, PdoList<>> {
  using type = PdoList<Taken...>;
};
template <const Dictionary& D, PdoIndices Indices, class... Taken, class P, class... Rest>
struct Served<D, Indices, PdoList<Taken...>, PdoList<P, Rest...>> {
  static constexpr bool maps = P::entries > 0 || mapping_capacity(D, Indices.mapping + P::number - 1) > 0;
  static constexpr bool serves = maps && D.has(Indices.communication + P::number - 1, pdo_parameter::cob_id);
  using type = typename Served<D, Indices, std::conditional_t<serves, PdoList<Taken..., P>, PdoList<Taken...>>,
                               PdoList<Rest...>>::type;
};

/// Whether the PDOs of a list are numbered from 1 without gaps.
template <class Pdos>
inline constexpr bool counts_from_one = [] {
  bool counts = true;
  Pdos::for_each([&]<class Pdo, std::size_t I>() { counts = counts && Pdo::number == I + 1; });
  return counts;
}();

template <class Pdos>
inline constexpr std::array<std::uint16_t, Pdos::count> numbers_of = [] {
  std::array<std::uint16_t, Pdos::count> numbers{};
  Pdos::for_each([&]<class Pdo, std::size_t I>() { numbers[I] = Pdo::number; });
  return numbers;
}();

}  // namespace pdo_detail

/// Returns the number of the PDO at a position in a list.
template <class Pdos>
[[nodiscard]] constexpr std::uint16_t number_of_pdo(std::size_t place) {
  if constexpr (pdo_detail::counts_from_one<Pdos>) {
    return static_cast<std::uint16_t>(place + 1);
  } else {
    return pdo_detail::numbers_of<Pdos>[place];
  }
}

/// Returns the position in a list of the PDO whose communication or mapping parameter has this index; `Pdos::count` if
/// it does not exist.
template <class Pdos>
[[nodiscard]] constexpr std::size_t place_of_pdo(std::uint16_t index) {
  const std::size_t place = index & 0x1FFu;
  if constexpr (pdo_detail::counts_from_one<Pdos>) {
    return place < Pdos::count ? place : Pdos::count;
  } else {
    std::size_t i = 0;
    while (i < Pdos::count && pdo_detail::numbers_of<Pdos>[i] != place + 1) ++i;
    return i;
  }
}

/// The PDOs of a list that map an object, or can do so, and whose COB-ID is in the dictionary.
template <const Dictionary& D, PdoIndices Indices, class List>
using ServedPdos = typename pdo_detail::Served<D, Indices, PdoList<>, List>::type;

}  // namespace canopen
