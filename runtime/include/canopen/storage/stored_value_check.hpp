/// Checks stored values: whether they could have been written over the bus.
#pragma once

#include <algorithm>
#include <array>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>

#include "canopen/base/abort_code.hpp"
#include "canopen/can/cob_id.hpp"
#include "canopen/nmt/error_behavior.hpp"
#include "canopen/od/closed_objects.hpp"
#include "canopen/od/dictionary.hpp"
#include "canopen/od/object_store.hpp"
#include "canopen/pdo/communication_parameters.hpp"
#include "canopen/pdo/pdo_list.hpp"
#include "canopen/pdo/pdo_mapping.hpp"
#include "canopen/pdo/transmission_type.hpp"
#include "canopen/storage/parameter_layout.hpp"
#include "canopen/sync/sync.hpp"

namespace canopen {

/// Finds stored values that could not have been written over the bus.
template <class Device>
class StoredValueCheck {
  using Layout = ParameterLayout<Device>;

 public:
  /// A stored entry with a check of its service, or sub-index 0 of a mapping parameter.
  struct Checked {
    std::uint16_t index;
    std::uint8_t sub_index;
    std::uint8_t what;  ///< one of these, or the maximum number of objects of a mapping parameter
  };

 private:
  static constexpr std::uint8_t plain_value = 0;
  static constexpr std::uint8_t max_mapped = 64;
  static constexpr std::uint8_t emcy_inhibit_time = 0xF7;
  static constexpr std::uint8_t error_behavior = 0xF8;
  static constexpr std::uint8_t pdo_cob_id = 0xF6;  ///< of a device that allows restricted CAN-IDs
  static constexpr std::uint8_t rpdo_transmission = 0xF9;
  static constexpr std::uint8_t tpdo_transmission = 0xFA;
  static constexpr std::uint8_t sync_start = 0xFB;
  static constexpr std::uint8_t sync_period = 0xFC;
  static constexpr std::uint8_t sync_overflow = 0xFD;
  static constexpr std::uint8_t cob_id = 0xFF;      ///< if it is not valid, any value is accepted
  static constexpr std::uint8_t identifier = 0xFE;  ///< the same, but bits 30 and 31 have another meaning
  [[nodiscard]] static constexpr bool is_mapping(const Checked& row) { return row.what <= max_mapped; }

  template <std::uint8_t What>
  [[nodiscard]] static constexpr bool is(const Checked& row) {
    return row.what == What;
  }

  [[nodiscard]] static constexpr std::uint8_t what_is(std::uint16_t index, std::uint8_t sub_index) {
    if (const std::optional<CobIdEntries> row = find_cob_id_entries(index, sub_index)) {
      constexpr RestrictedCanIds allowed = Device::options.pdo_allowed_can_ids;
      if (allowed.first <= allowed.last && (is_rpdo_communication(index) || is_tpdo_communication(index))) {
        return pdo_cob_id;
      }
      return row->has_valid_bit ? cob_id : identifier;
    }
    const bool tpdo = is_tpdo_communication(index);
    if ((tpdo || is_rpdo_communication(index)) && sub_index == pdo_parameter::transmission_type) {
      return tpdo ? tpdo_transmission : rpdo_transmission;
    }
    if (tpdo && sub_index == pdo_parameter::sync_start) return sync_start;
    if (index == 0x1006) return sync_period;
    if (index == 0x1019) return sync_overflow;
    if (index == 0x1029 && sub_index != 0) return error_behavior;
    if (index == 0x1015 && Device::options.emcy_inhibit_time_step != 1) return emcy_inhibit_time;
    const bool mapping = sub_index == 0 && (is_rpdo_mapping(index) || is_tpdo_mapping(index));
    return mapping ? mapping_capacity(Device::dictionary, index) : plain_value;
  }

  template <class Visit>
  static constexpr void for_each_checked(Visit&& visit) {
    Device::dictionary.for_each_communication_entry([&](std::uint16_t index, std::uint8_t sub_index, entry::Word word) {
      if (entry::place_of(word) != entry::Place::ram) return;
      const std::uint8_t what = what_is(index, sub_index);
      if (what != plain_value && Layout::stores(index, sub_index)) visit(Checked{index, sub_index, what});
    });
  }

 public:
  static constexpr std::size_t checked_count = [] {
    std::size_t count = 0;
    for_each_checked([&](const Checked&) { ++count; });
    return count;
  }();
  static constexpr std::array<Checked, checked_count> checked = [] {
    std::array<Checked, checked_count> rows{};
    std::size_t i = 0;
    for_each_checked([&](const Checked& row) { rows[i++] = row; });
    return rows;
  }();
  /// Whether a mapping can be stored.
  static constexpr bool has_mappings = std::ranges::any_of(checked, is_mapping);

  /// Whether these bytes of an entry, as SDO sends them, could have been written over the bus. A mapping is checked
  /// when all its entries are loaded.
  [[nodiscard]] static bool is_possible(std::uint16_t index, std::uint8_t sub_index, entry::Word word,
                                        std::span<const std::uint8_t> bytes) {
    if (EntryAccess<Device>::check_value(index, sub_index, word, bytes) != ok) return false;
    if (check_closed<Device>(index, sub_index, bytes) != ok) return false;
    if constexpr (!Device::dictionary.accepted.empty()) {
      if (!bytes.empty() && !Device::dictionary.accepts(index, static_cast<std::int8_t>(bytes[0]))) return false;
    }
    if constexpr (checked_count != 0) {
      for (const Checked& row : checked) {
        if (row.index == index && row.sub_index == sub_index) return is_possible(row.what, number_in(bytes));
      }
    }
    return true;
  }

  /// The mapping parameters whose stored mapping is not possible: one bit for each row of `checked`.
  using Rejected = std::array<std::uint8_t, has_mappings ? (checked_count + 7) / 8 : 0>;

  /// Whether an entry belongs to a mapping parameter that has been rejected.
  [[nodiscard]] static bool is_rejected([[maybe_unused]] const Rejected& rejected,
                                        [[maybe_unused]] std::uint16_t index) {
    if constexpr (has_mappings) {
      for (std::size_t i = 0; i < checked_count; ++i) {
        if (((rejected[i / 8] >> (i % 8)) & 1) != 0 && checked[i].index == index) return true;
      }
    }
    return false;
  }

  /// Adds the mappings that are loaded and not possible. Returns whether there are any.
  [[nodiscard]] static bool reject_mappings(EntryAccess<Device> entries, Rejected& rejected) {
    bool any = false;
    for_each_impossible_mapping(entries, [&](std::size_t i) {
      rejected[i / 8] = static_cast<std::uint8_t>(rejected[i / 8] | 1u << i % 8);
      any = true;
    });
    return any;
  }

  /// Whether one of the rejected mappings would be possible with its present values, which are the default values: a
  /// default value that is not possible either is an error in the EDS.
  [[nodiscard]] static bool has_better_defaults(EntryAccess<Device> entries, const Rejected& rejected) {
    Rejected left = rejected;
    for_each_impossible_mapping(
        entries, [&](std::size_t i) { left[i / 8] = static_cast<std::uint8_t>(left[i / 8] & ~(1u << i % 8)); });
    return std::ranges::any_of(left, [](std::uint8_t bits) { return bits != 0; });
  }

 private:
  template <class Visit>
  static void for_each_impossible_mapping(EntryAccess<Device> entries, Visit visit) {
    for (std::size_t i = 0; i < checked_count; ++i) {
      const Checked& row = checked[i];
      if (!is_mapping(row)) continue;
      const std::uint8_t* const count = entries.ram(EntryAccess<Device>::find(row.index, 0));
      const MappingParameter mapping{count, entries.ram(EntryAccess<Device>::find(row.index, 1))};
      if (!is_possible_mapping<Device>(mapping, is_tpdo_mapping(row.index), *count, row.what)) visit(i);
    }
  }

  /// Whether the service of a parameter accepts a value.
  [[nodiscard]] static bool is_possible(std::uint8_t what, std::uint32_t value) {
    switch (what) {
      case sync_period: return is_sync_period(value);
      case sync_overflow: return is_sync_overflow(value);
      case sync_start: return value <= highest_sync_counter;
      case error_behavior:
        if constexpr (std::ranges::any_of(checked, is<error_behavior>)) {
          return check_error_behavior(static_cast<std::uint8_t>(value)) == ok;
        }
        return true;
      case emcy_inhibit_time:
        if constexpr (std::ranges::any_of(checked, is<emcy_inhibit_time>)) {
          return value % Device::options.emcy_inhibit_time_step == 0;
        }
        return true;
      case rpdo_transmission:
      case tpdo_transmission:
        return check_transmission_type(Device::options, what == tpdo_transmission, static_cast<std::uint8_t>(value)) ==
               ok;
      case cob_id:
      case identifier: {
        const CobId id{value & (what == cob_id ? 0xFFFF'FFFF : CobId::identifier)};
        return !id.valid() || may_be_written(id, true, Device::options.pdo_extended_ids);
      }
      case pdo_cob_id:
        if constexpr (std::ranges::any_of(checked, is<pdo_cob_id>)) {
          const CobId id{value};
          return !id.valid() || may_be_used_by_pdo<Device>(id, Device::options.pdo_extended_ids);
        }
        return true;
      default: return true;  // a mapping
    }
  }
};

}  // namespace canopen
