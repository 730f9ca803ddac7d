#include "online/identity.hpp"

#include <fmt/format.h>

#include <algorithm>

#include "online/sdo_access.hpp"
#include "values/little_endian.hpp"

namespace edsc {
namespace {

std::optional<std::uint32_t> default_of(const Device& device, std::uint16_t index, std::uint8_t sub_index) {
  const Entry* entry = device.find(index, sub_index);
  if (entry == nullptr || !entry->default_value || entry->default_value->plus_node_id) return std::nullopt;
  return static_cast<std::uint32_t>(entry->default_value->bits);
}

std::optional<std::uint32_t> unless_zero(std::optional<std::uint32_t> number, std::uint32_t otherwise = 0) {
  if (number.value_or(0) == 0) number = otherwise;
  return *number == 0 ? std::nullopt : number;
}

bool differs(std::optional<std::uint32_t> a, std::optional<std::uint32_t> b) { return a && b && *a != *b; }

}  // namespace

Identity identity_of(const Device& device) {
  Identity identity;
  identity.device_type = unless_zero(default_of(device, 0x1000, 0));
  identity.vendor_id = unless_zero(default_of(device, 0x1018, 1), device.vendor_number);
  identity.product_code = unless_zero(default_of(device, 0x1018, 2), device.product_number);
  identity.revision_number = unless_zero(default_of(device, 0x1018, 3), device.revision_number);
  if (const auto& commissioning = device.information.commissioning) {
    identity.serial_number = unless_zero(commissioning->lss_serial_number);
  }
  return identity;
}

ReadIdentity read_identity(SdoAccess& node) {
  ReadIdentity read;
  for (const IdentityNumber& number : identity_numbers) {
    constexpr std::size_t size = 4;
    const SdoOutcome outcome = node.upload(number.index, number.sub_index, SdoTransfer::segmented, {}, size);
    if (outcome.end == SdoEnd::no_answer) {
      read.unanswered = &number;
      break;
    }
    if (!outcome.done() || outcome.bytes.size() != size) continue;
    read.identity.*number.value = static_cast<std::uint32_t>(number_of(outcome.bytes));
  }
  return read;
}

bool has_numbers(const Identity& identity) {
  return std::ranges::any_of(identity_numbers,
                             [&](const IdentityNumber& number) { return (identity.*number.value).has_value(); });
}

bool fits(IdentityMatch match) {
  using enum IdentityMatch;
  return match == same || match == minor_revision || match == major_revision;
}

std::string_view to_text(IdentityMatch match) {
  constexpr std::string_view texts[] = {"same device", "other minor revision", "other major revision", "other device",
                                        "not known"};
  return texts[static_cast<std::size_t>(match)];
}

IdentityMatch compare_identity(const Identity& sheet, const Identity& device) {
  IdentityMatch match = IdentityMatch::unknown;
  for (const IdentityNumber& number : identity_numbers) {
    const auto expected = sheet.*number.value, found = device.*number.value;
    if (!expected || !found) continue;
    if (*expected == *found) {
      if (match == IdentityMatch::unknown) match = IdentityMatch::same;
      continue;
    }
    if (number.difference == IdentityMatch::other) return IdentityMatch::other;
    match = (*expected >> 16) == (*found >> 16) ? IdentityMatch::minor_revision : IdentityMatch::major_revision;
  }
  return match;
}

std::string identity_differences(const Identity& sheet, const Identity& device) {
  std::string text;
  for (const IdentityNumber& number : identity_numbers) {
    if (!differs(sheet.*number.value, device.*number.value)) continue;
    text += fmt::format("{}{} is {:08X}h, expected {:08X}h", text.empty() ? "" : "; ", number.name,
                        *(device.*number.value), *(sheet.*number.value));
  }
  return text;
}

unsigned count_differences(const Identity& sheet, const Identity& device) {
  unsigned count = 0;
  for (const IdentityNumber& number : identity_numbers)
    count += differs(sheet.*number.value, device.*number.value) ? 1 : 0;
  return count;
}

std::vector<NotCompared> not_compared(const Identity& sheet, const Identity& device) {
  std::vector<NotCompared> missing;
  for (const IdentityNumber& number : identity_numbers) {
    const bool in_sheet = (sheet.*number.value).has_value(), in_device = (device.*number.value).has_value();
    if ((in_sheet && in_device) || (!number.usual && !in_sheet)) continue;
    missing.push_back({number.name, number.key, in_sheet});
  }
  return missing;
}

std::string names_of(const std::vector<NotCompared>& numbers) {
  std::string text;
  for (const NotCompared& number : numbers) text += fmt::format("{}{}", text.empty() ? "" : ", ", number.name);
  return text;
}

}  // namespace edsc
