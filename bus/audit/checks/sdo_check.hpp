/// SDO transfers: violations of the protocol, answers that are late or missing, and aborts.
#pragma once

#include <cstdint>
#include <optional>
#include <vector>

#include "audit/audit_state.hpp"

namespace edsc::audit {

class SdoCheck {
 public:
  void see(const SeenMessage& seen, AuditState& audit);
  void finish(const Moment& end, AuditState& audit);

 private:
  /// A server whose client waits for a response.
  struct Channel {
    std::uint8_t node_id = 0;
    std::optional<std::int64_t> asked_us;  ///< the last request of a node that answers requests
    std::uint16_t index = 0;
    std::uint8_t sub_index = 0;
    bool is_unheard =
        false;  ///< the last frame is a request of a node that does not answer: absent, booting or stopped
  };

  void end_transfers(const SeenMessage& boot_up, AuditState& audit);
  bool check_answer(Channel& channel, const Moment& now, AuditState& audit);

  std::vector<Channel> channels_;  ///< by Message::channel
};

}  // namespace edsc::audit
