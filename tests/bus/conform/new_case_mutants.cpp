/// Mutants of received PDOs, of the SDO protocol without a transfer, and of the error register in EMCYs.
#include <canopen/base/abort_code.hpp>
#include <canopen/nmt/nmt.hpp>
#include <cstdint>
#include <memory>

#include "frame_changes.hpp"
#include "mutant.hpp"

namespace edsc::conform {
namespace control_mutant {
namespace {

using std::chrono::milliseconds;

constexpr std::uint32_t rpdo_id = 0x200 + node;
constexpr std::uint8_t rpdo_bytes = 7;  // of the mapping in 1600h
constexpr auto pre_operational = static_cast<std::uint8_t>(NmtCommand::enter_pre_operational);
constexpr auto started = static_cast<std::uint8_t>(NmtCommand::start);

Frame nmt(std::uint8_t command) { return make(0, {command, static_cast<std::uint8_t>(node)}); }

// ---- RPDOs ----

/// RPDOs are also processed in the state that this command has led to.
Change processes_rpdo_after(NmtCommand command) {
  return [wanted = static_cast<std::uint8_t>(command), last = pre_operational](Wire& wire, Frame& frame) mutable {
    if (is_data(frame, 0)) last = frame.data[0];
    if (last != wanted || !is_data(frame, rpdo_id)) return;
    wire.drop();
    for (const Frame& sent : {nmt(started), frame, nmt(wanted)}) wire.request(sent);
  };
}

/// An RPDO of Pre-operational is processed after Start.
Change keeps_rpdo() {
  return [last = pre_operational, kept = Frame{}](Wire& wire, Frame& frame) mutable {
    if (is_data(frame, 0)) last = frame.data[0];
    if (last == pre_operational && is_data(frame, rpdo_id)) kept = frame;
    if (!is_nmt(frame, NmtCommand::start) || kept.size == 0) return;
    wire.drop();
    for (const Frame& sent : {frame, kept}) wire.request(sent);
    kept = {};
  };
}

Change takes_short_rpdo() {
  return [](Wire&, Frame& frame) {
    if (is_data(frame, rpdo_id) && frame.size < rpdo_bytes) frame.size = rpdo_bytes;
  };
}

/// Of an RPDO that is too long only the first object is used.
Change takes_part_of_long_rpdo() {
  return [](Wire&, Frame& frame) {
    if (!is_data(frame, rpdo_id) || frame.size <= rpdo_bytes) return;
    for (std::size_t i = 1; i != frame.size; ++i) frame.data[i] = 0;
  };
}

/// A download of a COB-ID with bit 31 is confirmed without being executed.
Change stays_valid(std::uint16_t index) {
  return [=](Wire& wire, Frame& frame) {
    const int sub_index = index == 0x1014 ? 0 : 1;
    if (!names(frame, sdo_request_id, index, sub_index) || frame.data[0] != 0x23 || (frame.data[7] & 0x80) == 0) return;
    wire.drop();
    wire.send(make(sdo_answer_id, {0x60, frame.data[1], frame.data[2], frame.data[3], 0, 0, 0, 0}));
  };
}

/// Each refused download of the entry is confirmed.
Change takes_all(std::uint16_t index, int sub_index) {
  return [=](Wire&, Frame& frame) {
    if (!names(frame, sdo_answer_id, index, sub_index) || frame.data[0] != 0x80) return;
    frame.data[0] = 0x60;
    put_word(frame, 4, 0);
  };
}

// ---- EMCY ----

Change register_with(std::uint16_t code, std::uint8_t bits) {
  return [=](Wire&, Frame& frame) {
    if (is_data(frame, emcy_id) && (word_at(frame, 0) & 0xFFFF) == code) frame.data[2] = bits;
  };
}

Change no_inhibit_time() {
  return [](Wire&, Frame& frame) {
    if (names(frame, sdo_request_id, 0x1015, 0) && frame.data[0] == 0x2B) put_word(frame, 4, 0);
  };
}

// ---- SDO ----

/// Requests with this command directly after an abort of the client are lost.
Change ignores_without_transfer(std::uint8_t command) {
  return [command, last = std::uint8_t{0}](Wire& wire, Frame& frame) mutable {
    if (!is_data(frame, sdo_request_id)) return;
    if (last == 0x80 && frame.data[0] == command) wire.drop();
    last = frame.data[0];
  };
}

/// An initiate upload of 1000h directly after this request is lost.
Change ignores_initiate_after(std::uint8_t command, std::uint16_t index) {
  return [=, open = false](Wire& wire, Frame& frame) mutable {
    if (!is_data(frame, sdo_request_id)) return;
    if (open && names(frame, sdo_request_id, 0x1000, 0) && frame.data[0] == 0x40) wire.drop();
    open = names(frame, sdo_request_id, index, 0) && frame.data[0] == command;
  };
}

Change answers_abort() {
  return [](Wire& wire, Frame& frame) {
    if (is_data(frame, sdo_request_id) && frame.data[0] == 0x80)
      wire.send(make(sdo_answer_id, {0x80, 0, 0, 0, 0, 0, 0, 8}));
  };
}

Change takes_short_request() {
  return [](Wire&, Frame& frame) {
    if (is_data(frame, sdo_request_id) && frame.data[0] == 0x2B) frame.size = 8;
  };
}

bool is_any_abort(const Frame& frame) { return is_data(frame, sdo_answer_id) && frame.data[0] == 0x80; }

/// Segments with a wrong number of bytes are confirmed.
Change takes_wrong_size() {
  return [](Wire&, Frame& frame) {
    const bool of_size = is_any_abort(frame) && (word_at(frame, 4) & 0xFFFF'FFF0) == 0x0607'0010;
    if (of_size && names(frame, sdo_answer_id, 0x1017, 0)) frame = make(sdo_answer_id, {0x20, 0, 0, 0, 0, 0, 0, 0});
  };
}

Change aborts_with_code(AbortCode right, std::uint32_t wrong) {
  return [=](Wire&, Frame& frame) {
    if (is_any_abort(frame) && word_at(frame, 4) == static_cast<std::uint32_t>(right)) put_word(frame, 4, wrong);
  };
}

Change aborts_without_index() {
  return [](Wire&, Frame& frame) {
    if (is_any_abort(frame) && names(frame, sdo_answer_id, 0x1004, any_sub_index)) frame.data[1] = 0;
  };
}

Change fills_reserved_bytes() {
  return [](Wire&, Frame& frame) {
    if (is_data(frame, sdo_answer_id) && frame.data[0] == 0x60) frame.data[7] = 0x55;
  };
}

// ---- heartbeat, NMT ----

/// Each heartbeat comes 3 ms later than the one before, relative to its period.
Change heartbeats_drift() {
  return [last = canopen::TimePoint{}, count = 0U](Wire& wire, Frame& frame) mutable {
    if (!is_heartbeat(frame)) return;
    count = wire.now - last > milliseconds{500} ? 0 : count + 1;
    last = wire.now;
    wire.delay(milliseconds{3} * count);
  };
}

/// The first heartbeats after a write of 1017h are missing.
Change first_heartbeats_missing() {
  return [missing = 0U](Wire& wire, Frame& frame) mutable {
    if (names(frame, sdo_answer_id, 0x1017, 0) && frame.data[0] == 0x60) missing = 2;
    if (missing == 0 || !is_heartbeat(frame)) return;
    wire.drop();
    --missing;
  };
}

/// A download of 0 or, with `any`, of each value is confirmed without being executed.
Change forgets(std::uint16_t index, int sub_index, bool any) {
  return [=](Wire& wire, Frame& frame) {
    if (!names(frame, sdo_request_id, index, sub_index) || (frame.data[0] & 0xE2) != 0x22) return;
    if (!any && word_at(frame, 4) != 0) return;
    wire.drop();
    wire.send(make(sdo_answer_id, {0x60, frame.data[1], frame.data[2], frame.data[3], 0, 0, 0, 0}));
  };
}

Change unknown_command_starts() {
  return [](Wire&, Frame& frame) {
    if (is_data(frame, 0) && frame.data[0] == 3) frame.data[0] = started;
  };
}

Change takes_commands_for_others() {
  return [](Wire&, Frame& frame) {
    if (is_data(frame, 0) && frame.size == 2 && frame.data[1] != 0) frame.data[1] = static_cast<std::uint8_t>(node);
  };
}

Change takes_short_commands() {
  return [](Wire&, Frame& frame) {
    if (!is_data(frame, 0) || frame.size != 1) return;
    frame.size = 2;
    frame.data[1] = static_cast<std::uint8_t>(node);
  };
}

// ---- power cuts ----

/// The value of an entry after a power cut is another one, until the next reset. A boot-up message without a reset
/// before it shows the power cut.
Mutant loses_value(std::string_view name, std::uint16_t index, std::uint32_t value) {
  struct Power {
    bool was_reset = false, was_cut = false;
  };
  const auto power = std::make_shared<Power>();
  return {name,
          [=](Wire&, Frame& frame) {
            if (is_boot_up(frame)) {
              power->was_cut = !power->was_reset;
              power->was_reset = false;
            }
            if (power->was_cut && names(frame, sdo_answer_id, index, 0) && (frame.data[0] & 0xE2) == 0x42) {
              put_word(frame, 4, value);
            }
          },
          [=](Wire&, Frame& frame) {
            if (!is_nmt(frame, NmtCommand::reset_node) && !is_nmt(frame, NmtCommand::reset_communication)) return;
            power->was_reset = true;
          }};
}

}  // namespace
}  // namespace control_mutant

std::vector<Mutant> new_case_mutants() {
  using namespace control_mutant;
  constexpr std::uint16_t short_rpdo = 0x8210, lost_node = 0x8130, current = 0x2310;
  return {
      // RPDO
      {"rpdo-processed-in-pre-operational", {}, processes_rpdo_after(NmtCommand::enter_pre_operational)},
      {"rpdo-processed-in-stopped", {}, processes_rpdo_after(NmtCommand::stop)},
      {"rpdo-of-pre-operational-kept", {}, keeps_rpdo()},
      {"rpdo-too-short-processed", {}, takes_short_rpdo()},
      {"rpdo-too-long-processed-in-part", {}, takes_part_of_long_rpdo()},
      {"rpdo-cannot-be-disabled", {}, stays_valid(0x1400)},
      {"rpdo-without-sync", {}, drops([](const Frame& frame) { return is_data(frame, sync_id); })},
      {"rpdo-cob-id-changes-while-valid", takes_all(0x1400, 1), {}},
      {"tpdo-cob-id-changes-while-valid", takes_all(0x1800, 1), {}},
      {"inhibit-time-changes-while-valid", takes_all(0x1800, 3), {}},
      // EMCY
      {"error-register-of-short-rpdo", register_with(short_rpdo, 0x01), {}},
      {"error-register-of-lost-node", register_with(lost_node, 0x01), {}},
      {"error-register-of-current", register_with(current, 0x01), {}},
      {"error-register-without-generic-bit-in-emcy", register_with(lost_node, 0x10), {}},
      {"error-register-with-reserved-bit-in-emcy", register_with(current, 0x43), {}},
      {"error-register-0-when-one-error-ends", register_with(0, 0), {}},
      {"emcy-inhibit-time-ignored", {}, no_inhibit_time()},
      {"emcy-cannot-be-disabled", {}, stays_valid(0x1014)},
      {"emcy-cob-id-changes-while-valid", takes_all(0x1014, 0), {}},
      // SDO
      {"upload-segment-without-transfer-ignored", {}, ignores_without_transfer(0x60)},
      {"download-segment-without-transfer-ignored", {}, ignores_without_transfer(0x01)},
      {"block-start-without-transfer-ignored", {}, ignores_without_transfer(0xA3)},
      {"client-abort-answered", {}, answers_abort()},
      {"short-request-processed", {}, takes_short_request()},
      {"initiate-during-upload-ignored", {}, ignores_initiate_after(0x40, 0x1008)},
      {"initiate-during-download-ignored", {}, ignores_initiate_after(0x21, 0x1017)},
      {"wrong-sizes-confirmed", takes_wrong_size(), {}},
      {"abort-without-index", aborts_without_index(), {}},
      {"download-answer-with-reserved-byte", fills_reserved_bytes(), {}},
      {"abort-code-0-of-command", aborts_with_code(AbortCode::command_specifier, 0), {}},
      {"abort-code-0-of-read-only", aborts_with_code(AbortCode::read_only, 0), {}},
      {"abort-code-of-no-table", aborts_with_code(AbortCode::read_only, 0x0601'0003), {}},
      {"abort-code-of-no-table-for-no-data", aborts_with_code(AbortCode::no_data, 0x0800'0025), {}},
      {"abort-code-of-sub-index-ff", aborts_with_code(AbortCode::no_sub_index, 0x0609'0030), {}},
      // Heartbeat, NMT
      {"heartbeat-consumer-cannot-be-disabled", {}, forgets(0x1016, 1, false)},
      {"heartbeats-drift", heartbeats_drift(), {}},
      {"first-heartbeats-missing", first_heartbeats_missing(), {}},
      {"error-behavior-forgotten", {}, forgets(0x1029, 1, true)},
      {"unknown-nmt-command-starts", {}, unknown_command_starts()},
      {"nmt-for-others-executed", {}, takes_commands_for_others()},
      {"short-nmt-executed", {}, takes_short_commands()},
      {"nmt-for-all-ignored", {}, drops([](const Frame& frame) {
         return is_data(frame, 0) && frame.size == 2 && frame.data[1] == 0;
       })},
      // SYNC and TIME
      {"time-restricted-cob-id",
       [](Wire&, Frame& frame) {
         if (names(frame, sdo_answer_id, 0x1012, 0) && frame.data[0] == 0x43) put_word(frame, 4, 0x70);
       },
       {}},
      {"time-cob-id-changes-while-used", takes_all(0x1012, 0), {}},
      {"sync-cob-id-changes-while-produced", takes_all(0x1005, 0), {}},
      // Storage
      loses_value("stored-value-lost-by-power-cut", 0x100C, 0),
      loses_value("power-cut-leaves-some-values", 0x1007, 0x777),
  };
}

}  // namespace edsc::conform
