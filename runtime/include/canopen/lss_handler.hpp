/// LSS in a node: what the application gives a slave, among the node's handlers.
///
///     struct Port {
///       canopen::LssError accept(canopen::NodeId);           // or refuse a node-ID, 1..127 or 255
///       canopen::LssError accept(canopen::LssBitTiming);     // or refuse a bit rate
///       canopen::LssError store(canopen::NodeId, canopen::LssBitTiming);
///       canopen::LssBitTiming bit_timing();                  // the one that is stored
///       void stop_communication();
///       void start_communication(canopen::LssBitTiming);
///     };
///     auto sensor = canopen::make_node<rk5c::Device>(bus, stored_node_id, canopen::configured_by_lss<rk5c::Device::lss_options>(port));
#pragma once

#include <tuple>

#include "canopen/lss_slave.hpp"

namespace canopen {

template <LssOptions Options, class Port>
struct LssHandler {
  static constexpr LssOptions options = Options;
  Port* port;
};

/// Gives a node an LSS slave. The port must outlive the node.
template <LssOptions Options = LssOptions{}, class Port>
[[nodiscard]] constexpr LssHandler<Options, Port> configured_by_lss(Port& port) {
  return {&port};
}

namespace lss_detail {

template <class Handler>
inline constexpr bool is_handler = false;
template <LssOptions Options, class Port>
inline constexpr bool is_handler<LssHandler<Options, Port>> = true;

/// The handler for LSS among others; void where there is none.
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

/// The slave that a handler makes; an empty class for none.
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
