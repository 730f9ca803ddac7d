/// The objects of a node as numbers, whose sizes and presence its EDS decides.
#pragma once

#include <cstdint>
#include <optional>
#include <type_traits>
#include <vector>

#include "device/behaviour.hpp"
#include "values/little_endian.hpp"

namespace edsc {

/// Returns an integer of the node, sign-extended if `Type` is signed; nothing if the device does not have the object.
template <class Type>
[[nodiscard]] std::optional<Type> integer_of(BehaviourTarget& target, std::uint16_t index, std::uint8_t sub_index) {
  const std::optional<std::vector<std::uint8_t>> bytes = target.get(index, sub_index);
  if (!bytes || bytes->empty() || bytes->size() > sizeof(std::uint64_t)) return std::nullopt;
  const std::uint64_t bits = number_of(*bytes);
  if constexpr (std::is_signed_v<Type>) {
    return static_cast<Type>(sign_extended(bits, 8 * static_cast<unsigned>(bytes->size())));
  } else {
    return static_cast<Type>(bits);
  }
}

/// Sets an integer, if the device has it and its value differs: a new value can cause a TPDO.
template <class Type>
void set_integer(BehaviourTarget& target, std::uint16_t index, std::uint8_t sub_index, Type value) {
  const std::optional<std::vector<std::uint8_t>> present = target.get(index, sub_index);
  if (!present || present->empty() || present->size() > sizeof(std::uint64_t)) return;
  const auto bytes = bytes_of(static_cast<std::uint64_t>(static_cast<std::int64_t>(value)), present->size());
  if (bytes != *present) static_cast<void>(target.set(index, sub_index, bytes));
}

}  // namespace edsc
