/// The master of a network that `edsc network generate` has described: boots the nodes, exchanges their signals, and
/// reports their faults by the names of the network file.
///
///     #include <canopen_plant/plant.hpp>
///     #include <plant.hpp>
///     canopen::Plant<plant::Network, canopen::HostBus> control{bus};
///     control.on(plant::signals::sensor::position{}, [&](std::int32_t position) { control.axis1.target(position); });
///     control.on_fault = [](const canopen::PlantNode& node, const canopen::PlantFault& fault) { stop(node, fault); };
///     bus.run(control);
#pragma once

#include <algorithm>
#include <array>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <tuple>
#include <type_traits>

#include "canopen/base/abort_code.hpp"
#include "canopen/base/clock.hpp"
#include "canopen/base/result.hpp"
#include "canopen/base/small_function.hpp"
#include "canopen/can/bus_status.hpp"
#include "canopen/can/frame.hpp"
#include "canopen/emcy/emcy_consumer.hpp"
#include "canopen/nmt_master/nmt_master.hpp"
#include "canopen/node.hpp"
#include "canopen/od/value_for.hpp"
#include "canopen_plant/plant_fault.hpp"
#include "canopen_plant/plant_node.hpp"
#include "canopen_plant/signal.hpp"

namespace canopen {

/// Consists of the master's own device as a node, which produces SYNC and heartbeat and exchanges the PDOs, and of an
/// NmtMaster with the slaves of the network, which writes their concise DCFs (CiA 302-2). The nodes of the network are
/// members: `plant.axis1.position()` returns a value, `plant.axis1.target(5)` sends one. No heap.
///
/// A received value is empty before the first PDO, and from the loss of its node until the first PDO after its boot-up.
/// A value that is sent has the default value of the master's object until it is set, which may be before `start`.
/// Handlers are called from `on_frame` and `on_time`; they may use the plant. Up to `Requests` SDO requests of the
/// application may wait.
template <class NetworkDescription, Bus BusType, std::size_t Requests = 4>
class Plant : public NetworkDescription::template Nodes<Plant<NetworkDescription, BusType, Requests>> {
 public:
  using Network = NetworkDescription;
  using Nodes = typename Network::template Nodes<Plant>;
  static constexpr std::size_t count = Network::slaves.size();

  explicit Plant(BusType& bus, SdoClientOptions options = {})
      : Nodes{*this},
        node_{bus, Network::master_id, RpdoHandler<RpdoEvents>{{this}}},
        master_{bus, Network::slaves, Network::start_up, options, Host{this}} {}
  Plant(const Plant&) = delete;
  Plant& operator=(const Plant&) = delete;

  /// A node has been identified, configured and started; also each time it is booted again.
  SmallFunction<void(const PlantNode&)> on_booted;
  SmallFunction<void(const PlantNode&, const PlantFault&)> on_fault;

  /// Calls `function(value)` with each PDO that contains this signal, after all its values have been stored. Replaces
  /// an earlier function for it.
  template <ReceivedBy<Network> SignalType, class Callable>
  void on(SignalType, Callable function) {
    std::get<Network::Received::template position_of<SignalType>>(functions_).call = function;
  }

  /// Returns the last value received; empty if there is none since the node has booted.
  template <ReceivedBy<Network> SignalType>
  [[nodiscard]] std::optional<typename SignalType::type> get(SignalType) const {
    if (!fresh_[Network::Received::template position_of<SignalType>]) return std::nullopt;
    return value_of<SignalType>();
  }

  /// Sends a value with the next PDO, which an event-driven TPDO sends at once. value_too_high or value_too_low: it is
  /// outside the limits of the node's object, and the last value is kept.
  template <SentBy<Network> SignalType>
  requires(!can_be_refused<typename SignalType::receiver>) AbortCode
      set(SignalType, std::type_identity_t<ParameterFor<typename SignalType::receiver>> value) {
    return store<SignalType>(value_for_detail::value_in(value));
  }
  template <SentBy<Network> SignalType, FitsInto<typename SignalType::receiver::type> Value>
  requires(can_be_refused<typename SignalType::receiver>) [[nodiscard]] AbortCode set(SignalType, Value value) {
    return store<SignalType>(value_for_detail::value_as<typename SignalType::receiver::type>(value));
  }
  /// A constant, whose limits the compiler checks.
  template <SentBy<Network> SignalType>
  requires(can_be_refused<typename SignalType::receiver>) void set(
      SignalType, std::type_identity_t<CheckedValue<typename SignalType::receiver>> value) {
    static_cast<void>(store<SignalType>(value.value()));
  }

  /// Returns the value that is sent.
  template <SentBy<Network> SignalType>
  [[nodiscard]] typename SignalType::type get(SignalType) const {
    return value_of<SignalType>();
  }

  /// Starts the master's device, resets the nodes and boots them. Values that have been set before are kept.
  void start(TimePoint now) {
    now_ = now;
    const SentValues before = sent_values();
    node_.start(now);
    restore(before);
    master_.start(now);
  }
  void on_frame(const Frame& frame, TimePoint now) {
    now_ = now;
    master_.on_frame(frame, now);
    report_emergency(frame);
    node_.on_frame(frame, now);
  }
  /// Call it at `next_deadline()`, and when the bus has room again.
  void on_time(TimePoint now) {
    now_ = now;
    master_.on_time(now);
    node_.on_time(now);
  }
  [[nodiscard]] std::optional<TimePoint> next_deadline() const {
    const std::optional<TimePoint> one = master_.next_deadline();
    const std::optional<TimePoint> other = node_.next_deadline();
    return one && other ? std::min(*one, *other) : one ? one : other;
  }
  void on_bus_status(const BusStatus& status, TimePoint now) {
    now_ = now;
    node_.on_bus_status(status, now);
  }

  /// Returns the last state that a node reported; empty if it is unknown or lost.
  [[nodiscard]] std::optional<NmtState> state(NodeId node_id) const { return master_.state(node_id); }

  /// Whether a node, by its position in the network, has booted and is not lost.
  [[nodiscard]] bool booted(std::size_t position) const { return booted_[position]; }
  [[nodiscard]] bool all_booted() const { return std::ranges::find(booted_, false) == booted_.end(); }

  /// Resets a node and boots it again.
  void boot(NodeId node_id) { master_.boot(node_id, now_); }

  /// Sends an NMT command to one node, or to all nodes with node-ID 0. Returns false if the bus had no room.
  [[nodiscard]] bool command(NmtCommand command, NodeId node_id) { return master_.command(command, node_id); }

  /// Appends an SDO transfer to the queue of a node (NmtMaster::request). 060A 0023h: `Requests` are waiting.
  Result<void> request(NodeId node_id, const SdoRequest& what) { return master_.request(node_id, what, now_); }

  /// Returns the master's own device.
  [[nodiscard]] auto& device() { return node_; }

 private:
  /// Receives the events of the RPDOs of the master's device.
  struct RpdoEvents {
    Plant* plant;
    void operator()(RpdoEvent event, std::uint16_t number) const { plant->on_rpdo(event, number); }
  };

  /// Receives the events of the NMT master.
  struct Host {
    Plant* plant;
    void happened(NmtMasterEvent event, NodeId node_id, NmtState state) { plant->on_event(event, node_id, state); }
    void booted(NodeId node_id, const BootResult& result) { plant->on_boot_result(node_id, result); }
    void network_started() { plant->node_.request(NmtCommand::start, plant->now_); }
    void boot_time_elapsed() {}
  };

  /// The master has its configurations from the network file; it does not have storage, LSS or memory for DOMAINs.
  using OwnNode = Node<typename Network::Master, BusType, RpdoHandler<RpdoEvents>,
                       composition_detail::OmitsMissing<typename Network::Master, RpdoHandler<RpdoEvents>>>;

  template <class SignalType>
  struct Function {
    SmallFunction<void(typename SignalType::type)> call;
  };

  template <class SignalType>
  [[nodiscard]] AbortCode store(const typename SignalType::receiver::type& value) {
    if (const AbortCode code = check_limits<typename SignalType::receiver>(value); code != ok) return code;
    is_set_[Network::Sent::template position_of<SignalType>] = true;
    return node_.template set<typename SignalType::object>(from_raw<typename SignalType::object::type>(to_raw(value)));
  }
  /// The value of the master's object, which may not have the meaning that the node's object has.
  template <class SignalType>
  [[nodiscard]] typename SignalType::type value_of() const {
    return from_raw<typename SignalType::type>(to_raw(node_.template get<typename SignalType::object>()));
  }

  template <class SignalType>
  struct SentValue {
    typename SignalType::object::type value{};
  };
  using SentValues = typename Network::Sent::template Slots<SentValue>;

  [[nodiscard]] SentValues sent_values() const {
    SentValues values;
    Network::Sent::for_each([&]<class SignalType, std::size_t Position>() {
      std::get<Position>(values).value = node_.template get<typename SignalType::object>();
    });
    return values;
  }

  /// Sets the values that the application has set; the others keep the default values of the start.
  void restore(const SentValues& values) {
    Network::Sent::for_each([&]<class SignalType, std::size_t Position>() {
      if (!is_set_[Position]) return;
      static_cast<void>(node_.template set<typename SignalType::object>(std::get<Position>(values).value));
    });
  }

  [[nodiscard]] static std::optional<std::size_t> position_of(NodeId node_id) {
    for (std::size_t i = 0; i < count; ++i) {
      if (Network::nodes[i].node_id == node_id) return i;
    }
    return std::nullopt;
  }

  // Signals

  void on_rpdo(RpdoEvent event, std::uint16_t number) {
    switch (event) {
      case RpdoEvent::taken: return take(number);
      case RpdoEvent::too_short: return report_rpdo(PlantFaultKind::pdo_too_short, number);
      case RpdoEvent::timeout: return report_rpdo(PlantFaultKind::pdo_missing, number);
      case RpdoEvent::length_right:
      case RpdoEvent::in_time: return;
    }
  }

  /// All values of the PDO are valid before the first function is called.
  void take(std::uint16_t number) {
    Network::Received::for_each([&]<class SignalType, std::size_t Position>() {
      if (SignalType::Rpdo::number == number) fresh_[Position] = true;
    });
    Network::Received::for_each([&]<class SignalType, std::size_t Position>() {
      if (SignalType::Rpdo::number == number) std::get<Position>(functions_).call(value_of<SignalType>());
    });
  }

  void forget(std::size_t position) {
    booted_[position] = false;
    Network::Received::for_each([&]<class SignalType, std::size_t Position>() {
      if (SignalType::node == position) fresh_[Position] = false;
    });
  }

  /// Sends the values of event-driven TPDOs to a node that has missed them: an object that has changed and changed back
  /// is sent.
  void send_again(std::size_t position) {
    Network::Sent::for_each([&]<class SignalType, std::size_t Position>() {
      constexpr bool is_on_change =
          SignalType::Tpdo::parameters.event_timer == 0 && (SignalType::Tpdo::parameters.transmission_type == 0 ||
                                                            SignalType::Tpdo::parameters.transmission_type >= 254);
      if constexpr (is_on_change && std::is_arithmetic_v<RawOf<typename SignalType::type>>) {
        if (SignalType::node != position) return;
        using Object = NumbersOf<typename SignalType::object>;
        const typename Object::type value = node_.template get<Object>();
        static_cast<void>(node_.template set<Object>(static_cast<typename Object::type>(value == 0 ? 1 : 0)));
        static_cast<void>(node_.template set<Object>(value));
      }
    });
  }

  // Faults

  void report(std::size_t position, const PlantFault& fault) { on_fault(Network::nodes[position], fault); }

  /// An RPDO that several nodes could send is reported for the first one.
  void report_rpdo(PlantFaultKind kind, std::uint16_t number) {
    std::size_t position = count;
    Network::Received::for_each([&]<class SignalType, std::size_t Position>() {
      if (SignalType::Rpdo::number == number && position == count) position = SignalType::node;
    });
    if (position != count) report(position, {.kind = kind, .rpdo = number});
  }

  void report_emergency(const Frame& frame) {
    for (std::size_t i = 0; i < count; ++i) {
      if (Network::nodes[i].emcy != cob_id_of(frame)) continue;
      const std::optional<EmergencyMessage> message = emergency_message(frame);
      if (!message) return;
      const auto kind = message->code == 0 ? PlantFaultKind::emergency_over : PlantFaultKind::emergency;
      report(i, {.kind = kind, .emergency = *message});
    }
  }

  void on_event(NmtMasterEvent event, NodeId node_id, NmtState state) {
    const std::optional<std::size_t> position = position_of(node_id);
    if (!position) return;
    switch (event) {
      case NmtMasterEvent::boot_up: return forget(*position);
      case NmtMasterEvent::lost:
        forget(*position);
        return report(*position, {.kind = PlantFaultKind::lost, .state = state});
      case NmtMasterEvent::restarted: return report(*position, {.kind = PlantFaultKind::restarted});
      case NmtMasterEvent::not_watched: return report(*position, {.kind = PlantFaultKind::not_watched});
      case NmtMasterEvent::unexpected_state:
        return report(*position, {.kind = PlantFaultKind::unexpected_state, .state = state});
      case NmtMasterEvent::toggle_error:
        return report(*position, {.kind = PlantFaultKind::toggle_error, .state = state});
      case NmtMasterEvent::state_changed:
      case NmtMasterEvent::back: return;
    }
  }

  void on_boot_result(NodeId node_id, const BootResult& result) {
    const std::optional<std::size_t> position = position_of(node_id);
    if (!position) return on_fault(PlantNode{{}, node_id}, {.kind = PlantFaultKind::boot, .boot = result});
    const bool is_up = result.status == BootStatus::booted || result.status == BootStatus::was_operational;
    if (!is_up) return report(*position, {.kind = PlantFaultKind::boot, .boot = result});
    booted_[*position] = true;
    send_again(*position);
    on_booted(Network::nodes[*position]);
  }

  TimePoint now_{};
  OwnNode node_;
  NmtMaster<BusType, count, Host, Requests> master_;
  typename Network::Received::template Slots<Function> functions_{};
  std::array<bool, Network::Received::count> fresh_{};
  std::array<bool, Network::Sent::count> is_set_{};
  std::array<bool, count> booted_{};
};

}  // namespace canopen
