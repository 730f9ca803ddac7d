#include <fmt/format.h>

#include <algorithm>
#include <canopen/can/cob_id.hpp>
#include <cstdint>
#include <string>
#include <utility>

#include "device/cob_id_parameter.hpp"
#include "device/pdo/pdo_defaults.hpp"
#include "document/views.hpp"
#include "edit/sheet_parts.hpp"
#include "eds/number.hpp"
#include "pdo/mapping_fault.hpp"
#include "text/counted.hpp"

namespace edsc::edit {
namespace {

constexpr std::uint8_t cob_id_entry = 1;
constexpr std::uint8_t sync_start_entry = 6;

std::string_view direction_name(PdoDirection direction) { return direction == PdoDirection::receive ? "rpdo" : "tpdo"; }

const Entry* parameter_entry(const Pdo& pdo, std::uint8_t sub_index) {
  return pdo.communication == nullptr ? nullptr : pdo.communication->find(sub_index);
}

/// The value of a communication parameter as written; of a DCF, the ParameterValue.
std::string_view parameter_text(const OpenSheet& sheet, const Pdo& pdo, std::uint8_t sub_index) {
  const ObjectDescription* const object =
      pdo.communication == nullptr ? nullptr : sheet.sheet.find(pdo.communication->index);
  if (object == nullptr) return {};
  const ValueFields fields = sheet.sheet.values_of(*object, sub_index, true);
  const Field* const field = sheet.sheet.is_dcf && fields.parameter_value != nullptr && fields.parameter_value->present
                                 ? fields.parameter_value
                                 : fields.default_value;
  return field == nullptr ? std::string_view{} : field->text;
}

std::string_view kind_of(const Pdo& pdo, const Value& value) {
  const canopen::CobId cob_id{static_cast<std::uint32_t>(value.bits)};
  if (!on_by_default(pdo)) return "disabled";
  const auto [communication, mapping] = parameters_of(pdo.direction, pdo.number);
  const CobIdParameter* const row = find_cob_id_parameter(communication, cob_id_entry);
  const bool is_predefined = row != nullptr && row->plus_node_id && value.plus_node_id && !cob_id.extended() &&
                             row->predefined_of(communication) == cob_id.can_id();
  return is_predefined ? "predefined" : value.plus_node_id ? "node" : "fixed";
}

Json cob_id_json(const OpenSheet& sheet, const Pdo& pdo) {
  const Entry* const entry = parameter_entry(pdo, cob_id_entry);
  if (entry == nullptr || !entry->default_value) return {{"text", ""}, {"kind", "none"}, {"label", ""}};
  const Value& value = *entry->default_value;
  const canopen::CobId cob_id{static_cast<std::uint32_t>(value.bits)};
  return {{"text", parameter_text(sheet, pdo, cob_id_entry)},
          {"kind", kind_of(pdo, value)},
          {"label", fmt::format("{:X}h{}{}", cob_id.can_id(), value.plus_node_id ? " + node-ID" : "",
                                cob_id.extended() ? " (29 bits)" : "")}};
}

std::string milliseconds(std::optional<std::uint64_t> value, std::uint64_t unit_us) {
  return value ? fmt::format("{}", static_cast<double>(*value * unit_us) / 1000) : "";
}

std::string number_text(std::optional<std::uint64_t> value) { return value ? fmt::format("{}", *value) : ""; }

std::string entry_name(const Device& device, std::uint16_t index, const Entry& entry) {
  const Object* const object = device.find(index);
  return object != nullptr && object->has_sub_indices() ? fmt::format("{}: {}", object->name, entry.name) : entry.name;
}

std::string name_of(const Device& device, const PdoEntry& mapped) {
  if (mapped.dummy != nullptr) return fmt::format("dummy {}", mapped.dummy->name);
  return mapped.object == nullptr ? "missing object" : entry_name(device, mapped.index, *mapped.object);
}

/// `byte 0 bits 0 to 7, Statusword`, `byte 0 to 1, Statusword`.
std::string label_of(const PdoEntry& mapped, std::string_view name) {
  const unsigned first = mapped.offset / 8U;
  const unsigned last = (mapped.offset + std::max(1U, unsigned{mapped.bits}) - 1) / 8U;
  if (first != last && mapped.offset % 8U == 0 && mapped.bits % 8U == 0) {
    return fmt::format("byte {} to {}, {}", first, last, name);
  }
  const unsigned first_bit = mapped.offset % 8U;
  const unsigned last_bit = (mapped.end() - 1) % 8U;
  if (first != last) return fmt::format("byte {} bit {} to byte {} bit {}, {}", first, first_bit, last, last_bit, name);
  if (mapped.bits <= 1) return fmt::format("byte {} bit {}, {}", first, first_bit, name);
  return fmt::format("byte {} bits {} to {}, {}", first, first_bit, last_bit, name);
}

Json entries_of(const Device& device, const Pdo& pdo) {
  Json entries = Json::array();
  for (const PdoEntry& mapped : pdo.entries) {
    const std::string name = name_of(device, mapped);
    entries.push_back({{"raw", fmt::format("{:08X}h", mapped.value())},
                       {"index", fmt::format("{:04X}", mapped.index)},
                       {"sub", fmt::format("{:02X}", mapped.sub_index)},
                       {"name", name},
                       {"bits", mapped.bits},
                       {"offset", mapped.offset},
                       {"dummy", mapped.dummy != nullptr},
                       {"label", label_of(mapped, name)}});
  }
  return entries;
}

/// Why no object can be added; empty if one can.
std::string full_text(const Pdo& pdo) {
  if (pdo.entries.size() >= classical_can.objects)
    return fmt::format("a PDO maps at most {} objects", pdo.entries.size());
  return pdo.bits() >= classical_can.bits() ? fmt::format("all {} bytes of the frame are used", classical_can.bytes)
                                            : "";
}

Json pdo_json(const OpenSheet& sheet, const Pdo& pdo) {
  const auto [communication, mapping] = parameters_of(pdo.direction, pdo.number);
  const unsigned used = pdo.bits();
  const unsigned free = used < classical_can.bits() ? classical_can.bits() - used : 0;
  const auto type = communication_default(pdo, transmission_type_sub_index);
  return {{"id", fmt::format("{}{}", direction_name(pdo.direction), pdo.number)},
          {"direction", direction_name(pdo.direction)},
          {"number", pdo.number},
          {"communication", fmt::format("{:04X}", communication)},
          {"mapping", fmt::format("{:04X}", mapping)},
          {"cob_id", cob_id_json(sheet, pdo)},
          {"type",
           {{"text", type ? fmt::format("{}", *type) : ""}, {"label", type ? document::transmission_text(*type) : ""}}},
          {"inhibit_ms",
           milliseconds(communication_default(pdo, inhibit_time_sub_index), sheet.options.inhibit_time_unit())},
          {"event_ms", milliseconds(communication_default(pdo, event_timer_sub_index), 1000)},
          {"sync_start", number_text(communication_default(pdo, sync_start_entry))},
          {"entries", entries_of(*sheet.device, pdo)},
          {"used_bits", used},
          {"free_bits", free},
          {"locked", pdo.multiplexed ? "multiplex PDO: each frame states the object that it carries" : ""},
          {"full", full_text(pdo)},
          {"too_long", fmt::format("needs more than the {} that are free", counted(free, "bit"))}};
}

Json candidate_json(const MappingValue& value, std::string_view name, bool is_dummy) {
  return {{"raw", fmt::format("{:08X}h", value.value())},
          {"index", fmt::format("{:04X}", value.index)},
          {"sub", fmt::format("{:02X}", value.sub_index)},
          {"name", name},
          {"bits", value.bits},
          {"dummy", is_dummy}};
}

/// The length with which a PDO maps an entry; 0 if none is certain.
std::uint8_t mapped_bits(const Entry& entry, const MappableObject& object) {
  if (entry.type == nullptr) return 0;
  if (entry.type->bits != 0) return entry.type->bits;
  const unsigned bits = 8 * object.string_octets.value_or(0);
  return bits <= classical_can.bits() ? static_cast<std::uint8_t>(bits) : 0;
}

Json candidates_for(const OpenSheet& sheet, PdoDirection direction) {
  Json list = Json::array();
  if (!sheet.device) return list;
  for (const Object& object : sheet.device->objects) {
    for (const Entry& entry : object.entries) {
      const MappableObject mappable = mappable_object(entry, sheet.options);
      const MappingValue value{entry.index, entry.sub_index, mapped_bits(entry, mappable)};
      if (value.bits == 0 || fault_of(direction, value, &mappable, sheet.device->dummies)) continue;
      list.push_back(candidate_json(value, entry_name(*sheet.device, entry.index, entry), false));
    }
  }
  if (direction == PdoDirection::transmit) return list;
  for (const std::uint16_t index : sheet.device->dummies) {
    const canopen::DataTypeRow* const type = canopen::find_data_type(index);
    if (type == nullptr || type->bits == 0) continue;
    list.push_back(candidate_json({index, 0, type->bits}, fmt::format("dummy {}", type->name), true));
  }
  return list;
}

/// The lowest number that no PDO has; null if there is none.
Json next_number(const OpenSheet& sheet, PdoDirection direction) {
  std::uint16_t number = 1;
  if (sheet.device) {
    for (const Pdo& pdo : sheet.device->pdos) {
      if (pdo.direction == direction && pdo.number == number) ++number;
    }
  }
  return number <= classical_can.pdos ? Json(number) : Json(nullptr);
}

}  // namespace

void add_pdos(const OpenSheet& sheet, EditParts& parts) {
  Json list = Json::array();
  if (sheet.device) {
    for (const Pdo& pdo : sheet.device->pdos) list.push_back(pdo_json(sheet, pdo));
  }
  Json next = Json::object();
  for (const PdoDirection direction : {PdoDirection::receive, PdoDirection::transmit}) {
    const std::string name{direction_name(direction)};
    next[name] = next_number(sheet, direction);
    parts.set("candidates/" + name, {{"list", candidates_for(sheet, direction)}});
  }
  parts.set("pdos", {{"list", std::move(list)}, {"next", std::move(next)}});
}

}  // namespace edsc::edit
