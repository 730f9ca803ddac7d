/// Builds objects of a JSON view without copies.
#pragma once

#include <cstddef>
#include <nlohmann/json.hpp>
#include <utility>

namespace edsc {

namespace detail {

inline void append_members(nlohmann::ordered_json::object_t&) {}

template <class Value, class... Rest>
void append_members(nlohmann::ordered_json::object_t& object, const char* key, Value&& value, Rest&&... rest) {
  object.emplace_back(key, std::forward<Value>(value));
  append_members(object, std::forward<Rest>(rest)...);
}

}  // namespace detail

/// An object of key, value, key, value, ... in this order, with distinct keys.
template <class... KeysAndValues>
[[nodiscard]] nlohmann::ordered_json json_object(KeysAndValues&&... keys_and_values) {
  nlohmann::ordered_json::object_t object;
  object.reserve(sizeof...(keys_and_values) / 2);
  detail::append_members(object, std::forward<KeysAndValues>(keys_and_values)...);
  return object;
}

/// An empty array with room for `size` items.
[[nodiscard]] inline nlohmann::ordered_json json_array(std::size_t size) {
  nlohmann::ordered_json::array_t array;
  array.reserve(size);
  return array;
}

}  // namespace edsc
