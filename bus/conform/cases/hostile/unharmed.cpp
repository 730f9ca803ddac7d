#include "conform/cases/hostile/unharmed.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <canopen/can/cob_id.hpp>

namespace edsc::conform {
namespace {

using canopen::CobId;
using canopen::NmtState;

constexpr std::uint16_t time_cob_id = 0x1012;

void add_cob_id(Dut& dut, std::set<std::uint32_t>& ids, std::uint16_t index, std::uint8_t sub_index) {
  if (!dut.is_readable(index, sub_index)) return;
  const auto cob_id = static_cast<std::uint32_t>(dut.read_number(index, sub_index));
  const bool has_flags = index == sync_cob_id || index == time_cob_id;  // bits 31 and 30 have other meanings there
  if (has_flags || CobId{cob_id}.valid()) ids.insert(cob_id & CobId::identifier);
}

std::uint32_t id_of(const canopen::Frame& frame) { return frame.id | (frame.extended ? CobId::extended_bit : 0U); }

/// Values that the device changes on its own, or that process data change.
bool is_compared(const Dut& dut, const FoundValues::Key& key) {
  const Entry* const entry = dut.entry(key.first, key.second);
  constexpr std::uint16_t live[] = {error_register, status_register, error_history, high_resolution_time};
  return entry != nullptr && !entry->pdo_mapping && std::ranges::find(live, key.first) == std::end(live);
}

/// The values that can be compared: those that do not change within a while.
Dut::Values stable_values(Dut& dut) {
  Dut::Values values = dut.values();
  constexpr Duration a_while = milliseconds{20};
  dut.pass_time(a_while);
  const Dut::Values again = dut.values();
  std::erase_if(values, [&](const auto& value) {
    const auto found = again.find(value.first);
    return found == again.end() || found->second != value.second || !is_compared(dut, value.first);
  });
  return values;
}

void expect_values(Dut& dut, const Dut::Values& before, const std::string& what) {
  const Dut::Values after = dut.values();
  for (const auto& [key, bytes] : before) {
    const std::string name = label(key.first, key.second);
    const auto found = after.find(key);
    const std::string expected = fmt::format("{} as before {}: {}", name, what, hex_bytes(bytes));
    if (found == after.end()) dut.fail(expected, "it can no longer be read");
    if (found->second != bytes) dut.fail(expected, hex_bytes(found->second));
  }
}

bool may_be_sent(const Dut& dut, const OwnCanIds& ids, const canopen::Frame& frame, NmtState state) {
  const std::uint32_t id = id_of(frame);
  if (state == NmtState::stopped) return !frame.remote && id == 0x700U + dut.node().value();
  if (ids.tpdos.contains(id)) return state == NmtState::operational;
  return !frame.remote && (ids.transmitted.contains(id) || (ids.received.contains(id) && !ids.rpdos.contains(id)));
}

}  // namespace

OwnCanIds own_can_ids(Dut& dut) {
  OwnCanIds ids;
  const std::uint32_t node = dut.node().value();
  for (const Pdo* pdo : dut.pdos(PdoDirection::receive)) add_cob_id(dut, ids.rpdos, pdo->communication->index, 1);
  for (const Pdo* pdo : dut.pdos(PdoDirection::transmit)) add_cob_id(dut, ids.tpdos, pdo->communication->index, 1);
  ids.received = ids.rpdos;
  ids.received.insert(0x600U + node);
  add_cob_id(dut, ids.received, sync_cob_id, 0);
  add_cob_id(dut, ids.received, time_cob_id, 0);
  ids.transmitted = ids.tpdos;
  ids.transmitted.insert({0x580U + node, 0x700U + node});
  add_cob_id(dut, ids.transmitted, emcy, 0);
  constexpr std::uint16_t first_server = 0x1201, last_server = 0x127F;
  for (std::uint16_t index = first_server; index <= last_server && dut.has(index, 2); ++index) {
    add_cob_id(dut, ids.received, index, 1);
    add_cob_id(dut, ids.transmitted, index, 2);
  }
  return ids;
}

void expect_unharmed(Dut& dut, NmtState state, const std::string& what, const std::function<void()>& attack) {
  dut.enter(NmtState::pre_operational);
  const bool reports_state = dut.watch_state();
  const OwnCanIds ids = own_can_ids(dut);
  const Dut::Values before = stable_values(dut);
  const bool had_error = dut.is_readable(error_register) && dut.read_number(error_register) != 0;
  if (state != NmtState::pre_operational) dut.enter(state);
  if (reports_state && dut.state() != state) {
    dut.inconclusive(Condition::state, fmt::format("the device is not in the state {}", to_text(state)));
  }
  const Dut::Mark since = dut.mark();
  attack();
  constexpr Duration to_respond = milliseconds{50};
  dut.pass_time(to_respond);
  const std::string after = fmt::format("after {} in {}", what, to_text(state));
  for (const SeenFrame& seen : dut.received_since(since, [](const canopen::Frame&) { return true; })) {
    dut.expect(!dut.boot_up()(seen.frame), "no boot-up message " + after, "one");
    dut.expect(may_be_sent(dut, ids, seen.frame, state), "no frame that the device may not send " + after,
               fmt::format("CAN-ID {:X}h", seen.frame.id));
  }
  if (reports_state) {
    const auto found = dut.state();
    dut.expect(found == state, fmt::format("the state {} {}", to_text(state), after),
               found ? std::string{to_text(*found)} : "no error control message");
  }
  if (state != NmtState::pre_operational) dut.enter(NmtState::pre_operational);
  dut.end_transfer();
  const SdoOutcome outcome = dut.upload(device_type);
  dut.expect(outcome.done() || outcome.end == SdoEnd::refused, "an answer to the read of 1000h:00 " + after,
             outcome_text(outcome));
  expect_values(dut, before, after);
  const bool has_error = dut.is_readable(error_register) && dut.read_number(error_register) != 0;
  if (has_error && !had_error) end_errors(dut);  // such as 8240h, a SYNC of another length
}

}  // namespace edsc::conform
