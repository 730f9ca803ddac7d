#include "device/error_code_text.hpp"

#include <algorithm>
#include <canopen/emcy/emcy_consumer.hpp>

#include "device/entry_text.hpp"
#include "device/meaning/value_parts.hpp"
#include "values/append.hpp"
#include "values/little_endian.hpp"

namespace edsc {
namespace {

using canopen::DataType;

constexpr std::uint16_t error_history = 0x1003, error_code_of_drive = 0x603F;
constexpr unsigned code_bits = 16;

/// Null if neither the device nor its profile has a name for the code.
const ErrorCodeName* find(const Device& device, std::uint16_t code) {
  const auto found = std::ranges::lower_bound(device.error_codes, code, {}, &ErrorCodeName::code);
  return found != device.error_codes.end() && found->code == code ? &*found : nullptr;
}

bool is_known(std::uint16_t code) {
  return std::ranges::any_of(canopen::emergency_code_texts,
                             [code](const canopen::EmergencyCodeText& row) { return (code & row.mask) == row.code; });
}

/// Whether the index is 603Fh of one of the eight axes, which are 800h apart.
bool is_error_code_of_axis(std::uint16_t index) {
  constexpr unsigned axis_objects = 0x800, after_last_axis = 0xA000;
  return index >= error_code_of_drive && index < after_last_axis && (index - error_code_of_drive) % axis_objects == 0;
}

bool has_name(const Device& device, std::uint16_t code, MeaningSource source) {
  const ErrorCodeName* const found = find(device, code);
  return found != nullptr && found->source == source;
}

bool is_drive(const Device& device) {
  constexpr std::uint64_t profile_mask = 0xFFFF, drives = 402;
  const Entry* const type = device.find(0x1000, 0);
  return type != nullptr && type->default_value && (type->default_value->bits & profile_mask) == drives;
}

}  // namespace

std::string_view error_code_text(const Device* device, std::uint16_t code) {
  if (device != nullptr) {
    if (const ErrorCodeName* const found = find(*device, code)) return found->text;
  }
  // Profiles and manufacturers define their own codes in the error classes of CiA 301.
  return canopen::emergency_text(is_known(code) ? code : static_cast<std::uint16_t>(code & 0xF000));
}

bool is_error(const Device* device, std::uint16_t code) {
  constexpr std::uint16_t last_reset_code = 0x00FF;
  if (code > last_reset_code) return true;
  return device != nullptr && code != 0 && has_name(*device, code, MeaningSource::options);
}

void append_error_code(std::string& text, const Device* device, std::uint16_t code) {
  append_hex_number(text, code, code_bits / 4);
  text += ' ';
  text += error_code_text(device, code);
}

ErrorCodePlace error_code_place(const Device& device, const Entry& entry) {
  if (entry.index == error_history && entry.sub_index != 0 && entry.type->type == DataType::unsigned32) {
    return ErrorCodePlace::low_word;
  }
  const bool has_own_names = entry.meaning && (entry.meaning->values || entry.meaning->has_fields());
  const bool is_code = !has_own_names && entry.sub_index == 0 && entry.type->type == DataType::unsigned16 &&
                       is_error_code_of_axis(entry.index) && is_drive(device);
  return is_code ? ErrorCodePlace::value : ErrorCodePlace::none;
}

void append_error_value(std::string& text, const Device& device, const Entry& entry, std::uint32_t value) {
  const auto code = static_cast<std::uint16_t>(value);
  if (entry.index != error_history) return append_error_code(text, &device, code);
  append_hex_number(text, value, 8);
  text += ' ';
  text += error_code_text(&device, code);
  const std::uint32_t rest = value >> code_bits << code_bits;
  if (rest == 0 || !entry.meaning) return;
  std::string parts;
  for_each_part(*entry.meaning, rest, std::nullopt, [&](const ValuePart& part) {
    if (part.field != nullptr && part.field->first_bit >= code_bits && part.number != 0) {
      append_part(parts.append(", "), part);
    }
  });
  text += parts;
}

void append_device_value(std::string& text, const Device& device, const Entry& entry,
                         std::span<const std::uint8_t> bytes, std::optional<std::int64_t> other) {
  if (error_code_place(device, entry) != ErrorCodePlace::none && bytes.size() == bytes_for(entry.type->bits)) {
    return append_error_value(text, device, entry, static_cast<std::uint32_t>(number_of(bytes)));
  }
  append_value(text, entry, bytes, other);
}

}  // namespace edsc
