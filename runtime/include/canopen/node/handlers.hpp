/// Handlers of the application for reads and writes of objects, NMT states and other events: callables that the node
/// keeps by value and finds by comparing numbers, without heap or indirect calls.
///
///     auto drive = canopen::make_node<Device>(bus, NodeId{5},
///         canopen::on_write<od::controlword>([](std::uint16_t command) { return accept(command); }),
///         canopen::on_read<od::temperature>([](auto& node) { node.template set<od::temperature>(measure()); }),
///         canopen::on_state([](canopen::NmtState state) { show(state); }));
#pragma once

#include <cstdint>
#include <span>
#include <tuple>
#include <type_traits>
#include <utility>

#include "canopen/base/abort_code.hpp"
#include "canopen/od/dictionary.hpp"
#include "canopen/od/object.hpp"
#include "canopen/od/value_bits.hpp"
#include "canopen/storage/storage.hpp"

namespace canopen {

template <DictionaryObject O, class F>
struct WriteHandler {
  using object = O;
  [[no_unique_address]] F call;
};

template <DictionaryObject O, class F>
struct ReadHandler {
  using object = O;
  [[no_unique_address]] F call;
};

template <class F>
struct StateHandler {
  [[no_unique_address]] F call;
};

template <class F>
struct SyncHandler {
  [[no_unique_address]] F call;
};

template <class F>
struct TimeHandler {
  [[no_unique_address]] F call;
};

template <class F>
struct HeartbeatHandler {
  [[no_unique_address]] F call;
};

template <class F>
struct LifeGuardingHandler {
  [[no_unique_address]] F call;
};

template <class F>
struct EmergencyHandler {
  [[no_unique_address]] F call;
};

template <class F>
struct ErrorHandler {
  [[no_unique_address]] F call;
};

template <class F>
struct RpdoHandler {
  [[no_unique_address]] F call;
};

/// Calls `handler(value)` or `handler(node, value)` with a value received by SDO or an RPDO, before it is stored. An
/// AbortCode other than `ok` rejects the value; a handler that returns void accepts it. For a DOMAIN the value is the
/// memory that has already been filled.
template <DictionaryObject O, class F>
[[nodiscard]] constexpr WriteHandler<O, F> on_write(F handler) {
  return {std::move(handler)};
}

/// Calls `handler()` or `handler(node)` before an SDO upload. It may set the object through the node, or return its
/// value or an AbortCode.
template <DictionaryObject O, class F>
[[nodiscard]] constexpr ReadHandler<O, F> on_read(F handler) {
  return {std::move(handler)};
}

/// Calls `handler(state)` or `handler(node, state)` with each NMT state that the node enters. Initialisation is
/// reported at start and at each reset, after the default values have been set.
template <class F>
[[nodiscard]] constexpr StateHandler<F> on_state(F handler) {
  return {std::move(handler)};
}

/// Calls `handler(counter)` or `handler(node, counter)` at each SYNC in Pre-operational and Operational, after
/// synchronous TPDOs have been sent and synchronous RPDOs applied. The counter is 0 if the network does not use it.
template <class F>
[[nodiscard]] constexpr SyncHandler<F> on_sync(F handler) {
  return {std::move(handler)};
}

/// Calls `handler(TimeOfDay)` or `handler(node, TimeOfDay)` with the time of day that a TIME frame contains.
template <class F>
[[nodiscard]] constexpr TimeHandler<F> on_time_of_day(F handler) {
  return {std::move(handler)};
}

/// Calls `handler(HeartbeatEvent, NodeId, NmtState)`, optionally with the node first, with the events of the nodes in
/// 1016h.
template <class F>
[[nodiscard]] constexpr HeartbeatHandler<F> on_heartbeat(F handler) {
  return {std::move(handler)};
}

/// Calls `handler(bool)` or `handler(node, bool)` when the life time of node guarding has elapsed (true) and when a
/// request is received again (false).
template <class F>
[[nodiscard]] constexpr LifeGuardingHandler<F> on_life_guarding(F handler) {
  return {std::move(handler)};
}

/// Calls `handler(ConsumedEmergency)` or `handler(node, ConsumedEmergency)` with the EMCYs of 1028h.
template <class F>
[[nodiscard]] constexpr EmergencyHandler<F> on_emergency(F handler) {
  return {std::move(handler)};
}

/// Calls `handler(std::uint16_t)` or `handler(node, std::uint16_t)` with the emergency error code of each error that
/// this node reports by EMCY, whether a service has detected it or the application has called `emergency`. The EMCY may
/// be sent later.
template <class F>
[[nodiscard]] constexpr ErrorHandler<F> on_error(F handler) {
  return {std::move(handler)};
}

/// Calls `handler(event, number)` or `handler(node, event, number)` with each event of an RPDO.
template <class F>
[[nodiscard]] constexpr RpdoHandler<F> on_rpdo(F handler) {
  return {std::move(handler)};
}

namespace handler_detail {

/// Calls `handler` with the arguments, and with the node first if it does not accept them alone.
template <class F, class Node, class... Arguments>
constexpr decltype(auto) call(F& handler, [[maybe_unused]] Node& node, const Arguments&... arguments) {
  if constexpr (std::is_invocable_v<F&, const Arguments&...>) {
    return handler(arguments...);
  } else {
    static_assert(std::is_invocable_v<F&, Node&, const Arguments&...>, "a handler takes (value) or (node, value)");
    return handler(node, arguments...);
  }
}

template <class Handler, class O>
inline constexpr bool is_write_handler_of = false;
template <class P, class F, class O>
inline constexpr bool is_write_handler_of<WriteHandler<P, F>, O> = P::index == O::index&& P::sub_index == O::sub_index;

template <class Handler>
inline constexpr bool is_access_handler = false;
template <class O, class F>
inline constexpr bool is_access_handler<WriteHandler<O, F>> = true;
template <class O, class F>
inline constexpr bool is_access_handler<ReadHandler<O, F>> = true;

/// Whether a handler is of this kind, such as SyncHandler.
template <class Handler, template <class> class Kind>
inline constexpr bool is_of = false;
template <class F, template <class> class Kind>
inline constexpr bool is_of<Kind<F>, Kind> = true;

template <class Handler>
inline constexpr std::uint32_t written_key = 0xFFFF'FFFF;
template <class O, class F>
inline constexpr std::uint32_t written_key<WriteHandler<O, F>> = object_key(O::index, O::sub_index);

template <class Node, DictionaryObject O, class F>
AbortCode write(WriteHandler<O, F>& handler, Node& node, const typename O::type& value) {
  using Answer = decltype(call(handler.call, node, value));
  if constexpr (std::is_same_v<Answer, AbortCode>) {
    return call(handler.call, node, value);
  } else {
    static_assert(std::is_void_v<Answer>, "a write handler answers an AbortCode or nothing");
    call(handler.call, node, value);
    return ok;
  }
}

template <class Node, DictionaryObject O, class F>
AbortCode read(ReadHandler<O, F>& handler, Node& node) {
  using Answer = decltype(call(handler.call, node));
  if constexpr (std::is_void_v<Answer>) {
    call(handler.call, node);
    return ok;
  } else if constexpr (std::is_same_v<Answer, AbortCode>) {
    return call(handler.call, node);
  } else {
    return node.template set<O>(call(handler.call, node));
  }
}

}  // namespace handler_detail

/// The handlers of one node.
template <class... Handlers>
class HandlerSet {
 public:
  constexpr explicit HandlerSet(Handlers... handlers) : handlers_{std::move(handlers)...} {}

  /// Whether `O` has a write handler.
  template <DictionaryObject O>
  static constexpr bool handles_write = (handler_detail::is_write_handler_of<Handlers, O> || ...);

  /// Whether any handler is called when an object is read or written over the bus.
  static constexpr bool has_access_handlers = (handler_detail::is_access_handler<Handlers> || ...);

  /// Whether the object with this key has a write handler.
  [[nodiscard]] static bool handles([[maybe_unused]] std::uint32_t key) {
    return ((key == handler_detail::written_key<Handlers>) || ...);
  }

  /// Calls the write handlers of `O`; returns the first abort code.
  template <DictionaryObject O, class Node>
  AbortCode before_write([[maybe_unused]] Node& node, [[maybe_unused]] const typename O::type& value) {
    AbortCode code = ok;
    for_each([&]<class H>([[maybe_unused]] H& handler) {
      if constexpr (handler_detail::is_write_handler_of<H, O>) {
        if (code == ok) code = handler_detail::write(handler, node, value);
      }
    });
    return code;
  }

  /// Calls the write handlers of the object with this key; returns the first abort code.
  template <class Node>
  AbortCode before_write(Node& node, std::uint32_t key, std::span<std::uint8_t> bytes) {
    AbortCode code = ok;
    for_each([&](auto& handler) { code = code == ok ? offer_write(handler, node, key, bytes) : code; });
    return code;
  }

  /// Calls the read handlers of the object with this key; returns the first abort code.
  template <class Node>
  AbortCode before_read(Node& node, std::uint32_t key) {
    AbortCode code = ok;
    for_each([&](auto& handler) { code = code == ok ? offer_read(handler, node, key) : code; });
    return code;
  }

  /// Whether a handler of this type is in the set.
  template <class H>
  static constexpr bool has = (std::is_same_v<H, Handlers> || ...);

  /// Whether the node has a storage.
  static constexpr bool has_storage = (storage_detail::is_stored_in<Handlers> || ...);

  [[nodiscard]] auto& storage() const requires has_storage {
    constexpr std::size_t position = [] {
      constexpr bool stored_in[] = {storage_detail::is_stored_in<Handlers>...};
      std::size_t i = 0;
      while (!stored_in[i]) ++i;
      return i;
    }();
    return *std::get<position>(handlers_).storage;
  }

  [[nodiscard]] std::tuple<Handlers...>& all() { return handlers_; }
  [[nodiscard]] const std::tuple<Handlers...>& all() const { return handlers_; }

  /// Calls all handlers of a kind, such as SyncHandler.
  template <template <class> class Kind, class Node, class... Arguments>
  void tell(Node& node, const Arguments&... arguments) {
    for_each([&]<class H>([[maybe_unused]] H& handler) {
      if constexpr (handler_detail::is_of<H, Kind>) handler_detail::call(handler.call, node, arguments...);
    });
  }

 private:
  template <class Visit>
  constexpr void for_each([[maybe_unused]] Visit&& visit) {
    std::apply([&](auto&... handler) { (visit(handler), ...); }, handlers_);
  }

  template <class Handler, class Node>
  static AbortCode offer_write(Handler&, Node&, std::uint32_t, std::span<std::uint8_t>) {
    return ok;
  }
  template <DictionaryObject O, class F, class Node>
  static AbortCode offer_write(WriteHandler<O, F>& handler, Node& node, std::uint32_t key,
                               std::span<std::uint8_t> bytes) {
    if (key != object_key(O::index, O::sub_index)) return ok;
    return handler_detail::write(handler, node, value_detail::value_from<O>(bytes));
  }

  template <class Handler, class Node>
  static AbortCode offer_read(Handler&, Node&, std::uint32_t) {
    return ok;
  }
  template <DictionaryObject O, class F, class Node>
  static AbortCode offer_read(ReadHandler<O, F>& handler, Node& node, std::uint32_t key) {
    return key == object_key(O::index, O::sub_index) ? handler_detail::read(handler, node) : ok;
  }

  [[no_unique_address]] std::tuple<Handlers...> handlers_;
};

}  // namespace canopen
