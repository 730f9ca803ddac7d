/// Only the values of a device and the search by index and sub-index.
#include "../cortex_m/startup.hpp"

#include <canopen/od/object_store.hpp>
#include <cstdint>
#include <device/device.hpp>

namespace {

volatile std::uint32_t asked;
volatile std::uint32_t found;
constinit canopen::ObjectStore<device::Device> store;

}  // namespace

void program() {
  store.reset_application(canopen::NodeId{5});
  store.reset_communication(canopen::NodeId{5});
  for (;;) {
    const std::uint32_t number = asked;
    found = store.entries().find(static_cast<std::uint16_t>(number >> 8), static_cast<std::uint8_t>(number));
  }
}
