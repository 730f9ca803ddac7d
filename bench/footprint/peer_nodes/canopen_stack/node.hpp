/// A node of canopen-stack with node-ID 5, its drivers, and the application of drive.hpp: a function for one written
/// object, and an error that is reported. A program that includes this file defines `transmit`.
#pragma once

#include <OD.h>
#include <cstdint>

/// Passes a frame to the bus. Returns false if the bus does not accept it now.
bool transmit(std::uint32_t id, std::uint32_t size, const std::uint32_t (&words)[2]);

namespace peer_drivers {

inline CO_IF_FRM* received = nullptr;
inline std::uint32_t ticks_left = 0;  // until the next timer elapses; 0: stopped

inline std::int16_t read(CO_IF_FRM* frame) {
  if (received == nullptr) return 0;
  *frame = *received;
  received = nullptr;
  return sizeof *frame;
}

/// Waits until the bus accepts the frame.
inline std::int16_t send(CO_IF_FRM* frame) {
  std::uint32_t words[2];
  __builtin_memcpy(words, frame->Data, sizeof words);
  while (!transmit(frame->Identifier, frame->DLC, words)) {
  }
  return sizeof *frame;
}

inline std::uint8_t update_timer() { return ticks_left != 0 && --ticks_left == 0 ? 1 : 0; }

inline const CO_IF_CAN_DRV can{[] {}, [](std::uint32_t) {}, read, send, [] {}, [] {}};
inline const CO_IF_TIMER_DRV timer{[](std::uint32_t) {},
                                   [](std::uint32_t ticks) { ticks_left = ticks; },
                                   [] { return ticks_left; },
                                   [] { ticks_left = 0; },
                                   [] {},
                                   update_timer};
inline const CO_IF_NVM_DRV memory{[] {}, [](std::uint32_t, std::uint8_t*, std::uint32_t) -> std::uint32_t { return 0; },
                                  [](std::uint32_t, std::uint8_t*, std::uint32_t) -> std::uint32_t { return 0; }};
inline CO_IF_DRV all{&can, &timer, &memory};

}  // namespace peer_drivers

class CanopenStackPeer {
 public:
  // Words of the messages of the error.
  static constexpr std::uint32_t emergency = 0x0003'2320;
  static constexpr std::uint32_t emergency_over = 0;
  static constexpr std::uint32_t error_in_history = 0x2320;

  /// Starts the node as after a reset. Returns whether canopen-stack accepts the object dictionary.
  bool start() {
    CO_NODE_SPEC specification{node_id,     bit_rate,       const_cast<CO_OBJ*>(OD_list), OD_ENTRIES, errors, timers_,
                               timer_count, tick_frequency, &peer_drivers::all,           transfer_};
    CONodeInit(&node_, &specification);
    if (CONodeGetErr(&node_) != CO_ERR_NONE) return false;
    CONodeStart(&node_);
    return true;
  }

  void receive(std::uint32_t id, std::uint32_t size, std::uint32_t first, std::uint32_t second) {
    const std::uint32_t words[2] = {first, second};
    CO_IF_FRM frame;
    frame.Identifier = id;
    __builtin_memcpy(frame.Data, words, sizeof words);
    frame.DLC = static_cast<std::uint8_t>(size);
    peer_drivers::received = &frame;
    CONodeProcess(&node_);
  }

  /// Does nothing: `receive` has processed the frame.
  void process_pdos(std::uint32_t /*elapsed*/) {}

  /// Processes the rest of a block. Returns whether there is more of it.
  bool process_sdo(std::uint32_t /*elapsed*/) { return false; }

  /// Processes all services. Returns whether the program must start the node again. `elapsed`: us since the last call.
  bool process(std::uint32_t elapsed) {
    constexpr std::uint32_t tick = 1'000'000 / tick_frequency;  // us
    for (unserved_ += elapsed; unserved_ >= tick; unserved_ -= tick) COTmrService(&node_.Tmr);
    CONodeProcess(&node_);
    COTmrProcess(&node_.Tmr);
    return false;
  }

  /// Reports an error while the output stage has one.
  void check(bool is_faulty) {
    if (is_faulty == is_faulty_) return;
    is_faulty_ = is_faulty;
    if (is_faulty) {
      COEmcySet(&node_.Emcy, 0, nullptr);
    } else {
      COEmcyClr(&node_.Emcy, 0);
    }
  }

  static CO_ERR write_acceleration(CO_OBJ* entry, CO_NODE* node, void* bytes, std::uint32_t size) {
    const CO_ERR result = COTInt32.Write(entry, node, bytes, size);
    if (result == CO_ERR_NONE) ramp() = x6083_0;
    return result;
  }

 private:
  static constexpr std::uint8_t node_id = 5;
  static constexpr std::uint32_t bit_rate = 500'000;  // the driver ignores it
  static constexpr std::uint16_t timer_count = 16;
  static constexpr std::uint32_t tick_frequency = 10'000;  // of inhibit times

  /// The errors that the application reports.
  inline static CO_EMCY_TBL errors[] = {{CO_EMCY_REG_CURRENT, 0x2320}};

  /// A register of the output stage.
  static volatile std::uint32_t& ramp();

  CO_NODE node_{};
  CO_TMR_MEM timers_[timer_count]{};
  std::uint8_t transfer_[CO_SSDO_N * CO_SDO_BUF_BYTE]{};
  std::uint32_t unserved_ = 0;  // us
  bool is_faulty_ = false;
};

/// The node of the programs.
using PeerNode = CanopenStackPeer;

inline std::uint32_t size_of_value(CO_OBJ* entry, CO_NODE* node, std::uint32_t width) {
  return COTInt32.Size(entry, node, width);
}
inline CO_ERR read_value(CO_OBJ* entry, CO_NODE* node, void* bytes, std::uint32_t size) {
  return COTInt32.Read(entry, node, bytes, size);
}

extern "C" {
extern const CO_OBJ_TYPE peer_written;
const CO_OBJ_TYPE peer_written{size_of_value, nullptr, read_value, CanopenStackPeer::write_acceleration, nullptr};
}
