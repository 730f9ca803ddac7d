/// The plant of examples/networks/eight_devices.json, with one of each device.
#pragma once

#include "networks/eight_devices_control.hpp"
#include "plant_bench.hpp"

namespace plant_bench {

struct Devices : PlantBench<EightDevices> {
  Devices() : PlantBench{125'000} {}

  auto& plant() { return control.plant; }

  LiveNode<can_2057c::Device> digital_outputs{bus, 1};
  LiveNode<can_2053c::Device> digital_inputs{bus, 2};
  LiveNode<can_2024c::Device> analog_outputs{bus, 3};
  LiveNode<can_2017c::Device> analog_inputs{bus, 4};
  LiveNode<cpc_tc1::Device> drive{bus, 5};
  LiveNode<cpd::Device> second_drive{bus, 6};
  LiveNode<ezd_1136::Device> axis{bus, 7};
  LiveNode<rk5c::Device> sensor{bus, 8};
};

}  // namespace plant_bench
