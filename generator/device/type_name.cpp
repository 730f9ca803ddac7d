#include "device/type_name.hpp"

#include <algorithm>
#include <iterator>

#include "eds/ini.hpp"

namespace edsc {
namespace {

using canopen::DataType;

struct TypeAlias {
  std::string_view name;
  DataType type;
};

// clang-format off
constexpr TypeAlias aliases[] = {
    {"bool", DataType::boolean},
    {"int8", DataType::integer8},
    {"int8_t", DataType::integer8},
    {"i8", DataType::integer8},
    {"int16", DataType::integer16},
    {"int16_t", DataType::integer16},
    {"i16", DataType::integer16},
    {"short", DataType::integer16},
    {"int32", DataType::integer32},
    {"int32_t", DataType::integer32},
    {"i32", DataType::integer32},
    {"int", DataType::integer32},
    {"int64", DataType::integer64},
    {"int64_t", DataType::integer64},
    {"i64", DataType::integer64},
    {"uint8", DataType::unsigned8},
    {"uint8_t", DataType::unsigned8},
    {"u8", DataType::unsigned8},
    {"byte", DataType::unsigned8},
    {"uint16", DataType::unsigned16},
    {"uint16_t", DataType::unsigned16},
    {"u16", DataType::unsigned16},
    {"word", DataType::unsigned16},
    {"uint32", DataType::unsigned32},
    {"uint32_t", DataType::unsigned32},
    {"u32", DataType::unsigned32},
    {"dword", DataType::unsigned32},
    {"uint64", DataType::unsigned64},
    {"uint64_t", DataType::unsigned64},
    {"u64", DataType::unsigned64},
    {"float", DataType::real32},
    {"real", DataType::real32},
    {"double", DataType::real64},
    {"string", DataType::visible_string},
};
// clang-format on

}  // namespace

const canopen::DataTypeRow* find_type_by_name(std::string_view name) {
  for (const canopen::DataTypeRow& row : canopen::data_types) {
    if (equal_ignoring_case(row.name, name)) return &row;
  }
  const auto* const alias =
      std::ranges::find_if(aliases, [&](const TypeAlias& row) { return equal_ignoring_case(row.name, name); });
  return alias == std::end(aliases) ? nullptr : canopen::find_data_type(static_cast<std::uint32_t>(alias->type));
}

}  // namespace edsc
