/// A new mapping of a PDO, from its layout: the parameters to write, in their order (CiA 301, 7.5.2.36 and 7.5.2.38).
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <type_traits>

#include "canopen/base/abort_code.hpp"
#include "canopen/base/label.hpp"
#include "canopen/can/cob_id.hpp"
#include "canopen/od/dictionary.hpp"
#include "canopen/pdo/pdo.hpp"
#include "canopen/pdo/pdo_check.hpp"
#include "canopen/pdo/pdo_list.hpp"

namespace canopen {

namespace pdo_detail {

template <class Layout>
inline constexpr bool is_tpdo = false;
template <class... Objects>
inline constexpr bool is_tpdo<Tpdo<Objects...>> = true;
template <class Layout>
inline constexpr bool is_rpdo = false;
template <class... Objects>
inline constexpr bool is_rpdo<Rpdo<Objects...>> = true;

/// The PDO with a new mapping. `Number` is RpdoNumber or TpdoNumber.
template <class Device, class Number, std::size_t Entries, std::size_t Capacity>
struct RemappedPdo {
  static constexpr bool is_good = true;
  static_assert(Capacity != 0, "PDO mapping: the mapping of this PDO is static, or the device does not have the PDO");
  static_assert(Capacity == 0 || Entries <= Capacity, "PDO mapping: the PDO maps fewer objects");
};

}  // namespace pdo_detail

/// `Layout` is a Tpdo<...> or Rpdo<...> of objects of the device, `Number` counts from 1.
template <class Device, std::uint16_t Number, class Layout>
struct Remapping {
  static constexpr bool transmit = pdo_detail::is_tpdo<Layout>;
  static_assert(transmit || pdo_detail::is_rpdo<Layout>,
                "PDO mapping: give it as canopen::Tpdo<...> or canopen::Rpdo<...>");
  static constexpr PdoIndices first = transmit ? tpdo_indices : rpdo_indices;
  static constexpr std::uint16_t communication = first.communication + Number - 1;
  static constexpr std::uint16_t mapping = first.mapping + Number - 1;
  using Pdo = std::conditional_t<transmit, TpdoNumber<Number>, RpdoNumber<Number>>;
  static_assert(
      pdo_detail::RemappedPdo<Device, Pdo, Layout::entries, mapping_capacity(Device::dictionary, mapping)>::is_good);
  static_assert(decltype(pdo_detail::check_entries<Device::dictionary, Pdo, Layout, Device::granularity>(
      std::make_index_sequence<Layout::entries>{}))::type::is_good);

  /// The values of the sub-indices from 1 on.
  static constexpr std::array<std::uint32_t, Layout::entries> entries = [] {
    std::array<std::uint32_t, Layout::entries> values{};
    Layout::for_each([&]<class Object, std::size_t Position>() {
      values[Position] = (object_key(Object::index, Object::sub_index) << 8) | Object::bits;
    });
    return values;
  }();

  /// Calls `write(index, sub_index, value, bytes)` for the mapping parameter, until it returns an abort code. The PDO
  /// must not be valid (CiA 301, 7.5.2.36 and 7.5.2.38).
  template <class Write>
  [[nodiscard]] static AbortCode map(Write&& write) {
    if (const AbortCode code = write(mapping, std::uint8_t{0}, 0u, 1u); code != ok) return code;
    for (std::size_t i = 0; i < entries.size(); ++i) {
      if (const AbortCode code = write(mapping, static_cast<std::uint8_t>(i + 1), entries[i], 4u); code != ok)
        return code;
    }
    return write(mapping, std::uint8_t{0}, static_cast<std::uint32_t>(entries.size()), 1u);
  }

  /// The same over the bus: the PDO with this COB-ID is not valid while its mapping changes. After an abort code it
  /// stays so.
  template <class Write>
  [[nodiscard]] static AbortCode map_valid(std::uint32_t cob_id, Write&& write) {
    if (const AbortCode code = write(communication, pdo_parameter::cob_id, cob_id | CobId::invalid_bit, 4u); code != ok)
      return code;
    if (const AbortCode code = map(write); code != ok) return code;
    return write(communication, pdo_parameter::cob_id, cob_id & ~CobId::invalid_bit, 4u);
  }
};

}  // namespace canopen
