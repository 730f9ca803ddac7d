#include "device/types/type_name.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <bit>
#include <iterator>
#include <string>

#include "eds/ini.hpp"

namespace edsc {
namespace {

using canopen::DataClass;
using canopen::DataType;

struct TypeAlias {
  std::string_view name;
  DataType type;
};

/// Names other than those that follow from sign and length.
constexpr TypeAlias aliases[] = {
    {"bool", DataType::boolean},          {"short", DataType::integer16}, {"int", DataType::integer32},
    {"byte", DataType::unsigned8},        {"word", DataType::unsigned16}, {"dword", DataType::unsigned32},
    {"float", DataType::real32},          {"real", DataType::real32},     {"double", DataType::real64},
    {"string", DataType::visible_string},
};

/// `int8`, `int8_t`, `i8`, `uint8`, `uint8_t` or `u8`: an integer of a length that programming languages have.
bool is_integer_name(const canopen::DataTypeRow& type, std::string_view name) {
  const bool is_signed = type.kind == DataClass::signed_integer;
  if ((!is_signed && type.kind != DataClass::unsigned_integer) || !std::has_single_bit(unsigned{type.bits}))
    return false;
  const std::string names[] = {fmt::format("{}{}", is_signed ? "int" : "uint", type.bits),
                               fmt::format("{}{}_t", is_signed ? "int" : "uint", type.bits),
                               fmt::format("{}{}", is_signed ? "i" : "u", type.bits)};
  return std::ranges::any_of(names, [&](const std::string& known) { return equal_ignoring_case(known, name); });
}

}  // namespace

const canopen::DataTypeRow* find_type_by_name(std::string_view name) {
  for (const canopen::DataTypeRow& row : canopen::data_types) {
    if (equal_ignoring_case(row.name, name) || is_integer_name(row, name)) return &row;
  }
  const auto* const alias =
      std::ranges::find_if(aliases, [&](const TypeAlias& row) { return equal_ignoring_case(row.name, name); });
  return alias == std::end(aliases) ? nullptr : canopen::find_data_type(static_cast<std::uint32_t>(alias->type));
}

}  // namespace edsc
