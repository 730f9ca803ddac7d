/// A CANopen master for programs on a host: boots and monitors its slaves, reads and writes their objects, and
/// exchanges PDOs with them, with the generated types of their devices.
///
///     canopen::HostBus bus{"socketcan:can0"};
///     canopen::Master master{bus, slaves};
///     auto drive = master.remote<cpc_tc1::Device>(canopen::NodeId{5});
///     master.on_configure = [&](canopen::NodeId) { return drive.write<od::profile_velocity>(4'000); };
///     master.on_booted = [&](canopen::NodeId node, const canopen::BootResult& end) { log(boot_text(node, end)); };
///     drive.on_pdo<cpc_tc1::Tpdo2>([](auto status, auto position) { ... });
///     master.start();
///     while (!stop) master.poll(100ms);
#pragma once

// First, so that the compiler's messages about its checks begin with few including files.
#include "canopen/sdo/remote_node.hpp"
//
#include <algorithm>
#include <array>
#include <cstdint>
#include <deque>
#include <functional>
#include <map>
#include <optional>
#include <span>
#include <utility>
#include <vector>

#include "canopen/base/abort_code.hpp"
#include "canopen/base/bytes.hpp"
#include "canopen/base/clock.hpp"
#include "canopen/base/result.hpp"
#include "canopen/can/cob_id.hpp"
#include "canopen/can/frame.hpp"
#include "canopen/can/node_id.hpp"
#include "canopen/emcy/emcy_consumer.hpp"
#include "canopen/host/blocking_sdo.hpp"
#include "canopen/host/master_remote.hpp"
#include "canopen/host/master_text.hpp"
#include "canopen/host/master_transfers.hpp"
#include "canopen/nmt/nmt.hpp"
#include "canopen/nmt_master/network_list.hpp"
#include "canopen/nmt_master/nmt_master.hpp"
#include "canopen/pdo/communication_parameters.hpp"
#include "canopen/pdo/pdo_list.hpp"
#include "canopen/sdo/sdo_queue.hpp"

namespace canopen {

/// Handlers are called only from `poll`, in the order of the events. They may use SDO transfers, during which the
/// master continues to monitor its slaves; they may not call `poll`. Exceptions of the bus are passed on.
///
/// All transfers to a node, of the application and of the boot-up, run one after the other (SdoQueue). The boot-up
/// message of a slave of the list ends those that were requested before with 0800 0022h.
template <BlockingBus BusType>
class Master {
 public:
  static constexpr std::size_t max_slaves = 127;
  static constexpr std::size_t max_requests = 64;       ///< of the application that may wait; further ones: 060A 0023h
  static constexpr std::size_t max_nodes_at_once = 16;  ///< few enough for timely responses at 20 kbit/s
  static constexpr std::size_t max_upload = MasterTransfers::max_upload;  ///< bytes; 0504 0005h: a value is longer

  explicit Master(BusType& can_bus, std::vector<NmtSlave> slaves = {}, NmtStartUp start_up = {},
                  SdoClientOptions options = {})
      : bus_{can_bus}, slaves_{std::move(slaves)}, nmt_{can_bus, slaves_, start_up, options, Host{*this}} {}
  Master(const Master&) = delete;
  Master& operator=(const Master&) = delete;

  /// Configuration step of a slave, after its identity and its concise DCF, and before its error control is started
  /// (CiA 302-2): `ok`, or why it failed, which ends its boot-up with BootStatus::configuration. If it returns no
  /// value, the application continues with `begin_upload` and `begin_download`, and calls `configured` at the end.
  std::function<std::optional<Result<void>>(NodeId)> on_configure;
  /// Called when the boot-up of a slave has ended.
  std::function<void(NodeId, const BootResult&)> on_booted;
  /// Called with each event of a slave and the last reported state.
  std::function<void(NmtMasterEvent, NodeId, NmtState)> on_event;
  /// Called when all mandatory slaves have booted.
  std::function<void()> on_network_started;
  /// Called when the boot time 1F89h elapses and mandatory slaves are missing; the master keeps waiting for them.
  std::function<void()> on_boot_time_elapsed;
  /// Called with the EMCYs of nodes that send them with CAN-ID 80h + node-ID.
  std::function<void(NodeId, const EmergencyMessage&)> on_emergency;

  /// Resets and boots the slaves.
  void start() { nmt_.start(bus_.now()); }

  /// Receives frames for this time, and calls the handlers.
  void poll(Duration span) {
    const TimePoint end = bus_.now() + span;
    do {
      const TimePoint now = bus_.now();
      receive(now < end ? end - now : Duration{0});
      tell();
    } while (bus_.now() < end);
  }

  /// Ends a configuration for which `on_configure` has returned no value. Has no effect if the slave has
  /// booted up again.
  void configured(NodeId node_id, Result<void> result) {
    if (to_configure_[node_id.value() & 0x7F] == 0) after_configuration(node_id, result);
  }

  /// Sends an NMT command to one node, or to all nodes with node-ID 0. Returns false if the bus had no room.
  [[nodiscard]] bool command(NmtCommand command, NodeId node_id) { return nmt_.command(command, node_id); }

  /// Resets and boots a slave again, for instance after a failure.
  void boot(NodeId node_id) { nmt_.boot(node_id, bus_.now()); }

  /// Sends SYNC without a counter.
  [[nodiscard]] bool send_sync() { return bus_.send({.id = 0x80}); }

  /// Returns the last state that a slave reported; empty if it is unknown or lost.
  [[nodiscard]] std::optional<NmtState> state(NodeId node_id) const { return nmt_.state(node_id); }

  /// Returns what the NMT master knows of its slaves.
  [[nodiscard]] const auto& nmt() const { return nmt_; }

  /// Returns a node with the types of its device. It must not outlive the master.
  template <class Device>
  [[nodiscard]] MasterRemote<Device, BusType> remote(NodeId node_id) {
    return {*this, node_id};
  }

  /// Reads an entry; waits for the result.
  [[nodiscard]] Result<std::vector<std::uint8_t>> upload(NodeId node_id, std::uint16_t index, std::uint8_t sub_index) {
    Transfer& transfer = transfers_.add(node_id, index, sub_index);
    const MasterTransfers::Awaited awaited{transfer};
    const Result<void> done = wait_for(transfer, MasterTransfers::upload(transfer));
    if (!done) return done.abort_code();
    return std::move(transfer.bytes);
  }

  /// Writes an entry; waits for the result.
  Result<void> download(NodeId node_id, std::uint16_t index, std::uint8_t sub_index,
                        std::span<const std::uint8_t> bytes) {
    Transfer& transfer = transfers_.add(node_id, index, sub_index);
    const MasterTransfers::Awaited awaited{transfer};
    return wait_for(transfer, MasterTransfers::download(transfer, bytes));
  }

  /// Reads an entry of up to eight bytes; waits for the result.
  [[nodiscard]] SdoAnswer read_number(NodeId node_id, std::uint16_t index, std::uint8_t sub_index,
                                      std::span<std::uint8_t> memory) {
    Transfer& transfer = transfers_.add(node_id, index, sub_index);
    const MasterTransfers::Awaited awaited{transfer};
    const Result<void> done = wait_for(transfer, MasterTransfers::upload(transfer, memory.size()));
    const std::size_t size = done ? transfer.size : 0;
    std::copy_n(transfer.bytes.begin(), size, memory.begin());
    return {done.abort_code(), memory.first(size), transfer.size_known};
  }

  using UploadDone = std::function<void(const Result<std::vector<std::uint8_t>>&)>;
  using DownloadDone = std::function<void(Result<void>)>;

  /// Starts to read an entry; `done` is called from `poll`, exactly once unless this call is rejected: 060A 0023h.
  Result<void> begin_upload(NodeId node_id, std::uint16_t index, std::uint8_t sub_index, UploadDone done) {
    Transfer& transfer = transfers_.add(node_id, index, sub_index, [done = std::move(done)](Transfer& ended) {
      if (!done) return;
      if (ended.result == ok) {
        done(std::move(ended.bytes));
      } else {
        done(ended.result);
      }
    });
    return begin(transfer, MasterTransfers::upload(transfer));
  }

  /// Starts to write a copy of these bytes to an entry.
  Result<void> begin_download(NodeId node_id, std::uint16_t index, std::uint8_t sub_index,
                              std::span<const std::uint8_t> bytes, DownloadDone done) {
    Transfer& transfer = transfers_.add(node_id, index, sub_index, [done = std::move(done)](Transfer& ended) {
      if (done) done(ended.result);
    });
    return begin(transfer, MasterTransfers::download(transfer, bytes));
  }

 private:
  template <class Device, BlockingBus Any>
  friend class MasterRemote;
  using Transfer = MasterTransfers::Transfer;

  /// Queues the events of the NMT master until `poll`.
  struct Host {
    Master& master;
    void happened(NmtMasterEvent event, NodeId node_id, NmtState state) {
      if (event == NmtMasterEvent::boot_up) ++master.boots_[node_id.value() & 0x7F];
      if (event == NmtMasterEvent::boot_up) master.keep([&m = master, node_id] { m.read_cob_ids(node_id); });
      master.keep([&m = master, event, node_id, state] {
        if (m.on_event) m.on_event(event, node_id, state);
      });
    }
    void configure(NodeId node_id) {
      ++master.to_configure_[node_id.value() & 0x7F];
      master.keep([&m = master, node_id] { m.configure(node_id); });
    }
    void booted(NodeId node_id, const BootResult& result) {
      master.keep([&m = master, node_id, result] {
        if (m.on_booted) m.on_booted(node_id, result);
      });
    }
    void network_started() {
      master.keep([&m = master] {
        if (m.on_network_started) m.on_network_started();
      });
    }
    void boot_time_elapsed() {
      master.keep([&m = master] {
        if (m.on_boot_time_elapsed) m.on_boot_time_elapsed();
      });
    }
  };

  struct PdoHandler {
    std::uint8_t node_id;
    std::uint16_t index;   ///< of the communication parameter
    std::uint32_t cob_id;  ///< bit 29 is set for extended frames; `no_cob_id`: the PDO is not valid
    std::uint8_t size;     ///< bytes that it requires
    std::function<void(const Frame&)> call;
  };

  static constexpr std::uint32_t no_cob_id = 0xFFFF'FFFF;

  void keep(std::function<void()> what) { waiting_.push_back(std::move(what)); }

  /// Calls the handlers that are queued now. SDO transfers of a handler receive frames, which may queue more.
  void tell() {
    for (std::size_t count = waiting_.size(); count != 0 && !waiting_.empty(); --count) {
      const std::function<void()> next = std::move(waiting_.front());
      waiting_.pop_front();
      next();
    }
  }

  /// Receives the next frame within this time, or several if the first one is not for the master.
  void receive(Duration timeout) {
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
      if (frame) on_frame(*frame, now);
      nmt_.on_time(now);
      if (frame || now >= end) return;
    }
  }

  void on_frame(const Frame& frame, TimePoint now) {
    nmt_.on_frame(frame, now);
    take(frame);
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
      keep([this, node_id, seen = *message] { on_emergency(node_id, seen); });
    }
  }

  // Transfers

  /// Processes frames received before the request, so that none of them is taken for its response.
  [[nodiscard]] Result<void> submit(Transfer& transfer, const SdoRequest& request) {
    constexpr unsigned at_most = 1'000;  // the bus may receive frames continuously
    for (unsigned i = 0; i != at_most; ++i) {
      const std::optional<Frame> frame = bus_.receive(Duration{0});
      if (!frame) break;
      on_frame(*frame, bus_.now());
    }
    transfer.requested = true;
    const Result<void> submitted = nmt_.request(transfer.node_id, request, bus_.now());
    transfer.requested = static_cast<bool>(submitted);
    return submitted;
  }

  [[nodiscard]] Result<void> wait_for(Transfer& transfer, const SdoRequest& request) {
    const Result<void> submitted = submit(transfer, request);
    if (!submitted) return submitted;
    while (!transfer.over) receive(std::chrono::milliseconds{100});
    return transfer.result;
  }

  /// Removes a transfer that has been rejected, because its end is not reported.
  [[nodiscard]] Result<void> begin(Transfer& transfer, const SdoRequest& request) {
    const Result<void> submitted = submit(transfer, request);
    if (!submitted) transfers_.remove(transfer);
    return submitted;
  }

  /// Applies a written COB-ID, and completes the transfer.
  void on_transfer(Transfer& ended) {
    if (ended.download && ended.result == ok && is_pdo_cob_id(ended.index, ended.sub_index) &&
        ended.bytes.size() == 4) {
      set_cob_id(ended.node_id, ended.index, little_endian_number(ended.bytes));
    }
    if (!ended.done) return;
    keep([this, &ended] {
      const std::function<void(Transfer&)> done = std::move(ended.done);
      done(ended);
      transfers_.remove(ended);
    });
  }

  // Configuration

  void configure(NodeId node_id) {
    std::uint8_t& to_configure = to_configure_[node_id.value() & 0x7F];
    const std::uint8_t turn = to_configure;
    std::optional<Result<void>> result = Result<void>{};
    if (turn == 1) {  // otherwise, it has booted up again
      --to_configure;
      if (on_configure) result = on_configure(node_id);
      if (result && to_configure == 0) after_configuration(node_id, *result);
    } else {
      --to_configure;
    }
  }

  /// Reads the COB-IDs of the slave, which may have changed. A node responds in order: the last one completes them.
  void after_configuration(NodeId node_id, Result<void> result) {
    if (!result) return nmt_.configured(node_id, result.abort_code(), bus_.now());
    const std::uint32_t boots = boots_[node_id.value() & 0x7F];
    const bool reads = read_cob_ids(node_id, [this, node_id, boots](AbortCode code) {
      if (boots != boots_[node_id.value() & 0x7F]) return;  // it has booted up again, and is configured again
      nmt_.configured(node_id, code == AbortCode::timeout ? code : ok, bus_.now());
    });
    if (!reads) nmt_.configured(node_id, ok, bus_.now());
  }

  // COB-IDs of PDOs

  [[nodiscard]] static bool is_pdo_cob_id(std::uint16_t index, std::uint8_t sub_index) {
    return (is_rpdo_communication(index) || is_tpdo_communication(index)) && sub_index == pdo_parameter::cob_id;
  }

  /// Sets the COB-ID of a PDO of a node, for handlers and for RPDOs that are sent.
  void set_cob_id(NodeId node_id, std::uint16_t index, std::uint32_t value) {
    const CobId parameter{value};
    const std::uint32_t extended = parameter.extended() ? std::uint32_t{0x2000'0000} : 0;
    const std::uint32_t cob_id = parameter.valid() ? parameter.can_id() | extended : no_cob_id;
    cob_ids_[{node_id.value(), index}] = cob_id;
    for (PdoHandler& pdo : pdos_) {
      if (pdo.node_id == node_id.value() && pdo.index == index) pdo.cob_id = cob_id;
    }
  }

  /// Reads the known COB-IDs of a node again. `done`, if any, is called at the end of the last one; false:
  /// there are none.
  bool read_cob_ids(NodeId node_id, const std::function<void(AbortCode)>& done = {}) {
    std::vector<std::uint16_t> indices;
    for (const auto& [key, cob_id] : cob_ids_) {
      if (key.first == node_id.value()) indices.push_back(key.second);
    }
    bool last_begun = false;
    for (const std::uint16_t index : indices) {
      const bool last = index == indices.back();
      const auto read = [this, node_id, index, last, done](const Result<std::vector<std::uint8_t>>& bytes) {
        if (bytes && bytes->size() == 4) set_cob_id(node_id, index, little_endian_number(*bytes));
        if (last && done) done(bytes.abort_code());
      };
      const bool begun = static_cast<bool>(begin_upload(node_id, index, pdo_parameter::cob_id, read));
      if (!begun) cob_ids_[{node_id.value(), index}] = no_cob_id;  // unknown; it is read at the next boot-up
      last_begun = last && begun;
    }
    return last_begun;
  }

  /// Returns the COB-ID of a PDO of a node, which is read if unknown. 0800 0022h: the PDO is not valid.
  [[nodiscard]] Result<std::uint32_t> pdo_cob_id(NodeId node_id, std::uint16_t index) {
    const auto key = std::pair{node_id.value(), index};
    const auto known = cob_ids_.find(key);
    if (known != cob_ids_.end() && known->second != no_cob_id) return known->second;
    const Result<std::vector<std::uint8_t>> bytes = upload(node_id, index, pdo_parameter::cob_id);
    if (!bytes) return bytes.abort_code();
    if (bytes->size() != 4) return AbortCode::length_mismatch;
    set_cob_id(node_id, index, little_endian_number(*bytes));
    const std::uint32_t cob_id = cob_ids_[key];
    if (cob_id == no_cob_id) return AbortCode::device_state;
    return cob_id;
  }

  BusType& bus_;
  std::vector<NmtSlave> slaves_;
  NmtMaster<BusType, max_slaves, Host, max_requests, max_nodes_at_once> nmt_;
  MasterTransfers transfers_{[this](Transfer& ended) { on_transfer(ended); }};
  std::deque<PdoHandler> pdos_;
  std::map<std::pair<std::uint8_t, std::uint16_t>, std::uint32_t> cob_ids_;
  std::array<std::uint32_t, 128> boots_{};        ///< boot-up messages, by node-ID
  std::array<std::uint8_t, 128> to_configure_{};  ///< pending calls of `on_configure`, by node-ID
  std::deque<std::function<void()>> waiting_;
};

}  // namespace canopen
