/// The PDOs of a device, by number, and the location of their parameters in its dictionary.
#pragma once

#include <array>
#include <cstdint>
#include <span>
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

namespace pdo_detail {

/// The keys of the objects of a PDO, in their order.
template <class Pdo>
inline constexpr std::array<std::uint32_t, Pdo::entries> keys_of = [] {
  std::array<std::uint32_t, Pdo::entries> keys{};
  Pdo::for_each([&]<class O, std::size_t I>() { keys[I] = object_key(O::index, O::sub_index); });
  return keys;
}();

}  // namespace pdo_detail

/// A device has up to 512 PDOs of a direction. What is needed of each of them is in arrays: a function for each PDO
/// whose name contains the list takes the compiler time that grows with the third power of their number.
template <class... Pdos>
struct PdoList {
  static constexpr std::size_t count = sizeof...(Pdos);

  // Of each PDO:
  static constexpr std::array<std::uint16_t, count> numbers{Pdos::number...};
  static constexpr std::array<std::uint8_t, count> sizes{Pdos::size...};  ///< data bytes of the default mapping
  static constexpr std::array<std::span<const std::uint32_t>, count> keys{pdo_detail::keys_of<Pdos>...};

  /// Calls `visit.template operator()<Pdo, I>()` for each PDO in order.
  template <class Visit>
  static constexpr void for_each([[maybe_unused]] Visit&& visit) {
    visit_all(visit, std::index_sequence_for<Pdos...>{});
  }

 private:
  template <class Visit, std::size_t... I>
  [[gnu::always_inline]] static constexpr void visit_all([[maybe_unused]] Visit& visit, std::index_sequence<I...>) {
    // Not a fold: Clang accepts 256 operands at most.
    [[maybe_unused]] const bool visited[] = {true, (visit.template operator()<Pdos, I>(), true)...};
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

/// Whether a PDO maps an object, or can do so, and its COB-ID is in the dictionary.
template <const Dictionary& D, PdoIndices Indices, class P>
inline constexpr bool is_served = (P::entries > 0 || mapping_capacity(D, Indices.mapping + P::number - 1) > 0) &&
                                  D.has(Indices.communication + P::number - 1, pdo_parameter::cob_id);

/// The PDOs of several lists.
template <class... Lists>
struct Joined;
template <>
struct Joined<> {
  using type = PdoList<>;
};
template <class... A>
struct Joined<PdoList<A...>> {
  using type = PdoList<A...>;
};
template <class... A, class... B, class... Rest>
struct Joined<PdoList<A...>, PdoList<B...>, Rest...> : Joined<PdoList<A..., B...>, Rest...> {};
template <class... A, class... B, class... C, class... D, class... E, class... F, class... G, class... H, class... Rest>
struct Joined<PdoList<A...>, PdoList<B...>, PdoList<C...>, PdoList<D...>, PdoList<E...>, PdoList<F...>, PdoList<G...>,
              PdoList<H...>, Rest...> : Joined<PdoList<A..., B..., C..., D..., E..., F..., G..., H...>, Rest...> {};

template <class List>
struct Whole {
  using type = List;
};

template <const Dictionary& D, PdoIndices Indices, class List>
struct Served;
template <const Dictionary& D, PdoIndices Indices, class... P>
struct Served<D, Indices, PdoList<P...>> {
  static constexpr bool all = [] {
    bool every = true;
    for (const bool serves : {true, is_served<D, Indices, P>...}) every = every && serves;
    return every;
  }();
  using type =
      typename std::conditional_t<all, Whole<PdoList<P...>>,
                                  Joined<std::conditional_t<is_served<D, Indices, P>, PdoList<P>, PdoList<>>...>>::type;
};

/// Whether the PDOs of a list are numbered from 1 without gaps.
template <class Pdos>
inline constexpr bool counts_from_one = [] {
  for (std::size_t i = 0; i < Pdos::count; ++i) {
    if (Pdos::numbers[i] != i + 1) return false;
  }
  return true;
}();

}  // namespace pdo_detail

/// Returns the number of the PDO at a position in a list.
template <class Pdos>
[[nodiscard]] constexpr std::uint16_t number_of_pdo(std::size_t place) {
  if constexpr (pdo_detail::counts_from_one<Pdos>) {
    return static_cast<std::uint16_t>(place + 1);
  } else {
    return Pdos::numbers[place];
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
    while (i < Pdos::count && Pdos::numbers[i] != place + 1) ++i;
    return i;
  }
}

/// The PDOs of a list that map an object, or can do so, and whose COB-ID is in the dictionary.
template <const Dictionary& D, PdoIndices Indices, class List>
using ServedPdos = typename pdo_detail::Served<D, Indices, List>::type;

}  // namespace canopen
