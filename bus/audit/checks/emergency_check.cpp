#include "audit/checks/emergency_check.hpp"

#include <fmt/format.h>

#include <utility>

#include "audit/checks/sync_check.hpp"
#include "device/error_code_text.hpp"

namespace edsc::audit {
namespace {

constexpr std::uint16_t heartbeat_error = 0x8130;
constexpr std::uint8_t generic_error = 1;

using Texts = std::pair<std::string, std::string>;

/// `8611h following error`
std::string code_text(const Device* device, std::uint16_t code) {
  std::string text;
  append_error_code(text, device, code);
  return text;
}

}  // namespace

void EmergencyCheck::check_emcy(const SeenMessage& seen, AuditState& audit) {
  const Message& message = seen.message;
  NodeState& state = audit.sender(message);
  Node& node = nodes_[message.node_id % AuditState::node_ids];
  if (seen.frame.remote) return;
  if (seen.frame.size != 8) {
    audit.findings.add({"emcy-length", message.node_id}, seen.at, 0, [&] {
      return Texts{"8 bytes", fmt::format("{} bytes", unsigned{seen.frame.size})};
    });
    return;
  }
  if (state.model != nullptr && !is_cob_id(state.settings.emcy_id, canopen::cob_id_of(seen.frame))) {
    audit.findings.add({"emcy-cob-id", message.node_id, 0x1014}, seen.at, 0, [&] {
      const bool valid = (state.settings.emcy_id >> 31) == 0;
      return Texts{valid ? fmt::format("{:03X}h", state.settings.emcy_id & 0x1FFF'FFFF) : "no EMCY",
                   fmt::format("{:03X}h", seen.frame.id)};
    });
  }
  const Device* const device = state.model != nullptr ? &state.model->device() : nullptr;
  const bool is_error = edsc::is_error(device, message.error_code);
  if (is_error && (message.error_register & generic_error) == 0) {
    audit.findings.add({"emcy-register", message.node_id}, seen.at, 0, [&] {
      return Texts{"bit 0 is 1",
                   fmt::format("{:02X}h with {}", message.error_register, code_text(device, message.error_code))};
    });
  }
  const std::int64_t inhibit = state.settings.emcy_inhibit_us;
  const bool is_timed = seen.at.has_time && node.last_us && *node.last_us >= state.settings_since;
  if (is_timed && seen.at.us - *node.last_us < inhibit - audit.limits.slack(inhibit)) {
    const std::int64_t gap = seen.at.us - *node.last_us;
    audit.findings.add({"emcy-inhibit-time", message.node_id, 0x1015}, seen.at, -gap, [&] {
      return Texts{"at least " + milliseconds(inhibit), "after " + milliseconds(gap)};
    });
  }
  node.error_register = message.error_register;
  if (is_error) {
    node.open = seen.at;
    node.open_code = code_text(device, message.error_code);
  } else if (message.error_register == 0) {
    node.open.reset();
  }
  if (!seen.at.has_time) return;
  node.last_us = state.last_emcy_us = seen.at.us;
  if (message.error_code == heartbeat_error) state.last_heartbeat_error_us = seen.at.us;
}

void EmergencyCheck::check_register_read(const SeenMessage& seen, AuditState& audit) const {
  const Message& message = seen.message;
  const Node& node = nodes_[message.node_id % AuditState::node_ids];
  const bool is_read = message.step == TransferStep::finished && !message.download && message.index == 0x1001;
  if (!is_read || message.values.empty() || message.values[0].bytes.size() != 1 || !node.error_register) return;
  // An EMCY may wait for its inhibit time.
  const std::int64_t settled = audit.sender(message).settings.emcy_inhibit_us + reaction_us;
  if (!seen.at.has_time || !node.last_us || seen.at.us - *node.last_us < settled) return;
  const std::uint8_t value = message.values[0].bytes[0];
  if (value == *node.error_register) return;
  audit.findings.add({"emcy-register-value", message.node_id, 0x1001}, seen.at, 0, [&] {
    return Texts{fmt::format("{:02X}h", *node.error_register), fmt::format("{:02X}h", value)};
  });
}

void EmergencyCheck::see(const SeenMessage& seen, AuditState& audit) {
  switch (seen.message.service) {
    case Service::emcy: return check_emcy(seen, audit);
    case Service::sdo: return check_register_read(seen, audit);
    case Service::boot_up: nodes_[seen.message.node_id % AuditState::node_ids] = {}; return;
    default: return;
  }
}

void EmergencyCheck::finish(AuditState& audit) const {
  for (std::size_t id = 1; id < nodes_.size(); ++id) {
    const Node& node = nodes_[id];
    if (!node.open) continue;
    audit.findings.add({"emcy-not-reset", static_cast<std::uint8_t>(id)}, *node.open, 0, [&] {
      return Texts{"EMCY 0000h", "the last one is " + node.open_code};
    });
  }
}

}  // namespace edsc::audit
