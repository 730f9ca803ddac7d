/// Functions that create a node; its types follow from the arguments.
#pragma once

#include <tuple>
#include <type_traits>
#include <utility>

#include "canopen/can/frame.hpp"
#include "canopen/can/node_id.hpp"
#include "canopen/node/composition.hpp"

namespace canopen {

template <class Device, class BusType, class... Parts>
class Node;

/// Returns a node of a device on a bus, with its parts: handlers, applications, storage, LSS port, in any order:
///     auto drive = canopen::make_node<cpc_tc1::Device>(bus, canopen::NodeId{5}, canopen::on_write<...>(...));
/// `Device` may be a Composition: its parts that are not among the values are default-constructed.
template <class Device, class BusType, class... Parts>
[[nodiscard]] constexpr auto make_node(BusType& bus, NodeId node_id, Parts&&... parts) {
  using Made = typename composition_detail::NodeFor<Device, BusType, std::remove_cvref_t<Parts>...>::type;
  return Made{bus, node_id, std::forward<Parts>(parts)...};
}

/// The same with the handlers in a tuple, as returned by a function that creates all handlers of an application:
///     auto pump_node = canopen::make_node<pump::Device>(bus, canopen::NodeId{5}, application.handlers());
template <class Device, class BusType, class... Parts>
[[nodiscard]] constexpr auto make_node(BusType& bus, NodeId node_id, std::tuple<Parts...> parts) {
  return std::apply(
      [&](Parts&... part) {
        return Node<Device, BusType, Parts...>{bus, node_id, std::move(part)...};
      },
      parts);
}

/// The same for a node whose node-ID is passed to `start`.
template <class Device, class BusType, class... Parts>
[[nodiscard]] constexpr auto make_node(BusType& bus, Parts&&... parts) {
  using Made = typename composition_detail::NodeFor<Device, BusType, std::remove_cvref_t<Parts>...>::type;
  return Made{bus, std::forward<Parts>(parts)...};
}

}  // namespace canopen
