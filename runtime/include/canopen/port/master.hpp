/// A CANopen master for programs on a host: boots and watches its slaves, reads and writes their objects, and exchanges
/// PDOs with them, all by the generated types of their devices.
///
///     canopen::HostBus bus{"socketcan:can0"};
///     canopen::Master master{bus, slaves, {canopen::nmt_start_up::no_slave_start}};
///     auto drive = master.remote<cpc_tc1::Device>(canopen::NodeId{5});
///     master.on_booted = [&](canopen::NodeId, canopen::BootStatus) { drive.write<od::profile_velocity>(4'000); };
///     drive.on_pdo<cpc_tc1::Tpdo2>([](auto status, auto position) { ... });
///     master.start();
///     while (!stop) master.poll(100ms);
#pragma once

#include <algorithm>
#include <cstdint>
#include <deque>
#include <functional>
#include <map>
#include <optional>
#include <tuple>
#include <type_traits>
#include <utility>
#include <vector>

#include "canopen/abort_code.hpp"
#include "canopen/cob_id.hpp"
#include "canopen/emcy_consumer.hpp"
#include "canopen/frame.hpp"
#include "canopen/network_list.hpp"
#include "canopen/nmt.hpp"
#include "canopen/nmt_master.hpp"
#include "canopen/node_id.hpp"
#include "canopen/pdo_list.hpp"
#include "canopen/port/blocking_sdo.hpp"
#include "canopen/result.hpp"
#include "canopen/time.hpp"

namespace canopen {

namespace master_detail {

/// The number of the one PDO in a list that has a layout; 0: none has, or several have.
template <class Layout, class List>
inline constexpr std::uint16_t number_in = 0;
template <class Layout, class... Pdos>
inline constexpr std::uint16_t number_in<Layout, PdoList<Pdos...>> =
    (unsigned{std::is_base_of_v<Layout, Pdos>} + ... + 0u) == 1
        ? static_cast<std::uint16_t>((unsigned{std::is_base_of_v<Layout, Pdos> ? Pdos::number : std::uint16_t{0}} +
                                      ... + 0u))
        : std::uint16_t{0};

}  // namespace master_detail

template <class Device, BlockingBus B>
class MasterRemote;

/// Handlers are called from `poll` alone, in the order in which things have happened. They may transfer by SDO, for
/// which the master goes on watching its slaves; they may not call `poll`. What the bus throws comes through.
template <BlockingBus B>
class Master {
 public:
  explicit Master(B& can_bus, std::vector<NmtSlave> slaves = {}, NmtStartUp start_up = {},
                  SdoClientOptions options = {})
      : bus_{can_bus},
        slaves_{std::move(slaves)},
        nmt_{can_bus, slaves_, start_up, options.timeout, Host{*this}},
        sdo_{watched_, options} {}
  Master(const Master&) = delete;
  Master& operator=(const Master&) = delete;

  /// How the boot-up of a slave has ended.
  std::function<void(NodeId, BootStatus)> on_booted;
  /// What the master sees of a slave, with the state last told.
  std::function<void(NmtMasterEvent, NodeId, NmtState)> on_event;
  /// All mandatory slaves have booted.
  std::function<void()> on_network_started;
  /// The EMCY of a node that sends it at 80h + node-ID.
  std::function<void(NodeId, const EmergencyMessage&)> on_emergency;

  /// Resets and boots the slaves.
  void start() { nmt_.start(bus_.now()); }

  /// Takes what comes within this time, and tells it.
  void poll(Duration span) {
    const TimePoint end = bus_.now() + span;
    do {
      const TimePoint now = bus_.now();
      static_cast<void>(receive(now < end ? end - now : Duration{0}));
      tell();
    } while (bus_.now() < end);
  }

  /// An NMT command to one node, or to all with node-ID 0. False when the bus had no room.
  bool command(NmtCommand command, NodeId node_id) { return nmt_.command(command, node_id); }

  /// A slave that has failed is reset and booted again.
  void boot(NodeId node_id) { nmt_.boot(node_id, bus_.now()); }

  /// SYNC, without a counter.
  [[nodiscard]] bool send_sync() { return bus_.send({.id = 0x80}); }

  /// The state that a slave has told last; nothing when it is unknown or lost.
  [[nodiscard]] std::optional<NmtState> state(NodeId node_id) const { return nmt_.state(node_id); }

  /// A node by the types of its device. It must not outlive the master.
  template <class Device>
  [[nodiscard]] MasterRemote<Device, B> remote(NodeId node_id) {
    return {*this, node_id};
  }

 private:
  template <class Device, BlockingBus Any>
  friend class MasterRemote;

  static constexpr std::size_t most_slaves = 127;

  /// Keeps what the NMT master tells until `poll`.
  struct Host {
    Master& master;
    void happened(NmtMasterEvent event, NodeId node_id, NmtState state) {
      master.keep([&m = master, event, node_id, state] {
        if (m.on_event) m.on_event(event, node_id, state);
      });
    }
    void booted(NodeId node_id, BootStatus status) {
      master.keep([&m = master, node_id, status] {
        if (m.on_booted) m.on_booted(node_id, status);
      });
    }
    void network_started() {
      master.keep([&m = master] {
        if (m.on_network_started) m.on_network_started();
      });
    }
    void boot_time_elapsed() {}
  };

  /// The bus as transfers see it: while they wait the master goes on.
  struct WatchedBus {
    Master& master;
    [[nodiscard]] bool send(const Frame& frame) { return master.bus_.send(frame); }
    [[nodiscard]] std::optional<Frame> receive(Duration timeout) { return master.receive(timeout); }
    [[nodiscard]] TimePoint now() { return master.bus_.now(); }
  };

  struct PdoHandler {
    std::uint32_t cob_id;
    std::uint8_t size;  ///< bytes that it needs
    std::function<void(const Frame&)> call;
  };

  void keep(std::function<void()> what) { waiting_.push_back(std::move(what)); }

  void tell() {
    while (!waiting_.empty()) {
      const std::function<void()> next = std::move(waiting_.front());
      waiting_.pop_front();
      next();
    }
  }

  /// The next frame within this time. The NMT master has seen it then; PDOs and EMCYs are kept.
  [[nodiscard]] std::optional<Frame> receive(Duration timeout) {
    constexpr Duration try_again{1'000};  // the bus had no room for a frame
    const TimePoint end = bus_.now() + timeout;
    for (;;) {
      const TimePoint before = bus_.now();
      Duration wait = before < end ? end - before : Duration{0};
      if (const std::optional<TimePoint> deadline = nmt_.next_deadline()) {
        wait = std::min(wait, *deadline > before ? *deadline - before : try_again);
      }
      const std::optional<Frame> frame = bus_.receive(wait);
      const TimePoint now = bus_.now();
      if (frame) {
        nmt_.on_frame(*frame, now);
        take(*frame);
      }
      nmt_.on_time(now);
      if (frame || now >= end) return frame;
    }
  }

  void take(const Frame& frame) {
    if (frame.remote) return;
    for (std::size_t i = 0; i < pdos_.size(); ++i) {
      if (pdos_[i].cob_id == cob_id_of(frame) && frame.size >= pdos_[i].size) {
        keep([this, i, frame] { pdos_[i].call(frame); });
      }
    }
    const NodeId node_id{static_cast<std::uint8_t>(frame.id & 0x7F)};
    if (!on_emergency || frame.extended || (frame.id & ~0x7Fu) != function_code::emcy || !node_id.valid()) return;
    if (const std::optional<EmergencyMessage> message = emergency_message(frame)) {
      keep([this, node_id, told = *message] { on_emergency(node_id, told); });
    }
  }

  /// The COB-ID in a PDO communication parameter of a node, read once. 0800 0022h: the PDO is not valid.
  [[nodiscard]] Result<std::uint32_t> pdo_cob_id(NodeId node_id, std::uint16_t index) {
    const auto key = std::pair{node_id.value(), index};
    if (const auto known = cob_ids_.find(key); known != cob_ids_.end()) return known->second;
    const Result<std::vector<std::uint8_t>> bytes = sdo_.upload(node_id, index, pdo_parameter::cob_id, 4);
    if (!bytes) return bytes.abort_code();
    std::uint32_t value = 0;
    for (std::size_t i = bytes->size(); i > 0; --i) value = (value << 8) | (*bytes)[i - 1];
    const CobId cob_id{value};
    if (!cob_id.valid()) return AbortCode::device_state;
    return cob_ids_[key] = cob_id.can_id() | (cob_id.extended() ? std::uint32_t{0x2000'0000} : 0);
  }

  B& bus_;
  std::vector<NmtSlave> slaves_;
  NmtMaster<B, most_slaves, Host> nmt_;
  WatchedBus watched_{*this};
  BlockingSdo<WatchedBus> sdo_;
  std::deque<PdoHandler> pdos_;
  std::map<std::pair<std::uint8_t, std::uint16_t>, std::uint32_t> cob_ids_;
  std::deque<std::function<void()>> waiting_;
};

/// A device on the bus by its generated types: its objects over SDO, its PDOs by their layouts.
template <class Device, BlockingBus B>
class MasterRemote {
 public:
  MasterRemote(Master<B>& master, NodeId node_id) : master_{master}, node_id_{node_id} {}

  [[nodiscard]] NodeId node_id() const { return node_id_; }

  /// The value of an object.
  template <DictionaryObject O>
  [[nodiscard]] auto read() {
    return blocking().template read<O>();
  }
  /// Writes an object. A value outside the limits is refused without a frame.
  template <DictionaryObject O, class V>
  Result<void> write(V value) {
    return blocking().template write<O>(value);
  }
  /// Writes a constant, whose limits the compiler checks.
  template <DictionaryObject O, auto Value>
  Result<void> write() {
    return blocking().template write<O, Value>();
  }

  /// From now on the handler is called with the values of each TPDO of this layout: `handler(values...)`. Its COB-ID is
  /// read from the node.
  template <class Layout, class F>
  Result<void> on_pdo(F handler) {
    const Result<std::uint32_t> cob_id = master_.pdo_cob_id(node_id_, tpdo_index<Layout>());
    if (!cob_id) return cob_id.abort_code();
    master_.pdos_.push_back({*cob_id, Layout::size, [handler = std::move(handler)](const Frame& frame) mutable {
                               std::apply(handler, Layout::unpack(frame));
                             }});
    return ok;
  }

  /// Sends an RPDO with these values. 060A 0023h: the bus has no room.
  template <class Layout, class... Values>
  Result<void> send(const Values&... values) {
    constexpr std::uint16_t number = master_detail::number_in<Layout, typename Device::Rpdos>;
    static_assert(number != 0, "no RPDO of this device has this layout, or several have");
    const Result<std::uint32_t> cob_id =
        master_.pdo_cob_id(node_id_, static_cast<std::uint16_t>(rpdo_indices.communication + number - 1));
    if (!cob_id) return cob_id.abort_code();
    Frame frame = frame_of(*cob_id);
    Layout::pack_into(frame, values...);
    return master_.bus_.send(frame) ? ok : AbortCode::no_resource;
  }

  /// Asks for a TPDO by a remote frame. 060A 0023h: the bus has no room.
  template <class Layout>
  Result<void> request() {
    const Result<std::uint32_t> cob_id = master_.pdo_cob_id(node_id_, tpdo_index<Layout>());
    if (!cob_id) return cob_id.abort_code();
    Frame frame = frame_of(*cob_id);
    frame.remote = true;
    frame.size = Layout::size;
    return master_.bus_.send(frame) ? ok : AbortCode::no_resource;
  }

 private:
  template <class Layout>
  [[nodiscard]] static constexpr std::uint16_t tpdo_index() {
    constexpr std::uint16_t number = master_detail::number_in<Layout, typename Device::Tpdos>;
    static_assert(number != 0, "no TPDO of this device has this layout, or several have");
    return static_cast<std::uint16_t>(tpdo_indices.communication + number - 1);
  }
  [[nodiscard]] static Frame frame_of(std::uint32_t cob_id) {
    Frame frame{};
    frame.extended = (cob_id & 0x2000'0000) != 0;
    frame.id = cob_id & 0x1FFF'FFFF;
    return frame;
  }
  [[nodiscard]] auto blocking() { return master_.sdo_.template remote<Device>(node_id_); }

  Master<B>& master_;
  NodeId node_id_;
};

}  // namespace canopen
