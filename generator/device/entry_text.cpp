#include "device/entry_text.hpp"

#include <fmt/format.h>

#include "device/meaning/physical.hpp"
#include "device/meaning/value_parts.hpp"
#include "text/ascii.hpp"
#include "text/suggestion.hpp"
#include "values/append.hpp"
#include "values/little_endian.hpp"
#include "values/read_value.hpp"

namespace edsc {
namespace {

using canopen::DataClass;
using canopen::DataType;
using canopen::DataTypeRow;
using Bytes = std::span<const std::uint8_t>;

bool is_number(const DataTypeRow& type) {
  return type.kind == DataClass::unsigned_integer || type.kind == DataClass::signed_integer ||
         type.kind == DataClass::real;
}

/// The number in an integer; negative for a negative INTEGER.
std::int64_t integer_of(const DataTypeRow& type, std::uint64_t bits) {
  if (type.kind != DataClass::signed_integer) return static_cast<std::int64_t>(bits);
  return static_cast<std::int64_t>(sign_extended(bits, type.bits));
}

/// A value by its meaning, or else by its type.
void append_by_meaning(std::string& text, const Entry& entry, Bytes bytes, std::optional<std::int64_t> other) {
  const DataTypeRow& type = *entry.type;
  if (!entry.meaning || bytes.size() != bytes_for(type.bits)) return append_value(text, type, bytes);
  const std::uint64_t bits = number_of(bytes);
  if (const Meaning* const meaning = meaning_of_integer(entry)) {
    const NamedValue* const named = meaning->values ? meaning->values->find(integer_of(type, bits)) : nullptr;
    if (named != nullptr) {
      append_decimal(text, named->value);
      text.append(" ").append(named->name);
      return;
    }
    if (meaning->has_fields()) {
      append_hex_number(text, bits, (type.bits + 3U) / 4);
      text += ' ';
      const std::size_t before = text.size();
      append_parts(text, *meaning, bits, other);
      if (text.size() == before) text.pop_back();
      return;
    }
  }
  if (const Quantity* const quantity = quantity_of(entry)) {
    return append_physical(text, *quantity, type, bits, type.bits);
  }
  append_value(text, type, bytes);
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

/// `; did you mean "homing"?`, or all names if there are few.
std::string names_hint(const Enumeration& values, std::string_view text) {
  constexpr std::size_t max_listed = 8;
  std::vector<std::string> names;
  for (const NamedValue& one : values.values) names.push_back(one.name);
  std::string hint = did_you_mean(text, names);
  if (hint.empty() && names.size() <= max_listed) hint = fmt::format("; expected {}", fmt::join(names, ", "));
  return hint;
}

/// The value of a name, or of names of bits.
RawNumber named_number(const Meaning& meaning, const DataTypeRow& type, std::string_view text) {
  const NamedValue* const named = meaning.values ? meaning.values->find(text) : nullptr;
  if (named != nullptr) return {static_cast<std::uint64_t>(named->value) & low_bits(type.bits), ""};
  if (meaning.has_fields()) return parse_parts(meaning, text);
  return {0, fmt::format("\"{}\" is not a number or a named value{}", text, names_hint(*meaning.values, text))};
}

/// The number before names, if the whole text is what edsc writes for it: `3 profile_velocity`.
std::optional<ParsedValue> number_with_names(const Entry& entry, std::string_view text) {
  const std::size_t blank = text.find(' ');
  if (blank == std::string_view::npos) return std::nullopt;
  ParsedValue number = parse_value_text(*entry.type, text.substr(0, blank));
  if (!number.ok() || value_text(entry, number.bytes) != text) return std::nullopt;
  return number;
}

/// Why a closed enumeration, of the entry or of a field, does not have the number; empty if each has it.
std::string closed_problem(const Entry& entry, std::uint64_t bits, std::string_view text) {
  const Meaning* const meaning = meaning_of_integer(entry);
  if (meaning == nullptr) return "";
  const auto is_rejected = [](const std::optional<Enumeration>& values, std::int64_t number) {
    return values && values->closed && values->find(number) == nullptr;
  };
  const std::string label = fmt::format("{} \"{}\"", entry_label(entry.index, entry.sub_index), entry.name);
  if (is_rejected(meaning->values, integer_of(*entry.type, bits))) {
    return fmt::format("{} is not a value of {}{}", text, label, names_hint(*meaning->values, text));
  }
  for (const BitField& field : meaning->fields) {
    if (!is_rejected(field.values, field.of(bits))) continue;
    return fmt::format("{}={} is not a value of {}{}", field.name, field.of(bits), label,
                       names_hint(*field.values, ""));
  }
  return "";
}

}  // namespace

const Meaning* meaning_of_integer(const Entry& entry) {
  const bool is_integer =
      entry.type->kind == DataClass::unsigned_integer || entry.type->kind == DataClass::signed_integer;
  return is_integer ? entry.meaning.get() : nullptr;
}

const Quantity* quantity_of(const Entry& entry) {
  return is_number(*entry.type) && entry.meaning && entry.meaning->quantity ? &*entry.meaning->quantity : nullptr;
}

const Quantity* quantity_with_unit(const Entry& entry) {
  const Quantity* const quantity = quantity_of(entry);
  return quantity != nullptr && !quantity->symbol.empty() ? quantity : nullptr;
}

void append_value(std::string& text, const Entry& entry, Bytes bytes, std::optional<std::int64_t> other) {
  const bool is_communication = entry.index >= 0x1000 && entry.index < 0x2000;
  const bool has_meaning =
      entry.meaning && (entry.meaning->quantity || entry.meaning->values || entry.meaning->has_fields());
  if (!is_communication || has_meaning || entry.type->type != DataType::unsigned32 ||
      bytes.size() != sizeof(std::uint32_t)) {
    return append_by_meaning(text, entry, bytes, other);
  }
  append_hex_number(text, number_of(bytes), 8);
}

std::string value_text(const Entry& entry, Bytes bytes, std::optional<std::int64_t> other) {
  std::string text;
  append_value(text, entry, bytes, other);
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

ParsedValue parse_unchecked(const Entry& entry, std::string_view text) {
  const DataTypeRow& type = *entry.type;
  if (!is_number(type)) return parse_value_text(type, text);
  text = trim(text);
  ParsedValue result;
  const auto take = [&](const RawNumber& raw) {
    if (raw.ok()) {
      result = {bytes_of(raw.bits, bytes_for(type.bits)), ""};
    } else {
      result.problem = fmt::format("{}: {} \"{}\"", raw.problem, entry_label(entry.index, entry.sub_index), entry.name);
    }
  };
  result = parse_value_text(type, text);  // 10h is 16, 10 h are hours
  const Quantity* const quantity = quantity_of(entry);
  if (!result.ok() && quantity != nullptr) {
    if (const auto physical = split_physical(text)) take(raw_number(*quantity, type, *physical));
  }
  const Meaning* const meaning = meaning_of_integer(entry);
  const bool has_names = meaning != nullptr && (meaning->values || meaning->has_fields());
  if (has_names && !is_digit(text.empty() ? '0' : text.front())) {
    // A name may look like a number: each, or 0EACh.
    const RawNumber named = named_number(*meaning, type, text);
    if (named.ok() || !result.ok()) take(named);
  }
  if (has_names && !result.ok()) {
    if (auto with_names = number_with_names(entry, text)) result = std::move(*with_names);
  }
  if (!result.ok()) result.bytes.clear();
  return result;
}

ParsedValue parse_value_text(const Entry& entry, std::string_view text) {
  ParsedValue result = parse_unchecked(entry, text);
  if (!result.ok() || !is_number(*entry.type)) return result;
  result.problem = limit_problem(entry, number_of(result.bytes), trim(text));
  if (result.ok()) result.problem = closed_problem(entry, number_of(result.bytes), trim(text));
  if (!result.ok()) result.bytes.clear();
  return result;
}

}  // namespace edsc
