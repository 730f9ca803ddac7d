/// The plant of examples/networks/four_modules.json.
#pragma once

#include "networks/four_modules_control.hpp"
#include "plant_bench.hpp"

namespace plant_bench {

struct Modules : PlantBench<FourModules> {
  Modules() : PlantBench{125'000} {}

  auto& plant() { return control.plant; }

  LiveNode<can_2057c::Device> digital_outputs{bus, 1};
  LiveNode<can_2053c::Device> digital_inputs{bus, 2};
  LiveNode<can_2024c::Device> analog_outputs{bus, 3};
  LiveNode<can_2017c::Device> analog_inputs{bus, 4};
};

}  // namespace plant_bench
