/// Mutants of EMCY, SYNC, error control, storage, NMT and LSS.
#include <canopen/base/abort_code.hpp>
#include <canopen/can/cob_id.hpp>
#include <canopen/nmt/nmt.hpp>
#include <cstring>
#include <initializer_list>

#include "mutant.hpp"

namespace edsc::conform {
namespace control_mutant {
namespace {

using canopen::AbortCode;
using canopen::Frame;
using canopen::NmtCommand;
using canopen::NmtState;
using std::chrono::milliseconds;

constexpr std::uint32_t node = Wire::node_id;
constexpr std::uint32_t sync_id = 0x80, emcy_id = 0x80 + node, tpdo_id = 0x180 + node, error_control_id = 0x700 + node;
constexpr std::uint32_t sdo_answer_id = 0x580 + node, sdo_request_id = 0x600 + node;
constexpr std::uint32_t lss_answer_id = 0x7E4, lss_request_id = 0x7E5;
constexpr std::uint16_t lost_node = 0x8130;

Frame make(std::uint32_t id, std::initializer_list<std::uint8_t> bytes) {
  Frame frame;
  frame.id = id;
  for (const std::uint8_t byte : bytes) frame.data[frame.size++] = byte;
  return frame;
}

Frame with_size(Frame frame, std::uint8_t size) {
  frame.size = size;
  return frame;
}

std::uint32_t word_at(const Frame& frame, std::size_t first) {
  std::uint32_t word = 0;
  std::memcpy(&word, &frame.data[first], sizeof word);
  return word;
}

void put_word(Frame& frame, std::size_t first, std::uint32_t word) {
  std::memcpy(&frame.data[first], &word, sizeof word);
}

bool is_data(const Frame& frame, std::uint32_t id) { return frame.id == id && !frame.remote && !frame.extended; }
bool is_emcy(const Frame& frame, std::uint16_t code) {
  return is_data(frame, emcy_id) && (word_at(frame, 0) & 0xFFFF) == code;
}
bool is_heartbeat(const Frame& frame) { return is_data(frame, error_control_id) && frame.data[0] != 0; }
bool is_boot_up(const Frame& frame) { return is_data(frame, error_control_id) && frame.data[0] == 0; }
bool is_guarding_request(const Frame& frame) { return frame.remote && frame.id == error_control_id; }
bool is_nmt(const Frame& frame, NmtCommand command) {
  return is_data(frame, 0) && frame.data[0] == static_cast<std::uint8_t>(command);
}
bool is_lss(const Frame& frame, std::uint32_t id, std::uint8_t command) {
  return is_data(frame, id) && frame.data[0] == command;
}

constexpr int any_sub_index = -1;

/// Returns whether an SDO frame is for this entry.
bool names(const Frame& frame, std::uint32_t id, std::uint16_t index, int sub_index) {
  if (!is_data(frame, id) || (frame.data[1] | frame.data[2] << 8) != index) return false;
  return sub_index == any_sub_index || frame.data[3] == sub_index;
}
bool is_upload_answer(const Frame& frame, std::uint16_t index, int sub_index) {
  return names(frame, sdo_answer_id, index, sub_index) && (frame.data[0] & 0xE2) == 0x42;
}
bool is_download(const Frame& frame, std::uint16_t index, int sub_index) {
  return names(frame, sdo_request_id, index, sub_index) && (frame.data[0] & 0xE2) == 0x22;
}
bool is_download_answer(const Frame& frame, std::uint16_t index) {
  return names(frame, sdo_answer_id, index, any_sub_index) && frame.data[0] == 0x60;
}
bool is_abort(const Frame& frame, std::uint16_t index, AbortCode code) {
  return names(frame, sdo_answer_id, index, any_sub_index) && frame.data[0] == 0x80 &&
         word_at(frame, 4) == static_cast<std::uint32_t>(code);
}

/// The test reads this value.
Change reads(std::uint16_t index, int sub_index, std::uint32_t value) {
  return [=](Wire&, Frame& frame) {
    if (is_upload_answer(frame, index, sub_index)) put_word(frame, 4, value);
  };
}
/// A download of `value` writes `instead`.
Change writes(std::uint16_t index, std::uint32_t value, std::uint32_t instead) {
  return [=](Wire&, Frame& frame) {
    if (is_download(frame, index, any_sub_index) && word_at(frame, 4) == value) put_word(frame, 4, instead);
  };
}
/// A rejected download is confirmed.
Change takes(std::uint16_t index, AbortCode refused) {
  return [=](Wire&, Frame& frame) {
    if (!is_abort(frame, index, refused)) return;
    frame.data[0] = 0x60;
    put_word(frame, 4, 0);
  };
}
Change aborts_with(std::uint16_t index, AbortCode code, AbortCode instead) {
  return [=](Wire&, Frame& frame) {
    if (is_abort(frame, index, code)) put_word(frame, 4, static_cast<std::uint32_t>(instead));
  };
}
/// A download that is confirmed without being executed.
Change forgets(std::uint16_t index, int sub_index) {
  return [=](Wire& wire, Frame& frame) {
    if (!is_download(frame, index, sub_index)) return;
    wire.drop();
    wire.send(make(sdo_answer_id, {0x60, frame.data[1], frame.data[2], frame.data[3], 0, 0, 0, 0}));
  };
}
/// Each signature is accepted as the right one.
Change takes_each_signature(std::uint16_t index, std::uint32_t right) {
  return [=](Wire&, Frame& frame) {
    if (is_download(frame, index, any_sub_index)) put_word(frame, 4, right);
  };
}
Change refuses(std::uint16_t index, AbortCode code) {
  return [=](Wire&, Frame& frame) {
    if (!is_download_answer(frame, index)) return;
    frame.data[0] = 0x80;
    put_word(frame, 4, static_cast<std::uint32_t>(code));
  };
}
Change lacks(std::uint16_t index) {
  return [=](Wire&, Frame& frame) {
    if (!is_upload_answer(frame, index, any_sub_index)) return;
    frame.data[0] = 0x80;
    put_word(frame, 4, static_cast<std::uint32_t>(AbortCode::no_object));
  };
}

template <class Predicate>
Change drops(Predicate predicate) {
  return [=](Wire& wire, Frame& frame) {
    if (predicate(frame)) wire.drop();
  };
}
/// One in `every` of these frames is lost.
template <class Predicate>
Change drops_some(Predicate predicate, unsigned every) {
  return [=, seen = 0U](Wire& wire, Frame& frame) mutable {
    if (predicate(frame) && ++seen % every == 0) wire.drop();
  };
}
template <class Predicate>
Change repeats(Predicate predicate) {
  return [=](Wire& wire, Frame& frame) {
    if (predicate(frame)) wire.send(frame);
  };
}
/// The device also sends `added` after each frame of this kind.
template <class Predicate>
Change adds(Predicate predicate, Frame added) {
  return [=](Wire& wire, Frame& frame) {
    if (predicate(frame)) wire.send(added);
  };
}
template <class Predicate>
Change sets_byte(Predicate predicate, std::size_t at, std::uint8_t value) {
  return [=](Wire&, Frame& frame) {
    if (predicate(frame)) frame.data[at] = value;
  };
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

bool is_sync(const Frame& frame) { return is_data(frame, sync_id); }
bool is_any_emcy(const Frame& frame) { return is_data(frame, emcy_id); }
bool is_lost_node(const Frame& frame) { return is_emcy(frame, lost_node); }
bool is_emcy_reset(const Frame& frame) { return is_emcy(frame, 0); }
bool is_foreign_heartbeat(const Frame& frame) {
  return !frame.remote && (frame.id & 0x780) == 0x700 && frame.id != error_control_id;
}
const Frame lost_message = make(emcy_id, {0x30, 0x81, 0x11, 0, 0, 0, 0, 0});

/// Answers guarding requests for other nodes with its own state.
Change guards_for_others() {
  return [state = std::uint8_t{127}](Wire& wire, Frame& frame) mutable {
    if (is_nmt(frame, NmtCommand::stop)) state = 4;
    if (is_nmt(frame, NmtCommand::enter_pre_operational)) state = 127;
    if (frame.remote && (frame.id & 0x780) == 0x700 && frame.id != error_control_id) wire.send(make(frame.id, {state}));
  };
}
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
Change late(milliseconds span) {
  return [=](Wire& wire, Frame& frame) {
    if (is_lost_node(frame)) wire.delay(span);
  };
}
Change jitters() {
  return [odd = false](Wire& wire, Frame& frame) mutable {
    if (!is_sync(frame)) return;
    odd = !odd;
    if (odd) wire.delay(milliseconds{5});
  };
}
Change counts_from_0() {
  return [](Wire&, Frame& frame) {
    if (is_sync(frame) && frame.size == 1) --frame.data[0];
  };
}
Change always_counts() {
  return [](Wire&, Frame& frame) {
    if (is_sync(frame)) frame = with_size(frame, 1);
  };
}
Change short_emcy() {
  return [](Wire&, Frame& frame) {
    if (is_any_emcy(frame)) frame = with_size(frame, 7);
  };
}
/// Answers to an upload indicate another size: `command` is 4Fh for one byte, 43h for four.
Change says_size(std::uint16_t index, std::uint8_t command) {
  return [=](Wire&, Frame& frame) {
    if (is_upload_answer(frame, index, 0)) frame.data[0] = command;
  };
}
Change sync_doubled() {
  return [](Wire& wire, Frame& frame) {
    if (is_sync(frame)) wire.request(frame);
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
/// Each COB-ID accepts a restricted CAN-ID.
Change takes_restricted_can_ids() {
  return [](Wire& wire, Frame& frame) {
    for (const unsigned index : {0x1005U, 0x1012U, 0x1014U, 0x1201U, 0x1400U, 0x1800U}) {
      takes(static_cast<std::uint16_t>(index), AbortCode::invalid_value)(wire, frame);
    }
  };
}

constexpr std::uint32_t save = 0x6576'6173, load = 0x6461'6F6C;
constexpr std::uint8_t expected_node = node;

}  // namespace
}  // namespace control_mutant

std::vector<Mutant> control_mutants() {
  using namespace control_mutant;
  return {
      // EMCY
      {"emcy-cob-id-of-sync", reads(0x1014, 0, 0x80), {}},
      {"error-register-reserved-bit", reads(0x1001, 0, 0x40), {}},
      {"error-register-without-generic-bit", reads(0x1001, 0, 0x10), {}},
      {"error-register-always-0", reads(0x1001, 0, 0), {}},
      {"history-counts-too-many", reads(0x1003, 0, 9), {}},
      {"history-abort-code", aborts_with(0x1003, AbortCode::no_data, AbortCode::no_sub_index), {}},
      {"history-wrong-error", reads(0x1003, 1, 0x8130), {}},
      {"emcy-missing", drops(is_any_emcy), {}},
      {"emcy-short", short_emcy(), {}},
      {"emcy-wrong-code", sets_byte(is_any_emcy, 1, 0x23), {}},
      {"emcy-twice", repeats(is_any_emcy), {}},
      {"emcy-without-end", drops(is_emcy_reset), {}},
      // SYNC
      {"sync-restricted-cob-id", reads(0x1005, 0, 0x70), {}},
      {"sync-some-missing", drops_some(is_sync, 3), {}},
      {"sync-each-second", drops_some(is_sync, 2), {}},
      {"sync-jitter", jitters(), {}},
      {"sync-with-byte", always_counts(), {}},
      {"sync-after-period-is-written",
       adds([](const Frame& frame) { return is_download_answer(frame, 0x1006); }, make(sync_id, {})),
       {}},
      {"sync-counts-twice", {}, sync_doubled()},
      {"sync-counter-from-0", counts_from_0(), {}},
      {"overflow-takes-reserved", takes(0x1019, AbortCode::invalid_value), {}},
      {"overflow-takes-while-period", takes(0x1019, AbortCode::device_state), {}},
      {"overflow-abort-code", aborts_with(0x1019, AbortCode::invalid_value, AbortCode::no_object), {}},
      {"overflow-stays", reads(0x1019, 0, 10), {}},
      {"overflow-0-becomes-10", {}, writes(0x1019, 0, 10)},
      // Guarding
      {"guard-time-one-byte", says_size(0x100C, 0x4F), {}},
      {"guard-time-missing", lacks(0x100C), {}},
      {"guarding-missing", {}, drops(is_guarding_request)},
      {"guarding-twice",
       {},
       [](Wire& wire, Frame& frame) {
         if (is_guarding_request(frame)) wire.request(frame);
       }},
      {"guarding-without-toggle",
       [](Wire&, Frame& frame) {
         if (is_heartbeat(frame)) frame.data[0] &= 0x7F;
       },
       {}},
      {"guarding-for-others", {}, guards_for_others()},
      {"guard-time-forgotten", {}, forgets(0x100C, 0)},
      {"life-time-factor-forgotten", {}, forgets(0x100D, 0)},
      {"guarding-beside-heartbeat", {}, adds(is_guarding_request, make(error_control_id, {0x7F}))},
      // Heartbeat
      {"lost-node-late", late(milliseconds{200}), {}},
      {"lost-node-missing", drops(is_lost_node), {}},
      {"lost-node-twice", repeats(is_lost_node), {}},
      {"lost-node-while-heartbeats-come", {}, adds(is_foreign_heartbeat, lost_message)},
      {"lost-node-while-guarded", {}, adds(is_guarding_request, lost_message)},
      {"lost-node-after-reset", adds(is_boot_up, lost_message), {}},
      {"heartbeat-time-four-bytes", says_size(0x1017, 0x43), {}},
      {"heartbeat-time-missing", lacks(0x1017), {}},
      {"heartbeat-each-second", drops_some(is_heartbeat, 2), {}},
      {"heartbeat-says-operational", sets_byte(is_heartbeat, 0, 5), {}},
      {"heartbeat-with-toggle",
       [](Wire&, Frame& frame) {
         if (is_heartbeat(frame)) frame.data[0] |= 0x80;
       },
       {}},
      {"heartbeat-never-off", {}, writes(0x1017, 0, 100)},
      {"consumer-takes-duplicate", takes(0x1016, AbortCode::parameter_incompatible), {}},
      {"consumer-duplicate-abort-code",
       aborts_with(0x1016, AbortCode::parameter_incompatible, AbortCode::no_object),
       {}},
      // Storage
      {"save-takes-each-signature", {}, takes_each_signature(0x1010, save)},
      {"load-takes-each-signature", {}, takes_each_signature(0x1011, load)},
      {"save-says-done", takes(0x1010, AbortCode::not_stored), {}},
      {"load-says-done", takes(0x1011, AbortCode::not_stored), {}},
      {"save-all-does-nothing", {}, forgets(0x1010, 1)},
      {"save-communication-does-nothing", {}, forgets(0x1010, 2)},
      {"save-fails", refuses(0x1010, AbortCode::hardware), {}},
      {"load-all-does-nothing", {}, forgets(0x1011, 1)},
      {"load-communication-does-nothing", {}, forgets(0x1011, 2)},
      {"verify-configuration-stays", reads(0x1020, 1, 15'000), {}},
      {"verify-configuration-forgotten", {}, forgets(0x1020, 2)},
      {"restricted-can-ids-taken", takes_restricted_can_ids(), {}},
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
