/// Checks of a value whose object is known at compile time.
#pragma once

#include <cstdint>
#include <type_traits>

#include "canopen/base/abort_code.hpp"
#include "canopen/od/object.hpp"
#include "canopen/od/typed_value.hpp"
#include "canopen/od/value_for.hpp"

namespace canopen {

/// Whether `set` of the application can reject a value of the object's type: the object has limits, uses fewer bits
/// than its type, or is a parameter of a service.
template <DictionaryObject Object>
inline constexpr bool can_be_refused = [] {
  using Type = RawOf<typename Object::type>;
  if (!std::is_arithmetic_v<Type>) return false;
  if (std::is_integral_v<Type> && is_communication_index(Object::index)) return true;
  return rejects_values<Object>;
}();

/// Returns value_too_high or value_too_low for a value outside the limits of its object, invalid_value for NaN.
template <DictionaryObject Object>
[[nodiscard]] constexpr AbortCode check_limits([[maybe_unused]] const typename Object::type& value) {
  if constexpr (NumberObject<Object>) return check_value<Object>(value);
  return ok;
}

}  // namespace canopen
