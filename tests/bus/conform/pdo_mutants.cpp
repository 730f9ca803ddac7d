/// Devices with wrong PDOs: their mappings, when they send them, and their data.
#include <canopen/base/abort_code.hpp>
#include <canopen/nmt/nmt.hpp>
#include <optional>
#include <utility>

#include "mutant.hpp"

namespace edsc::conform {
namespace pdo_mutant {
namespace {

using canopen::AbortCode;
using canopen::Frame;
using canopen::NmtCommand;

constexpr std::uint32_t tpdo1 = 0x180 + Wire::node_id, tpdo2 = 0x280 + Wire::node_id, sync = 0x80,
                        sdo_request = 0x600 + Wire::node_id, sdo_answer = 0x580 + Wire::node_id;
constexpr std::uint8_t written = 0x60, aborted = 0x80;

// ---- SDO ----

std::uint16_t index_of(const Frame& frame) { return static_cast<std::uint16_t>(frame.data[1] | frame.data[2] << 8); }

std::uint32_t value_of(const Frame& frame) {
  std::uint32_t value = 0;
  for (unsigned i = 8; i-- > 4;) value = value << 8 | frame.data[i];
  return value;
}

void set_value(Frame& frame, std::uint32_t value) {
  for (unsigned i = 4; i < 8; ++i, value >>= 8) frame.data[i] = static_cast<std::uint8_t>(value);
}

/// Entries of a range of objects. In a range from 1600h to 1BFFh only those of mapping parameters.
struct Entries {
  std::uint16_t first, last;
  std::uint8_t first_sub_index = 0, last_sub_index = 0xFF;

  [[nodiscard]] bool has(const Frame& frame) const {
    const std::uint16_t index = index_of(frame);
    const bool is_between = index >= 0x1800 && index <= 0x19FF && first < 0x1800 && last > 0x19FF;
    return index >= first && index <= last && !is_between && frame.data[3] >= first_sub_index &&
           frame.data[3] <= last_sub_index;
  }
};

constexpr Entries any_mapping{0x1600, 0x1BFF}, rpdo_mapping{0x1600, 0x17FF}, tpdo_mapping{0x1A00, 0x1BFF};
constexpr Entries mapped_objects_of(Entries mapping) { return {mapping.first, mapping.last, 1, 64}; }
constexpr Entries parameter_of_tpdos(std::uint8_t sub_index) { return {0x1800, 0x19FF, sub_index, sub_index}; }

bool is_write(const Frame& frame) {
  return frame.id == sdo_request && (frame.data[0] & 0xE3) >= 0x22 && (frame.data[0] & 0xE0) == 0x20;
}
bool is_value(const Frame& frame) { return frame.id == sdo_answer && (frame.data[0] & 0xE2) == 0x42; }
bool is_abort(const Frame& frame) { return frame.id == sdo_answer && frame.data[0] == aborted; }

Frame answer_to(const Frame& request, std::uint8_t command, AbortCode code = canopen::ok) {
  Frame answer = request;
  answer.id = sdo_answer;
  answer.data[0] = command;
  set_value(answer, static_cast<std::uint32_t>(code));
  return answer;
}

/// The device writes another value than the given one.
template <class Function>
Change writes(Entries entries, Function changed) {
  return [=](Wire&, Frame& frame) {
    if (is_write(frame) && entries.has(frame)) set_value(frame, changed(value_of(frame)));
  };
}

/// The device has another value.
Change reads(Entries entries, std::uint32_t value) {
  return [=](Wire&, Frame& frame) {
    if (is_value(frame) && entries.has(frame)) set_value(frame, value);
  };
}

/// The device has an entry that it must not have.
Change has(Entries entries, std::uint32_t value) {
  return [=](Wire&, Frame& frame) {
    if (!is_abort(frame) || !entries.has(frame)) return;
    frame.data[0] = 0x43;
    set_value(frame, value);
  };
}

/// The device rejects with another code or, without one, confirms.
Change refuses(Entries entries, AbortCode right, std::optional<AbortCode> wrong) {
  return [=](Wire&, Frame& frame) {
    if (!is_abort(frame) || !entries.has(frame) || value_of(frame) != static_cast<std::uint32_t>(right)) return;
    frame = answer_to(frame, wrong ? aborted : written, wrong.value_or(canopen::ok));
  };
}

/// The device rejects a value that it must accept, if the condition holds for it.
template <class Condition>
Change does_not_take(Entries entries, AbortCode code, Condition condition) {
  return [=](Wire& wire, Frame& frame) {
    if (!is_write(frame) || !entries.has(frame) || !condition(value_of(frame))) return;
    wire.drop();
    wire.send(answer_to(frame, aborted, code));
  };
}

/// The device confirms a download without executing it.
template <class Condition>
Change forgets(Entries entries, Condition condition) {
  return [=](Wire& wire, Frame& frame) {
    if (!is_write(frame) || !entries.has(frame) || !condition(value_of(frame))) return;
    wire.drop();
    wire.send(answer_to(frame, written));
  };
}

bool any_value(std::uint32_t) { return true; }
bool maps_object(std::uint32_t value) { return value >> 16 >= 0x1000; }
bool maps_dummy(std::uint32_t value) { return value != 0 && value >> 16 < 0x20; }
/// In the fixture, 1001h:00 and 200Dh:00 are ro, 200Eh:00 is rww; all can be mapped.
bool maps_input(std::uint32_t value) { return value >> 16 == 0x1001 || value >> 16 == 0x200D; }
bool maps_output(std::uint32_t value) { return value >> 16 == 0x200E; }

/// The device maps what it must not map: it confirms the wrong entry.
template <class Condition>
Mutant maps(std::string_view name, Entries mapping, Condition condition) {
  return {name, {}, forgets(mapped_objects_of(mapping), condition)};
}

// ---- frames of TPDOs ----

bool is_tpdo(const Frame& frame) { return frame.id == tpdo1 || frame.id == tpdo2; }

template <class Function>
Change sends(Function change) {
  return [=](Wire& wire, Frame& frame) mutable {
    if (is_tpdo(frame)) change(wire, frame);
  };
}

Frame some_tpdo() { return {tpdo1, 4, false, false, {}}; }

/// Sends a TPDO in a state where PDOs do not exist.
template <class Condition>
Change sends_in(NmtCommand state, Condition condition) {
  return [=, now = NmtCommand::enter_pre_operational](Wire& wire, Frame& frame) mutable {
    if (frame.id == 0 && !frame.remote && frame.size == 2) now = static_cast<NmtCommand>(frame.data[0]);
    if (now == state && condition(frame)) wire.send(some_tpdo());
  };
}

bool is_remote_frame_for_tpdo(const Frame& frame) { return frame.remote && is_tpdo(frame); }
bool is_sync(const Frame& frame) { return frame.id == sync && !frame.remote; }

/// Stays in its state, so that its TPDOs are still sent by events and timers.
Change ignores(NmtCommand command) {
  return [=](Wire& wire, Frame& frame) {
    if (frame.id == 0 && frame.size == 2 && frame.data[0] == static_cast<std::uint8_t>(command)) wire.drop();
  };
}

}  // namespace
}  // namespace pdo_mutant

std::vector<Mutant> pdo_mutants() {
  using namespace pdo_mutant;
  constexpr std::uint8_t cob_id = 1, type = 2, inhibit_time = 3, event_timer = 5, sync_start = 6;
  return {
      // communication parameters
      {"rpdo-beyond-eds", has({0x1410, 0x1410}, 0x8000'0305), {}},
      {"rpdo-reserved-type", reads({0x1400, 0x1400, type, type}, 241), {}},
      {"rpdo-takes-reserved-type", refuses({0x1400, 0x1400, type, type}, AbortCode::invalid_value, std::nullopt), {}},
      {"tpdo-beyond-eds", has({0x19FF, 0x19FF}, 0x8000'0385), {}},
      {"tpdo-restricted-cob-id", reads({0x1801, 0x1801, cob_id, cob_id}, 0x605), {}},
      {"tpdo-shared-cob-id", reads({0x1801, 0x1801, cob_id, cob_id}, tpdo1), {}},
      {"tpdo-sub-index-4", has({0x1800, 0x1800, 4, 4}, 0), {}},
      // remote frames
      {"tpdo-ignores-remote-frame",
       {},
       [](Wire& wire, Frame& frame) {
         if (is_remote_frame_for_tpdo(frame)) wire.drop();
       }},
      {"tpdo-answers-remote-frame-twice",
       {},
       [](Wire& wire, Frame& frame) {
         if (is_remote_frame_for_tpdo(frame)) wire.request(frame);
       }},
      {"tpdo-answers-forbidden-remote-frame",
       {},
       [forbidden = false](Wire& wire, Frame& frame) mutable {
         if (is_write(frame) && Entries{0x1800, 0x1800, 1, 1}.has(frame)) forbidden = (value_of(frame) >> 30) == 1;
         if (forbidden && is_remote_frame_for_tpdo(frame)) wire.send(some_tpdo());
       }},
      {"tpdo-252-not-sampled",
       {},
       writes(parameter_of_tpdos(type), [](std::uint32_t value) { return value == 252 ? 253U : value; })},
      // frames
      {"tpdo-lost", sends([](Wire& wire, Frame&) { wire.drop(); }), {}},
      {"tpdo-twice", sends([](Wire& wire, Frame& frame) { wire.send(frame); }), {}},
      {"tpdo-too-short", sends([](Wire&, Frame& frame) { --frame.size; }), {}},
      {"tpdo-too-long", sends([](Wire&, Frame& frame) { frame.size = 8; }), {}},
      {"tpdo-wrong-data", sends([](Wire&, Frame& frame) { frame.data[0] ^= 0x10; }), {}},
      {"tpdo-swapped-bytes", sends([](Wire&, Frame& frame) { std::swap(frame.data[0], frame.data[1]); }), {}},
      {"tpdo-wrong-can-id", sends([](Wire&, Frame& frame) { frame.id += 1; }), {}},
      {"tpdo-without-new-data",
       sends([last = std::optional<Frame>{}](Wire&, Frame& frame) mutable {
         const Frame present = frame;
         if (last && last->id == frame.id && last->size == frame.size) frame.data = last->data;
         last = present;
       }),
       {}},
      // times
      {"tpdo-ignores-inhibit-time", {}, writes(parameter_of_tpdos(inhibit_time), [](std::uint32_t) { return 0U; })},
      {"tpdo-halves-inhibit-time",
       {},
       writes(parameter_of_tpdos(inhibit_time), [](std::uint32_t value) { return value / 2; })},
      {"tpdo-ignores-event-timer", {}, writes(parameter_of_tpdos(event_timer), [](std::uint32_t) { return 0U; })},
      {"tpdo-late-event-timer",
       {},
       writes(parameter_of_tpdos(event_timer), [](std::uint32_t value) { return value + value / 10; })},
      {"tpdo-early-event-timer",
       {},
       writes(parameter_of_tpdos(event_timer), [](std::uint32_t value) { return value - value / 10; })},
      {"tpdo-keeps-event-timer",
       {},
       forgets(parameter_of_tpdos(event_timer), [](std::uint32_t value) { return value == 0; })},
      // SYNC
      {"tpdo-late-at-nth-sync",
       {},
       writes(parameter_of_tpdos(type), [](std::uint32_t value) { return value == 3 ? 4U : value; })},
      {"tpdo-at-each-sync",
       {},
       writes(parameter_of_tpdos(type), [](std::uint32_t value) { return value <= 240 ? 1U : value; })},
      {"tpdo-0-as-event",
       {},
       writes(parameter_of_tpdos(type), [](std::uint32_t value) { return value == 0 ? 255U : value; })},
      {"tpdo-ignores-sync-start", {}, writes(parameter_of_tpdos(sync_start), [](std::uint32_t) { return 0U; })},
      {"tpdo-other-sync-start",
       {},
       writes(parameter_of_tpdos(sync_start), [](std::uint32_t value) { return value == 0 ? 0 : value + 1; })},
      // states
      {"tpdo-answers-remote-frame-in-stopped", {}, sends_in(NmtCommand::stop, is_remote_frame_for_tpdo)},
      {"tpdo-answers-remote-frame-in-pre-operational",
       {},
       sends_in(NmtCommand::enter_pre_operational, is_remote_frame_for_tpdo)},
      {"tpdo-at-sync-in-stopped", {}, sends_in(NmtCommand::stop, is_sync)},
      {"tpdo-at-sync-in-pre-operational", {}, sends_in(NmtCommand::enter_pre_operational, is_sync)},
      {"pdo-ignores-stop", {}, ignores(NmtCommand::stop)},
      {"pdo-ignores-enter-pre-operational", {}, ignores(NmtCommand::enter_pre_operational)},
      // the present mapping
      {"mapping-of-missing-object", reads({0x1A00, 0x1A00, 1, 1}, 0x2100'0008), {}},
      {"mapping-of-unmappable-object", reads({0x1601, 0x1601, 4, 4}, 0x1017'0010), {}},
      {"mapping-of-wrong-length", reads({0x1A01, 0x1A01, 1, 1}, 0x2002'0110), {}},
      {"mapping-of-too-many-bits", reads({0x1A01, 0x1A01, 2, 2}, 0x2004'0040), {}},
      // a new mapping
      {"mapping-refused", {}, does_not_take(mapped_objects_of(any_mapping), AbortCode::read_only, any_value)},
      {"mapping-not-stored", {}, forgets(mapped_objects_of(any_mapping), maps_object)},
      {"mapping-count-not-stored", {}, forgets({0x1600, 0x1BFF, 0, 0}, [](std::uint32_t value) { return value != 0; })},
      {"rpdo-mapping-not-used",
       {},
       [](Wire&, Frame& frame) {
         if (frame.id == 0x205 && frame.size > 1) std::swap(frame.data[0], frame.data[frame.size - 1U]);
       }},
      {"mapping-changes-while-valid", refuses(any_mapping, AbortCode::unsupported_access, std::nullopt), {}},
      {"mapping-entry-changes-while-valid",
       refuses(mapped_objects_of(any_mapping), AbortCode::unsupported_access, std::nullopt),
       {}},
      {"mapping-in-use-wrong-code", refuses(any_mapping, AbortCode::unsupported_access, AbortCode::toggle_bit), {}},
      {"mapping-of-too-many-taken", refuses(any_mapping, AbortCode::pdo_length, std::nullopt), {}},
      {"mapping-of-too-many-wrong-code", refuses(any_mapping, AbortCode::pdo_length, AbortCode::no_sub_index), {}},
      {"mapping-wrong-code", refuses(any_mapping, AbortCode::not_mappable, AbortCode::invalid_value), {}},
      {"rpdo-maps-unmappable-object", refuses(rpdo_mapping, AbortCode::not_mappable, std::nullopt), {}},
      {"tpdo-maps-unmappable-object", refuses(tpdo_mapping, AbortCode::not_mappable, std::nullopt), {}},
      maps("rpdo-maps-input", rpdo_mapping, maps_input),
      maps("tpdo-maps-output", tpdo_mapping, maps_output),
      {"rpdo-does-not-map-output",
       {},
       does_not_take(mapped_objects_of(rpdo_mapping), AbortCode::not_mappable, maps_output)},
      {"tpdo-does-not-map-input",
       {},
       does_not_take(mapped_objects_of(tpdo_mapping), AbortCode::not_mappable, maps_input)},
      {"rpdo-does-not-map-dummy",
       {},
       does_not_take(mapped_objects_of(rpdo_mapping), AbortCode::not_mappable, maps_dummy)},
  };
}

}  // namespace edsc::conform
