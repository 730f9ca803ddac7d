/// Objects of device profiles: required objects and their data types.
#pragma once

#include <array>
#include <canopen/od/data_type.hpp>
#include <cstdint>
#include <string_view>

#include "rules/check_rules.hpp"

namespace edsc {

/// A device of the profile has one of these objects.
struct ProfileNeed {
  AnyRule rule;
  std::uint16_t profile;
  std::array<std::uint16_t, 3> one_of;  ///< unused elements are 0
  std::string_view name;
};

inline constexpr ProfileNeed profile_needs[] = {
    {"profile-402-object", 402, {0x6040}, "controlword"},
    {"profile-402-object", 402, {0x6041}, "statusword"},
    {"profile-402-object", 402, {0x6060}, "modes of operation"},
    {"profile-402-object", 402, {0x6061}, "modes of operation display"},
    {"profile-402-modes", 402, {0x6502}, "supported drive modes"},
    {"profile-406-object", 406, {0x6000}, "operating parameters"},
    {"profile-406-object", 406, {0x6004, 0x6020, 0x6008}, "position value"},
    {"profile-406-object", 406, {0x6500}, "operating status"},
};

/// The data type of an object's value, or of its elements.
struct ProfileType {
  std::uint16_t profile;
  std::uint16_t index;
  canopen::DataType type;
};

namespace profile_rows {

using enum canopen::DataType;

inline constexpr ProfileType types[] = {
    // CiA 401: inputs and outputs.
    {401, 0x6000, unsigned8},
    {401, 0x6002, unsigned8},
    {401, 0x6020, boolean},
    {401, 0x6100, unsigned16},
    {401, 0x6120, unsigned32},
    {401, 0x6200, unsigned8},
    {401, 0x6202, unsigned8},
    {401, 0x6206, unsigned8},
    {401, 0x6207, unsigned8},
    {401, 0x6220, boolean},
    {401, 0x6300, unsigned16},
    {401, 0x6320, unsigned32},
    {401, 0x6400, integer8},
    {401, 0x6401, integer16},
    {401, 0x6402, integer32},
    {401, 0x6403, real32},
    {401, 0x6410, integer8},
    {401, 0x6411, integer16},
    {401, 0x6412, integer32},
    {401, 0x6413, real32},
    {401, 0x6423, boolean},
    // CiA 402: drives.
    {402, 0x603F, unsigned16},
    {402, 0x6040, unsigned16},
    {402, 0x6041, unsigned16},
    {402, 0x6042, integer16},
    {402, 0x6043, integer16},
    {402, 0x6044, integer16},
    {402, 0x605A, integer16},
    {402, 0x605B, integer16},
    {402, 0x605C, integer16},
    {402, 0x605D, integer16},
    {402, 0x605E, integer16},
    {402, 0x6060, integer8},
    {402, 0x6061, integer8},
    {402, 0x6062, integer32},
    {402, 0x6063, integer32},
    {402, 0x6064, integer32},
    {402, 0x6065, unsigned32},
    {402, 0x6066, unsigned16},
    {402, 0x6067, unsigned32},
    {402, 0x6068, unsigned16},
    {402, 0x606B, integer32},
    {402, 0x606C, integer32},
    {402, 0x6071, integer16},
    {402, 0x6072, unsigned16},
    {402, 0x6073, unsigned16},
    {402, 0x6074, integer16},
    {402, 0x6075, unsigned32},
    {402, 0x6076, unsigned32},
    {402, 0x6077, integer16},
    {402, 0x6078, integer16},
    {402, 0x6079, unsigned32},
    {402, 0x607A, integer32},
    {402, 0x607C, integer32},
    {402, 0x607F, unsigned32},
    {402, 0x6081, unsigned32},
    {402, 0x6083, unsigned32},
    {402, 0x6084, unsigned32},
    {402, 0x6085, unsigned32},
    {402, 0x6086, integer16},
    {402, 0x6087, unsigned32},
    {402, 0x6098, integer8},
    {402, 0x609A, unsigned32},
    {402, 0x60F4, integer32},
    {402, 0x60FA, integer32},
    {402, 0x60FD, unsigned32},
    {402, 0x60FF, integer32},
    {402, 0x6502, unsigned32},
    // CiA 406: encoders.
    {406, 0x6000, unsigned16},
    {406, 0x6001, unsigned32},
    {406, 0x6002, unsigned32},
    {406, 0x6003, unsigned32},
    {406, 0x6004, unsigned32},
    {406, 0x6020, integer32},
    {406, 0x6030, integer16},
    {406, 0x6200, unsigned16},
    {406, 0x6500, unsigned16},
    {406, 0x6501, unsigned32},
    {406, 0x6502, unsigned16},
    {406, 0x6503, unsigned16},
    {406, 0x6504, unsigned16},
    {406, 0x6505, unsigned16},
    {406, 0x6506, unsigned16},
    {406, 0x6507, unsigned32},
    {406, 0x6508, unsigned32},
    {406, 0x6509, integer32},
    {406, 0x650B, unsigned32},
};

}  // namespace profile_rows

inline constexpr auto& profile_types = profile_rows::types;

}  // namespace edsc
