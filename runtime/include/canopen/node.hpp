/// A CANopen device: the services that its dictionary has objects for, around one set of values.
///
/// A node eats frames and time and sends frames; it reads no clock and waits for nothing. It runs in one context.
#pragma once

#include <algorithm>
#include <array>
#include <cstdint>
#include <cstring>
#include <optional>
#include <span>
#include <tuple>
#include <type_traits>
#include <utility>

#include "canopen/abort_code.hpp"
#include "canopen/bus_status.hpp"
#include "canopen/cob_id.hpp"
#include "canopen/communication_parameters.hpp"
#include "canopen/domain_handlers.hpp"
#include "canopen/emcy.hpp"
#include "canopen/emcy_consumer.hpp"
#include "canopen/error_behavior.hpp"
#include "canopen/error_control.hpp"
#include "canopen/error_register.hpp"
#include "canopen/frame.hpp"
#include "canopen/handler_check.hpp"
#include "canopen/handlers.hpp"
#include "canopen/heartbeat.hpp"
#include "canopen/heartbeat_consumer.hpp"
#include "canopen/lss_handler.hpp"
#include "canopen/mpdo.hpp"
#include "canopen/nmt.hpp"
#include "canopen/node_guarding.hpp"
#include "canopen/node_id.hpp"
#include "canopen/object_store.hpp"
#include "canopen/parameter_storage.hpp"
#include "canopen/pdo_mapping.hpp"
#include "canopen/rpdo.hpp"
#include "canopen/sdo_servers.hpp"
#include "canopen/storage.hpp"
#include "canopen/sync.hpp"
#include "canopen/time.hpp"
#include "canopen/time_stamp.hpp"
#include "canopen/tpdo.hpp"

namespace canopen {

/// Whether a value of its type can be refused where the application sets an object: the object has limits, uses fewer
/// bits than its type, or is a parameter of a service.
template <DictionaryObject O>
inline constexpr bool can_be_refused = [] {
  using T = typename O::type;
  if (!std::is_arithmetic_v<T>) return false;
  if (std::is_integral_v<T> && O::index < 0x2000) return true;
  return !std::is_same_v<T, bool> &&
         (requires { O::low_limit; } || requires { O::high_limit; } || O::bits < sizeof(T) * 8);
}();

/// `Device` is what edsc generates. A bus without state is kept by value, another one by reference and must outlive the
/// node.
template <class Device, Bus B, class... Handlers>
class Node {
 public:
  static_assert(checked_handlers<Device, Handlers...>());

  constexpr Node(B& can_bus, NodeId node_id, Handlers... handlers)
      : bus_{can_bus}, handlers_{std::move(handlers)...}, node_id_{node_id} {}
  /// `start` brings the node-ID. With a bus by value such a node is all zeroes: none of it is kept in flash.
  constexpr explicit Node(B& can_bus, Handlers... handlers) : bus_{can_bus}, handlers_{std::move(handlers)...} {}
  Node(const Node&) = delete;
  Node& operator=(const Node&) = delete;

  /// Power-on: default values and over them what is stored, boot-up message, Pre-operational (CiA 301, 7.3.2.1).
  void start(TimePoint now) {
    now_ = now;
    if constexpr (has_storage) parameters_.open(handlers_.storage());
    if constexpr (has_lss) lss_.start(node_id_, lss_handler().port->bit_timing());
    if constexpr (requires { Device::stored_eds; }) bind_constant<StoreEds>(Device::stored_eds);
    reset_node();
    serve();
  }

  /// The same for a node-ID that is known at run time only.
  void start(NodeId node_id, TimePoint now) {
    node_id_ = node_id;
    start(now);
  }

  /// Takes a frame from the bus. Frames that are not for this node are ignored.
  void on_frame(const Frame& frame, TimePoint now) {
    now_ = now;
    if constexpr (has_lss) {
      lss_.on_frame(frame, LssHooks{*this}, now);
      if (lss_.has_reply()) attention_ = true;
    }
    if (state_ == NmtState::initialisation) return serve_lss();
    if (attention_) serve();
    if (!is_rpdo(frame)) on_other_frame(frame);
    if (attention_) serve();
  }

  /// Lets time pass. To be called at `next_deadline()`, when the bus has room again, and at least every half hour.
  void on_time(TimePoint now) {
    now_ = now;
    if constexpr (has_lss) lss_.on_time(LssHooks{*this}, now);
    if (state_ == NmtState::initialisation) return serve_lss();
    sdo_.on_time(now);
    if constexpr (has_heartbeat_consumer) heartbeats_.on_time(now, HeartbeatHost{*this});
    if constexpr (has_guarding) {
      if (guarding_.on_time(guard_time(), now)) life_guarding(true);
    }
    if constexpr (has_rpdos) rpdos_.on_time(RpdoHost{*this});
    serve();
  }

  /// When `on_time` has something to do next: not later than the last time told when it has already. Nothing: only a
  /// frame or the application makes this node send.
  [[nodiscard]] std::optional<TimePoint> next_deadline() const {
    if (state_ == NmtState::initialisation || silent()) return lss_deadline();
    if (heartbeat_.boot_up_due() || sdo_.has_reply()) return now_;
    std::optional<TimePoint> next = heartbeat_.next_deadline();
    const auto consider = [&next](std::optional<TimePoint> other) {
      if (other && (!next || *other < *next)) next = other;
    };
    consider(lss_deadline());
    consider(sdo_.next_deadline());
    if constexpr (has_heartbeat_consumer) consider(heartbeats_.next_deadline());
    if constexpr (has_guarding) {
      if (guarding_.has_answer()) return now_;
      consider(guarding_.next_deadline());
    }
    if (serves_pdo(state_)) {
      if constexpr (has_tpdos) consider(tpdos_.next_deadline(now_));
      if constexpr (has_rpdos) consider(rpdos_.next_deadline());
      if constexpr (MpdoService<Device>::sends_destination) consider(mpdos_.next_deadline(now_));
    }
    if (serves_emcy(state_)) consider(emergencies_.next_deadline(now_));
    if constexpr (SyncProducer<Device>::exists) consider(sync_producer_.next_deadline());
    return next;
  }

  /// Whether a handler of this type was given to the node.
  template <class Handler>
  static constexpr bool has_handler = HandlerSet<Handlers...>::template has<Handler>;

  [[nodiscard]] NmtState state() const { return state_; }
  [[nodiscard]] NodeId node_id() const { return node_id_; }

  /// Does what an NMT master could command (CiA 301, 7.3.2: by local control). Nothing before `start`, or without a
  /// node-ID. From a write or read handler: as soon as the SDO server's answer is sent.
  void request(NmtCommand command, TimePoint now) {
    now_ = now;
    if (state_ == NmtState::initialisation) return;
    if constexpr (has_handlers) {
      if (handling_.active) {
        handling_.requested = static_cast<std::uint8_t>(command);
        attention_ = true;
        return;
      }
    }
    carry_out(command);
    serve();
  }

  /// The value of an object, whatever its access on the bus.
  template <DictionaryObject O>
  [[nodiscard]] typename O::type get() const {
    return store_.template get<O>();
  }

  /// Sets an object, whatever its access on the bus. TPDOs that carry it go out with the next `on_time` or `on_frame`
  /// when the value is a new one. In a write handler of the same object this is the value that counts, and not the one
  /// that was written. This object takes every value of its type: the answer is `ok`.
  template <DictionaryObject O>
  requires(!can_be_refused<O>) AbortCode set(const typename O::type& value) {
    static_assert(!std::is_same_v<typename O::type, Domain>, "the memory of a DOMAIN is bound with bind()");
    return take_over<O>(value);
  }

  /// The same for an object that can refuse a value: value_too_high or value_too_low outside the limits of the data
  /// sheet, invalid_value for a REAL that is not a number. A parameter of 1000h..1FFFh is refused as SDO refuses it: a
  /// PDO is mapped, or gets another CAN-ID, while it is not valid.
  template <DictionaryObject O>
  requires(can_be_refused<O>) [[nodiscard]] AbortCode set(const typename O::type& value) {
    if (const AbortCode code = check_limits<O>(value); code != ok) return code;
    if constexpr (O::index < 0x2000 && std::is_integral_v<typename O::type>) {
      typename O::type checked = value;
      const std::span<std::uint8_t> bytes{reinterpret_cast<std::uint8_t*>(&checked), (O::bits + 7) / 8};
      if (const AbortCode code = check_communication(O::index, O::sub_index, bytes); code != ok) return code;
      return take_over<O>(checked);
    } else {
      return take_over<O>(value);
    }
  }

  /// Sets an object known by number only, in the bytes that SDO would bring. Its access on the bus does not count,
  /// handlers are not called, and services do not ask whether a parameter of theirs may change now; they take it over.
  /// TPDOs go out as with the typed `set`. Refused for its length and its limits as a download would be; read_only: it is
  /// a constant of the data sheet.
  [[nodiscard]] AbortCode set(std::uint16_t index, std::uint8_t sub_index, std::span<const std::uint8_t> bytes) {
    const entry::Word word = EntryAccess<Device>::find(index, sub_index);
    if (word == Dictionary::no_object) return AbortCode::no_object;
    if (word == Dictionary::no_sub_index) return AbortCode::no_sub_index;
    if (entry::place_of(word) != entry::Place::ram) return AbortCode::read_only;
    if (const AbortCode code = entries().check(index, sub_index, word, bytes); code != ok) return code;
    handler_has_set(object_key(index, sub_index));
    if (!entry::is_domain(word) && entries().holds(word, bytes)) return ok;
    if constexpr (has_storage) {
      if ((word & entry::writable) != 0) configuration_changes(index, sub_index, bytes);
    }
    entries().write(word, bytes);
    after_write(index, sub_index, true);
    return ok;
  }

  /// An error of the application has appeared (CiA 301, 7.2.7.1): its emergency error code, the bits of 1001h that it
  /// sets (the generic one comes by itself), and the manufacturer's bytes. Sent with the next `on_time` or `on_frame`, as
  /// what `set` causes: `next_deadline` is due at once.
  void emergency(std::uint16_t code, ErrorRegister bits, const EmergencyInfo& info = {}) {
    emergencies_.appeared(store_, code, bits, info);
    attention_ = true;
    handlers_.template tell<ErrorHandler>(*this, code);
  }

  /// Sets bits of 1001h without an EMCY: an error that has been reported keeps them until `emergency_over` names them.
  void hold_error(ErrorRegister bits) { emergencies_.hold(store_, bits); }

  /// An error of the application has gone. `bits` of 1001h are cleared: those that no other error of the application
  /// holds, none for an error that has named none. The EMCY 0000h goes out, with what is left; nothing when no error
  /// held them.
  void emergency_over(ErrorRegister bits) {
    if (emergencies_.gone(store_, bits)) attention_ = true;
  }

  /// EMCYs that were never sent, since power-on, as more came than can wait while the bus has no room, the inhibit time
  /// 1015h runs or the node is Stopped. 1003h, where there is one, has them all the same. 65,535 stands for more.
  [[nodiscard]] std::uint16_t lost_emergencies() const { return emergencies_.lost(); }

  /// The CAN controller's state has changed, or it has lost frames.
  void on_bus_status(const BusStatus& status, TimePoint now) {
    now_ = now;
    const auto report = [this](ServiceError error, bool there, bool was_there) {
      if (there && !was_there) service_error(error);
      if (!there) service_error_over(error);
    };
    const bool off = status.state == BusState::off;
    const bool was_off = bus_status_.state == BusState::off;
    report(ServiceError::overrun, status.overrun, bus_status_.overrun);
    report(ServiceError::bus_passive, status.state == BusState::passive, bus_status_.state == BusState::passive);
    report(ServiceError::bus_off, off, was_off);
    bus_status_ = status;
    if (off && !was_off) communication_failed();
    if (attention_) serve();
  }

  /// The NMT state that a node of 1016h has told last; nothing while it is unknown or lost.
  [[nodiscard]] std::optional<NmtState> state_of(NodeId other) const requires(consumer_heartbeat_times(Device::dictionary) > 0) {
    return heartbeats_.state_of(other);
  }

  /// Sends TIME with this time of day. False: 1012h does not have this device produce it, the node is not in a state for
  /// it, or the bus has no room.
  bool send_time(TimeOfDay time) { return serves_sync(state_) && TimeStamp<Device>::send(store_, bus_, time); }

  /// Stores parameters as "save" to this sub-index of 1010h does: 1 all, 2 those of 1000h..1FFFh, 3 of 6000h..9FFFh,
  /// 4 of 2000h..5FFFh. hardware: the storage has failed, or the range is not one of these.
  [[nodiscard]] AbortCode save(std::uint8_t sub_index = 1) requires(HandlerSet<Handlers...>::has_storage) {
    const SectionSet sections = sections_of(sub_index);
    const bool saved = sections != 0 && parameters_.save(handlers_.storage(), sections, store_);
    return saved ? ok : AbortCode::hardware;
  }

  /// Gives up stored parameters as "load" to this sub-index of 1011h does: the next reset brings their defaults.
  [[nodiscard]] AbortCode restore(std::uint8_t sub_index = 1) requires(HandlerSet<Handlers...>::has_storage) {
    const SectionSet sections = sections_of(sub_index);
    const bool restored = sections != 0 && parameters_.restore(handlers_.storage(), sections, store_);
    return restored ? ok : AbortCode::hardware;
  }

  /// Sends a value to an object of another node, or of all nodes, as a DAM-MPDO (CiA 301, 7.2.2.5), with the next
  /// `on_time` or `on_frame`. False: the node is not Operational, it has no valid DAM-TPDO, or as many wait as can.
  [[nodiscard]] bool send_mpdo(const MpdoDestination& to, std::uint32_t value) {
    if (!serves_pdo(state_) || !mpdos_.put(entries(), to, value)) return false;
    attention_ = true;
    return true;
  }

  /// The same with the value of an object.
  template <DictionaryObject O>
  [[nodiscard]] bool send_mpdo(const MpdoDestination& to) {
    static_assert(O::bits >= 1 && O::bits <= 32, "a multiplex PDO carries a value of 32 bits at most");
    constexpr std::uint32_t mask = 0xFFFF'FFFF >> (32 - O::bits);
    return send_mpdo(to, static_cast<std::uint32_t>(pdo_detail::to_bits(get<O>())) & mask);
  }

  /// Gives a DOMAIN its memory: a download may fill all of it, an upload sends the first `size` bytes.
  template <DictionaryObject O>
  void bind(std::span<std::uint8_t> memory, std::size_t size) {
    static_assert(std::is_same_v<typename O::type, Domain>, "only a DOMAIN is bound to memory");
    store_.template set<O>(
        {memory.data(), static_cast<std::uint32_t>(size), static_cast<std::uint32_t>(memory.size())});
    sdo_.domain_rebound(O::index, O::sub_index);
    attention_ = true;
  }

  /// The same, with all of the memory as the value.
  template <DictionaryObject O>
  void bind(std::span<std::uint8_t> memory) {
    bind<O>(memory, memory.size());
  }

  /// Gives a DOMAIN that is only read its bytes, which may lie in flash.
  template <DictionaryObject O>
  void bind_constant(std::span<const std::uint8_t> bytes) {
    static_assert(!writable(O::access), "this DOMAIN may be written over the bus");
    store_.template set<O>({const_cast<std::uint8_t*>(bytes.data()), static_cast<std::uint32_t>(bytes.size()), 0});
    sdo_.domain_rebound(O::index, O::sub_index);
    attention_ = true;
  }

  /// The values as they lie in RAM. What is changed here sends no TPDO and restarts no timer. Mapping parameters are not
  /// to be changed here: services keep what follows from them.
  [[nodiscard]] typename Device::Values& values() { return store_.values(); }
  [[nodiscard]] const typename Device::Values& values() const { return store_.values(); }

  /// The dictionary by number, for tools.
  [[nodiscard]] EntryAccess<Device> entries() { return store_.entries(); }

 private:
  using BusMember = std::conditional_t<std::is_empty_v<B>, B, B&>;

  static constexpr bool has_storage = HandlerSet<Handlers...>::has_storage;
  using Parameters = std::conditional_t<has_storage, ParameterStorage<Device>, NoStorage>;

  using Lss = typename lss_detail::Find<Handlers...>::type;
  static constexpr bool has_lss = !std::is_void_v<Lss>;
  static constexpr std::size_t watched_nodes = consumer_heartbeat_times(Device::dictionary);
  static constexpr bool has_heartbeat_consumer = watched_nodes > 0;
  static constexpr bool has_guarding = Device::dictionary.has(0x100C, 0) && Device::dictionary.has(0x100D, 0);
  static constexpr bool has_heartbeat_time = Device::dictionary.has(0x1017, 0);
  static constexpr entry::Word clock_word = Device::dictionary.find(0x1013, 0);
  static constexpr bool has_clock =
      clock_word > Dictionary::no_sub_index && entry::place_of(clock_word) == entry::Place::ram;
  static constexpr entry::Kinds kinds = EntryAccess<Device>::kinds;
  static constexpr bool has_tpdos = TpdoService<Device>::count > 0;
  static constexpr bool has_rpdos = RpdoService<Device>::count > 0;
  static constexpr bool sends_changes = has_tpdos || MpdoService<Device>::sends_source;
  static constexpr bool has_dynamic_tpdos = TpdoService<Device>::has_dynamic_mapping;
  static constexpr bool has_dynamic_rpdos = RpdoService<Device>::has_dynamic_mapping;

  /// 1021h, which a device whose data sheet is generated into it binds by itself.
  using StoreEds = Object<0x1021, 0x00, Domain, Access::ro>;

  static constexpr bool has_handlers = HandlerSet<Handlers...>::has_access_handlers || DomainHandlerSet<Handlers...>::any;

  /// What goes on while a read or write handler is called.
  struct Handling {
    std::uint32_t key;       ///< of the object that is being written
    bool active;             ///< a handler is being called
    bool has_set;            ///< it has set the object itself
    std::uint8_t requested;  ///< the NMT command that it has asked for
  };

  struct Nothing {};
  template <bool Exists, class Service>
  using Present = std::conditional_t<Exists, Service, Nothing>;
  using HeartbeatConsumers = Present<has_heartbeat_consumer, HeartbeatConsumer<watched_nodes>>;

  struct SdoHooks {
    Node& node;
    bool new_value = true;  ///< what is written differs from what was there
    [[nodiscard]] EntryAccess<Device> entries() { return node.entries(); }
    [[nodiscard]] AbortCode before_read(std::uint16_t index, std::uint8_t sub_index) {
      return node.before_read(index, sub_index);
    }
    [[nodiscard]] AbortCode before_write(std::uint16_t index, std::uint8_t sub_index, std::span<std::uint8_t> bytes) {
      const AbortCode code = node.before_write(index, sub_index, bytes);
      if constexpr (has_storage) {
        if (code == ok && !node.set_by_handler()) Parameters::before_write(node.store_, index, sub_index, bytes);
      }
      return code;
    }
    [[nodiscard]] bool is_new(entry::Word word, std::span<const std::uint8_t> bytes) {
      if constexpr (has_handlers) {
        if (node.handling_.has_set) new_value = false;
      }
      if constexpr (sends_changes) {
        // DOMAINs are in no TPDO.
        if (new_value && (word & entry::tpdo) != 0) new_value = !entries().holds(word, bytes);
      }
      return new_value;
    }
    void after_write(std::uint16_t index, std::uint8_t sub_index) { node.after_write(index, sub_index, new_value); }
    [[nodiscard]] AbortCode command(std::uint16_t index, std::uint8_t sub_index, std::span<std::uint8_t> bytes) {
      return node.command(index, sub_index, bytes);
    }

    // DOMAINs that the application streams
    using Streams = DomainHandlerSet<Handlers...>;
    [[nodiscard]] bool streams_upload(std::uint16_t index, std::uint8_t sub_index) const requires(Streams::any) {
      return Streams::streams_upload(object_key(index, sub_index));
    }
    [[nodiscard]] Result<std::uint32_t> read_domain(std::uint16_t index, std::uint8_t sub_index, std::uint32_t offset,
                                                    std::span<std::uint8_t> bytes) requires(Streams::any) {
      const std::uint32_t key = object_key(index, sub_index);
      return node.ask_handlers(0, [&] { return Streams::read(node.handlers_.all(), node, key, offset, bytes); });
    }
    [[nodiscard]] bool streams_download(std::uint16_t index, std::uint8_t sub_index) const requires(Streams::any) {
      return Streams::streams_download(object_key(index, sub_index));
    }
    [[nodiscard]] AbortCode write_domain(std::uint16_t index, std::uint8_t sub_index, std::uint32_t offset,
                                         std::span<const std::uint8_t> bytes, bool last) requires(Streams::any) {
      const std::uint32_t key = object_key(index, sub_index);
      return node.ask_handlers(0, [&] { return Streams::write(node.handlers_.all(), node, key, offset, bytes, last); });
    }
  };

  /// Takes a frame that is an RPDO and has one of the CAN-IDs that the pre-defined connection set gives to PDOs: most
  /// frames are, and no other service is asked. Where an RPDO has another CAN-ID the other services come first.
  [[nodiscard]] bool is_rpdo(const Frame& frame) {
    if constexpr (!has_rpdos || MpdoService<Device>::exists) return false;
    constexpr std::uint32_t first = function_code::tpdo1 + 1;
    constexpr std::uint32_t can_ids = function_code::sdo_response - first;
    const std::uint32_t cob_id = cob_id_of(frame);
    if (frame.remote || cob_id - first >= can_ids || !serves_pdo(state_)) return false;
    return rpdos_.on_frame(frame, cob_id, RpdoHost{*this});
  }

  [[gnu::noinline]] void on_other_frame(const Frame& frame) {
    const std::uint32_t cob_id = cob_id_of(frame);
    if (frame.remote) {
      on_remote(frame);
    } else if (serves_sdo(state_) && sdo_.on_frame(store_, frame, SdoHooks{*this}, now_)) {
      attention_ = true;
    } else if (cob_id == function_code::nmt) {
      on_nmt(frame);
    } else if (on_error_control(frame) || !is_usable(cob_id)) {
      // a message of another node, or one that no service whose COB-ID can be configured may take
    } else if (SyncConsumer<Device>::takes(store_, cob_id)) {
      on_sync(SyncConsumer<Device>::sync_of(store_, frame));
    } else if (const std::optional<TimeOfDay> time = TimeStamp<Device>::take(store_, frame)) {
      if (serves_sync(state_)) handlers_.template tell<TimeHandler>(*this, *time);
    } else if (const std::optional<ConsumedEmergency> emergency = EmergencyConsumer<Device>::take(entries(), frame)) {
      if (serves_emcy(state_)) handlers_.template tell<EmergencyHandler>(*this, *emergency);
    } else if (serves_pdo(state_)) {
      rpdos_.on_frame(frame, cob_id, RpdoHost{*this});
      mpdos_.on_frame(entries(), frame, node_id_, RpdoHost{*this});
    }
  }

  // Network management

  void on_nmt(const Frame& frame) {
    if (is_nmt_command(frame, node_id_)) carry_out(static_cast<NmtCommand>(frame.data[0]));
  }

  /// Nothing for a code that is none. The newest command counts: what a handler has asked for before is over.
  [[gnu::noinline]] void carry_out(NmtCommand command) {
    if constexpr (has_handlers) handling_.requested = 0;
    switch (command) {
      case NmtCommand::start: enter(NmtState::operational); break;
      case NmtCommand::stop: enter(NmtState::stopped); break;
      case NmtCommand::enter_pre_operational: enter(NmtState::pre_operational); break;
      case NmtCommand::reset_node:
        announce_reset();
        reset_node();
        break;
      case NmtCommand::reset_communication:
        announce_reset();
        reset_communication();
        break;
    }
  }

  void announce_reset() {
    if (serves_emcy(state_)) emergencies_.announce_reset(store_, bus_);
  }

  void enter(NmtState next) {
    if (state_ == next && next != NmtState::initialisation) return;
    if constexpr (SyncProducer<Device>::exists) {
      if (!serves_sync(next)) {
        sync_producer_.stop();
      } else if (!serves_sync(state_)) {
        sync_producer_.start(store_, now_, true);
      }
    }
    if constexpr (Device::options.emcy_stopped_keeps_last) {
      if (state_ == NmtState::stopped) emergencies_.keep_last();
    }
    state_ = next;
    if constexpr (has_lss) lss_.enter(next);
    if (!serves_sdo(next)) sdo_.reset();
    if (serves_pdo(next)) {
      tpdos_.enter_operational(store_, now_);
      rpdos_.enter_operational(entries(), Watched{*this});
      mpdos_.enter_operational();
      tell_rpdo_errors();
    }
    attention_ = true;
    handlers_.template tell<StateHandler>(*this, next);
  }

  void reset_node() {
    if constexpr (has_lss) {
      lss_.reset_application();
      node_id_ = lss_.pending_node_id();  // what reset communication makes active
    }
    if constexpr (has_storage) {
      parameters_.reset_application(handlers_.storage(), store_, node_id_);
    } else {
      store_.reset_application(node_id_);
    }
    reset_communication();
  }

  void reset_communication() {
    if constexpr (has_lss) node_id_ = lss_.reset_communication();
    if constexpr (has_storage) {
      parameters_.reset_communication(handlers_.storage(), store_, node_id_);
    } else {
      store_.reset_communication(node_id_);
    }
    emergencies_.reset();
    if constexpr (has_storage) {
      if (parameters_.damaged()) data_set_error();
    }
    if constexpr (has_heartbeat_consumer) heartbeats_.configure(entries());
    if constexpr (has_guarding) guarding_.reset();
    enter(NmtState::initialisation);
    heartbeat_ = {};
    if (!node_id_.valid()) return;
    heartbeat_.boot_up();
    enter(NmtState::pre_operational);
    if (starts_itself()) enter(NmtState::operational);
  }

  /// 1F80h of a device that is not an NMT master: whether it enters Operational without a command (CiA 302-2).
  [[nodiscard]] bool starts_itself() const {
    if constexpr (Device::dictionary.has(0x1F80, 0)) {
      constexpr std::uint32_t waits = nmt_start_up::master | nmt_start_up::no_self_start;
      return (store_.template number<0x1F80, 0>() & waits) == 0;
    } else {
      return false;
    }
  }

  void data_set_error() {
    emergency(emergency_code::data_set, ErrorRegister::generic, Device::emergency_info(emergency_code::data_set));
  }

  // Error control

  struct HeartbeatHost {
    Node& node;
    void happened(HeartbeatEvent event, NodeId other, NmtState state) { node.heartbeat_happened(event, other, state); }
  };

  /// False when the frame is no message of error control that this device looks at.
  bool on_error_control([[maybe_unused]] const Frame& frame) {
    if constexpr (has_heartbeat_consumer) {
      if (const std::optional<ErrorControlMessage> message = error_control_message(frame)) {
        heartbeats_.on_message(*message, now_, HeartbeatHost{*this});
        return true;
      }
    }
    return false;
  }

  void heartbeat_happened(HeartbeatEvent event, NodeId other, NmtState state) {
    if (event == HeartbeatEvent::lost) error_control_failed();
    if (event == HeartbeatEvent::back || event == HeartbeatEvent::boot_up) tell_error_control_over();
    handlers_.template tell<HeartbeatHandler>(*this, event, other, state);
  }

  void life_guarding(bool lost) {
    if (lost) {
      error_control_failed();
    } else {
      tell_error_control_over();
    }
    handlers_.template tell<LifeGuardingHandler>(*this, lost);
  }

  void error_control_failed() {
    service_error(ServiceError::error_control);
    communication_failed();
  }

  void tell_error_control_over() {
    bool failed = false;
    if constexpr (has_heartbeat_consumer) failed = heartbeats_.any_lost();
    if constexpr (has_guarding) failed = failed || guarding_.failed();
    if (!failed) service_error_over(ServiceError::error_control);
  }

  /// What 1029h:01 asks for, after the EMCY.
  void communication_failed() {
    serve();
    std::uint8_t behavior = 0;
    if constexpr (Device::dictionary.has(0x1029, 1)) {
      behavior = static_cast<std::uint8_t>(store_.template number<0x1029, 1>());
    }
    if (const NmtState next = state_after_error(state_, behavior); next != state_) enter(next);
  }

  [[nodiscard]] std::uint16_t guard_time() const {
    return static_cast<std::uint16_t>(store_.template number<0x100C, 0>());
  }
  [[nodiscard]] std::uint8_t life_time_factor() const {
    return static_cast<std::uint8_t>(store_.template number<0x100D, 0>());
  }

  void on_guarding_request() {
    if (heartbeat_period().count() != 0) return;
    const bool was_lost = guarding_.failed();
    guarding_.on_request(guard_time(), life_time_factor(), now_);
    if (was_lost) life_guarding(false);
    attention_ = true;
  }

  // LSS

  struct LssHooks {
    Node& node;
    [[nodiscard]] std::uint32_t identity(std::uint8_t sub_index) {
      const entry::Word word = Device::dictionary.find(0x1018, sub_index);
      return word > Dictionary::no_sub_index ? node.entries().number(word) : 0;
    }
    [[nodiscard]] LssError accept(NodeId node_id) { return node.lss_handler().port->accept(node_id); }
    [[nodiscard]] LssError accept(LssBitTiming timing) { return node.lss_handler().port->accept(timing); }
    [[nodiscard]] LssError store(NodeId node_id, LssBitTiming timing) {
      return node.lss_handler().port->store(node_id, timing);
    }
    void reset_communication() { node.reset_communication(); }
    void stop_communication() { node.lss_handler().port->stop_communication(); }
    void start_communication(LssBitTiming timing) { node.lss_handler().port->start_communication(timing); }
  };

  [[nodiscard]] auto& lss_handler() { return std::get<Lss>(handlers_.all()); }

  /// All that a node without node-ID does.
  void serve_lss() {
    if constexpr (has_lss) {
      attention_ = !lss_.serve(bus_);
      if (state_ != NmtState::initialisation) serve();
    }
  }

  /// The bit rate is being switched: nothing is sent.
  [[nodiscard]] bool silent() const {
    if constexpr (has_lss) {
      return lss_.silent();
    } else {
      return false;
    }
  }

  [[nodiscard]] std::optional<TimePoint> lss_deadline() const {
    if constexpr (has_lss) {
      return lss_.has_reply() && !lss_.silent() ? now_ : lss_.next_deadline();
    } else {
      return std::nullopt;
    }
  }

  // SDO

  [[nodiscard]] AbortCode before_read(std::uint16_t index, std::uint8_t sub_index) {
    if constexpr (Device::dictionary.has(0x1003, 0)) {
      if (index == 0x1003 && sub_index > store_.template number<0x1003, 0>())
        return AbortCode::no_data;  // no such error
    }
    return ask_handlers(0, [&] { return handlers_.before_read(*this, object_key(index, sub_index)); });
  }

  [[nodiscard]] AbortCode before_write(std::uint16_t index, std::uint8_t sub_index, std::span<std::uint8_t> bytes) {
    if (const AbortCode code = check_communication(index, sub_index, bytes); code != ok) return code;
    const std::uint32_t key = object_key(index, sub_index);
    return ask_handlers(key, [&] { return handlers_.before_write(*this, key, bytes); });
  }

  /// Calls the handlers of an object that is read or written: while they run `request` waits, and `set` is noticed.
  template <class Ask>
  [[nodiscard]] auto ask_handlers([[maybe_unused]] std::uint32_t written, Ask&& ask) {
    if constexpr (has_handlers) {
      handling_.key = written;
      handling_.active = true;
      handling_.has_set = false;
      const auto answer = ask();
      handling_.active = false;
      return answer;
    } else {
      return ask();
    }
  }

  /// An object is being set: by its own write handler, perhaps.
  void handler_has_set([[maybe_unused]] std::uint32_t key) {
    if constexpr (has_handlers) {
      if (handling_.active && handling_.key == key) handling_.has_set = true;
    }
  }

  /// Whether the handler of the value that has just been written has set the object itself.
  [[nodiscard]] bool set_by_handler() const {
    if constexpr (has_handlers) return handling_.has_set;
    return false;
  }

  /// A write to an entry that is no variable: "save" and "load". Sub-indices of 1010h and 1011h that CiA 301 gives no
  /// range are what their write handlers make of them.
  [[nodiscard]] AbortCode command([[maybe_unused]] std::uint16_t index, [[maybe_unused]] std::uint8_t sub_index,
                                  [[maybe_unused]] std::span<std::uint8_t> bytes) {
    if constexpr (has_storage) {
      if (index == store_parameters || index == restore_parameters) {
        const std::uint32_t key = object_key(index, sub_index);
        AbortCode code = check_storage_command(entries(), index, sub_index, bytes);
        if (code == ok) code = ask_handlers(key, [&] { return handlers_.before_write(*this, key, bytes); });
        if (code != ok || (sections_of(sub_index) == 0 && handlers_.handles(key))) return code;
        return index == store_parameters ? save(sub_index) : restore(sub_index);
      }
    }
    return AbortCode::not_stored;
  }

  /// What the services have against a write to 1000h..1FFFh.
  [[nodiscard]] AbortCode check_communication(std::uint16_t index, std::uint8_t sub_index,
                                              std::span<std::uint8_t> bytes) {
    if constexpr (MpdoService<Device>::exists) {
      if (const AbortCode code = mpdos_.check(entries(), index, sub_index, bytes); code != ok) return code;
    }
    if constexpr (Device::dictionary.takes_writes(0x1400, 0x15FF) || Device::dictionary.takes_writes(0x1800, 0x19FF)) {
      if (is_rpdo_communication(index) || is_tpdo_communication(index)) {
        return check_pdo_parameter(entries(), index, sub_index, bytes);
      }
    }
    if constexpr (has_dynamic_rpdos || has_dynamic_tpdos) {
      if (is_rpdo_mapping(index) || is_tpdo_mapping(index)) {
        const std::uint8_t capacity = is_tpdo_mapping(index) ? TpdoService<Device>::Mapped::capacity_of(index)
                                                             : RpdoService<Device>::Mapped::capacity_of(index);
        return check_pdo_mapping(entries(), capacity, index, sub_index, bytes);
      }
    }
    if constexpr (Device::dictionary.takes_writes(sdo_server_parameter, last_sdo_server_parameter)) {
      if (index >= sdo_server_parameter && index <= last_sdo_server_parameter) {
        return check_sdo_cob_id(entries(), index, sub_index, bytes);
      }
    }
    if constexpr (SyncConsumer<Device>::exists) {
      if (index == 0x1005 || index == 0x1006 || index == 0x1019) {
        return check_sync_parameter(entries(), index, bytes);
      }
    }
    if constexpr (EmergencyProducer<Device>::has_parameters) {
      if (index == 0x1014 || index == 0x1015) return emergencies_.check(entries(), index, bytes);
    }
    if constexpr (TimeStamp<Device>::exists) {
      if (index == 0x1012) return check_time_parameter(entries(), bytes);
    }
    if constexpr (has_heartbeat_consumer) {
      if (index == 0x1016 && sub_index != 0) {
        return heartbeats_.check(sub_index - 1u, ConsumerHeartbeatTime{number_in(bytes)});
      }
    }
    if constexpr (Device::dictionary.takes_writes(0x1029, 0x1029)) {
      if (index == 0x1029 && sub_index != 0) return check_error_behavior(bytes[0]);
    }
    if constexpr (Device::dictionary.takes_writes(0x1003, 0x1003)) {
      if (index == 0x1003 && sub_index == 0 && bytes[0] != 0)
        return static_cast<AbortCode>(Device::options.error_history_abort_code);
    }
    return ok;
  }

  /// Tells the services that an object has been written: with a new value, or with the one that it had.
  void after_write(std::uint16_t index, std::uint8_t sub_index, bool new_value) {
    attention_ = true;
    if constexpr (has_heartbeat_time) {
      if (index == 0x1017) {
        heartbeat_.set_period(heartbeat_period(), now_);
        if constexpr (has_guarding) {
          if (heartbeat_period().count() != 0) guarding_.reset();
        }
      }
    }
    if constexpr (has_heartbeat_consumer) {
      if (index == 0x1016 && sub_index != 0) {
        const std::uint32_t value = entries().number(EntryAccess<Device>::find(index, sub_index));
        heartbeats_.configure(sub_index - 1u, ConsumerHeartbeatTime{value});
        tell_error_control_over();
      }
    }
    if constexpr (has_guarding) {
      if (index == 0x100C || index == 0x100D) {
        guarding_.configure(guard_time(), life_time_factor());
        tell_error_control_over();
      }
    }
    if constexpr (SyncProducer<Device>::exists) {
      if ((index == 0x1005 || index == 0x1006) && serves_sync(state_)) sync_producer_.start(store_, now_, false);
    }
    if constexpr (has_clock) {
      if (index == 0x1013) clock_offset_ = clock() - now_.since_start().count();
    }
    if (!serves_pdo(state_)) return;
    if constexpr (has_tpdos) {
      if (is_tpdo_communication(index) || is_tpdo_mapping(index)) {
        tpdos_.parameter_changed(store_, index, sub_index, now_);
        if (has_dynamic_tpdos && is_tpdo_mapping(index)) rpdos_.watch_again(entries(), Watched{*this});
      }
      if (new_value) tpdos_.changed(entries(), index, sub_index);
    }
    if (new_value) mpdos_.changed(entries(), index, sub_index);
    if constexpr (has_rpdos) {
      if (is_rpdo_communication(index) || is_rpdo_mapping(index)) {
        rpdos_.parameter_changed(entries(), index, Watched{*this});
        tell_rpdo_errors();
      }
    }
  }

  // PDO

  struct RpdoHost {
    Node& node;
    [[nodiscard]] EntryAccess<Device> entries() const { return node.entries(); }
    [[nodiscard]] TimePoint now() const { return node.now_; }
    [[nodiscard]] bool operational() const { return serves_pdo(node.state_); }
    [[nodiscard]] bool window_over() const { return node.sync_window_.over(node.now_); }
    template <DictionaryObject O>
    void take(const typename O::type& value) {
      node.template take<O>(value);
    }
    void take(std::uint16_t index, std::uint8_t sub_index, std::span<std::uint8_t> bytes) {
      node.take(index, sub_index, bytes);
    }
    void happened(RpdoEvent event, std::uint16_t number) { node.rpdo_happened(event, number); }
    void destination_missing(bool missing) {
      missing ? node.service_error(ServiceError::mpdo_destination) : node.tell_rpdo_errors();
    }
  };

  /// Whether more has to be done with a received value than to store it: it has limits or another size in memory, a
  /// handler or a service waits for it, or a TPDO carries it.
  struct Watched {
    const Node& node;
    [[nodiscard]] bool operator()(MappedObject mapped) const {
      if (mapped.is_dummy()) return false;  // is marked already
      const entry::Word word = EntryAccess<Device>::find(mapped.index(), mapped.sub_index());
      const std::uint8_t size = EntryAccess<Device>::bytes_of(word);
      if ((word & entry::limited) != 0 || (kinds.booleans && entry::is_boolean(word)) ||
          (kinds.padded && (size & (size - 1)) != 0))
        return true;
      if (mapped.index() < 0x2000 || HandlerSet<Handlers...>::handles(mapped.key())) return true;
      if (MpdoService<Device>::sends_source && (word & entry::tpdo) != 0) return true;
      return TpdoService<Device>::carries(const_cast<Node&>(node).entries(), mapped.key());
    }
  };

  [[gnu::noinline]] void on_sync(Sync sync) {
    if (!serves_sync(state_)) return;
    if constexpr (SyncConsumer<Device>::exists) {
      if constexpr (SyncConsumer<Device>::has_overflow) {
        if (!sync.good) {
          service_error(ServiceError::sync_length);
          return;
        }
        service_error_over(ServiceError::sync_length);
      }
      sync_window_.open(store_, now_);
      if constexpr (has_clock) set_clock(now_.since_start().count() + clock_offset_);
      if (serves_pdo(state_)) {
        if constexpr (has_tpdos) {
          // With the values as they are now, and at once where nothing else waits.
          if (!tpdos_.on_sync(store_, bus_, sync, !attention_ && !silent())) serve();
        }
        if constexpr (has_rpdos) rpdos_.on_sync(RpdoHost{*this});
      }
      handlers_.template tell<SyncHandler>(*this, sync.counter);
    }
  }

  /// 1013h: the time of the last SYNC, in us.
  [[nodiscard]] std::uint32_t clock() { return entries().number(clock_word); }
  void set_clock(std::uint32_t microseconds) {
    std::memcpy(entries().ram(clock_word), &microseconds, sizeof microseconds);
  }

  [[gnu::noinline]] void on_remote(const Frame& frame) {
    if constexpr (has_guarding) {
      if (is_guarding_request(frame, node_id_)) return on_guarding_request();
    }
    if constexpr (has_tpdos && Device::options.tpdo_remote_frames) {
      if (!serves_pdo(state_)) return;
      tpdos_.on_remote(entries(), cob_id_of(frame));
      attention_ = true;
    }
  }

  void rpdo_happened(RpdoEvent event, std::uint16_t number) {
    switch (event) {
      case RpdoEvent::taken: break;
      case RpdoEvent::too_short: service_error(ServiceError::pdo_length); break;
      case RpdoEvent::timeout: service_error(ServiceError::rpdo_timeout); break;
      case RpdoEvent::length_right:
      case RpdoEvent::in_time: tell_rpdo_errors(); break;
    }
    handlers_.template tell<RpdoHandler>(*this, event, number);
  }

  /// Errors of RPDOs are over when no RPDO has them any more.
  void tell_rpdo_errors() {
    if constexpr (has_rpdos || MpdoService<Device>::receives) {
      const auto [too_short, timeout] = rpdos_.conditions();
      if (!too_short && !mpdos_.too_short()) service_error_over(ServiceError::pdo_length);
      if (!timeout) service_error_over(ServiceError::rpdo_timeout);
    }
    if constexpr (MpdoService<Device>::receives) {
      if (!mpdos_.destination_missing()) service_error_over(ServiceError::mpdo_destination);
    }
  }

  void service_error(ServiceError error) {
    emergencies_.appeared(store_, error);
    attention_ = true;
    handlers_.template tell<ErrorHandler>(*this, service_error_codes[static_cast<std::uint8_t>(error)]);
  }
  void service_error_over(ServiceError error) {
    if (emergencies_.gone(store_, error)) attention_ = true;
  }

  /// A value for an object known by number. One that is outside its limits or that its handler refuses is not taken.
  void take(std::uint16_t index, std::uint8_t sub_index, std::span<std::uint8_t> bytes) {
    const entry::Word word = EntryAccess<Device>::find(index, sub_index);
    if (kinds.booleans && entry::is_boolean(word)) bytes[0] = bytes[0] != 0 ? 1 : 0;
    if (entries().check(index, sub_index, word, bytes) != ok) return;
    if (before_write(index, sub_index, bytes) != ok || set_by_handler()) return;
    if (entries().holds(word, bytes)) return;
    entries().write(word, bytes);
    after_write(index, sub_index, true);
  }

  /// A value from an RPDO. One that is outside its limits or that its handler refuses is not taken.
  template <DictionaryObject O>
  void take(const typename O::type& value) {
    if (check_limits<O>(value) != ok) return;
    if constexpr (HandlerSet<Handlers...>::template handles_write<O>) {
      const auto ask = [&] { return handlers_.template before_write<O>(*this, value); };
      if (ask_handlers(object_key(O::index, O::sub_index), ask) != ok || set_by_handler()) return;
    }
    if (store_.template set<O>(value)) changed<O>();
  }

  /// A value that has passed all checks.
  template <DictionaryObject O>
  AbortCode take_over(const typename O::type& value) {
    if constexpr (HandlerSet<Handlers...>::template handles_write<O>) {
      handler_has_set(object_key(O::index, O::sub_index));
    }
    if (!store_.template set<O>(value)) return ok;
    if constexpr (has_storage) {
      if constexpr (Parameters::template is_configuration<O>) {
        if (state_ != NmtState::initialisation) Parameters::clear_configuration(store_);
      }
    }
    changed<O>();
    return ok;
  }

  /// The application is about to set an object. What it sets in Initialisation belongs to the configuration that the
  /// device has after a reset; a later change makes 1020h 0.
  void configuration_changes(std::uint16_t index, std::uint8_t sub_index, std::span<const std::uint8_t> bytes) {
    if (state_ != NmtState::initialisation) Parameters::before_write(store_, index, sub_index, bytes);
  }

  template <DictionaryObject O>
  void changed() {
    if constexpr (O::index < 0x2000) after_write(O::index, O::sub_index, true);
    if constexpr (has_tpdos) {
      if (serves_pdo(state_) && tpdos_.template changed<O>(entries())) attention_ = true;
    }
    if (serves_pdo(state_) && mpdos_.changed(entries(), O::index, O::sub_index)) attention_ = true;
  }

  template <DictionaryObject O>
  [[nodiscard]] static AbortCode check_limits([[maybe_unused]] const typename O::type& value) {
    using T = typename O::type;
    if constexpr (std::is_arithmetic_v<T> && !std::is_same_v<T, bool>) {
      if constexpr (requires { O::high_limit; } || std::is_integral_v<T>) {
        if (value > high_limit<O>()) return AbortCode::value_too_high;
      }
      if constexpr (requires { O::low_limit; } || std::is_integral_v<T>) {
        if (value < low_limit<O>()) return AbortCode::value_too_low;
      }
      if constexpr (std::is_floating_point_v<T> && requires { O::low_limit; }) {
        if (value != value) return AbortCode::invalid_value;
      }
    }
    return ok;
  }

  // Sending

  [[nodiscard]] Duration heartbeat_period() const {
    if constexpr (has_heartbeat_time) {
      return from_milliseconds(static_cast<std::uint16_t>(store_.template number<0x1017, 0>()));
    } else {
      return Duration{0};
    }
  }

  /// Sends what is due, in order of importance; what finds no room stays due.
  [[gnu::noinline]] void serve() {
    attention_ = false;
    if (silent()) return;
    if constexpr (SyncProducer<Device>::exists) {
      if (sync_producer_.serve(store_, bus_, now_)) {
        attention_ = true;  // what is more important than a PDO goes out before them
        on_sync(sync_producer_.last(store_));
        attention_ = false;
      }
    }
    if (!send_due()) attention_ = true;
    if constexpr (has_handlers) {
      if (handling_.requested != 0 && !sdo_.has_reply()) carry_out_requested();
    }
  }

  /// What a handler has asked for, now that the SDO server has answered.
  void carry_out_requested() {
    carry_out(static_cast<NmtCommand>(handling_.requested));
    serve();
  }

  /// The boot-up message, or a heartbeat.
  [[nodiscard, gnu::noinline]] bool serve_heartbeat() {
    return heartbeat_.serve(bus_, node_id_, state_, heartbeat_period(), now_);
  }

  [[nodiscard]] bool send_due() {
    if (heartbeat_.boot_up_due() && !serve_heartbeat()) return false;
    if constexpr (has_lss) {
      if (!lss_.serve(bus_)) return false;
    }
    if constexpr (has_guarding) {
      if (!guarding_.serve(bus_, node_id_, state_)) return false;
    }
    if (!sdo_.serve(store_, bus_, SdoHooks{*this}, now_)) return false;
    if constexpr (has_heartbeat_time) {
      if (!serve_heartbeat()) return false;
    }
    if (serves_emcy(state_) && !emergencies_.serve(store_, bus_, now_)) return false;
    if constexpr (has_tpdos) {
      if (SyncWindow<Device>::exists && sync_window_.over(now_)) tpdos_.miss_sync();
      if (serves_pdo(state_) && !tpdos_.serve(store_, bus_, now_)) return false;
    }
    if constexpr (MpdoService<Device>::sends_destination) {
      if (serves_pdo(state_)) return mpdos_.serve(entries(), node_id_, bus_, now_);
    }
    return true;
  }

  // What is used most first, the values last: a Cortex-M0+ reaches bytes at offsets up to 31 in one instruction.
  [[no_unique_address]] BusMember bus_;
  [[no_unique_address]] HandlerSet<Handlers...> handlers_;
  TimePoint now_{};
  NodeId node_id_{};
  NmtState state_ = NmtState::initialisation;
  bool attention_ = false;  ///< something may have become due since it was last looked after
  BusStatus bus_status_{};
  HeartbeatProducer heartbeat_{};
  [[no_unique_address]] Present<has_handlers, Handling> handling_{};
  [[no_unique_address]] SyncWindow<Device> sync_window_{};
  [[no_unique_address]] Present<SyncProducer<Device>::exists, SyncProducer<Device>> sync_producer_{};
  SdoServers<Device> sdo_{};
  EmergencyProducer<Device> emergencies_{};
  [[no_unique_address]] Present<has_clock, std::uint32_t> clock_offset_{};  ///< us from the node's time to 1013h
  [[no_unique_address]] Present<has_guarding, NodeGuardingSlave> guarding_{};
  [[no_unique_address]] typename lss_detail::SlaveOf<Lss>::type lss_{};
  [[no_unique_address]] Parameters parameters_{};
  [[no_unique_address]] HeartbeatConsumers heartbeats_{};
  [[no_unique_address]] MpdoService<Device> mpdos_{};
  [[no_unique_address]] RpdoService<Device> rpdos_{};
  [[no_unique_address]] TpdoService<Device> tpdos_{};
  ObjectStore<Device> store_{};
};

/// A node of a device on a bus, with its handlers:
///     auto drive = canopen::make_node<cpc_tc1::Device>(bus, canopen::NodeId{5}, canopen::on_write<...>(...));
template <class Device, Bus B, class... Handlers>
[[nodiscard]] constexpr Node<Device, B, Handlers...> make_node(B& bus, NodeId node_id, Handlers... handlers) {
  return Node<Device, B, Handlers...>{bus, node_id, std::move(handlers)...};
}

/// The same with the handlers in a tuple, as a function that makes all handlers of an application returns them:
///     auto pump_node = canopen::make_node<pump::Device>(bus, canopen::NodeId{5}, application.handlers());
template <class Device, Bus B, class... Handlers>
[[nodiscard]] constexpr Node<Device, B, Handlers...> make_node(B& bus, NodeId node_id, std::tuple<Handlers...> handlers) {
  return std::apply(
      [&](Handlers&... handler) { return Node<Device, B, Handlers...>{bus, node_id, std::move(handler)...}; }, handlers);
}

/// The same for a node whose node-ID comes with `start`.
template <class Device, Bus B, class... Handlers>
[[nodiscard]] constexpr Node<Device, B, Handlers...> make_node(B& bus, Handlers... handlers) {
  return Node<Device, B, Handlers...>{bus, std::move(handlers)...};
}

}  // namespace canopen
