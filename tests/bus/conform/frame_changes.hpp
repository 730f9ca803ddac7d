/// Frames by kind, and changes of them, from which the tables of mutants are made.
#pragma once

#include <canopen/base/abort_code.hpp>
#include <canopen/can/cob_id.hpp>
#include <canopen/nmt/nmt.hpp>
#include <cstddef>
#include <cstdint>
#include <cstring>
#include <initializer_list>

#include "mutant.hpp"

namespace edsc::conform::control_mutant {

using canopen::AbortCode;
using canopen::Frame;
using canopen::NmtCommand;

inline constexpr std::uint32_t node = Wire::node_id;
inline constexpr std::uint32_t sync_id = 0x80, emcy_id = 0x80 + node, tpdo_id = 0x180 + node,
                               error_control_id = 0x700 + node;
inline constexpr std::uint32_t sdo_answer_id = 0x580 + node, sdo_request_id = 0x600 + node;

inline Frame make(std::uint32_t id, std::initializer_list<std::uint8_t> bytes) {
  Frame frame;
  frame.id = id;
  for (const std::uint8_t byte : bytes) frame.data[frame.size++] = byte;
  return frame;
}

inline std::uint32_t word_at(const Frame& frame, std::size_t first) {
  std::uint32_t word = 0;
  std::memcpy(&word, &frame.data[first], sizeof word);
  return word;
}

inline void put_word(Frame& frame, std::size_t first, std::uint32_t word) {
  std::memcpy(&frame.data[first], &word, sizeof word);
}

inline bool is_data(const Frame& frame, std::uint32_t id) { return frame.id == id && !frame.remote && !frame.extended; }
inline bool is_heartbeat(const Frame& frame) { return is_data(frame, error_control_id) && frame.data[0] != 0; }
inline bool is_boot_up(const Frame& frame) { return is_data(frame, error_control_id) && frame.data[0] == 0; }

inline bool is_nmt(const Frame& frame, NmtCommand command) {
  return is_data(frame, 0) && frame.data[0] == static_cast<std::uint8_t>(command);
}

inline constexpr int any_sub_index = -1;

/// Returns whether an SDO frame is for this entry.
inline bool names(const Frame& frame, std::uint32_t id, std::uint16_t index, int sub_index) {
  if (!is_data(frame, id) || (frame.data[1] | frame.data[2] << 8) != index) return false;
  return sub_index == any_sub_index || frame.data[3] == sub_index;
}

inline bool is_abort(const Frame& frame, std::uint16_t index, AbortCode code) {
  return names(frame, sdo_answer_id, index, any_sub_index) && frame.data[0] == 0x80 &&
         word_at(frame, 4) == static_cast<std::uint32_t>(code);
}

/// A rejected download is confirmed.
inline Change takes(std::uint16_t index, AbortCode refused) {
  return [=](Wire&, Frame& frame) {
    if (!is_abort(frame, index, refused)) return;
    frame.data[0] = 0x60;
    put_word(frame, 4, 0);
  };
}

template <class Predicate>
Change drops(Predicate predicate) {
  return [=](Wire& wire, Frame& frame) {
    if (predicate(frame)) wire.drop();
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

}  // namespace edsc::conform::control_mutant
