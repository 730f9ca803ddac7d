/// The objects of a device as a list of types, which edsc generates as `Objects`, and the selection of some of them.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <span>
#include <type_traits>
#include <utility>

namespace canopen {

/// Sub-index of an array's template that means the whole array: `od::consumer_heartbeat_time<>`. An array has at most
/// 254 elements (CiA 301, 7.4.7).
inline constexpr std::uint8_t whole_array = 0xFF;

/// Objects, by their generated types.
template <class... Os>
struct ObjectList {
  static constexpr std::size_t size = sizeof...(Os);

  /// Calls `visit.template operator()<O>()` for each object, in their order.
  template <class Visit>
  static constexpr void for_each([[maybe_unused]] Visit&& visit) {
    (visit.template operator()<Os>(), ...);
  }
};

/// All objects of a device, in rows: an object, or an array. A row that is not selected is not instantiated.
template <class... Rows>
struct ObjectRows {};

/// A row of the sub-indices 0..Highest.
template <template <std::uint8_t> class Array, std::uint8_t Highest>
struct ArrayObjects {};

namespace object_list_detail {

/// Which objects of a row a predicate selects, and their types by position.
template <class Predicate, class Row>
struct Selected {
  static constexpr std::array<bool, 1> values{Predicate::template selects<Row>};
  template <std::size_t>
  using at = Row;
};
template <class Predicate, template <std::uint8_t> class Array, std::uint8_t Highest>
struct Selected<Predicate, ArrayObjects<Array, Highest>> {
  static constexpr auto values = []<std::size_t... Position>(std::index_sequence<Position...>) {
    return std::array<bool, sizeof...(Position)>{
        Predicate::template selects<Array<static_cast<std::uint8_t>(Position)>>...};
  }
  (std::make_index_sequence<Highest + std::size_t{1}>{});
  template <std::size_t Position>
  using at = Array<static_cast<std::uint8_t>(Position)>;
};

template <std::size_t Position, class Row>
struct Numbered {};
template <class Numbers, class... Rows>
struct NumberedRows;
template <std::size_t... Position, class... Rows>
struct NumberedRows<std::index_sequence<Position...>, Rows...> : Numbered<Position, Rows>... {};

template <std::size_t Position, class Row>
Row* find_row(const Numbered<Position, Row>*);

struct Place {
  std::size_t row;
  std::size_t position;
};

template <class Predicate, class... Rows>
struct Select {
  /// Without a fold: Clang accepts 256 operands at most.
  static constexpr std::array<std::span<const bool>, sizeof...(Rows)> rows{Selected<Predicate, Rows>::values...};
  static constexpr std::size_t count = [] {
    std::size_t sum = 0;
    for (const std::span<const bool> row : rows) {
      for (const bool selected : row) sum += selected ? 1 : 0;
    }
    return sum;
  }();
  static constexpr std::array<Place, count> places = [] {
    std::array<Place, count> found{};
    std::size_t at = 0;
    for (std::size_t i = 0; i < rows.size(); ++i) {
      for (std::size_t j = 0; j < rows[i].size(); ++j) {
        if (rows[i][j]) found[at++] = {i, j};
      }
    }
    return found;
  }();

  template <std::size_t Position>
  using RowAt = std::remove_pointer_t<decltype(find_row<Position>(
      static_cast<const NumberedRows<std::index_sequence_for<Rows...>, Rows...>*>(nullptr)))>;

  template <std::size_t... Position>
  static ObjectList<
      typename Selected<Predicate, RowAt<places[Position].row>>::template at<places[Position].position>...>
      list(std::index_sequence<Position...>);
  using type = decltype(list(std::make_index_sequence<count>{}));
};

template <class Predicate, class Objects>
struct SelectFrom;
template <class Predicate, class... Rows>
struct SelectFrom<Predicate, ObjectRows<Rows...>> : Select<Predicate, Rows...> {};
template <class Predicate>
struct SelectFrom<Predicate, ObjectRows<>> {
  using type = ObjectList<>;
};

}  // namespace object_list_detail

/// The list of those objects of which `Predicate::template selects<O>` is true.
template <class Predicate, class Objects>
using SelectObjects = typename object_list_detail::SelectFrom<Predicate, Objects>::type;

}  // namespace canopen
