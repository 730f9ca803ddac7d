#include "device/entry_text.hpp"

#include <fmt/format.h>

#include "device/meaning/physical.hpp"
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

/// A number with its unit, or another value.
void append_with_unit(std::string& text, const Entry& entry, Bytes bytes) {
  const DataTypeRow& type = *entry.type;
  const Quantity* const quantity = quantity_of(entry);
  if (quantity == nullptr || bytes.size() * 8 != type.bits) return append_value(text, type, bytes);
  append_physical(text, *quantity, type, number_of(bytes), type.bits);
}

std::string limit_with_unit(const Entry& entry, const Value& limit) {
  const Quantity* const quantity = quantity_of(entry);
  if (quantity == nullptr || quantity->is_raw() || limit.plus_node_id) return limit_text(limit, *entry.type);
  std::string text;
  append_physical(text, *quantity, *entry.type, limit.bits, entry.type->bits);
  return text;
}

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
                       entry_label(entry.index, entry.sub_index), entry.name, limit_with_unit(entry, *limit));
  }
  return "";
}

}  // namespace

const Quantity* quantity_of(const Entry& entry) {
  const bool is_number = entry.type->kind == DataClass::unsigned_integer ||
                         entry.type->kind == DataClass::signed_integer || entry.type->kind == DataClass::real;
  return is_number && entry.meaning && entry.meaning->quantity ? &*entry.meaning->quantity : nullptr;
}

void append_value(std::string& text, const Entry& entry, Bytes bytes) {
  constexpr std::uint16_t cycle_period = 0x1006, window_length = 0x1007;  // in us
  const bool communication =
      entry.index >= 0x1000 && entry.index < 0x2000 && entry.index != cycle_period && entry.index != window_length;
  if (!communication || entry.type->type != DataType::unsigned32 || bytes.size() != sizeof(std::uint32_t)) {
    return append_with_unit(text, entry, bytes);
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
  if (entry.low_limit) text += limit_with_unit(entry, *entry.low_limit);
  text += "..";
  if (entry.high_limit) text += limit_with_unit(entry, *entry.high_limit);
  if (const Quantity* const quantity = quantity_of(entry); quantity != nullptr && quantity->is_raw()) {
    append_unit(text, quantity->symbol);
  }
  return text;
}

ParsedValue parse_value_text(const Entry& entry, std::string_view text) {
  const DataTypeRow& type = *entry.type;
  const bool number = type.kind == DataClass::unsigned_integer || type.kind == DataClass::signed_integer ||
                      type.kind == DataClass::real;
  if (!number) return parse_value_text(type, text);
  text = trim(text);
  ParsedValue result;
  const Quantity* const quantity = quantity_of(entry);
  const auto physical = quantity != nullptr ? split_physical(text) : std::nullopt;
  if (physical && (physical->unit == quantity->symbol || canopen::find_unit(physical->unit) != nullptr)) {
    const RawNumber raw = raw_number(*quantity, type, *physical);
    if (raw.ok()) {
      result.bytes = bytes_of(raw.bits, bytes_for(type.bits));
    } else {
      result.problem = fmt::format("{}: {} \"{}\"", raw.problem, entry_label(entry.index, entry.sub_index), entry.name);
    }
  } else {
    result = parse_value_text(type, text);
  }
  if (result.ok()) result.problem = limit_problem(entry, number_of(result.bytes), text);
  if (!result.ok()) result.bytes.clear();
  return result;
}

}  // namespace edsc
