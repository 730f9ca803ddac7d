/// Nodes of tests that do not need all parts that their EDS promises: what is missing is omitted.
#pragma once

#include <canopen/node.hpp>
#include <tuple>
#include <type_traits>
#include <utility>

namespace bench {

namespace omitting_detail {

using canopen::composition_detail::Omits;

template <class Device, class Bus, class Missing, class... Parts>
struct Select {
  using type = canopen::Node<Device, Bus, Parts..., Missing>;
};
template <class Device, class Bus, class... Parts>
struct Select<Device, Bus, Omits<>, Parts...> {
  using type = canopen::Node<Device, Bus, Parts...>;
};

}  // namespace omitting_detail

/// A node of a device that omits each part that is not among `Parts`.
template <class Device, class Bus, class... Parts>
using NodeOf =
    typename omitting_detail::Select<Device, Bus, canopen::composition_detail::OmitsMissing<Device, Parts...>,
                                     Parts...>::type;

/// The same with the values of its parts.
template <class Device, class Bus, class... Parts>
[[nodiscard]] constexpr auto make_node(Bus& bus, canopen::NodeId node_id, Parts&&... parts) {
  return NodeOf<Device, Bus, std::remove_cvref_t<Parts>...>{bus, node_id, std::forward<Parts>(parts)...};
}
template <class Device, class Bus, class... Parts>
[[nodiscard]] constexpr auto make_node(Bus& bus, canopen::NodeId node_id, std::tuple<Parts...> parts) {
  return std::apply(
      [&](Parts&... part) {
        return NodeOf<Device, Bus, Parts...>{bus, node_id, std::move(part)...};
      },
      parts);
}
template <class Device, class Bus, class... Parts>
[[nodiscard]] constexpr auto make_node(Bus& bus, Parts&&... parts) {
  return NodeOf<Device, Bus, std::remove_cvref_t<Parts>...>{bus, std::forward<Parts>(parts)...};
}

}  // namespace bench
