#include "device/sheet_options.hpp"

#include <algorithm>
#include <cstddef>
#include <iterator>
#include <string>
#include <string_view>
#include <type_traits>

#include "backend/cpp/lss_support.hpp"
#include "device/options/option_table.hpp"

namespace edsc {
namespace {

using canopen::DeviceOptions;
using canopen::LssOptions;
using canopen::Storing;

template <auto Member>
void set_option(DeviceOptions& options, const RuntimeOption& option) {
  using Type = std::remove_reference_t<decltype(options.*Member)>;
  if constexpr (std::is_same_v<Type, canopen::RestrictedCanIds>) {
    options.*Member = {static_cast<std::uint16_t>(option.value), static_cast<std::uint16_t>(option.last)};
  } else if constexpr (std::is_same_v<Type, std::optional<std::uint16_t>>) {
    options.*Member = static_cast<std::uint16_t>(option.value);
  } else {
    options.*Member = static_cast<Type>(option.value);
  }
}

struct OptionMember {
  std::string_view name;
  void (*set)(DeviceOptions& options, const RuntimeOption& option);
};

constexpr OptionMember option_members[] = {
    {"pdo_cob_id_writable", set_option<&DeviceOptions::pdo_cob_id_writable>},
    {"pdo_reserved_can_ids", set_option<&DeviceOptions::pdo_reserved_can_ids>},
    {"pdo_allowed_can_ids", set_option<&DeviceOptions::pdo_allowed_can_ids>},
    {"pdo_extended_ids", set_option<&DeviceOptions::pdo_extended_ids>},
    {"tpdo_remote_frames", set_option<&DeviceOptions::tpdo_remote_frames>},
    {"tpdo_remote_frames_can_be_disabled", set_option<&DeviceOptions::tpdo_remote_frames_can_be_disabled>},
    {"tpdo_remote_types", set_option<&DeviceOptions::tpdo_remote_types>},
    {"inhibit_time_unit", set_option<&DeviceOptions::inhibit_time_unit>},
    {"inhibit_time_writable_while_valid", set_option<&DeviceOptions::inhibit_time_writable_while_valid>},
    {"sync_start_writable_while_valid", set_option<&DeviceOptions::sync_start_writable_while_valid>},
    {"event_driven_on_change", set_option<&DeviceOptions::event_driven_on_change>},
    {"tpdo_acyclic_on_change", set_option<&DeviceOptions::tpdo_acyclic_on_change>},
    {"pdo_mapping_writable_while_valid", set_option<&DeviceOptions::pdo_mapping_writable_while_valid>},
    {"pdo_mapping_abort_code", set_option<&DeviceOptions::pdo_mapping_abort_code>},
    {"mpdo", set_option<&DeviceOptions::mpdo>},
    {"sync_cob_id_writable", set_option<&DeviceOptions::sync_cob_id_writable>},
    {"emcy_cob_id_writable", set_option<&DeviceOptions::emcy_cob_id_writable>},
    {"emcy_cob_id_writable_while_valid", set_option<&DeviceOptions::emcy_cob_id_writable_while_valid>},
    {"emcy_inhibit_time_step", set_option<&DeviceOptions::emcy_inhibit_time_step>},
    {"emcy_stopped_keeps_last", set_option<&DeviceOptions::emcy_stopped_keeps_last>},
    {"reset_emergency", set_option<&DeviceOptions::reset_emergency>},
    {"error_history_keeps_resets", set_option<&DeviceOptions::error_history_keeps_resets>},
    {"error_history_abort_code", set_option<&DeviceOptions::error_history_abort_code>},
    {"error_history_empty_is_zero", set_option<&DeviceOptions::error_history_empty_is_zero>},
    {"error_history_has_info", set_option<&DeviceOptions::error_history_has_info>},
    {"storage_signature_abort_code", set_option<&DeviceOptions::storage_signature_abort_code>},
    {"storage_version", set_option<&DeviceOptions::storage_version>},
    {"storage_first_format", set_option<&DeviceOptions::storage_first_format>},
    {"restore_needs_power_cycle", set_option<&DeviceOptions::restore_needs_power_cycle>},
    {"sdo_upload_size_indicated", set_option<&DeviceOptions::sdo_upload_size_indicated>},
    {"sdo_length_codes", set_option<&DeviceOptions::sdo_length_codes>},
    {"sdo_block_transfer", set_option<&DeviceOptions::sdo_block_transfer>},
    {"sdo_timeout", set_option<&DeviceOptions::sdo_timeout>},
    {"drive_additional_modes", set_option<&DeviceOptions::drive_additional_modes>},
};

struct LssMember {
  std::string_view name;
  bool LssOptions::*flag;
};
constexpr LssMember lss_members[] = {
    {"manufacturer_bit_timing", &LssOptions::manufacturer_bit_timing},
    {"unconfigurable", &LssOptions::unconfigurable},
    {"fastscan", &LssOptions::fastscan},
    {"served_in_stopped", &LssOptions::served_in_stopped},
    {"served_in_operational", &LssOptions::served_in_operational},
};

/// Whether a member has the name `member_of(row)`, or of an LSS option the name of the row.
[[nodiscard]] constexpr bool has_member(const OptionRow& row) {
  if (row.group.name == option_table::lss.name)
    return std::ranges::find(lss_members, row.name, &LssMember::name) != std::end(lss_members);
  return std::ranges::any_of(option_members, [&](const OptionMember& member) {
    if (!row.flat_name.empty()) return member.name == row.flat_name;
    const std::size_t prefix = row.group.name.size();
    return member.name.size() == prefix + 1 + row.name.size() && member.name.starts_with(row.group.name) &&
           member.name[prefix] == '_' && member.name.ends_with(row.name);
  });
}
static_assert(std::ranges::all_of(options_table,
                                  [](const OptionRow& row) {
                                    return row.form == OptionForm::structured || has_member(row);
                                  }),
              "a node without a compiler ignores an option");

/// The enumerators of canopen::Storing that an options file can name.
struct StoringName {
  std::string_view name;
  Storing storing;
};
constexpr StoringName storing_names[] = {
    {"by_access", Storing::by_access},
    {"always", Storing::always},
    {"never", Storing::never},
    {"with_node_id", Storing::with_node_id},
};

Storing storing_named(std::string_view name) {
  for (const StoringName& row : storing_names) {
    if (row.name == name) return row.storing;
  }
  return Storing::by_access;
}

}  // namespace

DeviceOptions device_options(const Options& options) {
  DeviceOptions made;
  for (const RuntimeOption& option : options.runtime) {
    const std::string name = member_of(*option.row);
    for (const OptionMember& member : option_members) {
      if (member.name == name) member.set(made, option);
    }
  }
  return made;
}

std::optional<LssOptions> lss_options(const Device& device, const Options& options) {
  if (!has_lss(device, options)) return std::nullopt;
  const LssSettings settings = options.lss.value_or(LssSettings{});
  LssOptions made;
  made.bit_rates = settings.bit_rates.value_or(lss_bit_rates(device.information.capabilities));
  for (const LssMember& member : lss_members) {
    const auto at = settings.flags.find(std::string{member.name});
    if (at != settings.flags.end()) made.*(member.flag) = at->second;
  }
  return made;
}

/// An entry comes before its object, so that it can differ from the other entries.
Storing storing_of(const Options& options, std::uint16_t index, std::uint8_t sub_index) {
  for (const bool of_object : {false, true}) {
    const auto is_of = [&](const EntryAddress& entry) {
      return entry.index == index && (of_object ? !entry.sub_index : entry.sub_index == sub_index);
    };
    for (const auto& [entry, how] : options.storing) {
      if (is_of(entry)) return storing_named(how);
    }
    for (const auto& [entry, by] : options.stored_by) {
      if (is_of(entry)) return canopen::stored_by(by);
    }
  }
  return Storing::by_access;
}

}  // namespace edsc
