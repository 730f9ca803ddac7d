/// A generated device without application, for a program that has several of them: one source for each device.
#include "generated_device.hpp"

#include EDSC_DEVICE_HEADER

std::unique_ptr<canopen::SimulatedNode> EDSC_MAKE(canopen::SimulatedBus& bus, canopen::SimulatedMemory& memory) {
  return canopen::make_simulated_node<EDSC_DEVICE>(bus, memory);
}
