#include "device/meaning/meaning.hpp"

#include <algorithm>
#include <cstddef>

namespace edsc {

std::string_view to_string(MeaningSource source) {
  constexpr std::string_view names[] = {"options", "eds", "profile"};
  return names[static_cast<std::size_t>(source)];
}

const NamedValue* Enumeration::find(std::int64_t value) const {
  const auto at = std::ranges::lower_bound(values, value, {}, &NamedValue::value);
  return at != values.end() && at->value == value ? &*at : nullptr;
}

const NamedValue* Enumeration::find(std::string_view name) const {
  const auto at = std::ranges::find(values, name, &NamedValue::name);
  return at == values.end() ? nullptr : &*at;
}

std::uint64_t BitField::mask() const {
  const std::uint64_t low = bits >= 64 ? ~std::uint64_t{0} : (std::uint64_t{1} << bits) - 1;
  return low << first_bit;
}

std::int64_t BitField::of(std::uint64_t raw) const {
  const std::uint64_t number = (raw & mask()) >> first_bit;
  const bool is_negative = is_signed && ((number >> (bits - 1)) & 1) != 0;
  return static_cast<std::int64_t>(is_negative && bits < 64 ? number | (~std::uint64_t{0} << bits) : number);
}

const MaskedValue* MaskedGroup::find(std::uint64_t raw) const {
  const auto at = std::ranges::find_if(values, [&](const MaskedValue& one) { return (raw & one.mask) == one.value; });
  return at == values.end() ? nullptr : &*at;
}

const FieldCase* Meaning::find_case(std::int64_t value) const {
  const auto at =
      std::ranges::find_if(cases, [&](const FieldCase& one) { return std::ranges::binary_search(one.values, value); });
  return at == cases.end() ? nullptr : &*at;
}

}  // namespace edsc
