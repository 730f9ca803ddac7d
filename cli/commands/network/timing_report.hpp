/// Load and response times of a network, as `edsc network check` prints them.
#pragma once

#include <nlohmann/json.hpp>
#include <optional>
#include <string>
#include <vector>

#include "network/cob_id_use.hpp"
#include "network/network.hpp"
#include "network/timing/sync_timing.hpp"
#include "network/timing/timing.hpp"

namespace edsc {

/// The analysis of a network that was loaded.
class TimingReport {
 public:
  explicit TimingReport(const Network& network);

  /// Load, SYNC cycle, and the message that comes nearest to its deadline; empty without a bit rate.
  [[nodiscard]] std::vector<std::string> summary() const;
  /// A line for each message, ascending by CAN-ID, after a heading.
  [[nodiscard]] std::vector<std::string> table() const;
  /// A member of "networks" in docs/schema/check.schema.json.
  [[nodiscard]] nlohmann::ordered_json json() const;

 private:
  const Network& network_;
  std::vector<CobIdUse> uses_;
  NetworkTiming timing_;
  std::optional<SyncTiming> sync_;
};

}  // namespace edsc
