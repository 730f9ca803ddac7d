/// Whether an object type is one of a device: the dictionary has its index and sub-index, and the EDS has its name.
#pragma once

#include <algorithm>
#include <array>
#include <cstddef>
#include <cstdint>
#include <string_view>

#include "canopen/od/object.hpp"
#include "canopen/od/object_list.hpp"

namespace canopen {

namespace device_object_detail {

/// A row of the EDS: an object, or all elements of an ARRAY, with sub-index 255.
struct NamedRow {
  std::uint32_t key = 0;
  std::string_view name;
};

[[nodiscard]] constexpr std::uint32_t key_of(std::uint16_t index, std::uint8_t sub_index) {
  return (std::uint32_t{index} << 8) | sub_index;
}

template <class Row>
struct RowOf {
  static constexpr NamedRow row{key_of(Row::index, Row::sub_index), Row::name};
};
template <template <std::uint8_t> class Array, std::uint8_t Highest>
struct RowOf<ArrayObjects<Array, Highest>> {
  static constexpr NamedRow row{key_of(Array<whole_array>::index, whole_array), Array<whole_array>::name};
};

template <class Objects>
struct NamedRows {
  static constexpr std::size_t count = 0;
};
template <class... Rows>
struct NamedRows<ObjectRows<Rows...>> {
  static constexpr std::size_t count = sizeof...(Rows);
  static constexpr std::array<NamedRow, sizeof...(Rows)> rows{RowOf<Rows>::row...};
};

/// Larger dictionaries are not searched: the compiler needs time for each row.
inline constexpr std::size_t max_rows = 4'000;

/// The rows are in the order of the dictionary.
template <class Rows>
[[nodiscard]] constexpr bool has_other_name(std::uint32_t key, std::string_view name) {
  const auto found = std::ranges::lower_bound(Rows::rows, key, {}, &NamedRow::key);
  return found != Rows::rows.end() && found->key == key && found->name != name;
}

template <class Object>
concept Named = requires {
  std::string_view{Object::name};
};

template <class Object, class Device>
[[nodiscard]] constexpr bool is_foreign() {
  if constexpr (Named<Object> && requires { typename Device::Objects; }) {
    using Rows = NamedRows<typename Device::Objects>;
    if constexpr (Rows::count != 0 && Rows::count <= max_rows) {
      return has_other_name<Rows>(key_of(Object::index, Object::sub_index), Object::name) ||
             (Object::sub_index != 0 && has_other_name<Rows>(key_of(Object::index, whole_array), Object::name));
    }
  }
  return false;
}

}  // namespace device_object_detail

/// Whether a device has an entry with the index and sub-index of an object.
template <class Object, class Device>
inline constexpr bool is_in_dictionary = Device::dictionary.has(Object::index, Object::sub_index);

/// Whether an object is an ARRAY without the sub-index of an element.
template <class Object, class Device>
inline constexpr bool lacks_sub_index = Object::sub_index == whole_array && !is_in_dictionary<Object, Device>;

/// Whether an object is one of another device, whose EDS has another name at this index. Objects without a name, which
/// are not generated, are those of every device.
template <class Object, class Device>
inline constexpr bool is_of_another_device = device_object_detail::is_foreign<Object, Device>();

}  // namespace canopen
