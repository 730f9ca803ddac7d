#include "format/spelling/key_table.hpp"

#include <limits>

namespace edsc {
namespace {

constexpr unsigned number_bits = 32;

std::uint64_t order_of(EntryOrder order, std::uint64_t row, const SectionKey& key, std::uint64_t number) {
  const bool number_first = order == EntryOrder::number && key.is_numbered();
  if (number_first) return ((number + 1) << number_bits) | row;
  return (row << number_bits) | (order == EntryOrder::row ? number : 0);
}

}  // namespace

KeySpelling spell_key(const SectionName& section, std::string_view key) {
  const bool is_in_module = section.kind == SectionKind::module_fixed_object;
  const SectionRow* const known = find_section(is_in_module ? section.part : section.kind);
  std::uint64_t row = 0;
  for (const SectionKey& one : known != nullptr ? known->keys : std::span<const SectionKey>{}) {
    if (const auto number = match_key(one, key)) {
      return {.identity = (row << number_bits) | *number,
              .order = order_of(known->order, row, one, *number),
              .name = spell_numbered_key(one, *number),
              .value = one.value,
              .hex_digits = one.hex_digits,
              .number = *number,
              .is_numbered = one.is_numbered(),
              .is_known = true};
    }
    ++row;
  }
  KeySpelling unknown;
  unknown.order = std::numeric_limits<std::uint64_t>::max();
  unknown.name = key;
  return unknown;
}

}  // namespace edsc
