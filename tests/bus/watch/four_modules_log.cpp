#include "networks/four_modules_control.hpp"
#include "plant_log.hpp"

namespace {

struct Modules : plant_bench::PlantBench<FourModules> {
  Modules() : PlantBench{125'000} {}

  plant_bench::LiveNode<can_2057c::Device> digital_outputs{bus, 1};
  plant_bench::LiveNode<can_2053c::Device> digital_inputs{bus, 2};
  plant_bench::LiveNode<can_2024c::Device> analog_outputs{bus, 3};
  plant_bench::LiveNode<can_2017c::Device> analog_inputs{bus, 4};
};

}  // namespace

int main(int argc, char** argv) {
  return plant_log::run<Modules>(argc, argv, 4, 1009, [](Modules& bench, unsigned long second) {
    bench.digital_inputs.node().set(can_2053c::od::read_input_8_bit<2>{},
                                    canopen::raw(static_cast<std::uint8_t>(second)));
    bench.analog_inputs.node().set(can_2017c::od::read_analogue_input_16_bit<1>{},
                                   canopen::raw(static_cast<std::int16_t>(second % 1000)));
  });
}
