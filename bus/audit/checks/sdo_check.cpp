#include "audit/checks/sdo_check.hpp"

#include <fmt/format.h>

#include <utility>

namespace edsc::audit {
namespace {

using Texts = std::pair<std::string, std::string>;

struct FaultRow {
  SdoFault fault;
  AuditRule rule;
  std::string_view expected;
};

constexpr FaultRow fault_rows[] = {
    {SdoFault::length, "sdo-length", "8 bytes"},
    {SdoFault::command, "sdo-command", "a command that fits the transfer"},
    {SdoFault::unrequested, "sdo-unrequested", "a request before"},
    {SdoFault::unfinished, "sdo-unfinished", "the end of the transfer before"},
    {SdoFault::toggle, "sdo-toggle", "the other toggle bit"},
    {SdoFault::sequence, "sdo-sequence", "the next sequence number"},
    {SdoFault::size, "sdo-size", "the announced number of bytes"},
    {SdoFault::crc, "sdo-crc", "the CRC of the data"},
};

void check_fault(const SeenMessage& seen, AuditState& audit) {
  const Message& message = seen.message;
  for (const FaultRow& row : fault_rows) {
    if (row.fault != message.fault) continue;
    audit.findings.add({row.rule, message.node_id, message.index, message.sub_index}, seen.at, 0, [&] {
      return Texts{row.expected, message.text};
    });
  }
}

/// A node that never sent anything is not on the bus.
bool answers(const NodeState& node) {
  return node.first_seen && node.state != canopen::NmtState::initialisation && node.state != canopen::NmtState::stopped;
}

}  // namespace

/// Returns whether the server has not answered in time. A node that boots or is stopped does not answer any more.
bool SdoCheck::check_answer(Channel& channel, const Moment& now, AuditState& audit) {
  if (!channel.asked_us || !now.has_time) return false;
  const NodeState& node = audit.nodes[channel.node_id];
  const std::int64_t until = !answers(node) && node.state_since.us > *channel.asked_us ? node.state_since.us : now.us;
  const std::int64_t waited = until - *channel.asked_us;
  if (waited <= audit.limits.sdo_timeout_us) return false;
  audit.findings.add({"sdo-timeout", channel.node_id, channel.index, channel.sub_index}, now, waited, [&] {
    return Texts{"within " + milliseconds(audit.limits.sdo_timeout_us), "none for " + milliseconds(waited)};
  });
  return true;
}

void SdoCheck::see(const SeenMessage& seen, AuditState& audit) {
  const Message& message = seen.message;
  if (message.service == Service::boot_up) return end_transfers(seen, audit);
  if (message.service != Service::sdo) return;
  if (channels_.size() <= message.channel) channels_.resize(message.channel + 1U);
  Channel& channel = channels_[message.channel];
  channel.node_id = message.node_id;
  const bool late = check_answer(channel, seen.at, audit);
  // The client gave up after its time, or asks again: the response that was missing is one finding, not two. A node
  // that was not there could not answer.
  const bool gave_up =
      (late || channel.is_unheard) && (message.fault == SdoFault::unfinished || message.fault == SdoFault::command);
  if (message.fault != SdoFault::none && !gave_up) check_fault(seen, audit);
  if (message.step == TransferStep::aborted) {
    const Subject subject{"sdo-abort", message.node_id, message.index, message.sub_index, message.abort_code};
    audit.findings.add(subject, seen.at, 0, [&] { return Texts{"the end of the transfer", message.text}; });
  }
  channel.asked_us.reset();
  channel.is_unheard = false;
  if (!message.from_client || message.step != TransferStep::part) return;
  channel.is_unheard = !answers(audit.sender(message));
  if (channel.is_unheard || !seen.at.has_time) return;
  channel = {message.node_id, seen.at.us, message.index, message.sub_index};
}

/// A node that boots does not answer what was asked before.
void SdoCheck::end_transfers(const SeenMessage& boot_up, AuditState& audit) {
  for (Channel& channel : channels_) {
    if (channel.node_id != boot_up.message.node_id) continue;
    (void)check_answer(channel, boot_up.at, audit);
    channel.asked_us.reset();
    channel.is_unheard = false;
  }
}

void SdoCheck::finish(const Moment& end, AuditState& audit) {
  for (Channel& channel : channels_) (void)check_answer(channel, end, audit);
}

}  // namespace edsc::audit
