#include "backend/cpp/views.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <canopen/pdo/pdo_parameters.hpp>
#include <string>
#include <vector>

#include "backend/cpp/cpp_text.hpp"
#include "backend/cpp/placement.hpp"
#include "device/cob_id_parameter.hpp"
#include "device/complete_device.hpp"

namespace edsc {
namespace {

using canopen::CobId;
using canopen::DataClass;
using canopen::PdoParameters;
using nlohmann::ordered_json;

bool is_receive(const Pdo& pdo) { return pdo.direction == PdoDirection::receive; }

std::string type_name(const Pdo& pdo) { return fmt::format("{}{}", is_receive(pdo) ? "Rpdo" : "Tpdo", pdo.number); }

// ---- the layout ----

std::string entry_type(const NamedDevice& named, const PdoEntry& entry) {
  if (entry.dummy != nullptr) return fmt::format("canopen::Dummy<0x{:04X}, {}>", entry.index, entry.bits);
  const std::string object = named.names.type_of(*named.device.find(entry.index), *entry.object).text();
  const canopen::DataTypeRow& type = *entry.object->type;
  if (type.kind == DataClass::string) return fmt::format("canopen::FixedString<{}, {}>", object, entry.bits / 8);
  return entry.bits == type.bits ? object : fmt::format("canopen::Padded<{}, {}>", object, entry.bits);
}

ordered_json entry_rows(const NamedDevice& named, const Pdo& pdo) {
  ordered_json rows = ordered_json::array();
  for (const PdoEntry& entry : pdo.entries) {
    const std::string name = entry.dummy != nullptr ? "(dummy)" : cpp_comment(entry.object->name);
    const auto* type = entry.dummy != nullptr ? entry.dummy : entry.object->type;
    rows.push_back(
        {{"object", entry_type(named, entry)},
         {"separator", rows.empty() ? "" : ", "},
         {"bit_range", fmt::format("{:>2}..{:<2}", entry.offset, entry.end() - 1)},
         {"description", fmt::format("{}  {}  {}", entry_label(entry.index, entry.sub_index), type->name, name)}});
  }
  return rows;
}

// ---- checks of the C++ compiler ----

/// The parameters of a PDO for the C++ checks. `left_out`: harmless faults that only `edsc check` reports.
struct Provable {
  PdoParameters parameters;
  std::uint32_t granularity = 1;
  std::vector<std::string> left_out;
};

/// The value after a reset: 0 if the entry has no default value, `otherwise` if it does not exist.
std::uint64_t start_value(const Pdo& pdo, std::uint8_t sub_index, std::uint64_t otherwise) {
  const Entry* entry = pdo.communication->find(sub_index);
  if (entry == nullptr) return otherwise;
  return entry->default_value ? entry->default_value->bits : 0;
}

/// Adds the COB-ID of the device, also if it is invalid.
void add_cob_id(const Pdo& pdo, PdoParameters& parameters) {
  const Entry* entry = pdo.communication->find(1);
  parameters.cob_id = static_cast<std::uint32_t>(start_value(pdo, 1, CobId::invalid_bit));
  parameters.plus_node_id = entry->default_value && entry->default_value->plus_node_id;
  parameters.can_id_is_allowed = pdo.can_id_is_allowed;
}

/// Times that the transmission type does not use are harmless.
void add_transmission(const Pdo& pdo, Provable& provable) {
  const auto type = static_cast<std::uint8_t>(start_value(pdo, 2, default_transmission_type));
  provable.parameters.transmission_type = type;
  const auto inhibit_time = static_cast<std::uint16_t>(start_value(pdo, 3, 0));
  const auto event_timer = static_cast<std::uint16_t>(start_value(pdo, 5, 0));
  if (inhibit_time != 0 && !canopen::inhibit_time_is_used(is_receive(pdo), type)) {
    provable.left_out.push_back("inhibit time");
  } else {
    provable.parameters.inhibit_time = inhibit_time;
  }
  if (event_timer != 0 && !canopen::event_timer_is_used(is_receive(pdo), type)) {
    provable.left_out.push_back("event timer");
  } else {
    provable.parameters.event_timer = event_timer;
  }
}

void add_granularity(const Device& device, const Pdo& pdo, Provable& provable) {
  const std::uint32_t granularity = device.information.capabilities.granularity.value_or(1);
  if (granularity <= 1) return;
  if (std::ranges::any_of(pdo.entries, [&](const PdoEntry& entry) { return !entry.is_multiple_of(granularity); })) {
    return provable.left_out.push_back("Granularity");
  }
  provable.granularity = granularity;
}

Provable provable_of(const Device& device, const Pdo& pdo) {
  Provable provable;
  add_cob_id(pdo, provable.parameters);
  add_transmission(pdo, provable);
  if (pdo.communication->find(4) != nullptr) {
    provable.parameters.compatibility_entry = true;
    provable.left_out.push_back("sub-index 4");
  }
  add_granularity(device, pdo, provable);
  return provable;
}

/// Whether the PDO can be checked.
bool is_checked(const Pdo& pdo) {
  return pdo.mapping != nullptr && !is_left_out(pdo) && pdo.communication != nullptr &&
         pdo.communication->find(1) != nullptr;
}

/// `.cob_id = 0x180`; without members that have their default.
std::vector<std::string> member_initializers(const PdoParameters& parameters) {
  std::vector<std::string> members;
  constexpr PdoParameters unknown;
  if (parameters.cob_id != unknown.cob_id) members.push_back(fmt::format(".cob_id = 0x{:X}", parameters.cob_id));
  if (parameters.plus_node_id) members.emplace_back(".plus_node_id = true");
  if (parameters.transmission_type != unknown.transmission_type) {
    members.push_back(fmt::format(".transmission_type = {}", parameters.transmission_type));
  }
  if (parameters.inhibit_time != 0) members.push_back(fmt::format(".inhibit_time = {}", parameters.inhibit_time));
  if (parameters.event_timer != 0) members.push_back(fmt::format(".event_timer = {}", parameters.event_timer));
  if (parameters.can_id_is_allowed) members.emplace_back(".can_id_is_allowed = true");
  if (parameters.compatibility_entry) members.emplace_back(".compatibility_entry = true");
  return members;
}

/// The value of the parameters, and the template arguments after dictionary, number and layout.
void add_parameters(const Provable& provable, ordered_json& row) {
  const std::vector<std::string> members = member_initializers(provable.parameters);
  const std::string parameters = fmt::format("canopen::PdoParameters{{{}}}", fmt::join(members, ", "));
  const bool is_regular = provable.granularity == 1;
  row["parameters"] = parameters;
  row["granularity"] = provable.granularity;
  row["check_arguments"] = (is_regular && members.empty() ? "" : ", " + parameters) +
                           (is_regular ? "" : fmt::format(", {}", provable.granularity));
}

}  // namespace

bool has_wrong_cob_id(const Pdo& pdo) {
  if (pdo.communication == nullptr || pdo.communication->find(1) == nullptr) return false;
  PdoParameters parameters;
  add_cob_id(pdo, parameters);
  return !canopen::cob_id_is_legal(parameters);
}

bool is_left_out(const Pdo& pdo) { return pdo.broken || has_wrong_cob_id(pdo); }

ordered_json pdo_rows(const NamedDevice& named) {
  const Device& device = named.device;
  ordered_json rows = ordered_json::array();
  for (const Pdo& pdo : device.pdos) {
    if (pdo.mapping == nullptr) continue;
    const bool receive = is_receive(pdo);
    const PdoParameterIndices indices = parameters_of(pdo.direction, pdo.number);
    ordered_json row;
    row["label"] = pdo_label(pdo);
    row["type"] = type_name(pdo);
    row["number"] = pdo.number;
    row["template"] = receive ? "canopen::Rpdo" : "canopen::Tpdo";
    row["communication"] = index_label(indices.communication);
    row["mapping"] = index_label(indices.mapping);
    row["broken"] = is_left_out(pdo);
    row["bits"] = pdo.bits();
    row["entries"] = is_left_out(pdo) ? ordered_json::array() : entry_rows(named, pdo);
    row["checked"] = is_checked(pdo);
    if (is_checked(pdo)) {
      const Provable provable = provable_of(device, pdo);
      row["check"] = receive ? "canopen::CheckedRpdo" : "canopen::CheckedTpdo";
      add_parameters(provable, row);
      row["any_left_out"] = !provable.left_out.empty();
      row["left_out"] = fmt::format("{}", fmt::join(provable.left_out, ", "));
    }
    rows.push_back(std::move(row));
  }
  return rows;
}

ordered_json served_pdos(const Device& device, PdoDirection direction) {
  ordered_json rows = ordered_json::array();
  for (const Pdo& pdo : device.pdos) {
    if (pdo.direction != direction || pdo.communication == nullptr || pdo.mapping == nullptr) continue;
    if (has_wrong_cob_id(pdo)) continue;
    const bool empty = pdo.broken || pdo.entries.empty();
    if (empty && !pdo.dynamic && !pdo.multiplexed) continue;
    const std::string_view kind = direction == PdoDirection::receive ? "Rpdo" : "Tpdo";
    rows.push_back({{"number", pdo.number},
                    {"layout", empty ? fmt::format("canopen::{}<>", kind) : fmt::format("{}{}", kind, pdo.number)},
                    {"separator", rows.empty() ? "" : ","}});
  }
  return rows;
}

ordered_json distinct_pdos(const Device& device) {
  std::vector<std::string> names;
  std::vector<canopen::PdoCobId> cob_ids;
  for (const Pdo& pdo : device.pdos) {
    if (!is_checked(pdo)) continue;
    const PdoParameters parameters = provable_of(device, pdo).parameters;
    if (!canopen::CobId{parameters.cob_id}.valid()) continue;
    names.push_back(type_name(pdo));
    cob_ids.push_back({is_receive(pdo), parameters.cob_id, parameters.plus_node_id});
    if (!canopen::find_cob_id_clash(cob_ids.data(), cob_ids.size()).found) continue;
    names.pop_back();
    cob_ids.pop_back();
  }
  ordered_json rows = ordered_json::array();
  if (names.size() < 2) return rows;
  for (const std::string& name : names) {
    rows.push_back({{"type", name}, {"separator", rows.empty() ? "" : ", "}});
  }
  return rows;
}

}  // namespace edsc
