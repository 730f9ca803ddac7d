#include "live/identity.hpp"

#include <fmt/format.h>

namespace edsc {
namespace {

struct Number {
  std::string_view name;
  std::optional<std::uint32_t> Identity::*value;
  Fit difference;
};

constexpr Number numbers[] = {
    {"device type", &Identity::device_type, Fit::other},
    {"vendor-ID", &Identity::vendor_id, Fit::other},
    {"product code", &Identity::product_code, Fit::other},
    {"revision number", &Identity::revision_number, Fit::major_revision},
    {"serial number", &Identity::serial_number, Fit::other},
};

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

std::string_view to_text(Fit fit) {
  switch (fit) {
    case Fit::same: return "same device";
    case Fit::minor_revision: return "other minor revision";
    case Fit::major_revision: return "other major revision";
    case Fit::other: return "other device";
    case Fit::unknown: return "not known";
  }
  return {};
}

Fit compare_identity(const Identity& sheet, const Identity& device) {
  if (!sheet.vendor_id || !device.vendor_id) return Fit::unknown;
  Fit fit = Fit::same;
  for (const Number& number : numbers) {
    if (!differs(sheet.*number.value, device.*number.value)) continue;
    if (number.difference == Fit::other) return Fit::other;
    const bool same_major = (*(sheet.*number.value) >> 16) == (*(device.*number.value) >> 16);
    fit = same_major ? Fit::minor_revision : Fit::major_revision;
  }
  return fit;
}

std::string identity_differences(const Identity& sheet, const Identity& device) {
  std::string text;
  for (const Number& number : numbers) {
    if (!differs(sheet.*number.value, device.*number.value)) continue;
    text += fmt::format("{}{} is {:08X}h, not {:08X}h", text.empty() ? "" : "; ", number.name, *(device.*number.value),
                        *(sheet.*number.value));
  }
  return text;
}

}  // namespace edsc
