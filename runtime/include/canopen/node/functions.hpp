/// The functions by which an application takes part in its node: one row for each.
#pragma once

#include <cstdint>
#include <type_traits>
#include <utility>

#include "canopen/can/node_id.hpp"
#include "canopen/emcy/emcy_consumer.hpp"
#include "canopen/nmt/heartbeat_consumer.hpp"
#include "canopen/nmt/nmt.hpp"
#include "canopen/pdo/rpdo.hpp"
#include "canopen/storage/stored_value.hpp"
#include "canopen/time/time_stamp.hpp"

namespace canopen::function {

template <class... Arguments>
struct ArgumentList {};

/// Converts to references to each type: stands for the node.
struct AnyNode {
  template <class Type>
  operator Type&() const;  // NOLINT(google-explicit-constructor)
};

/// What a call returns if no function of the application fits.
struct NoneFits {};

// clang-format off
// A template argument cannot be the name of a function. Therefore, a macro makes the rows. Of each:
//   object       index of the object without which a device never calls the function; 0: every device may call it
//   Arguments    of an event
//   Both         with an application as the other base: the name is ambiguous if the application has it
//   is_declared  whether the application has a function of this name; a member of another kind is not one
//   call         calls the function; is not viable if no overload fits
//   address      of the function; not declared if it has overloads
//   OrNone       the application with a function for all other arguments
#define CANOPEN_FUNCTION(Row, function_name, needed_object, ...)                                    \
  struct Row {                                                                                      \
    static constexpr std::uint16_t object = needed_object;                                          \
    using Arguments = ArgumentList<__VA_ARGS__>;                                                    \
    struct Name { void function_name(); };                                                          \
    template <class Application> struct Both : Application, Name {};                                                    \
    template <class Application> static constexpr bool is_other =                                             \
        requires { typename Application::function_name; } ||                                                  \
        requires { requires !std::is_function_v<std::remove_reference_t<decltype(Application::function_name)>>; };\
    template <class Application> static constexpr bool is_declared =                                          \
        !requires { &Both<Application>::function_name; } && !is_other<Application>;                                     \
    template <class Application> requires requires { &Application::function_name; }                                     \
    static constexpr auto address = &Application::function_name;                                              \
    template <class Application> struct OrNone : Application {                                                          \
      using Application::function_name;                                                                       \
      static NoneFits function_name(...);                                                           \
    };                                                                                              \
    template <class Application, class... Values>                                                             \
    static constexpr auto call(Application& application, Values&&... values)                                  \
        -> decltype(application.function_name(std::forward<Values>(values)...)) {                   \
      return application.function_name(std::forward<Values>(values)...);                            \
    }                                                                                               \
  }

/// `write(od::x, value)`: before a value that was received by SDO or PDO is stored. Returns an AbortCode, a
/// Result<void>, or nothing: the value is accepted.
CANOPEN_FUNCTION(Write, write, 0, );
/// `written(od::x, value)`: after it has been stored, even if it is the same as before.
CANOPEN_FUNCTION(Written, written, 0, );
/// `read(od::x)`: before an SDO upload, and before a TPDO with this object is sent. Returns the value, a Result of
/// it, an AbortCode, or nothing: the value in the node is sent. A value for a TPDO does not send other TPDOs.
CANOPEN_FUNCTION(Read, read, 0, );

/// Power-on, the first call that an application gets: default and stored values have been set, the boot-up message
/// follows. A reset by NMT does not call it again: it enters Initialisation.
CANOPEN_FUNCTION(StartOfAnyAccess, start, 0, );
struct Start : StartOfAnyAccess {
  /// A private function of this common name is left alone.
  template <class Application> static constexpr bool is_declared = StartOfAnyAccess::is_declared<Application> &&
      (requires { &Application::start; } || requires(Application& application) { application.start(); } ||
       requires(Application& application, AnyNode node) { application.start(node); });
};
/// `every(Milliseconds<10>)`: a function with a period, in each NMT state. Returns nothing.
CANOPEN_FUNCTION(Every, every, 0, );

/// The node has entered an NMT state. Initialisation is reported at start and at each reset, after the default values
/// have been set. A state that an application leaves in this function is not reported to those after it.
CANOPEN_FUNCTION(OnState, on_state, 0, NmtState);
/// A SYNC in Pre-operational or Operational, after synchronous TPDOs have been sent and synchronous RPDOs applied; with
/// its counter, 0 if the network does not use it.
CANOPEN_FUNCTION(OnSync, on_sync, 0x1005, std::uint8_t);
/// The time of day of a TIME frame.
CANOPEN_FUNCTION(OnTimeOfDay, on_time_of_day, 0x1012, TimeOfDay);
/// An event of a node in 1016h.
CANOPEN_FUNCTION(OnHeartbeat, on_heartbeat, 0x1016, HeartbeatEvent, NodeId, NmtState);
/// The life time of node guarding has elapsed (true), or a request was received again (false).
CANOPEN_FUNCTION(OnLifeGuarding, on_life_guarding, 0x100C, bool);
/// An EMCY of a node in 1028h.
CANOPEN_FUNCTION(OnEmergency, on_emergency, 0x1028, ConsumedEmergency);
/// The emergency error code of an error that this node reports by EMCY, whether a service has detected it or the
/// application has called `emergency`. The EMCY may be sent later.
CANOPEN_FUNCTION(OnError, on_error, 0, std::uint16_t);
/// An event of an RPDO, with its number.
CANOPEN_FUNCTION(OnRpdo, on_rpdo, 0, RpdoEvent, std::uint16_t);
/// A stored value that this version of the device does not accept as it is, at each reset until it is saved without it.
CANOPEN_FUNCTION(OnStoredValue, on_stored_value, 0x1010, StoredValue);

// Names that are never called, but are probably meant to be one of these.
CANOPEN_FUNCTION(Writen, writen, 0, );
CANOPEN_FUNCTION(OnWrite, on_write, 0, );
CANOPEN_FUNCTION(OnWritten, on_written, 0, );
CANOPEN_FUNCTION(OnRead, on_read, 0, );
CANOPEN_FUNCTION(OnNmtState, on_nmt_state, 0, );
CANOPEN_FUNCTION(OnEmcy, on_emcy, 0, );
CANOPEN_FUNCTION(OnPdo, on_pdo, 0, );
CANOPEN_FUNCTION(OnChange, on_change, 0, );
CANOPEN_FUNCTION(OnChanged, on_changed, 0, );
CANOPEN_FUNCTION(OnUpdate, on_update, 0, );
CANOPEN_FUNCTION(OnReceive, on_receive, 0, );
CANOPEN_FUNCTION(OnReceived, on_received, 0, );
CANOPEN_FUNCTION(OnStateChange, on_state_change, 0, );
CANOPEN_FUNCTION(OnNmt, on_nmt, 0, );
CANOPEN_FUNCTION(OnHeartBeat, on_heart_beat, 0, );
CANOPEN_FUNCTION(OnNodeGuarding, on_node_guarding, 0, );
CANOPEN_FUNCTION(OnErrors, on_errors, 0, );
CANOPEN_FUNCTION(Wrote, wrote, 0, );
CANOPEN_FUNCTION(Wirte, wirte, 0, );
CANOPEN_FUNCTION(OnStart, on_start, 0, );
CANOPEN_FUNCTION(OnEvery, on_every, 0, );
CANOPEN_FUNCTION(OnTick, on_tick, 0, );
CANOPEN_FUNCTION(OnTimer, on_timer, 0, );
// The same if they have the parameters of a periodic function.
CANOPEN_FUNCTION(Tick, tick, 0, );
CANOPEN_FUNCTION(Evry, evry, 0, );
CANOPEN_FUNCTION(Each, each, 0, );
CANOPEN_FUNCTION(Periodic, periodic, 0, );
CANOPEN_FUNCTION(OnTime, on_time, 0, );
// clang-format on
#undef CANOPEN_FUNCTION

}  // namespace canopen::function
