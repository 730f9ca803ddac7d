#include "audit/checks/lss_check.hpp"

#include <fmt/format.h>

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
  bool of_one_slave;      ///< only one slave may be in this state
  bool has_error;         ///< byte 1 of the response is an error code
};

constexpr LssAnswer lss_answers[] = {
    {Command::select_serial_number, Command::selected, false, false, false},
    {Command::identify_serial_number_high, Command::identified, false, false, false},
    {Command::identify_non_configured, Command::identified_non_configured, false, false, false},
    {Command::fastscan, Command::identified, false, false, false},
    {Command::configure_node_id, Command::configure_node_id, true, true, true},
    {Command::configure_bit_timing, Command::configure_bit_timing, true, false, true},
    {Command::activate_bit_timing, Command::none, true, false, false},
    {Command::store_configuration, Command::store_configuration, true, false, true},
    {Command::inquire_vendor_id, Command::inquire_vendor_id, true, true, false},
    {Command::inquire_product_code, Command::inquire_product_code, true, true, false},
    {Command::inquire_revision_number, Command::inquire_revision_number, true, true, false},
    {Command::inquire_serial_number, Command::inquire_serial_number, true, true, false},
    {Command::inquire_node_id, Command::inquire_node_id, true, true, false},
};

const LssAnswer* find_answer(std::uint8_t request) {
  const auto* const at = std::ranges::find(lss_answers, Command{request}, &LssAnswer::request);
  return at == std::end(lss_answers) ? nullptr : at;
}

/// The commands with the parts of an LSS address follow each other: 40h to 43h, and 46h to 4Bh.
bool needs_part_before(std::uint8_t command) {
  constexpr auto first_selected = static_cast<std::uint8_t>(Command::select_vendor_id);
  constexpr auto last_selected = static_cast<std::uint8_t>(Command::select_serial_number);
  constexpr auto first_identified = static_cast<std::uint8_t>(Command::identify_vendor_id);
  constexpr auto last_identified = static_cast<std::uint8_t>(Command::identify_serial_number_high);
  return (command > first_selected && command <= last_selected) ||
         (command > first_identified && command <= last_identified);
}

}  // namespace

/// The slave that has responded in the configuration state must respond there again.
void LssCheck::check_silence(const Moment& now, AuditState& audit) {
  if (!asked_us_) return;
  const std::int64_t waited = now.us - *asked_us_;
  asked_us_.reset();
  if (waited < reaction_us) return;
  audit.findings.add({"lss-timeout"}, now, waited, [&] {
    return Texts{"a response within " + milliseconds(reaction_us),
                 fmt::format("none to {:02X}h for {}", last_request_.value_or(0), milliseconds(waited))};
  });
}

void LssCheck::request(const SeenMessage& seen, AuditState& audit) {
  check_silence(seen.at, audit);
  const std::uint8_t command = seen.frame.data[0], operand = seen.frame.data[1];
  const std::uint8_t before = last_request_.value_or(command - 1);
  last_request_ = command;
  answered_ = false;
  const bool lacks_part = needs_part_before(command) && before != command - 1;
  if (seen.message.problem || lacks_part) {
    audit.findings.add({"lss-command"}, seen.at, 0, [&] {
      return Texts{lacks_part ? fmt::format("command {:02X}h before", command - 1) : "an LSS command",
                   seen.message.text};
    });
  }
  switch (Command{command}) {
    case Command::switch_state_global:
      slaves_ =
          operand == static_cast<std::uint8_t>(canopen::LssState::configuration) ? Slaves::unknown : Slaves::waiting;
      return;
    // The slave that is found enters the configuration state without a response of its own.
    case Command::fastscan: slaves_ = Slaves::unknown; return;
    case Command::configure_node_id: asked_node_id_ = operand < AuditState::node_ids ? operand : 0; break;
    // Until the end of the second switch delay the slave does not send (CiA 305, activate bit timing).
    case Command::activate_bit_timing: {
      constexpr std::int64_t delays = 2, us_per_ms = 1000;
      const std::int64_t delay_us = (operand | seen.frame.data[2] << 8) * us_per_ms;
      if (seen.at.has_time) silent_until_us_ = seen.at.us + delays * delay_us;
      break;
    }
    default: break;
  }
  const LssAnswer* const row = find_answer(command);
  if (row == nullptr || !row->in_configuration) return;
  const bool responds = slaves_ == Slaves::configure && row->response != Command::none && seen.at.has_time &&
                        seen.at.us >= silent_until_us_.value_or(0);
  if (responds) asked_us_ = seen.at.us;
  if (slaves_ != Slaves::waiting) return;
  audit.findings.add({"lss-mode"}, seen.at, 0, [&] {
    return Texts{"switch state to configuration before", seen.message.text};
  });
}

void LssCheck::response(const SeenMessage& seen, AuditState& audit) {
  const Command command{seen.frame.data[0]};
  const LssAnswer* const row = last_request_ ? find_answer(*last_request_) : nullptr;
  asked_us_.reset();
  // The request may be before the log.
  const bool fits = !last_request_ || (row != nullptr && row->response == command && command != Command::none);
  const bool again = fits && row != nullptr && row->of_one_slave && std::exchange(answered_, true);
  if (!fits || again) {
    audit.findings.add({"lss-response"}, seen.at, 0, [&] {
      return Texts{again ? "one response: one slave in configuration" : "a response to the last request",
                   seen.message.text};
    });
    return;
  }
  if (command == Command::selected || (row != nullptr && row->in_configuration)) slaves_ = Slaves::configure;
  if (row == nullptr || !row->has_error) return;
  const std::uint8_t error = seen.frame.data[1];
  if (command == Command::configure_node_id && error == 0) audit.lss_node_id = asked_node_id_;
  if (error == 0) return;
  Subject subject{"lss-refused"};
  subject.sub_index = static_cast<std::uint8_t>(command);
  audit.findings.add(subject, seen.at, 0, [&] { return Texts{"done", seen.message.text}; });
}

void LssCheck::see(const SeenMessage& seen, AuditState& audit) {
  if (seen.message.service == Service::nmt && !seen.message.problem && seen.message.node_id == 0) {
    if (canopen::NmtCommand{seen.frame.data[0]} >= canopen::NmtCommand::reset_node) slaves_ = Slaves::unknown;
    return;
  }
  if (seen.message.service != Service::lss || seen.frame.size != 8 || seen.frame.remote) return;
  return seen.message.from_client ? request(seen, audit) : response(seen, audit);
}

void LssCheck::finish(const Moment& end, AuditState& audit) { check_silence(end, audit); }

}  // namespace edsc::audit
