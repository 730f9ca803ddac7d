#include "format/dcf/move_values.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <canopen/can/cob_id.hpp>
#include <optional>
#include <string>

#include "device/cob_id_parameter.hpp"
#include "format/spelling/key_table.hpp"
#include "format/spelling/number_spelling.hpp"
#include "values/read_value.hpp"
#include "values/value_bytes.hpp"

namespace edsc {
namespace {

using canopen::CobId;

constexpr std::uint64_t flag_bits = CobId::invalid_bit | CobId::no_rtr_bit;
constexpr std::uint64_t node_id_bits = 0x7F;

class ValueMover {
 public:
  ValueMover(const DataSheet& sheet, const Device& device, std::uint8_t node_id, Diagnostics& diagnostics)
      : sheet_(sheet),
        device_(device),
        own_(device.node_id.value_or(0)),
        node_id_(node_id),
        diagnostics_(diagnostics) {}

  void move(DocumentSection& section) {
    const ObjectDescription* const object = sheet_.find(section.kind.index);
    if (object == nullptr) return;
    for (DocumentEntry& entry : section.entries) {
      if (section.kind.kind == SectionKind::compact_values) {
        const KeySpelling key = spell_key(section.kind, entry.key);
        if (key.value != ValueKind::typed || key.number > 0xFF) continue;
        move(entry, object->index, static_cast<std::uint8_t>(key.number), *object);
      } else if (entry.key == "ParameterValue") {
        const EntryDescription* const described = find_description(section.kind, *object);
        if (described != nullptr) move(entry, object->index, section.kind.sub_index, *described);
      }
    }
  }

 private:
  static const EntryDescription* find_description(const SectionName& name, const ObjectDescription& object) {
    return name.kind == SectionKind::object ? static_cast<const EntryDescription*>(&object)
                                            : object.find(name.sub_index);
  }

  void move(DocumentEntry& line, std::uint16_t index, std::uint8_t sub_index, const EntryDescription& described) {
    const Entry* const entry = device_.find(index, sub_index);
    if (entry == nullptr || line.value.empty() || line.value.find('$') != std::string::npos) return;
    Diagnostics ignored;
    const auto value = parse_value({line.value, {}, true}, *entry->type, std::nullopt, ignored);
    const auto default_value = parse_value(described.default_value, *entry->type, own_, ignored);
    const bool is_integer = entry->type->kind == canopen::DataClass::unsigned_integer ||
                            entry->type->kind == canopen::DataClass::signed_integer;
    if (!value || !is_integer) return;
    const bool is_cob_id = find_cob_id_parameter(index, sub_index) != nullptr;
    const std::uint64_t bits = low_bits(entry->type->bits);
    const std::uint64_t compared = is_cob_id ? bits & ~flag_bits : bits;
    if (default_value && described.default_value.text.find('$') != std::string_view::npos) {
      if (((value->bits ^ default_value->bits) & compared) != 0) return;
      if (!parse_value(described.default_value, *entry->type, node_id_, diagnostics_)) return;
      line.value = fmt::format("0x{:0{}X}", (value->bits - own_ + node_id_) & bits, hex_digits_of(*entry->type));
    } else if (is_cob_id && is_can_id_of_own_node(value->bits)) {
      diagnostics_.warning(
          "cob-id-node-id", described.parameter_value.position,
          fmt::format("{} remains {}, a CAN-ID of node {}: its default value does not depend on the node-ID",
                      entry_label(index, sub_index), line.value, own_));
    }
  }

  [[nodiscard]] bool is_can_id_of_own_node(std::uint64_t bits) const {
    const CobId cob_id{static_cast<std::uint32_t>(bits)};
    const std::uint32_t can_id = cob_id.can_id();
    return cob_id.valid() && !cob_id.extended() && can_id > canopen::function_code::emcy &&
           can_id < canopen::function_code::sdo_response && (can_id & node_id_bits) == own_;
  }

  const DataSheet& sheet_;
  const Device& device_;
  std::uint8_t own_;
  std::uint8_t node_id_;
  Diagnostics& diagnostics_;
};

}  // namespace

void move_values(Document& document, const DataSheet& sheet, const Device& device, std::uint8_t node_id,
                 Diagnostics& diagnostics) {
  ValueMover mover(sheet, device, node_id, diagnostics);
  for (DocumentSection& section : document.sections) {
    constexpr SectionKind kinds[] = {SectionKind::object, SectionKind::sub_object, SectionKind::compact_values};
    if (std::ranges::find(kinds, section.kind.kind) != std::end(kinds)) mover.move(section);
  }
}

}  // namespace edsc
