/// The composition of a reference device on a board. The build may set a node-ID; then the device omits LSS.
#pragma once

#include <canopen/node.hpp>
#include EDSC_DEVICE_HEADER

#ifdef EDSC_NODE_ID
inline constexpr bool node_id_is_set = true;
#else
inline constexpr bool node_id_is_set = false;
#endif

template <class Device, bool OmitsLss>
struct SelectParts {
  using type = canopen::Composition<Device>;
};
template <class Device>
struct SelectParts<Device, true> {
  using type = canopen::Composition<Device, canopen::without<canopen::part::lss>>;
};
template <class Device>
using PartsOf = SelectParts<Device, node_id_is_set && canopen::part::lss::is_promised<Device>>::type;
