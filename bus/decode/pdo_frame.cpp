#include "decode/pdo_frame.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <iterator>

#include "device/scaled_unit.hpp"
#include "text/counted.hpp"
#include "values/append.hpp"
#include "values/little_endian.hpp"
#include "values/value_text.hpp"

namespace edsc {
namespace {

using canopen::Frame;

void append_field(std::string& text, const PdoField& field, std::uint64_t word, Message& message) {
  MessageValue value;
  value.index = field.index;
  value.sub_index = field.sub_index;
  value.name = field.name;
  value.type = field.type;
  value.number = field.offset < classical_can.bits() ? word >> field.offset & low_bits(field.bits) : 0;
  value.bits = field.bits;
  text += field.name;
  text += " = ";
  value.text_begin = text.size();
  if (field.drive_word != DriveWord::none) {
    append_drive_word(text, field.drive_word, static_cast<std::uint16_t>(value.number));
  } else if (field.type == nullptr) {
    append_hex_number(text, value.number, (field.bits + 3U) / 4U);
  } else if (field.type->kind == canopen::DataClass::string) {
    append_value(text, *field.type, bytes_of(value.number, std::min<std::size_t>(bytes_for(field.bits), 8)));
  } else {
    if (field.entry != nullptr) value.unit = raw_unit(*field.entry);
    append_number(text, *field.type, value.number, field.bits, value.unit);
  }
  value.text_end = text.size();
  message.values.push_back(value);
}

}  // namespace

void append_pdo(const Frame& frame, const PdoLayout& pdo, Message& message) {
  const std::uint64_t word = number_of(data_of(frame));
  const unsigned bits = frame.size * 8U;
  const std::size_t bytes = bytes_for(pdo.bits);
  const char* separator = "";
  for (const PdoField& field : pdo.fields) {
    if (field.end() > bits) break;
    message.text += separator;
    append_field(message.text, field, word, message);
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
  }
  message.values_node = address.node_id;
  message.text += address.destination ? "to " : "from ";
  message.text += address.node_id == 0 ? "all nodes, " : fmt::format("node {}, ", address.node_id);
  append_field(message.text, field, number_of(data_of(frame)), message);
  message.values.back().name = field.entry != nullptr ? std::string_view{field.entry->name} : std::string_view{};
}

}  // namespace edsc
