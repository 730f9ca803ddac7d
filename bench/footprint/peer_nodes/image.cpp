/// A complete node of another stack as in firmware, with the mailboxes and the registers of node.cpp.
#include "../../cortex_m/startup.hpp"
#include "../mailbox_bus.hpp"

#include <cstdint>
#include <node.hpp>

namespace {

PeerNode node;

volatile std::uint32_t& word_at(std::uintptr_t address) { return *reinterpret_cast<volatile std::uint32_t*>(address); }

}  // namespace

volatile std::uint32_t& PeerNode::ramp() { return word_at(0x4001'0000); }

bool transmit(std::uint32_t id, std::uint32_t size, const std::uint32_t (&words)[2]) {
  return MailboxBus::send(canopen::make_frame(id, static_cast<std::uint8_t>(size), {words[0], words[1]}));
}

void program() {
  constexpr std::uintptr_t timer = 0x4000'0024;
  constexpr std::uintptr_t fault = 0x4001'0004;
  for (;;) {
    if (!node.start()) continue;
    std::uint32_t last = word_at(timer);
    for (bool is_reset = false; !is_reset;) {
      if (MailboxBus::has_frame()) {
        const canopen::Frame frame = MailboxBus::receive();
        const canopen::FrameWords words = canopen::words_of(frame);
        node.receive(frame.id, frame.size, words.first, words.second);
      }
      node.check(word_at(fault) != 0);
      const std::uint32_t now = word_at(timer);
      is_reset = node.process(now - last);
      last = now;
    }
  }
}
