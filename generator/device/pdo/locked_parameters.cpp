#include "device/pdo/locked_parameters.hpp"

#include <fmt/format.h>

#include <algorithm>

#include "device/options/option_table.hpp"
#include "device/pdo/pdo_defaults.hpp"

namespace edsc {
namespace {

constexpr std::uint8_t cob_id_sub_index = 1;
constexpr std::uint8_t sync_start_sub_index = 6;

const Entry* writable_entry(const Object* object, std::uint8_t sub_index) {
  const Entry* const entry = object == nullptr ? nullptr : object->find(sub_index);
  return entry != nullptr && canopen::writable(entry->access) ? entry : nullptr;
}

template <std::uint8_t SubIndex>
const Entry* parameter_of_tpdo(const Pdo& pdo) {
  return pdo.direction == PdoDirection::transmit ? writable_entry(pdo.communication, SubIndex) : nullptr;
}

const Entry* mapping_of(const Pdo& pdo) { return pdo.dynamic ? writable_entry(pdo.mapping, 0) : nullptr; }

constexpr ConditionalParameter parameters[] = {
    {"mapping", "pdo_mapping_writable_while_valid", mapping_of},
    {"inhibit time", "inhibit_time_writable_while_valid", parameter_of_tpdo<inhibit_time_sub_index>},
    {"SYNC start value", "sync_start_writable_while_valid", parameter_of_tpdo<sync_start_sub_index>},
};

const OptionRow& row_of(const ConditionalParameter& parameter) { return *find_flat_option(parameter.option); }

/// Whether a PDO with this parameter can be disabled and enabled by its COB-ID.
bool can_be_disabled(const Pdo& pdo, const ConditionalParameter& parameter) {
  return parameter.entry_of(pdo) != nullptr && writable_entry(pdo.communication, cob_id_sub_index) != nullptr;
}

std::string pdo_names(const std::vector<LockedParameter>& locked) {
  std::string names = pdo_label(*locked.front().pdo);
  if (locked.size() > 1) names += fmt::format(" and {} more", locked.size() - 1);
  return names;
}

}  // namespace

std::span<const ConditionalParameter> conditional_parameters() { return parameters; }

std::vector<LockedParameter> locked_in(const Device& device, const ConditionalParameter& parameter) {
  std::vector<LockedParameter> locked;
  for (const Pdo& pdo : device.pdos) {
    if (pdo.communication == nullptr || !on_by_default(pdo)) continue;
    const Entry* const cob_id = pdo.communication->find(cob_id_sub_index);
    const Entry* const entry = parameter.entry_of(pdo);
    if (cob_id == nullptr || entry == nullptr || canopen::writable(cob_id->access)) continue;
    locked.push_back({&pdo, entry, cob_id});
  }
  return locked;
}

bool is_implied(const Device& device, const ConditionalParameter& parameter) {
  return !locked_in(device, parameter).empty() &&
         std::ranges::none_of(device.pdos, [&](const Pdo& pdo) { return can_be_disabled(pdo, parameter); });
}

void imply_options(const Device& device, Options& options, Diagnostics& diagnostics) {
  for (const ConditionalParameter& parameter : parameters) {
    const OptionRow& row = row_of(parameter);
    if (options.states(row) || !is_implied(device, parameter)) continue;
    const std::vector<LockedParameter> locked = locked_in(device, parameter);
    diagnostics.warning(
        "implied-option", locked.front().entry->access_position,
        fmt::format("the {} of {} is writable, but changes only while the PDO is not valid, and the COB-ID is {}; "
                    "assuming option {}",
                    parameter.name, pdo_names(locked), canopen::row_of(locked.front().cob_id->access).name,
                    path_of(row)),
        {{locked.front().cob_id->access_position, "the COB-ID"}});
    options.set({&row, 1});
  }
}

}  // namespace edsc
