/// A device whose tables belong to the node: its services are compiled for the frame, and use the sheet of the node.
#pragma once

#include <algorithm>
#include <array>
#include <canopen/can/node_id.hpp>
#include <canopen/od/object_list.hpp>
#include <canopen/od/object_store.hpp>
#include <canopen/pdo/pdo.hpp>
#include <canopen/pdo/pdo_list.hpp>
#include <cstddef>
#include <cstdint>
#include <span>
#include <type_traits>
#include <utility>

#include "device/frame.hpp"
#include "device/sheet.hpp"

namespace edsc {

namespace frame::detail {

template <template <class...> class Layout, std::size_t... I>
canopen::PdoList<canopen::NumberedPdo<I + 1, Layout<>>...> pdos(std::index_sequence<I...>);

}  // namespace frame::detail

/// The `Device` of canopen::Node for an EDS that is loaded at run time. The sheet of a node is set before `start`.
struct DynamicDevice {
  static constexpr auto name = "EDS";

  using Sheet = edsc::Sheet;
  using Objects = canopen::ObjectList<>;
  static constexpr const canopen::Dictionary& dictionary = frame::dictionary;

  using Rpdos = decltype(frame::detail::pdos<canopen::Rpdo>(std::make_index_sequence<frame::max_pdos>{}));
  using Tpdos = decltype(frame::detail::pdos<canopen::Tpdo>(std::make_index_sequence<frame::max_pdos>{}));

  static constexpr std::size_t longest_download = frame::detail::text_bytes;

  /// What the services can do: the options of the sheet decide.
  static constexpr canopen::DeviceOptions options = [] {
    canopen::DeviceOptions all;
    all.sdo_block_transfer = true;
    all.reset_emergency = 0xFFFF;
    return all;
  }();
  static constexpr std::uint32_t dummies = ~std::uint32_t{0};
  static constexpr std::uint8_t granularity = 1;
  static constexpr bool triggers_event(std::uint16_t, std::uint8_t) { return true; }
  static constexpr std::array<std::uint8_t, 5> emergency_info(std::uint16_t) { return {}; }

  /// The address range of the tables, except for the sheet.
  static constexpr std::size_t value_bytes = 0xFF00;
  struct Values {
    alignas(8) std::array<std::uint8_t, value_bytes> bytes{};
    const Sheet* sheet = nullptr;
  };
  static_assert(frame::bytes <= value_bytes && sizeof(Values) <= 0x10000);

  static const Sheet& sheet_of(const canopen::ObjectStore<DynamicDevice>& store) { return *store.values().sheet; }
  static const Sheet& sheet_of(canopen::EntryAccess<DynamicDevice> entries) {
    return *reinterpret_cast<const Values*>(entries.ram(0))->sheet;
  }

  /// Sets 1000h..1FFFh, or the other objects, to the values of the sheet. DOMAINs keep their memory.
  static void reset_communication(Values& values, canopen::NodeId node_id) {
    reset(values, node_id, 0, values.sheet->communication_end);
  }
  static void reset_application(Values& values, canopen::NodeId node_id) {
    reset(values, node_id, values.sheet->communication_end, values.sheet->image.size());
  }
  static constexpr std::span<const canopen::NodeIdRelative> node_id_relative_communication() { return {}; }
  static constexpr std::span<const canopen::NodeIdRelative> node_id_relative_application() { return {}; }

 private:
  static void reset(Values& values, canopen::NodeId node_id, std::size_t from, std::size_t to) {
    const Sheet& sheet = *values.sheet;
    const auto is_in = [from, to](std::size_t offset) { return offset >= from && offset < to; };
    for (const SheetDomain& domain : sheet.domains) {
      if (!is_in(domain.offset)) continue;
      std::copy(sheet.image.begin() + static_cast<std::ptrdiff_t>(from),
                sheet.image.begin() + static_cast<std::ptrdiff_t>(domain.offset),
                values.bytes.begin() + static_cast<std::ptrdiff_t>(from));
      from = domain.offset + sizeof(canopen::Domain);
    }
    std::copy(sheet.image.begin() + static_cast<std::ptrdiff_t>(from),
              sheet.image.begin() + static_cast<std::ptrdiff_t>(to),
              values.bytes.begin() + static_cast<std::ptrdiff_t>(from));
    for (const SheetNodeIdRow& row : sheet.node_id_rows) {
      if (!is_in(row.offset)) continue;
      unsigned carry = node_id.value();
      for (std::uint32_t i = 0; i < row.size; ++i) {
        carry += values.bytes[row.offset + i];
        values.bytes[row.offset + i] = static_cast<std::uint8_t>(carry);
        carry >>= 8;
      }
    }
  }
};

}  // namespace edsc
