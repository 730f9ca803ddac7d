/// Closed enumerations of a device: objects that accept only some values between their limits.
#pragma once

#include <algorithm>
#include <array>
#include <cstdint>
#include <span>

#include "canopen/base/abort_code.hpp"
#include "canopen/od/object_list.hpp"
#include "canopen/od/sheet.hpp"
#include "canopen/od/value_bits.hpp"

namespace canopen {

/// A device that has such objects: `ClosedObjects` is the list of them. An array is in it as `od::x<>`. Their words are
/// marked as limited, so that RPDOs check their values.
template <class Device>
concept HasClosedObjects = requires {
  typename Device::ClosedObjects;
};

namespace closed_objects_detail {

template <class Object>
[[nodiscard]] constexpr bool is_entry(std::uint16_t index, std::uint8_t sub_index) {
  if constexpr (Object::sub_index == whole_array) return index == Object::index && sub_index != 0;
  return index == Object::index && sub_index == Object::sub_index;
}

template <class... Objects>
[[nodiscard]] constexpr bool has(ObjectList<Objects...>, std::uint16_t index, std::uint8_t sub_index) {
  return (is_entry<Objects>(index, sub_index) || ...);
}

template <class Object>
[[nodiscard]] bool accepts(std::span<const std::uint8_t> bytes) {
  std::array<std::uint8_t, 8> copy{};
  std::copy_n(bytes.begin(), (Object::bits + 7) / 8, copy.begin());
  return Object::is_value(value_detail::value_from<Object>(copy));
}

template <class... Objects>
[[nodiscard]] bool accept(ObjectList<Objects...>, std::uint16_t index, std::uint8_t sub_index,
                          std::span<const std::uint8_t> bytes) {
  return ((!is_entry<Objects>(index, sub_index) || accepts<Objects>(bytes)) && ...);
}

}  // namespace closed_objects_detail

/// Whether an entry is in the list.
/// `of_node`: the EntryAccess or ObjectStore of a device with a sheet, nothing for others.
template <class Device, class... OfNode>
[[nodiscard]] constexpr bool is_closed([[maybe_unused]] std::uint16_t index, [[maybe_unused]] std::uint8_t sub_index,
                                       [[maybe_unused]] const OfNode&... of_node) {
  if constexpr (has_sheet<Device>) {
    return (Device::sheet_of(of_node), ...).is_closed(index, sub_index);
  } else if constexpr (HasClosedObjects<Device>) {
    return closed_objects_detail::has(typename Device::ClosedObjects{}, index, sub_index);
  } else {
    return false;
  }
}

/// Returns invalid_value if an entry of the list does not accept this value, whose length is correct.
template <class Device, class... OfNode>
[[nodiscard]] AbortCode check_closed([[maybe_unused]] std::uint16_t index, [[maybe_unused]] std::uint8_t sub_index,
                                     [[maybe_unused]] std::span<const std::uint8_t> bytes,
                                     [[maybe_unused]] const OfNode&... of_node) {
  if constexpr (has_sheet<Device>) {
    return (Device::sheet_of(of_node), ...).check_closed(index, sub_index, bytes);
  } else if constexpr (HasClosedObjects<Device>) {
    if (!closed_objects_detail::accept(typename Device::ClosedObjects{}, index, sub_index, bytes))
      return AbortCode::invalid_value;
  }
  return ok;
}

}  // namespace canopen
