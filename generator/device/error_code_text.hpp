/// Error codes of EMCY messages, 1003h and 603Fh as text.
#pragma once

#include <cstdint>
#include <optional>
#include <span>
#include <string>
#include <string_view>

#include "device/device.hpp"

namespace edsc {

/// The name that the options of the device or its profile give to an error code; otherwise the error class of CiA 301.
/// `device` may be null: only CiA 301 applies then.
[[nodiscard]] std::string_view error_code_text(const Device* device, std::uint16_t code);

/// Whether a code is an error and not its end: 0000h to 00FFh are the end (CiA 301, 7.2.7.1), except those that the
/// options of the device name.
[[nodiscard]] bool is_error(const Device* device, std::uint16_t code);

/// Appends `8611h following error`.
void append_error_code(std::string& text, const Device* device, std::uint16_t code);

/// Where an entry has an error code.
enum class ErrorCodePlace : std::uint8_t {
  none,
  value,     ///< it is the value: 603Fh of a drive, for each of its axes, unless the entry has names of its own
  low_word,  ///< bits 0..15: 1003h:01 to 1003h:FE
};
[[nodiscard]] ErrorCodePlace error_code_place(const Device& device, const Entry& entry);

/// Appends what `value_text` returns, with the name of an error code. `other`: the value of the object on which fields
/// depend; nothing if it is unknown.
void append_device_value(std::string& text, const Device& device, const Entry& entry,
                         std::span<const std::uint8_t> bytes, std::optional<std::int64_t> other = std::nullopt);

/// Appends a value of an entry with an error code: `8611h following error`, `00018611h following error,
/// additional_information=0001h`.
void append_error_value(std::string& text, const Device& device, const Entry& entry, std::uint32_t value);

}  // namespace edsc
