#include "audit/checks/lss_check.hpp"

#include <canopen/lss/lss_protocol.hpp>
#include <string>
#include <utility>

namespace edsc::audit {
namespace {

using canopen::lss::Command;
using Texts = std::pair<std::string, std::string>;

/// The response to the last of one or more requests.
struct LssAnswer {
  Command request, response;
  bool in_configuration;  ///< only in LSS configuration
};

constexpr LssAnswer lss_answers[] = {
    {Command::select_serial_number, Command::selected, false},
    {Command::identify_serial_number_high, Command::identified, false},
    {Command::identify_non_configured, Command::identified_non_configured, false},
    {Command::fastscan, Command::identified, false},
    {Command::configure_node_id, Command::configure_node_id, true},
    {Command::configure_bit_timing, Command::configure_bit_timing, true},
    {Command::activate_bit_timing, Command::none, true},
    {Command::store_configuration, Command::store_configuration, true},
    {Command::inquire_vendor_id, Command::inquire_vendor_id, true},
    {Command::inquire_product_code, Command::inquire_product_code, true},
    {Command::inquire_revision_number, Command::inquire_revision_number, true},
    {Command::inquire_serial_number, Command::inquire_serial_number, true},
    {Command::inquire_node_id, Command::inquire_node_id, true},
};

const LssAnswer* find_answer(std::uint8_t request) {
  const auto* const at = std::ranges::find(lss_answers, Command{request}, &LssAnswer::request);
  return at == std::end(lss_answers) ? nullptr : at;
}

}  // namespace

void LssCheck::request(const SeenMessage& seen, AuditState& audit) {
  const std::uint8_t command = seen.frame.data[0];
  last_request_ = command;
  const std::uint8_t operand = seen.frame.data[1];
  if (Command{command} == Command::configure_node_id) asked_node_id_ = operand < AuditState::node_ids ? operand : 0;
  switch (Command{command}) {
    case Command::switch_state_global:
      slaves_ = seen.frame.data[1] == static_cast<std::uint8_t>(canopen::LssState::configuration) ? Slaves::configure
                                                                                                  : Slaves::waiting;
      return;
    // The slave that is found enters the configuration state without a response of its own.
    case Command::fastscan: slaves_ = Slaves::unknown; return;
    default: break;
  }
  const LssAnswer* const row = find_answer(command);
  if (row == nullptr || !row->in_configuration || slaves_ != Slaves::waiting) return;
  audit.findings.add({RuleId::lss_mode}, seen.at, 0, [&] {
    return Texts{"switch state to configuration before", seen.message.text};
  });
}

void LssCheck::response(const SeenMessage& seen, AuditState& audit) {
  const Command command{seen.frame.data[0]};
  const LssAnswer* const row = last_request_ ? find_answer(*last_request_) : nullptr;
  // The request may be before the log.
  const bool fits = !last_request_ || (row != nullptr && row->response == command && command != Command::none);
  if (command == Command::selected) slaves_ = Slaves::configure;
  if (command == Command::configure_node_id && seen.frame.data[1] == 0) audit.lss_node_id = asked_node_id_;
  if (fits) return;
  audit.findings.add({RuleId::lss_response}, seen.at, 0, [&] {
    return Texts{"a response to the last request", seen.message.text};
  });
}

void LssCheck::see(const SeenMessage& seen, AuditState& audit) {
  if (seen.message.service == Service::nmt && !seen.message.problem && seen.message.node_id == 0) {
    if (canopen::NmtCommand{seen.frame.data[0]} >= canopen::NmtCommand::reset_node) slaves_ = Slaves::unknown;
    return;
  }
  if (seen.message.service != Service::lss || seen.frame.size != 8 || seen.frame.remote) return;
  return seen.message.from_client ? request(seen, audit) : response(seen, audit);
}

}  // namespace edsc::audit
