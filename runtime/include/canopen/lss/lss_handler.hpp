/// LSS in a node: the functions that the application provides to a slave, as one of the parts of the node.
///
///     struct Port {
///       canopen::LssError accept(canopen::NodeId);           // or reject a node-ID, 1..127 or 255
///       canopen::LssError accept(canopen::LssBitTiming);     // or reject a bit rate
///       canopen::LssError store(canopen::NodeId, canopen::LssBitTiming);
///       canopen::LssBitTiming bit_timing();                  // the stored one
///       void stop_communication();
///       void start_communication(canopen::LssBitTiming);
///     };
///     auto sensor = canopen::make_node<rk5c::Device>(bus, stored_node_id, canopen::configured_by_lss(port));
#pragma once

#include <tuple>
#include <type_traits>

#include "canopen/lss/lss_slave.hpp"
#include "canopen/od/sheet.hpp"

namespace canopen {

/// The LSS slave of a node, with the options of its device.
template <class Port>
struct ConfiguredByLss {
  Port* port;
};

/// The same with options of its own, for a device whose EDS does not have LSS.
template <LssOptions Options, class Port>
struct LssHandler {
  static constexpr LssOptions options = Options;
  Port* port;
};

/// Adds an LSS slave to a node. The port must outlive the node.
template <class Port>
[[nodiscard]] constexpr ConfiguredByLss<Port> configured_by_lss(Port& port) {
  return {&port};
}
template <LssOptions Options, class Port>
[[nodiscard]] constexpr LssHandler<Options, Port> configured_by_lss(Port& port) {
  return {&port};
}

namespace lss_detail {

template <class Handler>
inline constexpr bool is_handler = false;
template <class Port>
inline constexpr bool is_handler<ConfiguredByLss<Port>> = true;
template <LssOptions Options, class Port>
inline constexpr bool is_handler<LssHandler<Options, Port>> = true;

/// Finds the LSS handler among others; void if there is none.
template <class... Handlers>
struct Find {
  using type = void;
};
template <class HandlerType, class... Rest>
struct Find<HandlerType, Rest...> {
  using type = std::conditional_t<is_handler<HandlerType>, HandlerType, typename Find<Rest...>::type>;
};

/// Whether the EDS of a device has LSS.
template <class Device>
concept HasLss = requires {
  Device::lss_options;
};

/// The options of an LSS handler in a device.
template <class Device, class Handler>
inline constexpr LssOptions options_of{};
template <HasLss Device, class Port>
inline constexpr LssOptions options_of<Device, ConfiguredByLss<Port>> = Device::lss_options;
template <class Device, LssOptions Options, class Port>
inline constexpr LssOptions options_of<Device, LssHandler<Options, Port>> = Options;

/// Whether the options of an LSS handler are those of a device with LSS.
template <class Device, class Handler>
inline constexpr bool options_fit = true;
template <HasLss Device, LssOptions Options, class Port>
inline constexpr bool options_fit<Device, LssHandler<Options, Port>> = Options == Device::lss_options;

/// The slave for a handler; an empty class if there is none.
template <class Device, class Handler>
struct SlaveOf {
  using type = LssSlave<options_of<Device, Handler>>;
};
template <class Device, class Port>
requires has_sheet<Device>
struct SlaveOf<Device, ConfiguredByLss<Port>> {
  using type = LssSlave<LssOptions{}, true>;
};
template <class Device>
struct SlaveOf<Device, void> {
  struct type {};
};

}  // namespace lss_detail

}  // namespace canopen
