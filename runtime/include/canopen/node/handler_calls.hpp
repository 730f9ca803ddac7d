/// State of a node while it calls a read or write handler.
#pragma once

#include <cstdint>
#include <type_traits>

#include "canopen/nmt/nmt.hpp"

namespace canopen {

template <bool exist, bool write, bool supply, bool for_tpdo = false>
class HandlerCall;

/// Records what a read or write handler does with its node: an NMT command is executed after the response of the SDO
/// server, and a value that the handler sets itself replaces the received one.
/// `exist`: whether the node has handlers that are called for accesses; if not, this class is empty. `write`, `supply`:
/// whether any is called before an object is written, or supplies objects of TPDOs.
template <bool exist, bool write, bool supply>
class HandlerCalls {
 public:
  /// Returns a call of the read handlers of an object for a TPDO.
  [[nodiscard]] auto call_for_tpdo(std::uint32_t key) requires(supply) {
    return HandlerCall<exist, write, supply, true>{*this, key};
  }

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
  template <bool, bool, bool, bool>
  friend class HandlerCall;

  [[no_unique_address]] State state_{};
};

/// Handlers of an object are called as long as this exists; also if one of them throws an exception, as on a host.
/// `for_tpdo`: they are its read handlers, for a TPDO.
template <bool exist, bool write, bool supply, bool for_tpdo>
class HandlerCall {
 public:
  /// `key`: of the object that is checked before a write, or read for a TPDO; 0 in all other calls.
  explicit HandlerCall(HandlerCalls<exist, write, supply>& calls, [[maybe_unused]] std::uint32_t key = 0)
      : calls_{calls} {
    if constexpr (write && !for_tpdo) calls_.state_.has_set = false;
    if constexpr (write || supply) calls_.state_.key = key;
    if constexpr (exist) calls_.state_.active = true;
    if constexpr (for_tpdo) calls_.state_.for_tpdo = true;
  }
  ~HandlerCall() {
    if constexpr (for_tpdo) calls_.state_.for_tpdo = false;
    if constexpr (exist) calls_.state_.active = false;
  }
  HandlerCall(const HandlerCall&) = delete;
  HandlerCall& operator=(const HandlerCall&) = delete;

 private:
  HandlerCalls<exist, write, supply>& calls_;
};

}  // namespace canopen
