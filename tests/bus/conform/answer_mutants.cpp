/// Devices that send a frame with another content: one byte, one bit, another length or format.
#include <canopen/base/abort_code.hpp>
#include <canopen/nmt/nmt.hpp>
#include <cstdint>
#include <utility>

#include "frame_changes.hpp"
#include "mutant.hpp"

namespace edsc::conform {
namespace answer_mutant {
namespace {

using namespace control_mutant;
using canopen::NmtState;

constexpr std::uint32_t lss_answer_id = 0x7E4;
constexpr std::uint8_t abort_byte = 0x80, confirmed = 0x60;

/// Changes each frame of this kind.
template <class Predicate, class Function>
Change changes(Predicate predicate, Function change) {
  return [=](Wire&, Frame& frame) {
    if (predicate(frame)) change(frame);
  };
}

void as_remote(Frame& frame) { frame.remote = true; }
void as_extended(Frame& frame) { frame.extended = true; }
auto with_size(std::uint8_t size) {
  return [=](Frame& frame) { frame.size = size; };
}
auto with_byte(std::size_t at, std::uint8_t value) {
  return [=](Frame& frame) { frame.data[at] = value; };
}
void with_next_can_id(Frame& frame) { ++frame.id; }

// SDO
bool is_sdo_answer(const Frame& frame) { return is_data(frame, sdo_answer_id); }
bool is_any_abort(const Frame& frame) { return is_sdo_answer(frame) && frame.data[0] == abort_byte; }
bool is_confirmation(const Frame& frame) { return is_sdo_answer(frame) && frame.data[0] == confirmed; }
bool is_segmented_initiate(const Frame& frame) { return is_sdo_answer(frame) && frame.data[0] == 0x41; }
bool is_upload_segment(const Frame& frame) { return is_sdo_answer(frame) && (frame.data[0] & 0xE0) == 0; }
bool is_last_upload_segment(const Frame& frame) { return is_upload_segment(frame) && (frame.data[0] & 1) != 0; }
bool is_block_download_answer(const Frame& frame) { return is_sdo_answer(frame) && (frame.data[0] & 0xFB) == 0xA0; }
bool is_block_end(const Frame& frame) { return is_sdo_answer(frame) && (frame.data[0] & 0xE3) == 0xC1; }

/// Of 1017h:00 or, with another index, of that object.
auto is_value_of(std::uint16_t index) {
  return [=](const Frame& frame) {
    return names(frame, sdo_answer_id, index, any_sub_index) && (frame.data[0] & 0xE2) == 0x42;
  };
}

// EMCY, SYNC
bool is_emcy(const Frame& frame) { return is_data(frame, emcy_id); }
bool is_emcy_of_error(const Frame& frame) { return is_emcy(frame) && (frame.data[0] | frame.data[1]) != 0; }
bool is_emcy_reset(const Frame& frame) { return is_emcy(frame) && !is_emcy_of_error(frame); }
bool is_sync(const Frame& frame) { return is_data(frame, sync_id); }
bool is_counting_sync(const Frame& frame) { return is_sync(frame) && frame.size == 1; }

// Error control
auto reports(NmtState state) {
  return [=](const Frame& frame) { return is_heartbeat(frame) && (frame.data[0] & 0x7F) == static_cast<int>(state); };
}
auto as_state(NmtState state) { return with_byte(0, static_cast<std::uint8_t>(state)); }

/// The toggle bit of responses to node guarding begins with 1.
Change guarding_toggle_from_1() {
  return [](Wire&, Frame& frame) {
    if (is_heartbeat(frame)) frame.data[0] ^= 0x80;
  };
}

// PDO
bool is_tpdo(const Frame& frame) { return is_data(frame, tpdo_id) || is_data(frame, tpdo_id + 0x100); }
void with_another_last_byte(Frame& frame) {
  if (frame.size != 0) frame.data[frame.size - 1U] ^= 0x01;
}
void inverted(Frame& frame) {
  for (unsigned i = 0; i != frame.size; ++i) frame.data[i] ^= 0xFF;
}

// LSS
auto is_lss_answer(std::uint8_t command) {
  return [=](const Frame& frame) { return is_data(frame, lss_answer_id) && frame.data[0] == command; };
}
bool is_any_lss_answer(const Frame& frame) { return is_data(frame, lss_answer_id); }

std::vector<Mutant> sdo() {
  return {
      {"abort-code-0", changes(is_any_abort, [](Frame& frame) { put_word(frame, 4, 0); }), {}},
      {"abort-code-unknown", changes(is_any_abort, [](Frame& frame) { put_word(frame, 4, 0x0609'0099); }), {}},
      {"abort-with-bytes-reversed",
       changes(is_any_abort,
               [](Frame& frame) {
                 std::swap(frame.data[4], frame.data[7]);
                 std::swap(frame.data[5], frame.data[6]);
               }),
       {}},
      {"abort-of-another-object", changes(is_any_abort, [](Frame& frame) { frame.data[1] ^= 1; }), {}},
      {"abort-of-another-sub-index", changes(is_any_abort, [](Frame& frame) { frame.data[3] ^= 1; }), {}},
      {"abort-of-7-bytes", changes(is_any_abort, with_size(7)), {}},
      {"value-of-another-object", changes(is_value_of(0x1017), [](Frame& frame) { frame.data[1] ^= 1; }), {}},
      {"value-of-another-sub-index", changes(is_value_of(0x1018), [](Frame& frame) { frame.data[3] ^= 1; }), {}},
      {"value-of-4-bytes-for-each-parameter", changes(is_value_of(0x100C), with_byte(0, 0x43)), {}},
      {"value-of-3-bytes", changes(is_value_of(0x1017), with_byte(0, 0x47)), {}},
      {"value-with-bytes-swapped",
       changes(is_value_of(0x1017), [](Frame& frame) { std::swap(frame.data[4], frame.data[5]); }),
       {}},
      {"confirmation-of-another-object", changes(is_confirmation, [](Frame& frame) { frame.data[1] ^= 1; }), {}},
      {"confirmation-of-another-sub-index", changes(is_confirmation, [](Frame& frame) { frame.data[3] ^= 1; }), {}},
      {"confirmation-of-4-bytes", changes(is_confirmation, with_size(4)), {}},
      {"confirmation-with-size", changes(is_confirmation, with_byte(0, 0x61)), {}},
      {"segments-without-end", changes(is_last_upload_segment, [](Frame& frame) { frame.data[0] &= 0xFE; }), {}},
      {"segments-with-bytes-swapped",
       changes(is_upload_segment, [](Frame& frame) { std::swap(frame.data[1], frame.data[2]); }),
       {}},
      {"segment-size-indicated-as-0", changes(is_segmented_initiate, [](Frame& frame) { put_word(frame, 4, 0); }), {}},
      {"block-download-of-128-segments", changes(is_block_download_answer, with_byte(4, 128)), {}},
      {"block-download-of-0-segments", changes(is_block_download_answer, with_byte(4, 0)), {}},
      {"block-download-of-another-object",
       changes(is_block_download_answer, [](Frame& frame) { frame.data[1] ^= 1; }),
       {}},
      {"block-crc-with-bytes-swapped",
       changes(is_block_end, [](Frame& frame) { std::swap(frame.data[1], frame.data[2]); }),
       {}},
      {"block-end-with-one-more-unused-byte",
       changes(is_block_end, [](Frame& frame) { frame.data[0] = static_cast<std::uint8_t>(frame.data[0] + 4); }),
       {}},
  };
}

std::vector<Mutant> emergency_and_sync() {
  return {
      {"emcy-register-0", changes(is_emcy_of_error, with_byte(2, 0)), {}},
      {"emcy-register-of-voltage", changes(is_emcy_of_error, with_byte(2, 0x05)), {}},
      {"emcy-code-with-bytes-swapped",
       changes(is_emcy_of_error, [](Frame& frame) { std::swap(frame.data[0], frame.data[1]); }),
       {}},
      {"emcy-code-0", changes(is_emcy_of_error, [](Frame& frame) { frame.data[0] = frame.data[1] = 0; }), {}},
      {"emcy-without-data", changes(is_emcy, with_size(0)), {}},
      {"emcy-as-extended-frame", changes(is_emcy, as_extended), {}},
      {"emcy-as-remote-frame", changes(is_emcy, as_remote), {}},
      {"emcy-with-another-can-id", changes(is_emcy, with_next_can_id), {}},
      {"emcy-end-with-code-of-error", changes(is_emcy_reset, with_byte(1, 0x10)), {}},
      {"sync-of-two-bytes", changes(is_sync, with_size(2)), {}},
      {"sync-counter-stays", changes(is_counting_sync, with_byte(0, 1)), {}},
      {"sync-counts-by-two",
       changes(is_counting_sync, [](Frame& frame) { frame.data[0] = static_cast<std::uint8_t>(2 * frame.data[0]); }),
       {}},
      {"sync-never-counts", changes(is_counting_sync, with_size(0)), {}},
      {"sync-with-another-can-id", changes(is_sync, with_next_can_id), {}},
      {"sync-as-extended-frame", changes(is_sync, as_extended), {}},
  };
}

std::vector<Mutant> error_control() {
  return {
      {"heartbeat-with-unknown-state", changes(is_heartbeat, with_byte(0, 1)), {}},
      {"heartbeat-of-two-bytes", changes(is_heartbeat, with_size(2)), {}},
      {"heartbeat-without-data", changes(is_heartbeat, with_size(0)), {}},
      {"heartbeat-as-extended-frame", changes(is_heartbeat, as_extended), {}},
      {"heartbeat-with-another-can-id", changes(is_heartbeat, with_next_can_id), {}},
      {"guarding-toggle-from-1", guarding_toggle_from_1(), {}},
      {"stopped-reported-as-pre-operational",
       changes(reports(NmtState::stopped), as_state(NmtState::pre_operational)),
       {}},
      {"stopped-reported-as-operational", changes(reports(NmtState::stopped), as_state(NmtState::operational)), {}},
      {"operational-reported-as-stopped", changes(reports(NmtState::operational), as_state(NmtState::stopped)), {}},
      {"operational-reported-as-pre-operational",
       changes(reports(NmtState::operational), as_state(NmtState::pre_operational)),
       {}},
      {"boot-up-of-two-bytes", changes(is_boot_up, with_size(2)), {}},
      {"boot-up-without-data", changes(is_boot_up, with_size(0)), {}},
      {"boot-up-with-state", changes(is_boot_up, as_state(NmtState::pre_operational)), {}},
      {"boot-up-with-toggle-bit", changes(is_boot_up, with_byte(0, 0x80)), {}},
  };
}

std::vector<Mutant> pdos_and_lss() {
  return {
      {"tpdo-as-remote-frame", changes(is_tpdo, as_remote), {}},
      {"tpdo-as-extended-frame", changes(is_tpdo, as_extended), {}},
      {"tpdo-without-data", changes(is_tpdo, with_size(0)), {}},
      {"tpdo-with-another-last-byte", changes(is_tpdo, with_another_last_byte), {}},
      {"tpdo-inverted", changes(is_tpdo, inverted), {}},
      {"lss-selected-with-another-command", changes(is_lss_answer(0x44), with_byte(0, 0x45)), {}},
      {"lss-identified-with-another-command", changes(is_lss_answer(0x4F), with_byte(0, 0x50)), {}},
      {"lss-vendor-id-with-bytes-swapped",
       changes(is_lss_answer(0x5A), [](Frame& frame) { put_word(frame, 1, 0x0100'0000); }),
       {}},
      {"lss-wrong-revision-number", changes(is_lss_answer(0x5C), [](Frame& frame) { frame.data[1] ^= 1; }), {}},
      {"lss-wrong-serial-number", changes(is_lss_answer(0x5D), [](Frame& frame) { frame.data[4] ^= 0x80; }), {}},
      {"lss-node-id-255", changes(is_lss_answer(0x5E), with_byte(1, 0xFF)), {}},
      {"lss-bit-timing-error-code", changes(is_lss_answer(0x13), with_byte(1, 0xFF)), {}},
      {"lss-store-with-another-command", changes(is_lss_answer(0x17), with_byte(0, 0x18)), {}},
      {"lss-response-of-7-bytes", changes(is_any_lss_answer, with_size(7)), {}},
      {"lss-response-with-can-id-of-requests", changes(is_any_lss_answer, with_next_can_id), {}},
  };
}

}  // namespace
}  // namespace answer_mutant

std::vector<Mutant> answer_mutants() {
  using namespace answer_mutant;
  std::vector<Mutant> all;
  for (const auto table : {sdo, emergency_and_sync, error_control, pdos_and_lss}) {
    for (Mutant& mutant : table()) all.push_back(std::move(mutant));
  }
  return all;
}

}  // namespace edsc::conform
