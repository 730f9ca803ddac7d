/// State of a node while it calls a read or write handler.
#pragma once

#include <cstdint>
#include <type_traits>

#include "canopen/nmt/nmt.hpp"

namespace canopen {

/// Records what a read or write handler does with its node: an NMT command is executed after the response of the SDO
/// server, and a value that the handler sets itself replaces the received one.
/// `exist`: whether the node has handlers that are called for accesses; if not, this class is empty. `write`, `supply`:
/// whether any is called before an object is written, or supplies objects of TPDOs.
template <bool exist, bool write, bool supply>
class HandlerCalls {
 public:
  /// Handlers of an object are called as long as the result exists. `written` is the key of the object if it is
  /// written, otherwise 0.
  [[nodiscard]] auto call([[maybe_unused]] std::uint32_t written = 0) {
    if constexpr (exist) {
      if constexpr (write) state_.has_set = false;
      return Call<false>{state_, written};
    } else {
      return NoState{};
    }
  }

  /// The same for the read handlers of an object for a TPDO.
  [[nodiscard]] auto call_for_tpdo(std::uint32_t key) requires(supply) { return Call<true>{state_, key}; }

  /// Whether an object is set by its own read handler for a TPDO.
  [[nodiscard]] bool is_supplied([[maybe_unused]] std::uint32_t key) const {
    if constexpr (supply) return state_.for_tpdo && state_.key == key;
    return false;
  }

  /// Records that an object is set, possibly by its own write handler.
  void object_is_set([[maybe_unused]] std::uint32_t key) {
    if constexpr (write) {
      if (state_.active && state_.key == key) state_.has_set = true;
    }
  }

  /// Whether the write handler that has just been called has set the object itself.
  [[nodiscard]] bool set_by_handler() const {
    if constexpr (write) return state_.has_set;
    return false;
  }

  /// Defers a command if a handler is being called, and returns whether one is. The newest command replaces the others.
  [[nodiscard]] bool defer([[maybe_unused]] NmtCommand command) {
    if constexpr (exist) {
      if (state_.active) state_.deferred = static_cast<std::uint8_t>(command);
      return state_.active;
    }
    return false;
  }
  [[nodiscard]] bool has_deferred() const {
    if constexpr (exist) return state_.deferred != 0;
    return false;
  }
  [[nodiscard]] NmtCommand deferred() const requires(exist) { return static_cast<NmtCommand>(state_.deferred); }
  void discard_deferred() {
    if constexpr (exist) state_.deferred = 0;
  }

 private:
  struct NoState {};
  struct Called {
    bool active;            ///< a handler is being called
    std::uint8_t deferred;  ///< the NMT command that it has requested; 0: none
  };
  struct CalledForObject : Called {
    bool for_tpdo;      ///< it is a read handler, for a TPDO
    bool has_set;       ///< it has set that object itself
    std::uint32_t key;  ///< of the object that is being written, or read for a TPDO
  };
  using State = std::conditional_t<write || supply, CalledForObject, std::conditional_t<exist, Called, NoState>>;

  /// A call of handlers, which also ends if one of them throws an exception, as on a host.
  template <bool for_tpdo>
  class Call {
   public:
    Call(State& state, [[maybe_unused]] std::uint32_t key) : state_{state} {
      if constexpr (write || supply) state_.key = key;
      state_.active = true;
      if constexpr (for_tpdo) state_.for_tpdo = true;
    }
    ~Call() {
      if constexpr (for_tpdo) state_.for_tpdo = false;
      state_.active = false;
    }
    Call(const Call&) = delete;
    Call& operator=(const Call&) = delete;

   private:
    State& state_;
  };

  [[no_unique_address]] State state_{};
};

}  // namespace canopen
