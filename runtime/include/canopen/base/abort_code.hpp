/// SDO abort codes (CiA 301, 7.2.4.3.17, table 22), one row each.
#pragma once

#include <cstdint>
#include <string_view>

namespace canopen {

enum class AbortCode : std::uint32_t {
  none = 0,  ///< no abort
  toggle_bit = 0x0503'0000,
  timeout = 0x0504'0000,
  command_specifier = 0x0504'0001,
  block_size = 0x0504'0002,
  sequence_number = 0x0504'0003,
  crc = 0x0504'0004,
  out_of_memory = 0x0504'0005,
  unsupported_access = 0x0601'0000,
  write_only = 0x0601'0001,
  read_only = 0x0601'0002,
  no_object = 0x0602'0000,
  not_mappable = 0x0604'0041,
  pdo_length = 0x0604'0042,
  parameter_incompatible = 0x0604'0043,
  internal_incompatibility = 0x0604'0047,
  hardware = 0x0606'0000,
  length_mismatch = 0x0607'0010,
  length_too_high = 0x0607'0012,
  length_too_low = 0x0607'0013,
  no_sub_index = 0x0609'0011,
  invalid_value = 0x0609'0030,
  value_too_high = 0x0609'0031,
  value_too_low = 0x0609'0032,
  maximum_less_than_minimum = 0x0609'0036,
  no_resource = 0x060A'0023,
  general = 0x0800'0000,
  not_stored = 0x0800'0020,
  local_control = 0x0800'0021,
  device_state = 0x0800'0022,
  no_dictionary = 0x0800'0023,
  no_data = 0x0800'0024,
  /// The other side has sent an abort with code 0000 0000h, which CiA 301 does not define. An SDO client reports this
  /// value, which is not sent, because 0 is `ok`.
  sent_as_zero = 0xED5C'0000,
};

/// No error; a handler returns it to accept an access.
inline constexpr AbortCode ok = AbortCode::none;

struct AbortCodeText {
  AbortCode code;
  std::string_view text;
};

inline constexpr AbortCodeText abort_code_texts[] = {
    {AbortCode::none, "no error"},
    {AbortCode::toggle_bit, "toggle bit not alternated"},
    {AbortCode::timeout, "SDO protocol timed out"},
    {AbortCode::command_specifier, "command specifier not valid or unknown"},
    {AbortCode::block_size, "invalid block size"},
    {AbortCode::sequence_number, "invalid sequence number"},
    {AbortCode::crc, "CRC error"},
    {AbortCode::out_of_memory, "out of memory"},
    {AbortCode::unsupported_access, "unsupported access to an object"},
    {AbortCode::write_only, "read of a write-only object"},
    {AbortCode::read_only, "write of a read-only object"},
    {AbortCode::no_object, "object does not exist"},
    {AbortCode::not_mappable, "object cannot be mapped to the PDO"},
    {AbortCode::pdo_length, "mapped objects exceed the PDO's length"},
    {AbortCode::parameter_incompatible, "parameter incompatible"},
    {AbortCode::internal_incompatibility, "internal incompatibility in the device"},
    {AbortCode::hardware, "access failed, hardware error"},
    {AbortCode::length_mismatch, "length of the value does not match"},
    {AbortCode::length_too_high, "value too long"},
    {AbortCode::length_too_low, "value too short"},
    {AbortCode::no_sub_index, "sub-index does not exist"},
    {AbortCode::invalid_value, "invalid value"},
    {AbortCode::value_too_high, "value too high"},
    {AbortCode::value_too_low, "value too low"},
    {AbortCode::maximum_less_than_minimum, "maximum is less than minimum"},
    {AbortCode::no_resource, "resource not available"},
    {AbortCode::general, "general error"},
    {AbortCode::not_stored, "data cannot be transferred or stored"},
    {AbortCode::local_control, "data cannot be stored because of local control"},
    {AbortCode::device_state, "data cannot be stored in the present device state"},
    {AbortCode::no_dictionary, "no object dictionary"},
    {AbortCode::no_data, "no data available"},
};

[[nodiscard]] constexpr std::string_view to_text(AbortCode code) {
  for (const auto& row : abort_code_texts) {
    if (row.code == code) return row.text;
  }
  return code == AbortCode::sent_as_zero ? "not an abort code of CiA 301" : "unknown abort code";
}

/// Returns the code as it is in the frame of the abort.
[[nodiscard]] constexpr std::uint32_t code_in_frame(AbortCode code) {
  return code == AbortCode::sent_as_zero ? 0 : static_cast<std::uint32_t>(code);
}

/// Returns the code of the frame of an abort, for results in which 0 means success.
[[nodiscard]] constexpr AbortCode abort_code_from(std::uint32_t in_frame) {
  return in_frame == 0 ? AbortCode::sent_as_zero : static_cast<AbortCode>(in_frame);
}

}  // namespace canopen
