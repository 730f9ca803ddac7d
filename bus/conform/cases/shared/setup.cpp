#include "conform/cases/shared/setup.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <canopen/can/cob_id_check.hpp>
#include <canopen/pdo/pdo_list.hpp>

namespace edsc::conform {
namespace {

using canopen::CobId;
using canopen::Frame;
using canopen::NmtCommand;
using canopen::NmtState;
using canopen::NodeId;

constexpr std::uint32_t produces_sync = CobId::no_rtr_bit;

bool is_writable(const Dut& dut, std::uint16_t index, std::uint8_t sub_index) {
  return dut.is_writable(index, sub_index) && dut.is_readable(index, sub_index);
}

/// The node-ID of an error control message or an answer of the default SDO; std::nullopt for other frames.
std::optional<std::uint8_t> node_of(const Frame& frame) {
  const std::uint32_t code = frame.id & 0x780U;
  const bool known = code == canopen::function_code::error_control || code == canopen::function_code::sdo_response;
  const auto node = static_cast<std::uint8_t>(frame.id & 0x7FU);
  return known && node != 0 && !frame.extended && !frame.remote ? std::optional{node} : std::nullopt;
}

bool anything(const Frame&) { return true; }

/// Whether the first entries of a mapping parameter map objects of the EDS.
bool maps_objects(Dut& dut, std::uint16_t index, std::uint8_t count) {
  for (std::uint8_t i = 1; i <= count; ++i) {
    const auto mapped = MappingValue::of(static_cast<std::uint32_t>(dut.read_number(index, i)));
    if (!dut.has(mapped.index, mapped.sub_index)) return false;
  }
  return true;
}

/// Whether another TPDO has the same CAN-ID: their frames cannot be told apart.
bool shares_can_id(Dut& dut, const Pdo& pdo, CobId cob_id) {
  return std::ranges::any_of(dut.pdos(PdoDirection::transmit), [&](const Pdo* other) {
    if (other == &pdo || other->communication == nullptr) return false;
    const CobId used{
        static_cast<std::uint32_t>(dut.read_number(other->communication->index, canopen::pdo_parameter::cob_id))};
    return used.valid() && used.can_id() == cob_id.can_id();
  });
}

}  // namespace

void expect_refused(Dut& dut, std::uint16_t index, std::uint8_t sub_index, std::uint64_t value, std::uint64_t present,
                    const AbortRule& rule, const std::string& what) {
  dut.expect_abort(dut.download(index, sub_index, value), rule, what);
  dut.expect_equal(dut.read_number(index, sub_index), present, label(index, sub_index) + " afterwards");
}

void expect_default_cob_id(Dut& dut, std::uint16_t index, std::uint32_t standard) {
  const Entry& entry = dut.need(index);
  const std::uint64_t expected = dut.default_of(index).value_or(standard);
  const std::uint64_t got = dut.read_number(index);
  const std::string name = label(index, 0);
  dut.expect(canopen::is_legal({index, 0, static_cast<std::uint32_t>(got)}), name + ": a CAN-ID that is not restricted",
             fmt::format("{:X}h", got));
  if (got == expected) return;
  if (!canopen::writable(entry.access)) dut.expect_equal(got, expected, name);
  dut.inconclusive(
      fmt::format("{} is {:X}h, its default value is {:X}h: it may have been configured; restore its "
                  "default value to test it",
                  name, got, expected));
}

std::uint32_t emcy_cob_id(Dut& dut) {
  dut.need(emcy);
  const auto cob_id = static_cast<std::uint32_t>(dut.read_number(emcy));
  if (!CobId{cob_id}.valid()) dut.not_applicable("EMCY is not valid (bit 31 of 1014h:00)");
  return cob_id;
}

std::uint16_t emergency_code_of(const Frame& frame) {
  return static_cast<std::uint16_t>(frame.data[0] | frame.data[1] << 8);
}

Dut::Match emcy_with_code(std::uint32_t cob_id, std::uint16_t code) {
  return [is_emcy = Dut::with_cob_id(cob_id), code](const Frame& frame) {
    return is_emcy(frame) && frame.size == 8 && emergency_code_of(frame) == code;
  };
}

bool hears_other_nodes(Dut& dut, Duration span) {
  const auto is_of_other = [own = dut.node().value()](const Frame& frame) {
    const auto node = node_of(frame);
    return node && *node != own;
  };
  return !dut.collect(is_of_other, span).empty();
}

void need_no_other_node(Dut& dut) {
  constexpr Duration to_listen = milliseconds{1200};
  if (dut.simulated() || !hears_other_nodes(dut, to_listen)) return;
  dut.inconclusive(Condition::alone, "other nodes are on the bus, which the frames of this case could disturb");
}

NodeId free_node_id(Dut& dut) {
  std::set<std::uint8_t> taken{dut.node().value()};
  for (std::uint8_t sub_index = 1; dut.has(consumer_heartbeat, sub_index); ++sub_index) {
    taken.insert(static_cast<std::uint8_t>(dut.read_number(consumer_heartbeat, sub_index) >> 16 & 0x7F));
  }
  // Heartbeat times of more than a second are rare. In most networks the other CAN-IDs of a node include its node-ID.
  for (const SeenFrame& seen : dut.collect(anything, milliseconds{1200})) {
    taken.insert(static_cast<std::uint8_t>(seen.frame.id & 0x7FU));
  }
  for (std::uint8_t node = 127; node > 0; --node) {
    if (!taken.contains(node)) return NodeId{node};
  }
  dut.inconclusive(Condition::alone, "no free node-ID on this bus");
}

std::optional<Parameter> harmless_parameter(const Dut& dut) {
  constexpr Parameter candidates[] = {{0x100C, 0}, {0x1017, 0}, {0x1015, 0}, {0x1007, 0}, {0x1800, 5}};
  const auto found = std::ranges::find_if(
      candidates, [&](const Parameter& parameter) { return is_writable(dut, parameter.index, parameter.sub_index); });
  return found == std::end(candidates) ? std::nullopt : std::optional{*found};
}

std::uint64_t other_value(Dut& dut, const Parameter& parameter) {
  const std::uint64_t present = dut.read_number(parameter.index, parameter.sub_index);
  const auto by_default = dut.default_of(parameter.index, parameter.sub_index);
  for (const std::uint64_t value : {2000U, 3000U, 4000U}) {
    if (value != present && value != by_default) return value;
  }
  return present;
}

std::optional<std::uint32_t> set_up_tpdo(Dut& dut, std::uint8_t transmission_type, std::uint16_t event_timer_ms) {
  namespace parameter = canopen::pdo_parameter;
  for (const Pdo* pdo : dut.pdos(PdoDirection::transmit)) {
    const std::uint16_t index = pdo->communication->index;
    if (pdo->multiplexed || pdo->broken || pdo->mapping == nullptr) continue;
    if (!dut.has(index, parameter::transmission_type)) continue;
    const CobId cob_id{static_cast<std::uint32_t>(dut.read_number(index, parameter::cob_id))};
    const std::uint64_t mapped = dut.read_number(pdo->mapping->index);
    if (!canopen::is_usable(cob_id.value()) || mapped == 0 || mapped > classical_can.objects) continue;
    if (!maps_objects(dut, pdo->mapping->index, static_cast<std::uint8_t>(mapped))) continue;
    if (shares_can_id(dut, *pdo, cob_id)) continue;

    const auto set = [&](std::uint8_t sub_index, std::uint64_t value) {
      if (!dut.has(index, sub_index)) return value == 0;
      if (dut.read_number(index, sub_index) == value) return true;
      return is_writable(dut, index, sub_index) && dut.download(index, sub_index, value).done();
    };
    const bool switches = is_writable(dut, index, parameter::cob_id);
    if (switches && !set(parameter::cob_id, cob_id.value() | CobId::invalid_bit)) continue;
    const bool done = set(parameter::transmission_type, transmission_type) && set(parameter::inhibit_time, 0) &&
                      set(parameter::event_timer, event_timer_ms) && set(parameter::sync_start, 0);
    if (switches) dut.write(index, parameter::cob_id, cob_id.value());
    if (done) return cob_id.value();
  }
  return std::nullopt;
}

std::uint32_t stop_sync(Dut& dut) {
  dut.need(sync_cob_id);
  if (is_writable(dut, sync_period, 0) && dut.read_number(sync_period) != 0) dut.write(sync_period, 0, 0);
  const auto cob_id = static_cast<std::uint32_t>(dut.read_number(sync_cob_id));
  const std::uint32_t consumes = cob_id & ~produces_sync;
  if (cob_id != consumes && is_writable(dut, sync_cob_id, 0)) dut.write(sync_cob_id, 0, consumes);
  return consumes & CobId::identifier;
}

bool can_produce_sync(Dut& dut, std::uint32_t cob_id) {
  if (!is_writable(dut, sync_cob_id, 0) || !is_writable(dut, sync_period, 0)) return false;
  const SdoOutcome outcome = dut.download(sync_cob_id, 0, cob_id | produces_sync);
  if (!outcome.done()) {
    dut.expect_abort(outcome, abort_rule::value, "bit 30 of 1005h:00 on a device that does not produce SYNC");
    return false;
  }
  dut.write(sync_cob_id, 0, cob_id);
  return true;
}

void start_sync(Dut& dut, std::uint32_t cob_id, Duration period) {
  dut.write(sync_cob_id, 0, cob_id | produces_sync);
  dut.write(sync_period, 0, period.count());
}

void end_errors(Dut& dut) {
  const Dut::Mark since = dut.mark();
  dut.nmt(NmtCommand::reset_communication);
  (void)dut.wait_for(dut.boot_up(), milliseconds{5000}, since);
  dut.pass_time(milliseconds{50});
}

void expect_one_boot_up(Dut& dut, NmtCommand command) {
  const Dut::Mark since = dut.mark();
  dut.reset(command);
  dut.pass_time(milliseconds{200});
  dut.expect_equal(dut.received_since(since, dut.boot_up()).size(), 1, "boot-up messages after a reset");
}

void expect_state_after_boot_up(Dut& dut) {
  using canopen::nmt_start_up::master, canopen::nmt_start_up::no_self_start;
  if (dut.is_readable(nmt_startup)) {
    const std::uint64_t bits = dut.read_number(nmt_startup);
    if ((bits & master) != 0 && dut.state() == NmtState::operational) return;
    if ((bits & (master | no_self_start)) == 0) return dut.expect_state(NmtState::operational);
  }
  // A transition of table 38 of CiA 301 is "automatically", by local control.
  if (dut.state() == NmtState::operational) {
    return dut.warn("the device is Operational after its boot-up message, without an NMT command");
  }
  dut.expect_state(NmtState::pre_operational);
}

}  // namespace edsc::conform
