#include "device/types/type_table.hpp"

#include <fmt/format.h>

#include <algorithm>

#include "diagnostics/quote.hpp"
#include "eds/number.hpp"
#include "text/counted.hpp"
#include "values/read_value.hpp"

namespace edsc {
namespace {

using canopen::DataClass;
using canopen::DataType;
using canopen::DataTypeRow;

/// Predefined complex data types (CiA 301, 7.4.7, table 44).
constexpr std::uint64_t first_complex_type = 0x20;
constexpr std::uint64_t last_complex_type = 0x3F;

struct ComplexMember {
  std::uint8_t type;
  std::uint8_t first, last;  ///< sub-indices
  DataType member;
};

constexpr ComplexMember complex_members[] = {
    // PDO communication parameter
    {0x20, 1, 1, DataType::unsigned32},
    {0x20, 2, 2, DataType::unsigned8},
    {0x20, 3, 3, DataType::unsigned16},
    {0x20, 4, 4, DataType::unsigned8},
    {0x20, 5, 5, DataType::unsigned16},
    {0x20, 6, 6, DataType::unsigned8},
    // PDO mapping parameter
    {0x21, 1, 64, DataType::unsigned32},
    // SDO parameter
    {0x22, 1, 2, DataType::unsigned32},
    {0x22, 3, 3, DataType::unsigned8},
    // Identity
    {0x23, 1, 4, DataType::unsigned32},
    // OS debug record: command, status, reply
    {0x24, 1, 1, DataType::octet_string},
    {0x24, 2, 2, DataType::unsigned8},
    {0x24, 3, 3, DataType::octet_string},
    // OS command record: command, status, reply
    {0x25, 1, 1, DataType::octet_string},
    {0x25, 2, 2, DataType::unsigned8},
    {0x25, 3, 3, DataType::octet_string},
};

const DataTypeRow* basic_type(std::uint64_t code) {
  return code > 0xFFFF ? nullptr : canopen::find_data_type(static_cast<std::uint32_t>(code));
}

const DataTypeRow* basic_type(DataType type) { return canopen::find_data_type(static_cast<std::uint32_t>(type)); }

class DefinitionReader {
  static constexpr int max_steps = 8;               ///< from a DEFTYPE to its basic type
  static constexpr std::uint64_t max_octets = 256;  ///< longer types are a DOMAIN, in memory of the application

 public:
  DefinitionReader(const DataSheet& sheet, std::optional<std::uint8_t> node_id, Diagnostics& diagnostics)
      : sheet_{sheet}, node_id_{node_id}, diagnostics_{diagnostics} {}

  TypeDefinition read(const ObjectDescription& object) {
    TypeDefinition definition;
    definition.index = object.index;
    definition.name = object.parameter_name.text;
    definition.position = object.position;
    const auto object_type = number_of(object.object_type);
    if (object_type == static_cast<std::uint64_t>(ObjectType::defstruct)) {
      read_members(object, definition);
    } else if (object.find(1) != nullptr) {
      read_range(object, definition);
    } else {
      read_alias(object, definition);
    }
    return definition;
  }

 private:
  /// DEFSTRUCT: each sub-index holds the index of a data type (CiA 301, 7.4.7).
  void read_members(const ObjectDescription& object, TypeDefinition& definition) {
    definition.kind = ObjectType::defstruct;
    for (const SubObjectDescription& sub : object.sub_objects) {
      if (sub.sub_index == 0) continue;
      definition.members.resize(sub.sub_index);
      const auto code = number_of(sub.default_value);
      if (code) definition.members.back() = follow(*code);
      if (definition.members.back().row == nullptr) report(sub.default_value, "is not the index of a data type");
    }
  }

  /// A range in the format of CANFestival: a RECORD of the index of the basic type, the minimum and the maximum.
  void read_range(const ObjectDescription& object, TypeDefinition& definition) {
    const auto code = number_of(object.find(1)->default_value);
    if (code) definition.type = follow(*code);
    if (definition.type.row == nullptr) {
      return report(object.find(1)->default_value, "is not the index of a data type");
    }
    const SubObjectDescription* low = object.find(2);
    const SubObjectDescription* high = object.find(3);
    if (low != nullptr) definition.low_limit = limit(low->default_value, Limit::low, *definition.type.row);
    if (high != nullptr) definition.high_limit = limit(high->default_value, Limit::high, *definition.type.row);
  }

  void read_alias(const ObjectDescription& object, TypeDefinition& definition) {
    const TypeReference basic = data_type(object, max_steps);
    definition.type = with_length(basic, stated_length(object));
    if (definition.type.row == nullptr) return report(object.data_type, "is not the index of a data type");
    if (definition.type.row != basic.row) {
      // A basic type that the EDS also describes is that of CiA 301, regardless of the description.
      if (basic_type(std::uint64_t{object.index}) == nullptr) report_length(object, definition.type);
      return;
    }
    if (definition.type.row->bits == 0) return;  // a string or DOMAIN
    definition.low_limit = limit(object.low_limit, Limit::low, *definition.type.row);
    definition.high_limit = limit(object.high_limit, Limit::high, *definition.type.row);
  }

  /// The basic type of a type, through any DEFTYPEs.
  TypeReference follow(std::uint64_t code, int steps = max_steps) {
    if (const DataTypeRow* row = basic_type(code)) return {row};
    const ObjectDescription* object = code < first_communication_index ? sheet_.find(code) : nullptr;
    if (object == nullptr || steps == 0) return {};
    return with_length(data_type(*object, steps - 1), stated_length(*object));
  }

  TypeReference data_type(const ObjectDescription& object, int steps) {
    const auto code = number_of(object.data_type);
    return code ? follow(*code, steps) : TypeReference{};
  }

  /// The value of a DEFTYPE is the length of its type in bits (CiA 301, 7.4.7); 0 if it states none.
  static std::uint64_t stated_length(const ObjectDescription& object) {
    const bool is_deftype = number_of(object.object_type) == static_cast<std::uint64_t>(ObjectType::deftype);
    return is_deftype ? number_of(object.default_value).value_or(0) : 0;
  }

  /// A type whose length differs from its basic type is an OCTET_STRING, or a DOMAIN if it is long or not whole bytes.
  static TypeReference with_length(const TypeReference& basic, std::uint64_t bits) {
    const DataTypeRow* row = basic.row;
    if (bits == 0) return basic;
    if (row != nullptr && (row->bits == bits || row->kind == DataClass::domain)) return basic;
    if (bits % 8 != 0 || bits / 8 > max_octets) return {basic_type(DataType::domain)};
    const bool is_string = row != nullptr && row->kind == DataClass::string;
    return {is_string ? row : basic_type(DataType::octet_string), static_cast<std::uint32_t>(bits / 8)};
  }

  void report_length(const ObjectDescription& object, const TypeReference& type) {
    const std::string length = type.octets != 0 ? fmt::format(" of {}", counted(type.octets, "byte")) : "";
    diagnostics_.note("type-length", object.default_value.position,
                      fmt::format("{} {} has {}: its objects are of type {}{}", index_label(object.index),
                                  quote(object.parameter_name.text),
                                  counted(number_of(object.default_value).value_or(0), "bit"), type.row->name, length));
  }

  std::optional<Value> limit(const Field& field, Limit which, const DataTypeRow& type) {
    return parse_limit(field, which, type, node_id_, diagnostics_);
  }

  void report(const Field& field, std::string_view what) {
    diagnostics_.warning("type-definition", field.position, fmt::format("{} {}", quote(field.text), what));
  }

  const DataSheet& sheet_;
  std::optional<std::uint8_t> node_id_;
  Diagnostics& diagnostics_;
};

}  // namespace

TypeTable::TypeTable(const DataSheet& sheet, std::optional<std::uint8_t> node_id, Diagnostics& diagnostics) {
  DefinitionReader reader{sheet, node_id, diagnostics};
  for (const ObjectDescription& object : sheet.objects) {
    if (object.index >= first_communication_index) break;
    definitions_.push_back(reader.read(object));
  }
}

const TypeDefinition* TypeTable::definition(std::uint64_t code) const {
  const auto at = std::ranges::lower_bound(definitions_, code, {}, &TypeDefinition::index);
  return at != definitions_.end() && at->index == code ? &*at : nullptr;
}

ValueType TypeTable::find(std::uint64_t code) const {
  if (const DataTypeRow* row = basic_type(code)) return {row};
  const TypeDefinition* own = definition(code);
  if (own == nullptr || own->type.row == nullptr) return {};
  return {own->type.row, own->low_limit ? &*own->low_limit : nullptr, own->high_limit ? &*own->high_limit : nullptr,
          own->type.octets};
}

ValueType TypeTable::find_member(std::uint64_t code, std::uint8_t sub_index) const {
  if (const TypeDefinition* own = definition(code)) {
    if (sub_index < 1 || sub_index > own->members.size()) return {};
    const TypeReference& member = own->members[sub_index - 1U];
    return {member.row, nullptr, nullptr, member.octets};
  }
  for (const ComplexMember& row : complex_members) {
    if (row.type == code && sub_index >= row.first && sub_index <= row.last) return {basic_type(row.member)};
  }
  return {};
}

bool TypeTable::is_complex(std::uint64_t code) const {
  const TypeDefinition* own = definition(code);
  return own != nullptr ? own->kind == ObjectType::defstruct : code >= first_complex_type && code <= last_complex_type;
}

}  // namespace edsc
