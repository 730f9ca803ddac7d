/// Functions that create a node; its types follow from the arguments.
#pragma once

#include <tuple>
#include <utility>

#include "canopen/can/frame.hpp"
#include "canopen/can/node_id.hpp"

namespace canopen {

template <class Device, class B, class... Handlers>
class Node;

/// Returns a node of a device on a bus, with its handlers:
///     auto drive = canopen::make_node<cpc_tc1::Device>(bus, canopen::NodeId{5}, canopen::on_write<...>(...));
template <class Device, class B, class... Handlers>
[[nodiscard]] constexpr Node<Device, B, Handlers...> make_node(B& bus, NodeId node_id, Handlers... handlers) {
  return Node<Device, B, Handlers...>{bus, node_id, std::move(handlers)...};
}

/// The same with the handlers in a tuple, as returned by a function that creates all handlers of an application:
///     auto pump_node = canopen::make_node<pump::Device>(bus, canopen::NodeId{5}, application.handlers());
template <class Device, class B, class... Handlers>
[[nodiscard]] constexpr Node<Device, B, Handlers...> make_node(B& bus, NodeId node_id,
                                                               std::tuple<Handlers...> handlers) {
  return std::apply(
      [&](Handlers&... handler) {
        return Node<Device, B, Handlers...>{bus, node_id, std::move(handler)...};
      },
      handlers);
}

/// The same for a node whose node-ID is passed to `start`.
template <class Device, class B, class... Handlers>
[[nodiscard]] constexpr Node<Device, B, Handlers...> make_node(B& bus, Handlers... handlers) {
  return Node<Device, B, Handlers...>{bus, std::move(handlers)...};
}

}  // namespace canopen
