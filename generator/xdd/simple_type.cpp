#include "xdd/simple_type.hpp"

namespace edsc {
namespace {

constexpr SimpleType simple_types[] = {
    {"BOOL", "0x0001"},   {"SINT", "0x0002"},  {"INT", "0x0003"},     {"DINT", "0x0004"},     {"LINT", "0x0015"},
    {"USINT", "0x0005"},  {"UINT", "0x0006"},  {"UDINT", "0x0007"},   {"ULINT", "0x001B"},    {"BYTE", "0x0005"},
    {"WORD", "0x0006"},   {"DWORD", "0x0007"}, {"LWORD", "0x001B"},   {"REAL", "0x0008"},     {"LREAL", "0x0011"},
    {"STRING", "0x0009"}, {"CHAR", "0x0009"},  {"WSTRING", "0x000B"}, {bit_string, "0x000A"},
};

constexpr SimpleType domain{bit_string, "0x000F"};

}  // namespace

const SimpleType* find_simple_type(std::string_view name) {
  for (const SimpleType& row : simple_types) {
    if (row.name == name) return &row;
  }
  return nullptr;
}

const SimpleType& domain_type() { return domain; }

}  // namespace edsc
