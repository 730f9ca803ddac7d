/// The PDOs of a device, by number.
#pragma once

#include <cstdint>
#include <type_traits>
#include <utility>

#include "canopen/dictionary.hpp"
#include "canopen/pdo.hpp"

namespace canopen {

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
    [&]<std::size_t... I>(std::index_sequence<I...>) { (visit.template operator()<Pdos, I>(), ...); }
    (std::index_sequence_for<Pdos...>{});
  }
};

namespace pdo_detail {

template <const Dictionary& D, std::uint16_t FirstParameter, class Taken, class List>
struct Served;
template <const Dictionary& D, std::uint16_t FirstParameter, class... Taken>
struct Served<D, FirstParameter, PdoList<Taken...>, PdoList<>> {
  using type = PdoList<Taken...>;
};
template <const Dictionary& D, std::uint16_t FirstParameter, class... Taken, class P, class... Rest>
struct Served<D, FirstParameter, PdoList<Taken...>, PdoList<P, Rest...>> {
  static constexpr bool serves = P::entries > 0 && D.has(FirstParameter + P::number - 1, 1);
  using type = typename Served<D, FirstParameter, std::conditional_t<serves, PdoList<Taken..., P>, PdoList<Taken...>>,
                               PdoList<Rest...>>::type;
};

}  // namespace pdo_detail

/// Those PDOs of a list that carry something and whose COB-ID is in the dictionary, at `FirstParameter` + number - 1.
template <const Dictionary& D, std::uint16_t FirstParameter, class List>
using ServedPdos = typename pdo_detail::Served<D, FirstParameter, PdoList<>, List>::type;

}  // namespace canopen
