/// Handlers of the application: callables for reads and writes of objects, NMT states and other events, which a node
/// keeps by value and finds by comparing numbers, without heap or indirect calls. An application with more than a few
/// of them is a class: node/application.hpp.
///
///     auto drive = canopen::make_node<cpc_tc1::Device>(
///         bus, canopen::NodeId{5},
///         canopen::on_write(od::controlword{}, [](std::uint16_t command) { return accept(command); }),
///         canopen::on_read(od::temperature{}, [] { return measure(); }),
///         canopen::on_state([](canopen::NmtState state) { show(state); }));
#pragma once

#include <type_traits>
#include <utility>

#include "canopen/node/functions.hpp"
#include "canopen/node/period.hpp"
#include "canopen/od/object.hpp"

namespace canopen {

template <DictionaryObject O, class F>
struct WriteHandler {
  using object = O;
  [[no_unique_address]] F call;
};

template <DictionaryObject O, class F>
struct WrittenHandler {
  using object = O;
  [[no_unique_address]] F call;
};

template <DictionaryObject O, class F>
struct ReadHandler {
  using object = O;
  [[no_unique_address]] F call;
};

/// The handler of an event, a row of node/functions.hpp.
template <class Event, class F>
struct EventHandler {
  [[no_unique_address]] F call;
};
template <class F>
using StartHandler = EventHandler<function::Start, F>;
template <class F>
using StateHandler = EventHandler<function::OnState, F>;
template <class F>
using SyncHandler = EventHandler<function::OnSync, F>;
template <class F>
using TimeHandler = EventHandler<function::OnTimeOfDay, F>;
template <class F>
using HeartbeatHandler = EventHandler<function::OnHeartbeat, F>;
template <class F>
using LifeGuardingHandler = EventHandler<function::OnLifeGuarding, F>;
template <class F>
using EmergencyHandler = EventHandler<function::OnEmergency, F>;
template <class F>
using ErrorHandler = EventHandler<function::OnError, F>;
template <class F>
using RpdoHandler = EventHandler<function::OnRpdo, F>;
template <class F>
using StoredValueHandler = EventHandler<function::OnStoredValue, F>;

/// The handler of a period.
template <class P, class F>
struct PeriodicHandler {
  using period = P;
  [[no_unique_address]] F call;
};

/// Calls `handler()` or `handler(node)` at power-on, before all other handlers: default and stored values have been
/// set, the boot-up message follows. A reset by NMT does not call it again.
template <class F>
[[nodiscard]] constexpr StartHandler<F> on_start(F handler) {
  return {std::move(handler)};
}

/// Calls `handler()` or `handler(node)` with a period such as `Milliseconds<10>`, in each NMT state; the first time one
/// period after power-on.
template <Period P, class F>
[[nodiscard]] constexpr PeriodicHandler<P, F> every(F handler) {
  return {std::move(handler)};
}
template <class P, class F>
[[nodiscard]] constexpr PeriodicHandler<P, F> every(P, F handler) {
  static_assert(period_detail::length_of<P> != 0,
                "every: the period is known at compile time, such as canopen::Milliseconds<10>{}");
  return {std::move(handler)};
}

/// Calls `handler(value)` or `handler(node, value)` with a value received by SDO or an RPDO, before it is stored. An
/// AbortCode other than `ok`, or such a Result, rejects the value; a handler that returns void accepts it. For a DOMAIN
/// the value is the memory that has already been filled.
template <DictionaryObject O, class F>
[[nodiscard]] constexpr WriteHandler<O, F> on_write(F handler) {
  return {std::move(handler)};
}
template <DictionaryObject O, class F>
[[nodiscard]] constexpr WriteHandler<O, F> on_write(O, F handler) {
  return {std::move(handler)};
}

/// Calls `handler(value)` or `handler(node, value)` with a value received by SDO or an RPDO, after it has been stored,
/// even if it is the same as before.
template <DictionaryObject O, class F>
[[nodiscard]] constexpr WrittenHandler<O, F> on_written(F handler) {
  return {std::move(handler)};
}
template <DictionaryObject O, class F>
[[nodiscard]] constexpr WrittenHandler<O, F> on_written(O, F handler) {
  return {std::move(handler)};
}

/// Calls `handler()` or `handler(node)` before an SDO upload, and before a TPDO that maps the object is sent. It
/// returns the value, a Result of it, or an AbortCode, or sets the object through the node. After an abort code the
/// TPDO is sent with the last value.
template <DictionaryObject O, class F>
[[nodiscard]] constexpr ReadHandler<O, F> on_read(F handler) {
  return {std::move(handler)};
}
template <DictionaryObject O, class F>
[[nodiscard]] constexpr ReadHandler<O, F> on_read(O, F handler) {
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

/// Calls `handler(StoredValue)` or `handler(node, StoredValue)` at each reset with each stored value that is not
/// loaded, or was stored with another `storage.version` of the options. It may replace or discard the value.
template <class F>
[[nodiscard]] constexpr StoredValueHandler<F> on_stored_value(F handler) {
  return {std::move(handler)};
}

namespace handler_detail {

/// Whether a handler can be called with these arguments, alone or after the node.
template <class F, class Node, class... Arguments>
inline constexpr bool takes =
    std::is_invocable_v<F&, const Arguments&...> || std::is_invocable_v<F&, Node&, const Arguments&...>;

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

}  // namespace handler_detail
}  // namespace canopen
