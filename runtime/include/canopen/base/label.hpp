/// Types that make compilers name PDOs, entries and objects in their messages: template arguments that print well.
#pragma once

#include <cstddef>
#include <cstdint>
#include <type_traits>

namespace canopen {

template <std::uint16_t Number>
struct RpdoNumber {
  static constexpr std::uint16_t number = Number;
  static constexpr bool receive = true;
};
template <std::uint16_t Number>
struct TpdoNumber {
  static constexpr std::uint16_t number = Number;
  static constexpr bool receive = false;
};

/// Number of an entry from 1, like the sub-indices of a mapping parameter.
template <std::size_t Number>
struct EntryNumber {};

/// `ObjectAt<'6', '0', '4', '1', 'h', ':', '0', '0'>`
template <char... Label>
struct ObjectAt {};

/// `CanId<'1', '8', '1', 'h'>`
template <char... Label>
struct CanId {};

namespace pdo_detail {

[[nodiscard]] constexpr char hex_digit(std::uint32_t value, unsigned place) {
  return "0123456789ABCDEF"[(value >> (4 * place)) & 0xF];
}

template <class Object>
using LabelOf =
    ObjectAt<hex_digit(Object::index, 3), hex_digit(Object::index, 2), hex_digit(Object::index, 1),
             hex_digit(Object::index, 0), 'h', ':', hex_digit(Object::sub_index, 1), hex_digit(Object::sub_index, 0)>;

template <std::uint32_t Id>
using CanIdLabel =
    std::conditional_t<(Id <= 0x7FF), CanId<hex_digit(Id, 2), hex_digit(Id, 1), hex_digit(Id, 0), 'h'>,
                       CanId<hex_digit(Id, 7), hex_digit(Id, 6), hex_digit(Id, 5), hex_digit(Id, 4), hex_digit(Id, 3),
                             hex_digit(Id, 2), hex_digit(Id, 1), hex_digit(Id, 0), 'h'>>;

}  // namespace pdo_detail
}  // namespace canopen
