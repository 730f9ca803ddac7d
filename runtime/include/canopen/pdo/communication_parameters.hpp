/// Checks of writes to the communication parameters of a PDO (CiA 301, 7.5.2.35 and 7.5.2.37).
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>

#include "canopen/base/abort_code.hpp"
#include "canopen/base/clock.hpp"
#include "canopen/can/cob_id.hpp"
#include "canopen/od/device_options.hpp"
#include "canopen/od/object_store.hpp"
#include "canopen/od/sheet.hpp"
#include "canopen/pdo/pdo_list.hpp"
#include "canopen/pdo/transmission_type.hpp"
#include "canopen/sync/sync.hpp"

namespace canopen {

[[nodiscard]] constexpr bool is_rpdo_communication(std::uint16_t index) {
  return index >> 9 == rpdo_indices.communication >> 9;
}
[[nodiscard]] constexpr bool is_tpdo_communication(std::uint16_t index) {
  return index >> 9 == tpdo_indices.communication >> 9;
}

/// Whether a PDO of the device may send or receive with a COB-ID: is_usable(), and the CAN-IDs that its options allow.
/// `of_node`: the EntryAccess of a device with a sheet, nothing for others.
template <class Device, class... OfNode>
[[nodiscard]] constexpr bool is_usable_by_pdo(std::uint32_t cob_id, const OfNode&... of_node) {
  if (is_in(options_of<Device>(of_node...).pdo_allowed_can_ids, cob_id)) return true;
  return is_usable(cob_id);
}

/// The same for may_be_written() if the COB-ID is in use.
template <class Device, class... OfNode>
[[nodiscard]] constexpr bool may_be_used_by_pdo(CobId cob_id, bool extended_ids, const OfNode&... of_node) {
  if (is_in(options_of<Device>(of_node...).pdo_allowed_can_ids, cob_id.value())) return true;
  return may_be_written(cob_id, true, extended_ids);
}

/// Converts an inhibit time of 1800h..19FFh:03.
[[nodiscard]] constexpr Duration inhibit_duration(const DeviceOptions& options, std::uint16_t count) {
  return Duration{std::uint32_t{count} * options.inhibit_time_unit};
}

/// Returns 0609 0030h if the COB-ID of a PDO requires a feature that the device does not have.
[[nodiscard]] constexpr AbortCode check_pdo_features(const DeviceOptions& options, bool tpdo, CobId cob_id) {
  const auto [first, last] = options.pdo_reserved_can_ids;
  if (first <= last && cob_id.valid() && !cob_id.extended() && cob_id.can_id() >= first && cob_id.can_id() <= last)
    return AbortCode::invalid_value;
  if (!tpdo) return ok;
  if (!options.tpdo_remote_frames && cob_id.rtr_allowed()) return AbortCode::invalid_value;
  if (!options.tpdo_remote_frames_can_be_disabled && !cob_id.rtr_allowed()) return AbortCode::invalid_value;
  return ok;
}

/// Returns 0609 0030h for reserved transmission types.
[[nodiscard]] constexpr AbortCode check_transmission_type(const DeviceOptions& options, bool tpdo, std::uint8_t type) {
  const Transmission transmission = transmission_of(type);
  if (transmission == Transmission::synchronous || transmission == Transmission::event_driven) return ok;
  const bool remote = tpdo && options.tpdo_remote_frames && options.tpdo_remote_types;
  return remote && transmission != Transmission::reserved ? ok : AbortCode::invalid_value;
}

/// Whether this sub-index of all PDO communication parameters of a device has `Size` bytes.
template <class Device, std::uint8_t SubIndex, std::size_t Size>
inline constexpr bool has_pdo_parameter_size = [] {
  bool has = true;
  Device::dictionary.for_each_communication_entry([&](std::uint16_t index, std::uint8_t sub_index, entry::Word word) {
    if (sub_index == SubIndex && (is_rpdo_communication(index) || is_tpdo_communication(index)))
      has = has && entry::wire_bytes(word) == Size;
  });
  return has;
}();

/// Checks whether these bytes, whose length is correct, may be written to 1400h..15FFh or 1800h..19FFh. Bits of a
/// COB-ID that the device does not allow to change are restored in `bytes`. 0604 0047h: in the EDS, the parameter does
/// not have the type of CiA 301.
template <class Device>
[[nodiscard]] AbortCode check_pdo_parameter(EntryAccess<Device> entries, std::uint16_t index, std::uint8_t sub_index,
                                            std::span<std::uint8_t> bytes) {
  const bool tpdo = is_tpdo_communication(index);
  const DeviceOptions& options = options_of<Device>(entries);
  const CobId cob_id{entries.number(index, pdo_parameter::cob_id)};
  switch (sub_index) {
    case pdo_parameter::cob_id: {
      if (!has_pdo_parameter_size<Device, pdo_parameter::cob_id, 4> && bytes.size() != 4)
        return AbortCode::internal_incompatibility;
      const CobId after = written_cob_id(cob_id, options.pdo_cob_id_writable, bytes);
      const bool is_allowed = !cob_id.valid() && is_in(options.pdo_allowed_can_ids, after.value());
      if (!is_allowed && !may_change(cob_id, after, options.pdo_extended_ids)) return AbortCode::invalid_value;
      return check_pdo_features(options, tpdo, after);
    }
    case pdo_parameter::transmission_type: return check_transmission_type(options, tpdo, bytes[0]);
    case pdo_parameter::inhibit_time:
      if (!tpdo || options.inhibit_time_writable_while_valid) return ok;
      if (!has_pdo_parameter_size<Device, pdo_parameter::inhibit_time, 2> && bytes.size() != 2)
        return AbortCode::internal_incompatibility;
      break;
    case pdo_parameter::sync_start:
      if (!tpdo) return ok;
      if (bytes[0] > highest_sync_counter) return AbortCode::invalid_value;
      if (options.sync_start_writable_while_valid) return ok;
      break;
    default: return ok;
  }
  const bool changed = entries.number(index, sub_index) != number_in(bytes);
  return cob_id.valid() && changed ? AbortCode::device_state : ok;
}

}  // namespace canopen
