#include "device/sheet.hpp"

#include <algorithm>

namespace edsc {

using canopen::object_key;

bool Sheet::triggers_event(std::uint16_t index, std::uint8_t sub_index) const {
  if (without_event.empty()) return true;
  const auto of_object = without_event.find(object_key(index, 0));
  if (of_object != without_event.end() && of_object->second) return false;
  return !without_event.contains(object_key(index, sub_index));
}

std::array<std::uint8_t, 5> Sheet::emergency_info(std::uint16_t code) const {
  const auto at = emergency_infos.find(code);
  return at != emergency_infos.end() ? at->second : std::array<std::uint8_t, 5>{};
}

bool Sheet::is_closed(std::uint16_t index, std::uint8_t sub_index) const {
  return !accepted.empty() && accepted.contains(object_key(index, sub_index));
}

canopen::AbortCode Sheet::check_closed(std::uint16_t index, std::uint8_t sub_index,
                                       std::span<const std::uint8_t> bytes) const {
  const auto at = accepted.find(object_key(index, sub_index));
  if (at == accepted.end()) return canopen::ok;
  const canopen::entry::Word word = dictionary.find(index, sub_index);
  const bool is_signed = canopen::entry::class_of(word) == canopen::entry::Class::signed_integer;
  const bool negative = is_signed && !bytes.empty() && (bytes.back() & 0x80) != 0;
  std::uint64_t bits = negative ? ~std::uint64_t{0} : 0;
  for (std::size_t i = bytes.size(); i-- > 0;) bits = bits << 8 | bytes[i];
  const auto value = static_cast<std::int64_t>(bits);
  const auto has = [value](const SheetAcceptedRange& range) { return value >= range.low && value <= range.high; };
  return std::ranges::any_of(at->second, has) ? canopen::ok : canopen::AbortCode::invalid_value;
}

}  // namespace edsc
