/// Node guarding: the toggle bit of responses, and requests without a response.
#pragma once

#include <array>
#include <cstdint>
#include <optional>

#include "audit/audit_state.hpp"

namespace edsc::audit {

class GuardingCheck {
 public:
  void see(const SeenMessage& seen, AuditState& audit);
  void finish(const Moment& end, AuditState& audit);

 private:
  struct Node {
    std::optional<bool> toggle;            ///< of the next response, if known
    std::optional<std::int64_t> asked_us;  ///< the first request without a response
  };

  void check_silence(std::uint8_t node_id, const Moment& now, AuditState& audit);
  void request(const SeenMessage& seen, AuditState& audit);
  void response(const SeenMessage& seen, AuditState& audit);

  std::array<Node, AuditState::node_ids> nodes_;
};

}  // namespace edsc::audit
