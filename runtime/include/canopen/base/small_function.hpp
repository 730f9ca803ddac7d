/// A function of the application that is kept without heap.
#pragma once

#include <cstddef>
#include <new>
#include <type_traits>
#include <utility>

namespace canopen {

template <class Signature>
class SmallFunction;

/// Keeps a function, or a lambda that captures up to two pointers or references, by value. Calling an empty one has no
/// effect.
template <class... Arguments>
class SmallFunction<void(Arguments...)> {
 public:
  static constexpr std::size_t capacity = 2 * sizeof(void*);  ///< bytes of the captures

  constexpr SmallFunction() = default;

  template <class Function>
  requires(!std::is_same_v<std::decay_t<Function>, SmallFunction> &&
           std::is_invocable_v<std::decay_t<Function>&, Arguments...>)
      // NOLINTNEXTLINE(bugprone-forwarding-reference-overload): clang-tidy 14 does not see the constraint
      SmallFunction(Function&& function) {
    using Kept = std::decay_t<Function>;
    static_assert(sizeof(Kept) <= capacity && alignof(Kept) <= alignof(void*),
                  "the lambda captures more than two pointers or references; capture a struct by reference");
    static_assert(std::is_trivially_copyable_v<Kept>,
                  "the lambda captures an object with a copy constructor or a destructor by value");
    ::new (static_cast<void*>(memory_)) Kept(std::forward<Function>(function));
    call_ = [](std::byte* memory, Arguments... arguments) {
      static_cast<void>((*std::launder(reinterpret_cast<Kept*>(memory)))(std::forward<Arguments>(arguments)...));
    };
  }

  [[nodiscard]] explicit operator bool() const { return call_ != nullptr; }

  void operator()(Arguments... arguments) {
    if (call_ != nullptr) call_(memory_, std::forward<Arguments>(arguments)...);
  }

 private:
  alignas(void*) std::byte memory_[capacity]{};
  void (*call_)(std::byte*, Arguments...) = nullptr;
};

}  // namespace canopen
