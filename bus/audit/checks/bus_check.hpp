/// The bus as a whole: load, error frames, CAN-IDs and nodes.
#pragma once

#include <cstdint>

#include "audit/audit_state.hpp"

namespace edsc::audit {

class BusCheck {
 public:
  void see(const SeenMessage& seen, AuditState& audit);
  void finish(const Moment& end, AuditState& audit);

  /// Of the whole log, in tenths of a percent of the bit rate.
  [[nodiscard]] std::uint64_t mean_load(const Moment& end, const Limits& limits) const;
  /// Over 100 ms, in tenths of a percent.
  [[nodiscard]] std::uint64_t max_load() const { return max_load_; }

 private:
  void count_bits(const SeenMessage& seen, AuditState& audit);
  void end_interval(const Moment& now, AuditState& audit);

  std::int64_t interval_ = 0;  ///< number of the current 100 ms
  std::uint64_t interval_bits_ = 0, bits_ = 0, max_load_ = 0;
};

}  // namespace edsc::audit
