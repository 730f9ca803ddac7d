/// Mutants of NMT and LSS.
#include <canopen/base/abort_code.hpp>
#include <canopen/nmt/nmt.hpp>
#include <cstdint>

#include "frame_changes.hpp"
#include "mutant.hpp"

namespace edsc::conform {
namespace control_mutant {
namespace {

using canopen::NmtState;

constexpr std::uint32_t lss_answer_id = 0x7E4, lss_request_id = 0x7E5;

bool is_lss(const Frame& frame, std::uint32_t id, std::uint8_t command) {
  return is_data(frame, id) && frame.data[0] == command;
}

Change ignores(NmtCommand command) {
  return drops([=](const Frame& frame) { return is_nmt(frame, command); });
}

/// Only sends a boot-up message.
Change pretends(NmtCommand command) {
  return [=](Wire& wire, Frame& frame) {
    if (!is_nmt(frame, command)) return;
    wire.drop();
    wire.request(
        make(0, {static_cast<std::uint8_t>(NmtCommand::enter_pre_operational), static_cast<std::uint8_t>(node)}));
    wire.send(make(error_control_id, {0}));
  };
}

auto is_state(NmtState state) {
  return [=](const Frame& frame) { return is_heartbeat(frame) && frame.data[0] == static_cast<std::uint8_t>(state); };
}

auto is_lss_answer(std::uint8_t command) {
  return [=](const Frame& frame) { return is_lss(frame, lss_answer_id, command); };
}

auto is_lss_request(std::uint8_t command) {
  return [=](const Frame& frame) { return is_lss(frame, lss_request_id, command); };
}

Frame lss_answer(std::uint8_t command) { return make(lss_answer_id, {command, 0, 0, 0, 0, 0, 0, 0}); }

/// Serves SDO in Stopped.
Change answers_in_stopped() {
  return [stopped = false](Wire& wire, Frame& frame) mutable {
    if (is_data(frame, 0)) stopped = is_nmt(frame, NmtCommand::stop);
    if (!stopped || !is_data(frame, sdo_request_id) || frame.data[0] != 0x40) return;
    wire.send(make(sdo_answer_id, {0x43, frame.data[1], frame.data[2], frame.data[3], 0, 0, 0, 0}));
  };
}

/// Does not serve SDO in Operational.
Change silent_in_operational() {
  return [operational = false](Wire& wire, Frame& frame) mutable {
    if (is_data(frame, 0)) operational = is_nmt(frame, NmtCommand::start);
    if (operational && is_data(frame, sdo_request_id)) wire.drop();
  };
}

Change selects_each_serial_number() {
  return [](Wire&, Frame& frame) {
    if (is_lss(frame, lss_request_id, 0x43)) put_word(frame, 1, 0x1234'5678);
  };
}

Change keeps_its_node_id() {
  return [](Wire&, Frame& frame) {
    const bool other = is_lss(frame, lss_request_id, 0x11) && frame.data[1] >= 1 && frame.data[1] <= 127;
    if (other) frame.data[1] = node;
  };
}

constexpr std::uint8_t expected_node = node;

}  // namespace
}  // namespace control_mutant

std::vector<Mutant> network_mutants() {
  using namespace control_mutant;
  return {
      // NMT
      {"boot-up-missing", drops(is_boot_up), {}},
      {"boot-up-twice", repeats(is_boot_up), {}},
      {"boot-up-at-stop",
       {},
       adds([](const Frame& frame) { return is_nmt(frame, NmtCommand::stop); }, make(error_control_id, {0}))},
      {"reset-node-ignored", {}, ignores(NmtCommand::reset_node)},
      {"reset-communication-ignored", {}, ignores(NmtCommand::reset_communication)},
      {"reset-node-pretended", {}, pretends(NmtCommand::reset_node)},
      {"reset-communication-pretended", {}, pretends(NmtCommand::reset_communication)},
      {"start-ignored", {}, ignores(NmtCommand::start)},
      {"stop-ignored", {}, ignores(NmtCommand::stop)},
      {"enter-pre-operational-ignored", {}, ignores(NmtCommand::enter_pre_operational)},
      {"pdo-in-pre-operational", adds(is_state(NmtState::pre_operational), make(tpdo_id, {0})), {}},
      {"pdo-in-stopped", adds(is_state(NmtState::stopped), make(tpdo_id, {0})), {}},
      {"sync-in-stopped", adds(is_state(NmtState::stopped), make(sync_id, {})), {}},
      {"emcy-in-stopped", adds(is_state(NmtState::stopped), make(emcy_id, {0, 0x10, 1, 0, 0, 0, 0, 0})), {}},
      {"sdo-in-stopped", {}, answers_in_stopped()},
      {"no-sdo-in-operational", {}, silent_in_operational()},
      // LSS
      {"lss-silent", drops([](const Frame& frame) { return is_data(frame, lss_answer_id); }), {}},
      {"lss-selects-each-serial-number", {}, selects_each_serial_number()},
      {"lss-answers-switch-global", {}, adds(is_lss_request(0x04), lss_answer(0x04))},
      {"lss-wrong-product-code", sets_byte(is_lss_answer(0x5B), 1, 0x77), {}},
      {"lss-wrong-node-id", sets_byte(is_lss_answer(0x5E), 1, expected_node + 1), {}},
      {"lss-answers-while-waiting", {}, adds(is_lss_request(0x5A), lss_answer(0x5A))},
      {"lss-identifies-outside-ranges", {}, adds(is_lss_request(0x4B), lss_answer(0x4F))},
      {"lss-does-not-identify", drops(is_lss_answer(0x4F)), {}},
      {"lss-answers-with-node-id", {}, adds(is_lss_request(0x4C), lss_answer(0x50))},
      {"lss-does-not-say-non-configured", drops(is_lss_answer(0x50)), {}},
      {"lss-answers-each-fastscan", {}, adds(is_lss_request(0x51), lss_answer(0x4F))},
      {"lss-takes-each-node-id", sets_byte(is_lss_answer(0x11), 1, 0), {}},
      {"lss-node-id-error-code", sets_byte(is_lss_answer(0x11), 1, 2), {}},
      {"lss-keeps-node-id", {}, keeps_its_node_id()},
      {"lss-takes-each-bit-rate", sets_byte(is_lss_answer(0x13), 1, 0), {}},
      {"lss-does-not-store", sets_byte(is_lss_answer(0x17), 1, 2), {}},
      {"lss-activates-without-pause", {}, drops(is_lss_request(0x15))},
  };
}

}  // namespace edsc::conform
