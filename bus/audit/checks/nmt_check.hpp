/// NMT commands, and the states that nodes report: it keeps the NMT state of all nodes.
#pragma once

#include <cstdint>
#include <functional>
#include <optional>

#include "audit/audit_state.hpp"

namespace edsc::audit {

class NmtCheck {
 public:
  /// Called before the state of a node changes.
  using BeforeChange = std::function<void(std::uint8_t node_id, const Moment& now)>;

  explicit NmtCheck(BeforeChange before_change) : before_change_{std::move(before_change)} {}

  void see(const SeenMessage& seen, AuditState& audit);
  void finish(const Moment& end, AuditState& audit);

 private:
  void command(const SeenMessage& seen, AuditState& audit);
  void boot_up(const SeenMessage& seen, AuditState& audit);
  void report(const SeenMessage& seen, AuditState& audit);
  void change(std::uint8_t node_id, std::optional<canopen::NmtState> state, const Moment& now, AuditState& audit);

  BeforeChange before_change_;
};

}  // namespace edsc::audit
