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

template <DictionaryObject Object, class Function>
struct WriteHandler {
  using object = Object;
  [[no_unique_address]] Function call;
};

template <DictionaryObject Object, class Function>
struct WrittenHandler {
  using object = Object;
  [[no_unique_address]] Function call;
};

template <DictionaryObject Object, class Function>
struct ReadHandler {
  using object = Object;
  [[no_unique_address]] Function call;
};

/// The handler of an event, a row of node/functions.hpp.
template <class Event, class Function>
struct EventHandler {
  [[no_unique_address]] Function call;
};
template <class Function>
using StartHandler = EventHandler<function::Start, Function>;
template <class Function>
using StateHandler = EventHandler<function::OnState, Function>;
template <class Function>
using SyncHandler = EventHandler<function::OnSync, Function>;
template <class Function>
using TimeHandler = EventHandler<function::OnTimeOfDay, Function>;
template <class Function>
using HeartbeatHandler = EventHandler<function::OnHeartbeat, Function>;
template <class Function>
using LifeGuardingHandler = EventHandler<function::OnLifeGuarding, Function>;
template <class Function>
using EmergencyHandler = EventHandler<function::OnEmergency, Function>;
template <class Function>
using ErrorHandler = EventHandler<function::OnError, Function>;
template <class Function>
using RpdoHandler = EventHandler<function::OnRpdo, Function>;
template <class Function>
using StoredValueHandler = EventHandler<function::OnStoredValue, Function>;

/// The handler of a period.
template <class PeriodType, class Function>
struct PeriodicHandler {
  using period = PeriodType;
  [[no_unique_address]] Function call;
};

/// Calls `handler()` or `handler(node)` at power-on, before all other handlers: default and stored values have been
/// set, the boot-up message follows. A reset by NMT does not call it again.
template <class Function>
[[nodiscard]] constexpr StartHandler<Function> on_start(Function handler) {
  return {std::move(handler)};
}

/// Calls `handler()` or `handler(node)` with a period such as `Milliseconds<10>`, in each NMT state; the first time one
/// period after power-on.
template <Period PeriodType, class Function>
[[nodiscard]] constexpr PeriodicHandler<PeriodType, Function> every(Function handler) {
  return {std::move(handler)};
}
template <class PeriodType, class Function>
[[nodiscard]] constexpr PeriodicHandler<PeriodType, Function> every(PeriodType, Function handler) {
  static_assert(period_detail::length_of<PeriodType> != 0,
                "every: the period is known at compile time, such as canopen::Milliseconds<10>{}");
  return {std::move(handler)};
}

/// Calls `handler(value)` or `handler(node, value)` with a value received by SDO or an RPDO, before it is stored. An
/// AbortCode other than `ok`, or such a Result, rejects the value; a handler that returns void accepts it. For a DOMAIN
/// the value is the memory that has already been filled.
template <DictionaryObject Object, class Function>
[[nodiscard]] constexpr WriteHandler<Object, Function> on_write(Function handler) {
  return {std::move(handler)};
}
template <DictionaryObject Object, class Function>
[[nodiscard]] constexpr WriteHandler<Object, Function> on_write(Object, Function handler) {
  return {std::move(handler)};
}

/// Calls `handler(value)` or `handler(node, value)` with a value received by SDO or an RPDO, after it has been stored,
/// even if it is the same as before.
template <DictionaryObject Object, class Function>
[[nodiscard]] constexpr WrittenHandler<Object, Function> on_written(Function handler) {
  return {std::move(handler)};
}
template <DictionaryObject Object, class Function>
[[nodiscard]] constexpr WrittenHandler<Object, Function> on_written(Object, Function handler) {
  return {std::move(handler)};
}

/// Calls `handler()` or `handler(node)` before an SDO upload, and before a TPDO that maps the object is sent. It
/// returns the value, a Result of it, or an AbortCode, or sets the object through the node. After an abort code the
/// TPDO is sent with the last value.
template <DictionaryObject Object, class Function>
[[nodiscard]] constexpr ReadHandler<Object, Function> on_read(Function handler) {
  return {std::move(handler)};
}
template <DictionaryObject Object, class Function>
[[nodiscard]] constexpr ReadHandler<Object, Function> on_read(Object, Function handler) {
  return {std::move(handler)};
}

/// Calls `handler(state)` or `handler(node, state)` with each NMT state that the node enters. Initialisation is
/// reported at start and at each reset, after the default values have been set.
template <class Function>
[[nodiscard]] constexpr StateHandler<Function> on_state(Function handler) {
  return {std::move(handler)};
}

/// Calls `handler(counter)` or `handler(node, counter)` at each SYNC in Pre-operational and Operational, after
/// synchronous TPDOs have been sent and synchronous RPDOs applied. The counter is 0 if the network does not use it.
template <class Function>
[[nodiscard]] constexpr SyncHandler<Function> on_sync(Function handler) {
  return {std::move(handler)};
}

/// Calls `handler(TimeOfDay)` or `handler(node, TimeOfDay)` with the time of day that a TIME frame contains.
template <class Function>
[[nodiscard]] constexpr TimeHandler<Function> on_time_of_day(Function handler) {
  return {std::move(handler)};
}

/// Calls `handler(HeartbeatEvent, NodeId, NmtState)`, optionally with the node first, with the events of the nodes in
/// 1016h.
template <class Function>
[[nodiscard]] constexpr HeartbeatHandler<Function> on_heartbeat(Function handler) {
  return {std::move(handler)};
}

/// Calls `handler(bool)` or `handler(node, bool)` when the life time of node guarding has elapsed (true) and when a
/// request is received again (false).
template <class Function>
[[nodiscard]] constexpr LifeGuardingHandler<Function> on_life_guarding(Function handler) {
  return {std::move(handler)};
}

/// Calls `handler(ConsumedEmergency)` or `handler(node, ConsumedEmergency)` with the EMCYs of 1028h.
template <class Function>
[[nodiscard]] constexpr EmergencyHandler<Function> on_emergency(Function handler) {
  return {std::move(handler)};
}

/// Calls `handler(std::uint16_t)` or `handler(node, std::uint16_t)` with the emergency error code of each error that
/// this node reports by EMCY, whether a service has detected it or the application has called `emergency`. The EMCY may
/// be sent later.
template <class Function>
[[nodiscard]] constexpr ErrorHandler<Function> on_error(Function handler) {
  return {std::move(handler)};
}

/// Calls `handler(event, number)` or `handler(node, event, number)` with each event of an RPDO.
template <class Function>
[[nodiscard]] constexpr RpdoHandler<Function> on_rpdo(Function handler) {
  return {std::move(handler)};
}

/// Calls `handler(StoredValue)` or `handler(node, StoredValue)` at each reset with each stored value that is not
/// loaded, or was stored with another `storage.version` of the options. It may replace or discard the value.
template <class Function>
[[nodiscard]] constexpr StoredValueHandler<Function> on_stored_value(Function handler) {
  return {std::move(handler)};
}

namespace handler_detail {

/// Whether a handler can be called with these arguments, alone or after the node.
template <class Function, class Node, class... Arguments>
inline constexpr bool takes =
    std::is_invocable_v<Function&, const Arguments&...> || std::is_invocable_v<Function&, Node&, const Arguments&...>;

/// Calls `handler` with the arguments, and with the node first if it does not accept them alone.
template <class Function, class Node, class... Arguments>
constexpr decltype(auto) call(Function& handler, [[maybe_unused]] Node& node, const Arguments&... arguments) {
  if constexpr (std::is_invocable_v<Function&, const Arguments&...>) {
    return handler(arguments...);
  } else {
    static_assert(std::is_invocable_v<Function&, Node&, const Arguments&...>,
                  "a handler takes (value) or (node, value)");
    return handler(node, arguments...);
  }
}

}  // namespace handler_detail
}  // namespace canopen
