#include "device/entry_text.hpp"

#include <fmt/format.h>

#include "device/scaled_unit.hpp"
#include "text/ascii.hpp"
#include "values/append.hpp"
#include "values/little_endian.hpp"
#include "values/read_value.hpp"

namespace edsc {
namespace {

using canopen::DataClass;
using canopen::DataType;
using canopen::DataTypeRow;
using Bytes = std::span<const std::uint8_t>;

/// Why a value is rejected; empty if it is valid. A limit with an unknown node-ID is not checked.
std::string limit_problem(const Entry& entry, std::uint64_t number, std::string_view text) {
  const DataTypeRow& type = *entry.type;
  if (type.kind == DataClass::signed_integer) {
    number = static_cast<std::uint64_t>(sign_extended(number, type.bits));
  }
  for (const bool high : {false, true}) {
    const auto& limit = high ? entry.high_limit : entry.low_limit;
    if (!limit || limit->plus_node_id) continue;
    if (!(high ? is_less(type, limit->bits, number) : is_less(type, number, limit->bits))) continue;
    return fmt::format("{} is {} the {} limit of {} \"{}\", {}", text, high ? "above" : "below", high ? "high" : "low",
                       entry_label(entry.index, entry.sub_index), entry.name, limit_text(*limit, type));
  }
  return "";
}

}  // namespace

void append_value(std::string& text, const Entry& entry, Bytes bytes) {
  constexpr std::uint16_t cycle_period = 0x1006, window_length = 0x1007;  // in us
  const bool communication =
      entry.index >= 0x1000 && entry.index < 0x2000 && entry.index != cycle_period && entry.index != window_length;
  if (!communication || entry.type->type != DataType::unsigned32 || bytes.size() != sizeof(std::uint32_t)) {
    return append_value(text, *entry.type, bytes, raw_unit(entry));
  }
  append_hex_number(text, number_of(bytes), 8);
}

std::string value_text(const Entry& entry, Bytes bytes) {
  std::string text;
  append_value(text, entry, bytes);
  return text;
}

std::string limits_text(const Entry& entry) {
  if (!entry.low_limit && !entry.high_limit) return "";
  std::string text;
  if (entry.low_limit) text += limit_text(*entry.low_limit, *entry.type);
  text += "..";
  if (entry.high_limit) text += limit_text(*entry.high_limit, *entry.type);
  append_unit(text, raw_unit(entry));
  return text;
}

ParsedValue parse_value_text(const Entry& entry, std::string_view text) {
  const DataTypeRow& type = *entry.type;
  const bool number = type.kind == DataClass::unsigned_integer || type.kind == DataClass::signed_integer ||
                      type.kind == DataClass::real;
  if (!number) return parse_value_text(type, text);
  text = trim(text);
  const std::string_view unit = entry.unit;
  if (!unit.empty() && text.size() > unit.size() && text.ends_with(unit) &&
      text[text.size() - unit.size() - 1] == ' ') {
    if (is_scaled(entry)) {
      return {
          {},
          fmt::format(
              "\"{}\" has a unit, but {} \"{}\" is in steps of {} (Factor of the EDS); give the number of steps, without a "
              "unit",
              text, entry_label(entry.index, entry.sub_index), entry.name, physical_unit(entry))};
    }
    text = trim_right(text.substr(0, text.size() - unit.size()));
  }
  ParsedValue result = parse_value_text(type, text);
  if (result.ok()) result.problem = limit_problem(entry, number_of(result.bytes), text);
  if (!result.ok()) result.bytes.clear();
  return result;
}

}  // namespace edsc
