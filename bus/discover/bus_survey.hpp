/// What the frames of an unknown bus show: its nodes, SYNC, and the CAN-IDs that may be PDOs.
#pragma once

#include <array>
#include <canopen/can/frame.hpp>
#include <canopen/nmt/nmt.hpp>
#include <cstdint>
#include <map>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "audit/cycle_times.hpp"
#include "audit/spread.hpp"
#include "decode/decoder.hpp"
#include "decode/log/ordered_time.hpp"
#include "decode/message.hpp"
#include "device/entry_address.hpp"
#include "online/scan.hpp"

namespace edsc::discover {

struct SurveyedNode {
  std::optional<canopen::NmtState> state;  ///< the last one that it reported
  std::uint64_t frames = 0;                ///< that certainly are its own: error control, EMCY, SDO responses
  std::uint64_t boot_ups = 0, emergencies = 0;
  bool answers_sdo = false;
  std::map<EntryKey, std::uint32_t> parameters;  ///< 1000h to 1BFFh, as others read or wrote them
  std::optional<std::string> name;               ///< 1008h
};

/// How a PDO seems to be sent.
enum class Transmission : std::uint8_t { unknown, sync, timed, event };

[[nodiscard]] std::string_view to_text(Transmission transmission);

/// How the node of a PDO was found.
enum class PdoSource : std::uint8_t { none, parameters, default_cob_id };

/// A CAN-ID without a fixed service.
struct SurveyedPdo {
  canopen::Frame frame;  ///< the last one
  std::uint8_t min_bytes = 8, max_bytes = 0;
  std::uint64_t frames = 0;
  audit::Spread distance;                             ///< between two frames
  audit::Spread after_sync;                           ///< from the last SYNC
  std::map<std::uint64_t, std::uint64_t> sync_steps;  ///< how often there were so many SYNCs between two frames
  std::uint64_t last_sync = 0;                        ///< number of SYNCs before the last frame
  std::optional<std::int64_t> last_us;
};

/// A guess about a CAN-ID.
struct GuessedPdo {
  Transmission transmission{};
  std::uint64_t every_sync = 0;           ///< of `sync`
  std::optional<std::int64_t> period_us;  ///< of `timed`
  PdoSource source{};
  std::uint8_t node_id = 0;  ///< 0: unknown
  bool is_tpdo = false;      ///< of this node
  std::uint16_t number = 0;  ///< of the PDO of this node
};

class BusSurvey {
 public:
  static constexpr std::size_t node_ids = 128;
  using Pdos = std::map<std::uint32_t, SurveyedPdo>;  ///< by COB-ID; bit 29: extended

  BusSurvey();

  /// Adds a frame, in the order of the bus. Without a time, it does not count for periods. Returns how far
  /// the time goes back, in microseconds, if that is more than disorder; else 0. No period is measured across it.
  std::int64_t add(const canopen::Frame& frame, bool has_time, std::int64_t us);

  [[nodiscard]] std::uint64_t frames() const { return frames_; }
  /// Nothing without times.
  [[nodiscard]] std::optional<std::int64_t> duration_us() const;
  [[nodiscard]] const SurveyedNode& node(std::uint8_t node_id) const { return nodes_[node_id]; }
  [[nodiscard]] const Pdos& pdos() const { return pdos_; }
  [[nodiscard]] std::uint64_t syncs() const { return syncs_; }
  [[nodiscard]] bool has_sync_counter() const { return has_sync_counter_; }
  [[nodiscard]] std::uint64_t nmt_commands() const { return nmt_commands_; }
  [[nodiscard]] std::uint64_t time_messages() const { return time_messages_; }

  /// The period of SYNC, and that of the heartbeat of a node, as a round number; nothing if they are not known.
  [[nodiscard]] std::optional<std::int64_t> sync_period_us() const;
  [[nodiscard]] std::optional<std::int64_t> heartbeat_period_us(std::uint8_t node_id) const;
  /// Whether 1017h of a node is in the log or on the bus.
  [[nodiscard]] bool heartbeat_is_read(std::uint8_t node_id) const {
    return nodes_[node_id].parameters.contains({0x1017, 0});
  }
  [[nodiscard]] GuessedPdo guess(const SurveyedPdo& pdo) const;

  /// The nodes with the identity and heartbeat time that others read, else the measured heartbeat period.
  [[nodiscard]] std::vector<FoundNode> found_nodes() const;

 private:
  void restart_times();
  void see_node(const Message& message, const canopen::Frame& frame);
  void see_transfer(const Message& message);
  void see_unknown(const canopen::Frame& frame, bool has_time);
  [[nodiscard]] const audit::Cycle* cycle(audit::CycleKind kind, std::uint8_t node_id) const;
  void find_owner(const canopen::Frame& frame, GuessedPdo& guessed) const;

  Decoder decoder_;
  Message message_;
  audit::AuditState audit_;
  audit::CycleTimes cycle_times_;
  OrderedTime time_;
  std::array<SurveyedNode, node_ids> nodes_;
  Pdos pdos_;
  std::uint64_t frames_ = 0, syncs_ = 0, nmt_commands_ = 0, time_messages_ = 0;
  bool has_sync_counter_ = false;
  std::optional<std::int64_t> last_sync_us_;
};

/// The nearest round number if it differs by at most 1 %: 99.7 ms is 100 ms.
[[nodiscard]] std::int64_t round_period(double us);

}  // namespace edsc::discover
