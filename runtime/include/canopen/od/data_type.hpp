/// The basic data types of CiA 301, 7.4.7, table 44, one row each. The generator and the runtime share this table.
#pragma once

#include <array>
#include <cstdint>
#include <string_view>

namespace canopen {

enum class DataType : std::uint8_t {
  boolean = 0x01,
  integer8 = 0x02,
  integer16 = 0x03,
  integer32 = 0x04,
  unsigned8 = 0x05,
  unsigned16 = 0x06,
  unsigned32 = 0x07,
  real32 = 0x08,
  visible_string = 0x09,
  octet_string = 0x0A,
  unicode_string = 0x0B,
  time_of_day = 0x0C,
  time_difference = 0x0D,
  domain = 0x0F,
  integer24 = 0x10,
  real64 = 0x11,
  integer40 = 0x12,
  integer48 = 0x13,
  integer56 = 0x14,
  integer64 = 0x15,
  unsigned24 = 0x16,
  unsigned40 = 0x18,
  unsigned48 = 0x19,
  unsigned56 = 0x1A,
  unsigned64 = 0x1B,
};

enum class DataClass : std::uint8_t { boolean, unsigned_integer, signed_integer, real, string, time, domain };

struct DataTypeRow {
  DataType type;
  DataClass kind;
  std::uint8_t bits;          ///< on the wire; 0: variable length
  std::string_view name;      ///< as CiA 301 spells it
  std::string_view cpp_type;  ///< type that an application uses; for a string, its class template
};

inline constexpr DataTypeRow data_types[] = {
    {DataType::boolean, DataClass::boolean, 1, "BOOLEAN", "bool"},
    {DataType::integer8, DataClass::signed_integer, 8, "INTEGER8", "std::int8_t"},
    {DataType::integer16, DataClass::signed_integer, 16, "INTEGER16", "std::int16_t"},
    {DataType::integer24, DataClass::signed_integer, 24, "INTEGER24", "std::int32_t"},
    {DataType::integer32, DataClass::signed_integer, 32, "INTEGER32", "std::int32_t"},
    {DataType::integer40, DataClass::signed_integer, 40, "INTEGER40", "std::int64_t"},
    {DataType::integer48, DataClass::signed_integer, 48, "INTEGER48", "std::int64_t"},
    {DataType::integer56, DataClass::signed_integer, 56, "INTEGER56", "std::int64_t"},
    {DataType::integer64, DataClass::signed_integer, 64, "INTEGER64", "std::int64_t"},
    {DataType::unsigned8, DataClass::unsigned_integer, 8, "UNSIGNED8", "std::uint8_t"},
    {DataType::unsigned16, DataClass::unsigned_integer, 16, "UNSIGNED16", "std::uint16_t"},
    {DataType::unsigned24, DataClass::unsigned_integer, 24, "UNSIGNED24", "std::uint32_t"},
    {DataType::unsigned32, DataClass::unsigned_integer, 32, "UNSIGNED32", "std::uint32_t"},
    {DataType::unsigned40, DataClass::unsigned_integer, 40, "UNSIGNED40", "std::uint64_t"},
    {DataType::unsigned48, DataClass::unsigned_integer, 48, "UNSIGNED48", "std::uint64_t"},
    {DataType::unsigned56, DataClass::unsigned_integer, 56, "UNSIGNED56", "std::uint64_t"},
    {DataType::unsigned64, DataClass::unsigned_integer, 64, "UNSIGNED64", "std::uint64_t"},
    {DataType::real32, DataClass::real, 32, "REAL32", "float"},
    {DataType::real64, DataClass::real, 64, "REAL64", "double"},
    {DataType::time_of_day, DataClass::time, 48, "TIME_OF_DAY", "canopen::TimeOfDay"},
    {DataType::time_difference, DataClass::time, 48, "TIME_DIFFERENCE", "canopen::TimeDifference"},
    {DataType::visible_string, DataClass::string, 0, "VISIBLE_STRING", "canopen::VisibleString"},
    {DataType::octet_string, DataClass::string, 0, "OCTET_STRING", "canopen::OctetString"},
    {DataType::unicode_string, DataClass::string, 0, "UNICODE_STRING", "canopen::UnicodeString"},
    {DataType::domain, DataClass::domain, 0, "DOMAIN", "canopen::Domain"},
};

/// Bits of the data types 0001h..0008h, by index: those that an RPDO may map as dummies (CiA 301, 7.4.7.1).
inline constexpr auto dummy_bits = [] {
  std::array<std::uint8_t, 9> bits{};
  for (const DataTypeRow& row : data_types) {
    if (static_cast<std::uint8_t>(row.type) < bits.size()) bits[static_cast<std::uint8_t>(row.type)] = row.bits;
  }
  return bits;
}();

/// Returns the row of a basic data type by its index in the object dictionary (0001h..001Bh); null if it is not one.
[[nodiscard]] constexpr const DataTypeRow* find_data_type(std::uint32_t index) {
  for (const auto& row : data_types) {
    if (static_cast<std::uint32_t>(row.type) == index) return &row;
  }
  return nullptr;
}

}  // namespace canopen
