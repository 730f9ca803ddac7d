/// A node as its services see it: its state, and what they make it do.
#pragma once

#include <cstdint>
#include <tuple>
#include <type_traits>
#include <utility>

#include "canopen/base/clock.hpp"
#include "canopen/base/optimization.hpp"
#include "canopen/can/node_id.hpp"
#include "canopen/emcy/service_error.hpp"
#include "canopen/nmt/nmt.hpp"
#include "canopen/nmt/nmt_start_up.hpp"
#include "canopen/node/functions.hpp"
#include "canopen/node/handler_calls.hpp"
#include "canopen/node/handler_set.hpp"
#include "canopen/node/idle_time.hpp"
#include "canopen/node/services.hpp"
#include "canopen/od/object.hpp"
#include "canopen/od/object_store.hpp"
#include "canopen/sdo/domain_handlers.hpp"

namespace canopen {

/// Base of a node, by which its services refer to it. `NodeType` is the Node.
template <class NodeType, class DeviceOfNode, class BusType, class... Parts>
class ServiceHost {
 public:
  using Device = DeviceOfNode;
  using Handlers = HandlerSet<Device, NodeType, Parts...>;
  using Services = NodeServices<Device, Parts...>;

  template <class... Given>
  constexpr ServiceHost(BusType& can_bus, std::tuple<Given...> parts, NodeId id = {})
      : bus{can_bus}, handlers{std::move(parts)}, node_id{id} {}

  [[nodiscard]] NodeType& node() { return static_cast<NodeType&>(*this); }

  // Transmission

  /// Whether nothing else is waiting to be sent.
  [[nodiscard]] bool may_send_at_once() const { return !attention && !services.silent(); }

  /// Sends what is due, in order of importance; what the bus has no room for remains due. A command that a handler has
  /// requested is executed after the response of the SDO server.
  [[gnu::noinline]] void serve() {
    do {
      attention = false;
      idle.end();
      if (services.silent()) return;
      if (!services.serve(*this)) keep_attention();
    } while (carry_out_deferred());
  }

  // NMT

  /// Executes a command; an invalid code has no effect. The newest command replaces one that a handler has requested.
  void carry_out(NmtCommand command) {
    handler_calls.discard_deferred();
    switch (command) {
      case NmtCommand::start: enter(NmtState::operational); break;
      case NmtCommand::stop: enter(NmtState::stopped); break;
      case NmtCommand::enter_pre_operational: enter(NmtState::pre_operational); break;
      case NmtCommand::reset_node:
        emergencies().announce_reset(*this);
        reset_node();
        break;
      case NmtCommand::reset_communication:
        emergencies().announce_reset(*this);
        reset_communication();
        break;
    }
  }

  /// Enters a state, of which services and handlers are notified.
  void enter(NmtState next) {
    const NmtState before = state;
    if (before == next && next != NmtState::initialisation) return;
    state = next;
    services.on_state(*this, before, next);
    attention = true;
    handlers.template notify_while<function::OnState>(
        node(), [&] { return state == next; }, next);
  }

  void reset_node() {
    services.reset_application(*this);
    reset_communication();
  }

  [[gnu::noinline]] void reset_communication() {
    services.reset_communication(*this);
    initialise();
  }

  /// Initialisation after the values have been set (CiA 301, 7.3.2.2.1).
  void initialise() {
    enter(NmtState::initialisation);
    service::BootUp<Device>& boot_up = services.template get<service::BootUp<Device>>();
    boot_up.reset();
    if (!node_id.valid()) return;
    boot_up.start();
    enter(NmtState::pre_operational);
    if (starts_itself(store)) enter(NmtState::operational);
  }

  // Values

  /// Notifies the services that an object has been written, with a new or the same value.
  void after_write(std::uint16_t index, std::uint8_t sub_index, bool new_value) {
    if (!new_value && !is_communication_index(index)) return;
    attention = true;
    if (is_communication_index(index)) services.after_write(*this, index, sub_index);
    if (serves_pdo(state)) services.after_operational_write(*this, index, sub_index, new_value);
  }
  template <DictionaryObject Object>
  void on_new_value() {
    if constexpr (is_communication_index(Object::index)) after_write(Object::index, Object::sub_index, true);
    if (serves_pdo(state) && services.template on_new_value<Object>(*this)) attention = true;
  }

  // Errors

  [[nodiscard]] auto& emergencies() { return services.template get<service::Emergency<Device>>(); }

  /// Reports an error that a service has detected, as an EMCY.
  void report(ServiceError error) { emergencies().report(*this, error); }
  /// Ends an error.
  void end(ServiceError error) { emergencies().end(*this, error); }
  /// Ends those of these errors that no service has any more.
  void end_if_gone(ServiceErrors errors) { emergencies().end_if_gone(*this, errors); }

 private:
  using Sdo = service::Sdo<Device, Parts...>;
  static constexpr bool calls_handlers = Handlers::has_access_handlers || DomainHandlerSet<Parts...>::any;

  /// Whether `on_time` has something to check at each call: a value can be posted to a mailbox at any time. An image
  /// for size does not wait for the next slot of time with periodic functions, and while parameters are stored in
  /// steps. This costs nothing in a device without them.
  static constexpr bool checks_each_call = service::PostedValues<Device, Parts...>::exists ||
                                           (prefers_size && (service::Periodic<Device, Parts...>::exists ||
                                                             service::StoredValues<Device, Parts...>::is_stepped));

  /// Returns whether a handler had requested a command.
  bool carry_out_deferred() {
    if constexpr (calls_handlers) {
      if (!handler_calls.has_deferred() || services.template get<Sdo>().has_reply()) return false;
      carry_out(handler_calls.deferred());
      return true;
    }
    return false;
  }

  /// What the bus had no room for remains due.
  [[gnu::noinline]] void keep_attention() {
    attention = true;
    services.keep_deadlines(*this);
  }

 public:
  // Most used members first, the values last: a Cortex-M0+ accesses bytes at offsets up to 31 with one instruction.
  [[no_unique_address]] std::conditional_t<std::is_empty_v<BusType>, BusType, BusType&> bus;
  [[no_unique_address]] Handlers handlers;
  TimePoint now{};  ///< of the call of the node that is being executed
  NodeId node_id{};
  NmtState state = NmtState::initialisation;
  bool attention = false;  ///< something may have become due since the last check
  [[no_unique_address]] IdleTimeOf<checks_each_call> idle{};
  [[no_unique_address]] HandlerCalls<calls_handlers, Handlers::has_write_handlers, Handlers::has_read_handlers>
      handler_calls{};
  [[no_unique_address]] Services services{};
  ObjectStore<Device> store{};
};

}  // namespace canopen
