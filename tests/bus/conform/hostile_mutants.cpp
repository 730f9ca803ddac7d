/// Devices that pass each case but the hostile ones: frames of others, malformed frames and broken transfers disturb
/// them.
#include <canopen/nmt/nmt.hpp>
#include <cstdint>

#include "frame_changes.hpp"
#include "mutant.hpp"

namespace edsc::conform {
namespace hostile_mutant {
namespace {

using namespace control_mutant;
using std::chrono::milliseconds;

Frame command(NmtCommand which) { return make(0, {static_cast<std::uint8_t>(which), static_cast<std::uint8_t>(node)}); }

/// Resets after this many frames of a kind without a pause of 100 ms.
template <class Predicate>
Change resets_after(unsigned many, Predicate predicate) {
  return [=, count = 0U, last = canopen::TimePoint{}](Wire& wire, Frame& frame) mutable {
    if (!predicate(frame)) return;
    count = wire.now - last > milliseconds{100} ? 1 : count + 1;
    last = wire.now;
    if (count == many) wire.request(command(NmtCommand::reset_communication));
  };
}

bool is_of_other(const Frame& frame, std::uint32_t code) {
  return (frame.id & 0x780U) == code && (frame.id & 0x7FU) != node && !frame.extended && !frame.remote;
}

/// A 29-bit CAN-ID is received as one of 11 bits.
Change takes_extended() {
  return [](Wire&, Frame& frame) { frame.extended = false; };
}

template <class Predicate>
Change sends_tpdo_after(Predicate predicate) {
  return [=](Wire& wire, Frame& frame) {
    if (predicate(frame)) wire.send(make(tpdo_id, {1, 2, 3}));
  };
}

/// A segment that is requested more than 900 ms after the request before it resets the device.
Change resets_on_late_segment() {
  return [last = canopen::TimePoint{}](Wire& wire, Frame& frame) mutable {
    if (!is_data(frame, sdo_request_id)) return;
    if (frame.data[0] == 0x60 && wire.now - last > milliseconds{900}) {
      wire.request(command(NmtCommand::reset_communication));
    }
    last = wire.now;
  };
}

/// A request that follows another one at once blocks the server for 2 s.
Change blocked_by_burst() {
  return [count = 0U, last = canopen::TimePoint{}, until = canopen::TimePoint{}](Wire& wire, Frame& frame) mutable {
    if (!is_data(frame, sdo_request_id)) return;
    count = wire.now == last ? count + 1 : 0;
    last = wire.now;
    if (count == 32) until = wire.now + milliseconds{2000};
    if (until > wire.now) wire.drop();
  };
}

/// This request, directly after that one, blocks the server for 2 s.
template <class First, class Second>
Change blocked_by(First first, Second second) {
  return [=, armed = false, until = canopen::TimePoint{}](Wire& wire, Frame& frame) mutable {
    if (!is_data(frame, sdo_request_id)) return;
    if (armed && second(frame)) until = wire.now + milliseconds{2000};
    armed = first(frame);
    if (until > wire.now) wire.drop();
  };
}

auto begins_with(std::uint8_t byte) {
  return [byte](const Frame& frame) { return frame.data[0] == byte; };
}

/// A download that is only initiated writes a value.
Change writes_at_initiate() {
  return [](Wire& wire, Frame& frame) {
    if (!names(frame, sdo_request_id, 0x100C, 0) || frame.data[0] != 0x21) return;
    wire.drop();
    wire.request(make(sdo_request_id, {0x2B, 0x0C, 0x10, 0, 0x39, 0x05, 0, 0}));
  };
}

}  // namespace
}  // namespace hostile_mutant

std::vector<Mutant> hostile_mutants() {
  using namespace hostile_mutant;
  return {
      {"resets-on-boot-ups-of-others", {}, resets_after(60, [](const Frame& f) { return is_of_other(f, 0x700); })},
      {"resets-on-nmt-of-others",
       {},
       resets_after(60, [](const Frame& f) { return is_data(f, 0) && f.data[1] != node; })},
      {"resets-on-sdo-of-others", {}, resets_after(60, [](const Frame& f) { return is_of_other(f, 0x600); })},
      {"answers-random-frames", {}, sends_tpdo_after([](const Frame& f) {
         return is_data(f, 0x300 + node) && f.size == 3;
       })},
      {"answers-remote-sdo",
       {},
       [](Wire& wire, Frame& frame) {
         if (frame.remote && frame.id == sdo_request_id) wire.send(make(tpdo_id, {0}));
       }},
      {"receives-extended-as-standard", {}, takes_extended()},
      {"answers-empty-frames", {}, sends_tpdo_after([](const Frame& f) { return is_data(f, tpdo_id) && f.size == 0; })},
      {"answers-long-sync", {}, sends_tpdo_after([](const Frame& f) { return is_data(f, sync_id) && f.size > 1; })},
      {"resets-on-late-segment", {}, resets_on_late_segment()},
      {"blocked-by-many-requests", {}, blocked_by_burst()},
      {"resets-on-index-ffff",
       {},
       resets_after(1, [](const Frame& f) { return names(f, sdo_request_id, 0xFFFF, any_sub_index); })},
      {"blocked-by-open-upload", {}, blocked_by([](const Frame& f) { return f.data[0] == 0x70; }, begins_with(0x40))},
      {"download-written-at-initiate", {}, writes_at_initiate()},
      {"blocked-by-open-block-upload", {}, blocked_by(begins_with(0xA3), begins_with(0x40))},
      {"blocked-by-open-block-download", {}, blocked_by(begins_with(0x02), begins_with(0x80))},
      {"blocked-by-order",
       {},
       blocked_by(begins_with(0xE0), [](const Frame& f) { return f.data[0] != 0x40 && f.data[0] != 0x80; })},
  };
}

}  // namespace edsc::conform
