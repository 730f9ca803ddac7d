#include "decode/compose_pdo.hpp"

#include <fmt/format.h>

#include <algorithm>

#include "device/entry_text.hpp"
#include "values/append.hpp"
#include "values/little_endian.hpp"

namespace edsc {
namespace {

/// `RPDO 2`
std::string pdo_name(const PdoLayout& pdo) {
  return fmt::format("{} {}", pdo.direction == PdoDirection::receive ? "RPDO" : "TPDO", pdo.number);
}

bool is_value_of(const PdoValue& value, const PdoField& field) {
  return value.index == field.index && value.sub_index == field.sub_index;
}

/// Returns why this PDO cannot be sent with these values; empty if it can.
std::string problem_of(const PdoLayout& pdo, std::span<const PdoValue> values) {
  const std::string name = pdo_name(pdo);
  if (!pdo.cob_id.valid()) return fmt::format("{} is not valid: bit 31 of its COB-ID is 1", name);
  if (pdo.multiplexed) return fmt::format("{} is a multiplex PDO", name);
  for (const PdoValue& value : values) {
    const auto is_it = [&value](const PdoField& field) { return is_value_of(value, field); };
    const auto is_same = [&value](const PdoValue& other) {
      return other.index == value.index && other.sub_index == value.sub_index;
    };
    const std::string label = entry_label(value.index, value.sub_index);
    if (std::ranges::none_of(pdo.fields, is_it)) return fmt::format("{} does not map {}", name, label);
    if (std::ranges::count_if(values, is_same) > 1) return fmt::format("{} has two values", label);
  }
  return "";
}

/// Puts the value of a field into the frame; returns an error message, or nothing.
std::string put_field(const PdoField& field, std::span<const PdoValue> values, std::uint64_t& word) {
  if (field.entry == nullptr) return "";
  const auto value = std::ranges::find_if(values, [&field](const PdoValue& one) { return is_value_of(one, field); });
  const std::string label = entry_label(field.index, field.sub_index) + " " + field.name;
  if (value == values.end()) return fmt::format("missing value of {}", label);
  const ParsedValue parsed = parse_value_text(*field.entry, value->text);
  if (!parsed.ok()) return fmt::format("{}: {}", label, parsed.problem);
  word |= (number_of(parsed.bytes) & low_bits(field.bits)) << field.offset;
  return "";
}

}  // namespace

ComposedPdo compose_pdo(const PdoLayout& pdo, std::span<const PdoValue> values) {
  ComposedPdo composed;
  composed.problem = problem_of(pdo, values);
  std::uint64_t word = 0;
  for (const PdoField& field : pdo.fields) {
    if (!composed.ok()) return composed;
    composed.problem = field.is_within(classical_can)
                           ? put_field(field, values, word)
                           : fmt::format("{} maps more than {} bits", pdo_name(pdo), classical_can.bits());
  }
  composed.frame.id = pdo.cob_id.can_id();
  composed.frame.extended = pdo.cob_id.extended();
  composed.frame.size = static_cast<std::uint8_t>(bytes_for(pdo.bits));
  std::ranges::copy(bytes_of(word, composed.frame.size), composed.frame.data.begin());
  return composed;
}

}  // namespace edsc
