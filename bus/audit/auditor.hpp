/// A verdict on a recorded bus: each frame is checked against the parameters that apply to the nodes, with memory that
/// does not grow with the log.
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "audit/audit_state.hpp"
#include "audit/checks/bus_check.hpp"
#include "audit/checks/emergency_check.hpp"
#include "audit/checks/guarding_check.hpp"
#include "audit/checks/heartbeat_check.hpp"
#include "audit/checks/incident_check.hpp"
#include "audit/checks/lss_check.hpp"
#include "audit/checks/nmt_check.hpp"
#include "audit/checks/pdo_check.hpp"
#include "audit/checks/sdo_check.hpp"
#include "audit/checks/sync_check.hpp"
#include "audit/cycle_times.hpp"
#include "audit/network_times.hpp"
#include "decode/decoder.hpp"
#include "decode/log/log_line.hpp"
#include "decode/log/ordered_time.hpp"

namespace edsc::audit {

/// What an audit has seen, beside its findings.
struct Totals {
  std::uint64_t frames = 0;
  bool has_times = false;
  std::int64_t duration_us = 0;
  std::size_t nodes = 0;        ///< that sent at least one frame
  std::uint64_t mean_load = 0;  ///< in tenths of a percent
  std::uint64_t max_load = 0;   ///< over 100 ms, in tenths of a percent
};

class Auditor {
 public:
  /// The decoder, which evaluates the same frames, must outlive the auditor.
  Auditor(const Decoder& decoder, const Limits& limits);
  Auditor(const Auditor&) = delete;
  Auditor& operator=(const Auditor&) = delete;

  /// The node-ID of the NMT master, if it is a node, too.
  void set_nmt_master(std::uint8_t node_id) { audit_.nmt_master = node_id; }
  void silence(RuleId rule) { audit_.findings.silence(rule); }
  /// The run of `edsc conform` that wrote the log.
  void expect(Provocations provocations) { audit_.findings.expect(std::move(provocations)); }

  /// Measures the messages of the network, which must outlive the auditor.
  void measure(const Network& network) { network_times_.emplace(network); }

  /// Checks a frame whose message the decoder has just returned.
  void see(const LogLine& line, const Message& message);

  /// Reports what is still missing at the end of the log.
  void finish();

  [[nodiscard]] const Findings& findings() const { return audit_.findings; }
  [[nodiscard]] const Incidents& incidents() const { return audit_.incidents; }
  [[nodiscard]] const CycleTimes& cycle_times() const { return cycle_times_; }
  /// Null without a network.
  [[nodiscard]] const NetworkTimes* network_times() const { return network_times_ ? &*network_times_ : nullptr; }
  /// After `finish()`.
  [[nodiscard]] Totals totals() const;

 private:
  [[nodiscard]] Moment moment_of(const LogLine& line);
  void restart_times(const Moment& now, std::int64_t back_us);
  void check_interface(const LogLine& line);
  void end_interval(std::uint8_t node_id, const Moment& now);
  void read_settings(const Message& message);

  AuditState audit_;
  IncidentCheck incident_;
  NmtCheck nmt_;
  HeartbeatCheck heartbeat_;
  GuardingCheck guarding_;
  SyncCheck sync_;
  PdoCheck pdo_;
  EmergencyCheck emergency_;
  SdoCheck sdo_;
  LssCheck lss_;
  BusCheck bus_;
  CycleTimes cycle_times_;
  std::optional<NetworkTimes> network_times_;
  std::uint64_t frames_ = 0;
  OrderedTime times_;
  std::string interface_;  ///< of the first frame that has one
  Moment now_;
};

}  // namespace edsc::audit
