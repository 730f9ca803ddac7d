/// Checks stored values: whether they could have been written over the bus.
#pragma once

#include <algorithm>
#include <array>
#include <cstddef>
#include <cstdint>
#include <optional>

#include "canopen/base/abort_code.hpp"
#include "canopen/can/cob_id.hpp"
#include "canopen/nmt/error_behavior.hpp"
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
  /// A stored entry that does not accept all bit patterns, or sub-index 0 of a mapping parameter.
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
  static constexpr std::uint8_t rpdo_transmission = 0xF9;
  static constexpr std::uint8_t tpdo_transmission = 0xFA;
  static constexpr std::uint8_t sync_start = 0xFB;
  static constexpr std::uint8_t sync_period = 0xFC;
  static constexpr std::uint8_t sync_overflow = 0xFD;
  static constexpr std::uint8_t cob_id = 0xFF;      ///< if it is not valid, any value is accepted
  static constexpr std::uint8_t identifier = 0xFE;  ///< the same, but bits 30 and 31 have another meaning
  [[nodiscard]] static constexpr bool is_mapping(const Checked& row) {
    return row.what != plain_value && row.what <= max_mapped;
  }
  [[nodiscard]] static constexpr bool is_of_service(const Checked& row) {
    return row.what > max_mapped && row.what < identifier;
  }

  [[nodiscard]] static constexpr bool is_error_behavior(const Checked& row) { return row.what == error_behavior; }
  [[nodiscard]] static constexpr bool is_emcy_inhibit_time(const Checked& row) { return row.what == emcy_inhibit_time; }

  [[nodiscard]] static constexpr std::uint8_t what_is(std::uint16_t index, std::uint8_t sub_index) {
    if (const std::optional<CobIdEntries> row = find_cob_id_entries(index, sub_index)) {
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
    Device::dictionary.for_each_entry([&](std::uint16_t index, std::uint8_t sub_index, entry::Word word) {
      if (entry::place_of(word) != entry::Place::ram || !Layout::stores(index, sub_index)) return;
      const std::uint8_t what = what_is(index, sub_index);
      const bool limited = (word & entry::limited) != 0 || entry::is_boolean(word) || entry::is_string(word);
      if (limited || what != plain_value) visit(Checked{index, sub_index, what});
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
  static constexpr std::size_t communication_count =
      static_cast<std::size_t>(std::ranges::count_if(checked, [](const Checked& row) { return row.index < 0x2000; }));

  /// One bit for each row of `checked`.
  using Rows = std::array<std::uint8_t, (checked_count + 7) / 8>;
  [[nodiscard]] static bool is_row(const Rows& rows, std::size_t i) { return (rows[i / 8] >> i % 8 & 1) != 0; }

  /// Whether the value of an entry could have been written over the bus.
  [[nodiscard, gnu::noinline]] static bool is_possible(EntryAccess<Device> entries, const Checked& row) {
    const entry::Word word = EntryAccess<Device>::find(row.index, row.sub_index);
    const std::uint8_t* const at = entries.ram(word);
    if constexpr (std::ranges::any_of(checked, is_mapping)) {
      if (is_mapping(row)) {
        const MappingParameter mapping{at, entries.ram(EntryAccess<Device>::find(row.index, 1))};
        return is_possible_mapping<Device>(mapping, is_tpdo_mapping(row.index), *at, row.what);
      }
    }
    if constexpr (EntryAccess<Device>::kinds.strings_in_ram) {
      if (entry::is_string(word)) return number_in({at, 2}) <= EntryAccess<Device>::capacity(row.index, row.sub_index);
    }
    const std::size_t size = EntryAccess<Device>::bytes_of(word);
    if (EntryAccess<Device>::check_value(row.index, row.sub_index, word, {at, size}) != ok) return false;
    if (row.what == plain_value) return true;
    if constexpr (std::ranges::any_of(checked, is_of_service)) {
      if (is_of_service(row)) return is_possible(row.what, entries.number(word));
    }
    const CobId value{entries.number(word) & (row.what == cob_id ? 0xFFFF'FFFF : CobId::identifier)};
    return !value.valid() || may_be_written(value, true, Device::options.pdo_extended_ids);
  }

  /// Whether a byte of RAM belongs to one of these rows.
  [[nodiscard]] static bool belongs_to(const Rows& rows, std::size_t offset) {
    for (std::size_t i = 0; i < checked_count; ++i) {
      if (is_row(rows, i) && (is_in_entry(offset, checked[i].index, checked[i].sub_index, 1) ||
                              (is_mapping(checked[i]) && is_in_entry(offset, checked[i].index, 1, checked[i].what))))
        return true;
    }
    return false;
  }

 private:
  /// Whether the service of a parameter accepts a value.
  [[nodiscard]] static bool is_possible(std::uint8_t what, std::uint32_t value) {
    switch (what) {
      case sync_period: return is_sync_period(value);
      case sync_overflow: return is_sync_overflow(value);
      case sync_start: return value <= highest_sync_counter;
      case error_behavior:
        if constexpr (std::ranges::any_of(checked, is_error_behavior)) {
          return check_error_behavior(static_cast<std::uint8_t>(value)) == ok;
        }
        return true;
      case emcy_inhibit_time:
        if constexpr (std::ranges::any_of(checked, is_emcy_inhibit_time)) {
          return value % Device::options.emcy_inhibit_time_step == 0;
        }
        return true;
      default:
        return check_transmission_type(Device::options, what == tpdo_transmission, static_cast<std::uint8_t>(value)) ==
               ok;
    }
  }

  [[nodiscard]] static bool is_in_entry(std::size_t offset, std::uint16_t index, std::uint8_t sub_index,
                                        unsigned elements) {
    const entry::Word word = EntryAccess<Device>::find(index, sub_index);
    const std::size_t bytes = EntryAccess<Device>::bytes_of(word);
    std::size_t size = (bytes <= 2 ? bytes : bytes <= 4 ? 4 : 8) * elements;  // size in memory
    if (entry::is_string(word)) size = sizeof(std::uint16_t) + EntryAccess<Device>::capacity(index, sub_index);
    return offset - entry::offset_of(word) < size;
  }
};

}  // namespace canopen
