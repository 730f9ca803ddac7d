/// Devices whose tables are loaded at run time. The services of such a device are compiled for a type with all objects
/// that they know; each node has a sheet, with the tables and the options of its EDS. An object that the EDS does not
/// have keeps a value in the node that disables its service, and cannot be accessed over the bus.
///
/// `Device::Sheet` is the type of a sheet, and `Device::sheet_of(entries)` and `Device::sheet_of(store)` return the one
/// of a node. Its members:
///   dictionary                          a Dictionary; offsets of objects that services know are those of the type
///   options                             DeviceOptions
///   dummies, granularity                as in a generated device
///   longest_download                    in bytes
///   rpdo_numbers, tpdo_numbers          the number of the PDO at each place of the type's lists, ascending
///   triggers_event(index, sub_index), emergency_info(code)      as in a generated device
///   lss_options                         std::optional<LssOptions>; empty: the device does not have LSS
///   is_closed(index, sub_index), check_closed(index, sub_index, bytes)   see od/closed_objects.hpp
///
/// A generated device does not have a sheet: the functions here are then constants of its type, and cost nothing.
#pragma once

#include "canopen/od/device_options.hpp"

namespace canopen {

/// Whether the tables of a device are loaded at run time.
template <class Device>
inline constexpr bool has_sheet = requires {
  typename Device::Sheet;
};

/// Returns the options of a device: a constant of its type, or those of the sheet of a node, which is passed as its
/// EntryAccess or ObjectStore.
template <class Device, class... OfNode>
[[nodiscard, gnu::always_inline]] constexpr const DeviceOptions& options_of([[maybe_unused]] const OfNode&... of_node) {
  if constexpr (has_sheet<Device>) {
    static_assert(sizeof...(OfNode) == 1, "a sheet belongs to a node");
    return (Device::sheet_of(of_node), ...).options;
  } else {
    return Device::options;
  }
}

/// Returns `call(of_node)` for a device with a sheet, and `call()` for a generated one: a function that needs a node
/// only for its sheet does not get a parameter for it in an image.
template <class Device, class OfNode, class Call>
[[gnu::always_inline]] constexpr decltype(auto) with_sheet([[maybe_unused]] const OfNode& of_node, const Call& call) {
  if constexpr (has_sheet<Device>) {
    return call(of_node);
  } else {
    return call();
  }
}

}  // namespace canopen
