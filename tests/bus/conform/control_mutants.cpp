/// Mutants of EMCY, SYNC, error control and storage.
#include <canopen/base/abort_code.hpp>
#include <canopen/nmt/nmt.hpp>
#include <cstdint>

#include "frame_changes.hpp"
#include "mutant.hpp"

namespace edsc::conform {
namespace control_mutant {
namespace {

using std::chrono::milliseconds;

constexpr std::uint16_t lost_node = 0x8130;

Frame with_size(Frame frame, std::uint8_t size) {
  frame.size = size;
  return frame;
}

bool is_emcy(const Frame& frame, std::uint16_t code) {
  return is_data(frame, emcy_id) && (word_at(frame, 0) & 0xFFFF) == code;
}

bool is_guarding_request(const Frame& frame) { return frame.remote && frame.id == error_control_id; }

bool is_upload_answer(const Frame& frame, std::uint16_t index, int sub_index) {
  return names(frame, sdo_answer_id, index, sub_index) && (frame.data[0] & 0xE2) == 0x42;
}

bool is_download(const Frame& frame, std::uint16_t index, int sub_index) {
  return names(frame, sdo_request_id, index, sub_index) && (frame.data[0] & 0xE2) == 0x22;
}

bool is_download_answer(const Frame& frame, std::uint16_t index) {
  return names(frame, sdo_answer_id, index, any_sub_index) && frame.data[0] == 0x60;
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

/// One in `every` of these frames is lost.
template <class Predicate>
Change drops_some(Predicate predicate, unsigned every) {
  return [=, seen = 0U](Wire& wire, Frame& frame) mutable {
    if (predicate(frame) && ++seen % every == 0) wire.drop();
  };
}

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

/// Each COB-ID accepts a restricted CAN-ID.
Change takes_restricted_can_ids() {
  return [](Wire& wire, Frame& frame) {
    for (const unsigned index : {0x1005U, 0x1012U, 0x1014U, 0x1201U, 0x1400U, 0x1800U}) {
      takes(static_cast<std::uint16_t>(index), AbortCode::invalid_value)(wire, frame);
    }
  };
}

constexpr std::uint32_t save = 0x6576'6173, load = 0x6461'6F6C;

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
      {"history-second-wrong", reads(0x1003, 2, 0x8130), {}},
      {"history-not-deleted", refuses(0x1003, AbortCode::read_only), {}},
      {"history-takes-any-number", takes(0x1003, AbortCode::invalid_value), {}},
      {"emcy-inhibit-time-not-writable", refuses(0x1015, AbortCode::read_only), {}},
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
  };
}

}  // namespace edsc::conform
