#include "decode/pdo_frame.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <iterator>

#include "text/counted.hpp"
#include "values/append.hpp"
#include "values/little_endian.hpp"
#include "values/value_text.hpp"

namespace edsc {
namespace {

using canopen::Frame;

std::uint64_t number_in(const PdoField& field, std::uint64_t word) {
  return field.offset < classical_can.bits() ? word >> field.offset & low_bits(field.bits) : 0;
}

/// `other`: the value of the object on which fields depend.
void append_field(std::string& text, const PdoField& field, std::uint64_t word, std::optional<std::int64_t> other,
                  Message& message) {
  MessageValue& value = message.values.emplace_back();
  value.index = field.index;
  value.sub_index = field.sub_index;
  value.name = field.name;
  value.type = field.type;
  value.number = number_in(field, word);
  value.bits = field.bits;
  text += field.name;
  text += " = ";
  value.text_begin = text.size();
  if (field.is_formatted) {
    value.meaning = field.format.meaning();
    value.quantity = field.format.quantity();
    value.other = other;
    value.word = field.format.word(value.number, other);
    if (value.word != nullptr) {
      text += value.word->text;
    } else {
      field.format.append(text, value.number, other);
    }
  } else if (field.type == nullptr) {
    append_hex_number(text, value.number, (field.bits + 3U) / 4U);
  } else if (field.type->kind == canopen::DataClass::string) {
    append_value(text, *field.type, bytes_of(value.number, std::min<std::size_t>(bytes_for(field.bits), 8)));
  } else {
    append_number(text, *field.type, value.number, field.bits);
  }
  value.text_end = text.size();
}

}  // namespace

void append_pdo(const Frame& frame, const PdoLayout& pdo, NodeModel& node, Message& message) {
  const std::uint64_t word = number_of(data_of(frame));
  const unsigned bits = frame.size * 8U;
  const std::size_t bytes = bytes_for(pdo.bits);
  if (pdo.has_selectors) {
    for (const PdoField& field : pdo.fields) {
      if (field.selects && field.end() <= bits) node.select(*field.selects, number_in(field, word));
    }
  }
  const char* separator = "";
  for (const PdoField& field : pdo.fields) {
    if (field.end() > bits) break;
    message.text += separator;
    append_field(message.text, field, word, node.selector(field.depends_on), message);
    separator = ", ";
  }
  if (pdo.fields.empty()) {
    message.text += "no object is mapped";
    message.problem = frame.size > 0;
  } else if (bits < pdo.bits) {
    fmt::format_to(std::back_inserter(message.text), "{}too short: {} of {}", separator, frame.size,
                   counted(bytes, "byte"));
    message.problem = true;
  } else if (frame.size > bytes) {
    fmt::format_to(std::back_inserter(message.text), "{}{} more than mapped", separator,
                   counted(frame.size - bytes, "byte"));
  }
}

MpdoAddress mpdo_address_of(const Frame& frame) {
  return {(frame.data[0] & 0x80) != 0, static_cast<std::uint8_t>(frame.data[0] & 0x7F)};
}

void decode_mpdo(const Frame& frame, MpdoAddress address, const NodeModel* owner, Message& message) {
  PdoField field;
  field.index = static_cast<std::uint16_t>(frame.data[1] | frame.data[2] << 8);
  field.sub_index = frame.data[3];
  field.offset = 32;
  field.bits = 32;
  field.name = entry_label(field.index, field.sub_index);
  const Object* object = owner != nullptr ? owner->device().find(field.index) : nullptr;
  field.entry = object != nullptr ? object->find(field.sub_index) : nullptr;
  if (field.entry != nullptr) {
    field.type = field.entry->type;
    if (field.type->bits > 0 && field.type->bits < 32) field.bits = field.type->bits;
    field.name += " " + display_name(*object, *field.entry);
    field.is_formatted = field.type->bits == field.bits;
    if (field.is_formatted) field.format = ValueFormat{owner->device(), *field.entry};
  }
  message.values_node = address.node_id;
  message.text += address.destination ? "to " : "from ";
  message.text += address.node_id == 0 ? "all nodes, " : fmt::format("node {}, ", address.node_id);
  const auto other = field.entry != nullptr ? owner->selector_of(*field.entry) : std::nullopt;
  append_field(message.text, field, number_of(data_of(frame)), other, message);
  message.values.back().word = nullptr;  // it belongs to the field of this function
  message.values.back().name = field.entry != nullptr ? std::string_view{field.entry->name} : std::string_view{};
}

}  // namespace edsc
