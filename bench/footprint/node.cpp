/// A complete node as in firmware: a bus and an application, each a class in a header.
#include "../cortex_m/startup.hpp"
#include "drive.hpp"
#include "mailbox_bus.hpp"

#include <canopen/node.hpp>
#include <cstdint>
#include <device/device.hpp>

namespace {

MailboxBus bus;
constinit canopen::Node<device::Device, MailboxBus, Drive> node{bus};

canopen::TimePoint now() {
  constexpr std::uintptr_t timer = 0x4000'0024;
  return canopen::TimePoint{canopen::Duration{*reinterpret_cast<volatile std::uint32_t*>(timer)}};
}

}  // namespace

void program() {
  node.start(canopen::NodeId{5}, now());
  for (;;) {
    if (MailboxBus::has_frame()) node.on_frame(MailboxBus::receive(), now());
    node.application<Drive>().check(node);
    node.on_time(now());
  }
}
