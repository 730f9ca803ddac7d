#include <fmt/format.h>

#include <algorithm>
#include <canopen/can/cob_id.hpp>
#include <string>

#include "compare/compare_parts.hpp"
#include "device/complete_device.hpp"
#include "device/pdo/pdo_defaults.hpp"
#include "document/views.hpp"
#include "text/counted.hpp"
#include "text/utf8.hpp"
#include "values/value_text.hpp"

namespace edsc::document {
namespace {

constexpr std::uint8_t cob_id_sub_index = 1;
constexpr std::uint8_t sync_start_sub_index = 6;

/// The drawing of a PDO in units of SVG: a frame of 8 bytes from left to right, bit 0 of byte 0 first.
constexpr unsigned bit_width = 12;
constexpr unsigned byte_width = 8 * bit_width;
constexpr unsigned left_margin = 1;
constexpr unsigned text_margin = 5;
constexpr double character_width = 6.4;  ///< of the font of the names, on average

unsigned bit_x(unsigned bit) { return left_margin + bit * bit_width; }

std::string bit_range(unsigned start, unsigned bits) {
  return bits <= 1 ? fmt::format("{}", start) : fmt::format("{}..{}", start, start + bits - 1);
}

std::string name_of(const Device& device, const PdoEntry& mapped) {
  if (mapped.dummy != nullptr) return fmt::format("dummy {}", mapped.dummy->name);
  const Object* const object = device.find(mapped.index);
  if (mapped.object == nullptr || object == nullptr) return "missing object";
  return object->has_sub_indices() ? fmt::format("{}: {}", object->name, mapped.object->name) : object->name;
}

/// The number of characters that fit a field of this width.
std::size_t max_characters(unsigned width) {
  return width < 2 * text_margin ? 0 : static_cast<std::size_t>((width - 2 * text_margin) / character_width);
}

/// A text that fits a field of this width; empty if not even three characters do.
std::string fitting(const std::string& text, unsigned width) {
  const std::size_t max = max_characters(width);
  return max < 3 ? std::string{} : shortened(text, max);
}

/// The name of a field that fits it, without that of the object if both do not.
std::string fitting_name(const PdoEntry& mapped, const std::string& name, unsigned width) {
  const bool fits = mapped.object == nullptr || count_code_points(name) <= max_characters(width);
  return fitting(fits ? name : mapped.object->name, width);
}

Json field_view(const Device& device, const PdoEntry& mapped) {
  const unsigned width = mapped.bits * bit_width;
  const std::string name = name_of(device, mapped);
  const Object* const object = device.find(mapped.index);
  const bool is_number = mapped.object != nullptr && mapped.object->type->kind != canopen::DataClass::string;
  return {{"x", bit_x(mapped.offset)},
          {"width", width},
          {"text_x", bit_x(mapped.offset) + text_margin},
          {"text_end", bit_x(mapped.offset) + width - text_margin},
          {"field_class", mapped.dummy != nullptr    ? "dummy"
                          : mapped.object == nullptr ? "missing"
                                                     : "mapped"},
          {"field_name", name},
          {"short_name", shown(fitting_name(mapped, name, width))},
          {"short_entry", shown(fitting(entry_label(mapped.index, mapped.sub_index), width))},
          {"range", bit_range(mapped.offset, mapped.bits)},
          {"bits", mapped.bits},
          {"significance", is_number && mapped.bits > 8},
          {"entry", entry_label(mapped.index, mapped.sub_index)},
          {"href",
           mapped.object != nullptr && object != nullptr ? Json(anchor_of(*object, *mapped.object)) : Json(nullptr)},
          {"field_type", mapped.object != nullptr  ? mapped.object->type->name
                         : mapped.dummy != nullptr ? mapped.dummy->name
                                                   : std::string_view{}}};
}

/// `TPDO 1, 48 bits. Bits 0..15: Statusword; bits 16..47: Position actual value.`
std::string spoken(const Json& fields, const Pdo& pdo) {
  std::string text = fmt::format("{}, {}.", pdo_label(pdo), counted(pdo.bits(), "bit"));
  for (const Json& field : fields) {
    text +=
        fmt::format("{} {} {}: {}", &field == &fields.front() ? "" : ";", field["bits"] == 1 ? "bit" : "bits",
                    field["range"].get_ref<const std::string&>(), field["field_name"].get_ref<const std::string&>());
  }
  return text;
}

Json byte_rows(unsigned bytes) {
  Json rows = Json::array();
  for (unsigned byte = 0; byte < bytes; ++byte) {
    rows.push_back({{"byte", byte}, {"byte_x", bit_x(8 * byte)}, {"byte_middle", bit_x(8 * byte) + byte_width / 2}});
  }
  return rows;
}

Json tick_rows(unsigned bytes) {
  Json rows = Json::array();
  for (unsigned bit = 0; bit <= 8 * bytes; ++bit) {
    rows.push_back({{"tick_x", bit_x(bit)}, {"tick_y", bit % 8 == 0 ? 14 : 22}});
  }
  return rows;
}

/// Null if nothing is mapped, or more than a frame has.
Json drawing_view(const Device& device, const Pdo& pdo) {
  if (pdo.entries.empty() || pdo.bits() == 0 || pdo.bits() > classical_can.bits()) return nullptr;
  Json fields = Json::array();
  for (const PdoEntry& mapped : pdo.entries) fields.push_back(field_view(device, mapped));
  const unsigned bytes = pdo.bytes();
  const std::string label = spoken(fields, pdo);
  return {{"view_width", 2 * left_margin + 8 * byte_width},
          {"frame_width", bytes * byte_width},
          {"frame_x", left_margin},
          {"label", label},
          {"bytes", byte_rows(bytes)},
          {"ticks", tick_rows(bytes)},
          {"fields", std::move(fields)}};
}

const Value* parameter(const Pdo& pdo, std::uint8_t sub_index) {
  const Entry* const entry = pdo.communication != nullptr ? pdo.communication->find(sub_index) : nullptr;
  return entry != nullptr && entry->default_value ? &*entry->default_value : nullptr;
}

/// `180h + node-ID`, `185h`, `18A0180h (29 bits)`.
std::string pdo_can_id(const Value& value) {
  const canopen::CobId cob_id{static_cast<std::uint32_t>(value.bits)};
  return fmt::format("{:X}h{}{}", cob_id.can_id(), value.plus_node_id ? " + node-ID" : "",
                     cob_id.extended() ? " (29 bits)" : "");
}

/// A time in milliseconds, `1.5 ms`.
std::string timer_text(double time) { return time == 0 ? "0 ms (off)" : fmt::format("{} ms", time); }

Json pdo_properties(const Pdo& pdo, const Options& options) {
  Json rows = Json::array();
  if (const Value* const cob_id = parameter(pdo, cob_id_sub_index)) {
    add_property(rows, "CAN-ID", pdo_can_id(*cob_id));
    const Entry& entry = *pdo.communication->find(cob_id_sub_index);
    add_property(rows, "COB-ID", written_value(entry.default_value, *entry.type));
  }
  const std::uint64_t type =
      communication_default(pdo, transmission_type_sub_index).value_or(default_transmission_type);
  add_property(rows, "Transmission type", fmt::format("{}, {}", type, transmission_text(type)));
  if (const auto inhibit = communication_default(pdo, inhibit_time_sub_index)) {
    const std::uint64_t microseconds = *inhibit * options.inhibit_time_unit();
    add_property(rows, "Inhibit time", timer_text(static_cast<double>(microseconds) / 1000));
  }
  if (const auto timer = communication_default(pdo, event_timer_sub_index)) {
    add_property(rows, "Event timer", timer_text(static_cast<double>(*timer)));
  }
  if (const auto start = communication_default(pdo, sync_start_sub_index)) {
    add_property(rows, "SYNC start value", fmt::format("{}", *start));
  }
  add_property(rows, "Mapping", pdo.dynamic ? "can be changed by SDO" : "fixed");
  return rows;
}

/// Why a PDO has no drawing; empty if it has one.
std::string remark_of(const Pdo& pdo) {
  if (pdo.multiplexed) return "multiplex PDO: each frame states the object that it carries";
  if (pdo.mapping == nullptr) return "missing mapping parameter";
  if (pdo.entries.empty()) return "no object is mapped by default";
  if (pdo.bits() > classical_can.bits())
    return fmt::format("the mapping has {} bits; a frame has {}", pdo.bits(), classical_can.bits());
  return pdo.broken ? "the mapping is invalid" : "";
}

Json pdo_view(const DeviceToDocument& input, const Pdo& pdo) {
  const bool receives = pdo.direction == PdoDirection::receive;
  const PdoParameterIndices parameters = parameters_of(pdo.direction, pdo.number);
  const bool is_enabled = on_by_default(pdo);
  return {{"pdo_id", fmt::format("{}pdo-{}", receives ? 'r' : 't', pdo.number)},
          {"pdo_label", pdo_label(pdo)},
          {"enabled", is_enabled},
          {"state", is_enabled ? "enabled" : "disabled by default"},
          {"size", counted(pdo.bits(), "bit")},
          {"communication", index_label(parameters.communication)},
          {"mapping_object", index_label(parameters.mapping)},
          {"has_communication", pdo.communication != nullptr},
          {"has_mapping", pdo.mapping != nullptr},
          {"remark", shown(remark_of(pdo))},
          {"properties", pdo_properties(pdo, input.loaded.options)},
          {"drawing", drawing_view(input.device(), pdo)}};
}

Json group_view(const DeviceToDocument& input, PdoDirection direction, const char* name) {
  Json enabled = Json::array();
  Json disabled = Json::array();
  for (const Pdo& pdo : input.device().pdos) {
    if (pdo.direction != direction) continue;
    (on_by_default(pdo) ? enabled : disabled).push_back(pdo_view(input, pdo));
  }
  const std::string count = counted(disabled.size(), "PDO");
  const bool has_disabled = !disabled.empty();
  return {{"group", name},
          {"group_size", enabled.size() + disabled.size()},
          {"pdos", std::move(enabled)},
          {"has_disabled", has_disabled},
          {"disabled_count", count},
          {"disabled", std::move(disabled)}};
}

}  // namespace

void add_pdos(const DeviceToDocument& input, Json& view) {
  Json groups = Json::array();
  for (const auto& [direction, name] :
       {std::pair{PdoDirection::receive, "Receive PDOs"}, std::pair{PdoDirection::transmit, "Transmit PDOs"}}) {
    Json group = group_view(input, direction, name);
    if (group["group_size"] != 0) groups.push_back(std::move(group));
  }
  view["has_pdos"] = !groups.empty();
  view["pdo_groups"] = std::move(groups);
}

}  // namespace edsc::document
