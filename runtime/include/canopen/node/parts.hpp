/// The parts of a node, as types and as values: `Node<Device, Bus, Parts...>` lists the types, `make_node<Device>(bus,
/// node_id, parts...)` the values, in the same words:
///
///     canopen::Node<pump::Device, Bus, Pump, canopen::StoredIn<Flash>> node{bus, node_id, canopen::stored_in(flash)};
///     auto node = canopen::make_node<pump::Device>(bus, node_id, Pump{}, canopen::stored_in(flash));
///
/// A part that is not given to the constructor is default-constructed.
#pragma once

#include <cstddef>
#include <tuple>
#include <type_traits>
#include <utility>

#include "canopen/base/verdict.hpp"
#include "canopen/node/application.hpp"

namespace canopen::part_detail {

/// `Given` are references: an application as a variable would be copied: changes of the copy in the node would not be
/// seen in the variable.
template <class Given>
inline constexpr bool is_copy =
    std::is_lvalue_reference_v<Given>&& handler_detail::is_application<std::remove_cvref_t<Given>>;
template <class Given>
struct GivenPart {
  static constexpr bool is_good = true;
  static_assert(!is_copy<Given>,
                "application: this would copy the variable into the node; pass canopen::application_at(variable), or "
                "move it");
};

template <class Part, class... Parts>
inline constexpr std::size_t count_of = (std::size_t{std::is_same_v<Part, Parts>} + ... + 0);

/// A value that a node of these parts does not have.
template <class Given, class... Parts>
struct KnownPart {
  static constexpr bool is_good = true;
  static_assert(count_of<Given, Parts...> == 1,
                "node: this value is not one of the parts of the node's type, or one of two of the same type");
};

/// Parts that refer to something outside of the node.
template <class Part>
inline constexpr bool refers =
    storage_detail::is_stored_in<Part> || lss_detail::is_handler<Part> || mailbox_detail::is_values_from<Part>;
template <class Application>
inline constexpr bool refers<ApplicationAt<Application>> = true;

template <class Part>
inline constexpr bool has_default = std::is_default_constructible_v<Part> && !refers<Part>;

/// A part that is neither given nor default-constructible.
template <class Part, bool IsGiven>
struct MissingPart {
  static constexpr bool is_good = true;
  static_assert(IsGiven || has_default<Part>,
                "node: this part of the node's type needs a value, which is passed to the node");
};

/// Whether all parts are given, in their order.
template <class Parts, class... Given>
inline constexpr bool is_complete = std::is_same_v<Parts, std::tuple<std::remove_cvref_t<Given>...>>;

/// Checks the values given to a constructor.
template <class... Given, class... Parts>
[[nodiscard]] constexpr auto check_given(std::type_identity<std::tuple<Parts...>> /*parts*/) {
  if constexpr ((is_copy<Given> || ...) || is_complete<std::tuple<Parts...>, Given...>) {
    return canopen::first_failure(VerdictOf<!is_copy<Given>, GivenPart<Given>>{}...);
  } else {
    return canopen::first_failure(VerdictOf<count_of<std::remove_cvref_t<Given>, Parts...> == 1,
                                            KnownPart<std::remove_cvref_t<Given>, Parts...>>{}...,
                                  VerdictOf < count_of<Parts, std::remove_cvref_t<Given>...> != 0 || has_default<Parts>,
                                  MissingPart < Parts, false >> {}...);
  }
}

/// A class with `is_good`, which does not compile if a value is wrong or missing.
template <class Parts, class... Given>
using CheckedParts = typename decltype(part_detail::check_given<Given...>(std::type_identity<Parts>{}))::type;

/// The position of the value for a part, the I-th of `Parts`; the number of values if it is not given.
template <std::size_t Position, class Parts, class... Given>
inline constexpr std::size_t place_of = [] {
  if (is_complete<Parts, Given...>) return Position;
  constexpr bool same[] = {std::is_same_v<std::tuple_element_t<Position, Parts>, std::remove_cvref_t<Given>>..., true};
  std::size_t place = 0;
  while (!same[place]) ++place;
  return place;
}();

/// Converts to the given value of a part, or to a default-constructed part, which need not be movable.
template <class Part, std::size_t Place, class... Given>
struct PartValue {
  std::tuple<Given...>& given;  ///< references

  constexpr operator Part() const {  // NOLINT(google-explicit-constructor): stands for the part
    if constexpr (Place == sizeof...(Given)) {
      return Part{};
    } else {
      return std::get<Place>(std::move(given));
    }
  }
};

}  // namespace canopen::part_detail
