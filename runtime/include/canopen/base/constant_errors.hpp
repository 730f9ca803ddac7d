/// Compile errors for values that an object does not accept. The message has the arguments of the template: the object,
/// the unit, and the nearest values.
///
/// Functions, not classes: Clang reports the use of a class with a failed assertion a second time. Each is called by
/// the function that the application calls: Clang prints three lines for each template between. node.hpp and
/// remote_node.hpp include this file first, because compilers print the chain of includes that leads to it.
#pragma once

namespace canopen {

/// `Text<'2', '1', '.', '5', '_', 'd', 'e', 'g', 'C'>`: text that each compiler prints in its messages.
template <char... Characters>
struct Text {};

namespace constant_error {

/// False; depends on a template argument.
template <class>
inline constexpr bool never = false;

template <class Object, class Value, class NextValue>
constexpr void between() {
  static_assert(never<Object>, "this constant is between two values of the object, which this message names");
}
template <class Object, class HighestValue>
constexpr void above() {
  static_assert(never<Object>, "this constant is above the highest value of the object, which this message names");
}
template <class Object, class LowestValue>
constexpr void below() {
  static_assert(never<Object>, "this constant is below the lowest value of the object, which this message names");
}
template <class Object, class Unit>
constexpr void other_dimension() {
  static_assert(never<Object>, "this unit is of another dimension than the object");
}
template <class Object, class Unit>
constexpr void not_exact() {
  static_assert(never<Object>, "the factor between these units is not exact: use a unit of the other kind, or in<>()");
}
template <class Object, class Unit>
constexpr void too_wide() {
  static_assert(never<Object>, "this conversion needs numbers of more than 64 bits: use in<>(), or a coarser step");
}
template <class Left, class Right>
constexpr void number_compared() {
  static_assert(never<Left>, "a number without a unit is compared: write the unit, or compare .raw()");
}
template <class Left, class Right>
constexpr void others_compared() {
  static_assert(never<Left>, "values of different objects or dimensions are compared");
}
template <class Left, class Right>
constexpr void number_added() {
  static_assert(never<Left>, "a number without a unit is added or subtracted: write the unit");
}
template <class Left, class Right>
constexpr void others_added() {
  static_assert(never<Left>, "values of different dimensions are added or subtracted");
}
template <class Left, class Right>
constexpr void points_added() {
  static_assert(never<Left>, "temperatures are not added: add or subtract a difference, such as 0.5_K");
}
template <class Object, class Number>
constexpr void number() {
  static_assert(never<Object>,
                "a number without meaning: give the value by its name, with its unit or as "
                "canopen::raw(n)");
}
template <class Object, class Value>
constexpr void value_of_another() {
  static_assert(never<Object>, "a value of another object: names and fields belong to one object");
}

// A constant that is not accepted reads the element after the only one: the message has the name of the array.
template <unsigned Bits>
inline constexpr bool constant_is_outside_the_range_of_the_field[1] = {};

}  // namespace constant_error
}  // namespace canopen
