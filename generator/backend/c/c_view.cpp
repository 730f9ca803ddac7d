#include "backend/c/c_view.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <bit>
#include <cmath>
#include <cstdint>
#include <limits>
#include <optional>
#include <string>
#include <string_view>

#include "backend/cpp/cpp_text.hpp"
#include "backend/cpp/json_object.hpp"
#include "device/pdo/pdo_defaults.hpp"
#include "system/path.hpp"
#include "text/ascii.hpp"
#include "text/source_file.hpp"
#include "values/value_bytes.hpp"

namespace edsc {
namespace {

using canopen::DataClass;
using canopen::DataTypeRow;
using nlohmann::ordered_json;

std::string upper_case(std::string text) {
  std::ranges::transform(text, text.begin(), to_upper);
  return text;
}

/// An integer type for `bits`: `int32_t` for INTEGER24.
std::string integer_type(std::string_view prefix, unsigned bits) {
  return fmt::format("{}int{}_t", prefix, std::max(8U, std::bit_ceil(bits)));
}

/// The type of a value in C; empty for a string or DOMAIN, which has no fixed length.
std::string type_of(const DataTypeRow& type) {
  switch (type.kind) {
    case DataClass::boolean: return "bool";
    case DataClass::unsigned_integer:
    case DataClass::time: return integer_type("u", type.bits);
    case DataClass::signed_integer: return integer_type("", type.bits);
    case DataClass::real: return type.bits == 32 ? "float" : "double";
    case DataClass::string:
    case DataClass::domain: break;
  }
  return "";
}

std::string unsigned_literal(std::uint64_t number, bool hexadecimal) {
  const std::string digits = hexadecimal ? fmt::format("0x{:X}", number) : fmt::format("{}", number);
  return number > 0xFFFF'FFFF ? fmt::format("UINT64_C({})", digits) : digits + "u";
}

std::string signed_literal(std::int64_t number) {
  constexpr std::int64_t highest = std::numeric_limits<std::int32_t>::max();
  if (number == std::numeric_limits<std::int64_t>::min()) return "INT64_MIN";
  if (number > highest || number < -highest) return fmt::format("(INT64_C({}))", number);
  return fmt::format("({})", number);
}

/// Empty if C has no constant expression for the value.
std::string literal_of(const Value& value, const DataTypeRow& type) {
  switch (type.kind) {
    case DataClass::boolean: return value.bits != 0 ? "true" : "false";
    case DataClass::unsigned_integer:
    case DataClass::time: return unsigned_literal(value.bits, value.hexadecimal);
    case DataClass::signed_integer: return signed_literal(static_cast<std::int64_t>(value.bits));
    case DataClass::real: {
      if (!std::isfinite(real_of(value.bits, type))) return "";
      std::string text = real_text(value.bits, type);
      if (text.find_first_of(".e") == std::string::npos) text += ".0";
      return fmt::format("({}{})", text, type.bits == 32 ? "f" : "");
    }
    case DataClass::string: return type.type == canopen::DataType::visible_string ? cpp_string(value.bytes) : "";
    case DataClass::domain: break;
  }
  return "";
}

/// `DEFAULT 5u`; of a value to which the node-ID is added `DEFAULT(node_id) (0x180u + (node_id))`.
void add_constant(ordered_json& rows, std::string_view name, const std::optional<Value>& value,
                  const DataTypeRow& type) {
  if (!value) return;
  const std::string literal = literal_of(*value, type);
  if (literal.empty()) return;
  rows.push_back(json_object("constant", fmt::format("{}{}", name, value->plus_node_id ? "(node_id)" : ""), "value",
                             value->plus_node_id ? fmt::format("({} + (node_id))", literal) : literal));
}

/// Of C99, in lower case; `bool`, `false` and `true` are macros.
constexpr std::string_view keywords[] = {
    "auto", "bool",     "break",    "case",     "char",  "const",    "continue", "default", "do",     "double",
    "else", "enum",     "extern",   "false",    "float", "for",      "goto",     "if",      "inline", "int",
    "long", "register", "restrict", "return",   "short", "signed",   "sizeof",   "static",  "struct", "switch",
    "true", "typedef",  "union",    "unsigned", "void",  "volatile", "while"};

std::string member_name(const std::string& name) {
  return std::ranges::find(keywords, name) != std::end(keywords) ? name + "_" : name;
}

class CView {
 public:
  explicit CView(const NamedDevice& named)
      : device_{named.device}, names_{named.identifiers()}, space_{named.names.space()} {}

  [[nodiscard]] ordered_json view() {
    ordered_json entries = ordered_json::array();
    for (const Object& object : device_.objects) {
      for (const Entry& entry : object.entries) entries.push_back(entry_row(entry));
    }
    ordered_json pdos = ordered_json::array();
    ordered_json left_out = ordered_json::array();
    for (const Pdo& pdo : device_.pdos) add_pdo(pdo, pdos, left_out);
    return json_object("file", cpp_comment(file_name_of(device_.source->name())), "device", space_, "guard",
                       upper_case(space_) + "_OBJECTS_H", "entries", std::move(entries), "pdos", std::move(pdos),
                       "left_out", std::move(left_out));
  }

 private:
  [[nodiscard]] ordered_json entry_row(const Entry& entry) {
    const std::string name = fmt::format(
        "{}_{}", space_, scope_.take(names_.full(entry), fmt::format("{:04x}_{:02x}", entry.index, entry.sub_index)));
    const std::string type = type_of(*entry.type);
    ordered_json constants = ordered_json::array();
    add_constant(constants, "DEFAULT", entry.default_value, *entry.type);
    add_constant(constants, "LOW", entry.low_limit, *entry.type);
    add_constant(constants, "HIGH", entry.high_limit, *entry.type);
    return json_object("comment",
                       fmt::format("{} {}, {}, {}", entry_label(entry.index, entry.sub_index), cpp_comment(entry.name),
                                   entry.type->name, canopen::row_of(entry.access).name),
                       "name", name, "macro", upper_case(name), "type",
                       type.empty() ? ordered_json(nullptr) : ordered_json(type), "index",
                       fmt::format("0x{:04X}u", entry.index), "sub_index", fmt::format("0x{:02X}u", entry.sub_index),
                       "constants", std::move(constants));
  }

  void add_pdo(const Pdo& pdo, ordered_json& pdos, ordered_json& left_out) const {
    ordered_json members = member_rows(pdo);
    if (pdo.broken || pdo.multiplexed || members.empty()) {
      const std::string_view why = pdo.broken        ? "its mapping is invalid"
                                   : pdo.multiplexed ? "a multiplex PDO"
                                                     : "it maps no object by default";
      left_out.push_back(fmt::format("{}: {}", pdo_label(pdo), why));
      return;
    }
    const std::string name =
        fmt::format("{}_{}pdo_{}", space_, pdo.direction == PdoDirection::receive ? 'r' : 't', pdo.number);
    ordered_json constants = ordered_json::array();
    constexpr std::uint8_t cob_id = 1;
    if (const Entry* const entry = pdo.communication == nullptr ? nullptr : pdo.communication->find(cob_id)) {
      add_constant(constants, "COB_ID", entry->default_value, *entry->type);
    }
    pdos.push_back(json_object("pdo", pdo_label(pdo), "pdo_name", name, "pdo_macro", upper_case(name), "length",
                               pdo.bytes(), "pdo_constants", std::move(constants), "members", std::move(members)));
  }

  /// The objects of a PDO; dummy entries have no member.
  [[nodiscard]] ordered_json member_rows(const Pdo& pdo) const {
    IdentifierScope scope;
    ordered_json rows = ordered_json::array();
    for (const PdoEntry& mapped : pdo.entries) {
      if (mapped.object != nullptr) rows.push_back(member_row(mapped, scope));
    }
    return rows;
  }

  [[nodiscard]] ordered_json member_row(const PdoEntry& mapped, IdentifierScope& scope) const {
    const Entry& entry = *mapped.object;
    const std::string name = member_name(names_.full(entry));
    const DataTypeRow& type = *entry.type;
    const std::string c_type = type_of(type);
    const bool is_unsigned = type.kind == DataClass::unsigned_integer || type.kind == DataClass::time;
    return json_object("member", scope.take(name, fmt::format("{}", mapped.position)), "member_type",
                       c_type.empty() ? "uint8_t" : c_type, "member_comment",
                       fmt::format("{} {}", entry_label(entry.index, entry.sub_index), cpp_comment(entry.name)),
                       "start", mapped.offset, "bits", mapped.bits, "first_byte", mapped.offset / 8, "bytes",
                       mapped.bits / 8, "is_boolean", type.kind == DataClass::boolean, "is_unsigned", is_unsigned,
                       "is_signed", type.kind == DataClass::signed_integer, "is_real", type.kind == DataClass::real,
                       "is_bytes", c_type.empty());
  }

  const Device& device_;
  const Identifiers& names_;
  const std::string& space_;  ///< the prefix of all names
  IdentifierScope scope_;
};

}  // namespace

ordered_json c_view(const NamedDevice& named, const Options&, Diagnostics&) { return CView{named}.view(); }

}  // namespace edsc
