/// LSS in a node: the functions that the application provides to a slave, as one of the node's handlers.
///
///     struct Port {
///       canopen::LssError accept(canopen::NodeId);           // or reject a node-ID, 1..127 or 255
///       canopen::LssError accept(canopen::LssBitTiming);     // or reject a bit rate
///       canopen::LssError store(canopen::NodeId, canopen::LssBitTiming);
///       canopen::LssBitTiming bit_timing();                  // the stored one
///       void stop_communication();
///       void start_communication(canopen::LssBitTiming);
///     };
///     auto sensor = canopen::make_node<rk5c::Device>(bus, stored_node_id,
///                                                    canopen::configured_by_lss<rk5c::Device::lss_options>(port));
#pragma once

#include <tuple>

#include "canopen/lss/lss_slave.hpp"

namespace canopen {

template <LssOptions Options, class Port>
struct LssHandler {
  static constexpr LssOptions options = Options;
  Port* port;
};

/// Adds an LSS slave to a node. The port must outlive the node.
template <LssOptions Options = LssOptions{}, class Port>
[[nodiscard]] constexpr LssHandler<Options, Port> configured_by_lss(Port& port) {
  return {&port};
}

namespace lss_detail {

template <class Handler>
inline constexpr bool is_handler = false;
template <LssOptions Options, class Port>
inline constexpr bool is_handler<LssHandler<Options, Port>> = true;

/// Finds the LSS handler among others; void if there is none.
template <class... Handlers>
struct Find {
  using type = void;
};
template <class H, class... Rest>
struct Find<H, Rest...> {
  using type = typename Find<Rest...>::type;
};
template <LssOptions Options, class Port, class... Rest>
struct Find<LssHandler<Options, Port>, Rest...> {
  using type = LssHandler<Options, Port>;
};

/// The slave for a handler; an empty class if there is none.
template <class Handler>
struct SlaveOf {
  using type = LssSlave<Handler::options>;
};
template <>
struct SlaveOf<void> {
  struct type {};
};

}  // namespace lss_detail

}  // namespace canopen
