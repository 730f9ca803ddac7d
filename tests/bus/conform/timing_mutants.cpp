/// Devices whose frames are late, early, missing or sent more than once.
#include <canopen/base/abort_code.hpp>
#include <canopen/nmt/nmt.hpp>
#include <chrono>
#include <cstdint>

#include "frame_changes.hpp"
#include "mutant.hpp"

namespace edsc::conform {
namespace timing_mutant {
namespace {

using namespace control_mutant;
using std::chrono::milliseconds;

constexpr std::uint32_t lss_answer_id = 0x7E4;

bool is_emcy(const Frame& frame) { return is_data(frame, emcy_id); }
bool is_emcy_reset(const Frame& frame) { return is_emcy(frame) && (frame.data[0] | frame.data[1]) == 0; }
bool is_sync(const Frame& frame) { return is_data(frame, sync_id); }
bool is_tpdo(const Frame& frame) { return is_data(frame, tpdo_id) || is_data(frame, tpdo_id + 0x100); }
bool is_lss_answer(const Frame& frame) { return is_data(frame, lss_answer_id); }
bool is_any_abort(const Frame& frame) { return is_data(frame, sdo_answer_id) && frame.data[0] == 0x80; }
bool is_confirmation(const Frame& frame) { return is_data(frame, sdo_answer_id) && frame.data[0] == 0x60; }
bool is_upload_segment(const Frame& frame) { return is_data(frame, sdo_answer_id) && (frame.data[0] & 0xE0) == 0; }

auto is_command(NmtCommand command) {
  return [=](const Frame& frame) { return is_nmt(frame, command); };
}

/// One in `every` of these frames is late.
template <class Predicate>
Change delays(Predicate predicate, milliseconds span, unsigned every = 1) {
  return [=, seen = 0U](Wire& wire, Frame& frame) mutable {
    if (predicate(frame) && ++seen % every == 0) wire.delay(span);
  };
}

/// One in `every` of these frames is lost.
template <class Predicate>
Change loses(Predicate predicate, unsigned every) {
  return [=, seen = 0U](Wire& wire, Frame& frame) mutable {
    if (predicate(frame) && ++seen % every == 0) wire.drop();
  };
}

/// One in `every` of these frames is sent twice.
template <class Predicate>
Change doubles(Predicate predicate, unsigned every) {
  return [=, seen = 0U](Wire& wire, Frame& frame) mutable {
    if (predicate(frame) && ++seen % every == 0) wire.send(frame);
  };
}

/// Sent three times.
template <class Predicate>
Change triples(Predicate predicate) {
  return [=](Wire& wire, Frame& frame) {
    if (!predicate(frame)) return;
    wire.send(frame);
    wire.send(frame);
  };
}

/// Only the responses to node guarding.
Change late_guarding(milliseconds span) {
  return [=](Wire& wire, Frame& frame) {
    if (is_heartbeat(frame) && (frame.data[0] & 0x80) != 0) wire.delay(span);
  };
}

const Frame boot_up = make(error_control_id, {0}), heartbeat = make(error_control_id, {0x7F});

}  // namespace
}  // namespace timing_mutant

std::vector<Mutant> timing_mutants() {
  using namespace timing_mutant;
  return {
      // Boot-up
      {"boot-up-after-6-s", delays(is_boot_up, milliseconds{6000}), {}},
      {"boot-up-three-times", triples(is_boot_up), {}},
      {"boot-up-at-start", {}, adds(is_command(NmtCommand::start), boot_up)},
      {"boot-up-at-enter-pre-operational", {}, adds(is_command(NmtCommand::enter_pre_operational), boot_up)},
      {"boot-up-after-each-emcy", adds(is_emcy, boot_up), {}},
      // Heartbeat and guarding
      {"heartbeat-doubled", repeats(is_heartbeat), {}},
      {"heartbeat-each-third-missing", loses(is_heartbeat, 3), {}},
      {"heartbeat-each-third-doubled", doubles(is_heartbeat, 3), {}},
      {"heartbeat-jitter", delays(is_heartbeat, milliseconds{30}, 2), {}},
      {"heartbeat-each-fifth-half-late", delays(is_heartbeat, milliseconds{50}, 5), {}},
      {"heartbeat-at-boot-up", adds(is_boot_up, heartbeat), {}},
      {"guarding-response-late", late_guarding(milliseconds{500}), {}},
      // EMCY and SYNC
      {"emcy-after-1500-ms", delays(is_emcy, milliseconds{1500}), {}},
      {"emcy-three-times", triples(is_emcy), {}},
      {"emcy-each-second-lost", loses(is_emcy, 2), {}},
      {"emcy-end-twice", repeats(is_emcy_reset), {}},
      {"sync-each-tenth-lost", loses(is_sync, 10), {}},
      {"sync-each-fifth-doubled", doubles(is_sync, 5), {}},
      {"sync-each-third-late", delays(is_sync, milliseconds{8}, 3), {}},
      // SDO
      {"abort-twice", repeats(is_any_abort), {}},
      {"abort-after-3-s", delays(is_any_abort, milliseconds{3000}), {}},
      {"abort-missing", drops(is_any_abort), {}},
      {"confirmation-twice", repeats(is_confirmation), {}},
      {"upload-segment-twice", repeats(is_upload_segment), {}},
      // PDO
      {"tpdo-each-second-lost", loses(is_tpdo, 2), {}},
      {"tpdo-each-third-doubled", doubles(is_tpdo, 3), {}},
      {"tpdo-after-500-ms", delays(is_tpdo, milliseconds{500}), {}},
      {"tpdo-jitter", delays(is_tpdo, milliseconds{15}, 2), {}},
      // LSS
      {"lss-response-twice", repeats(is_lss_answer), {}},
      {"lss-response-after-3-s", delays(is_lss_answer, milliseconds{3000}), {}},
      {"lss-each-fourth-response-missing", loses(is_lss_answer, 4), {}},
  };
}

}  // namespace edsc::conform
