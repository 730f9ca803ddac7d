/// The generated devices as a program in simulated time; the name of a device is that of its C++ namespace.
#include <canopen_sim/simulated_device.hpp>

#include "generated_device.hpp"

int main(int argc, char** argv) {
#define EDSC_ROW(device) canopen::SimulatedDevice{#device, &make_##device},
  constexpr canopen::SimulatedDevice devices[] = {
#include "generated_device_rows.inc"
  };
#undef EDSC_ROW
  return canopen::simulate_devices(argc, argv, devices);
}
