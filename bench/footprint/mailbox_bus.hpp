/// A bus as a user has it: a class in a header, for a CAN controller with one mailbox for each direction.
#pragma once

#include <canopen/can/frame.hpp>
#include <cstdint>

/// Registers of a mailbox.
struct Mailbox {
  volatile std::uint32_t status;  ///< 1: transmit mailbox full, 2: receive mailbox full
  volatile std::uint32_t id;
  volatile std::uint32_t size;
  volatile std::uint32_t data[2];
};

class MailboxBus {
 public:
  /// Returns false if the mailbox is full.
  static bool send(const canopen::Frame& frame) {
    Mailbox& box = mailbox(0);
    if ((box.status & 1) != 0) return false;
    const canopen::FrameWords words = canopen::words_of(frame);
    box.id = frame.id;
    box.data[0] = words.first;
    box.data[1] = words.second;
    box.size = frame.size;
    return true;
  }
  static bool has_frame() { return (mailbox(1).status & 2) != 0; }
  /// Returns the frame in the receive mailbox.
  static canopen::Frame receive() {
    Mailbox& box = mailbox(1);
    return canopen::make_frame(box.id, static_cast<std::uint8_t>(box.size), {box.data[0], box.data[1]});
  }

 private:
  static Mailbox& mailbox(std::uint32_t number) { return reinterpret_cast<Mailbox*>(0x4000'6400)[number]; }
};
