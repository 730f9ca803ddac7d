/// The alignment of an address, for the compiler.
#pragma once

#include <cstddef>
#include <type_traits>

namespace canopen {

/// Returns an address that is a multiple of `Alignment`. The same as std::assume_aligned: its header, `<memory>`, has
/// shared pointers and locales, and takes the compiler as long as half of this runtime.
template <std::size_t Alignment, class Type>
[[nodiscard]] constexpr Type* assume_aligned(Type* address) {
  if (std::is_constant_evaluated()) return address;
  return static_cast<Type*>(__builtin_assume_aligned(address, Alignment));
}

}  // namespace canopen
