#include "networks/four_modules_bench.hpp"
#include "plant_log.hpp"

int main(int argc, char** argv) {
  return plant_log::run<plant_bench::Modules>(
      argc, argv, 4, 1009, [](plant_bench::Modules& bench, unsigned long second) {
        bench.digital_inputs.node().set(can_2053c::od::read_input_8_bit<2>{},
                                        canopen::raw(static_cast<std::uint8_t>(second)));
        bench.analog_inputs.node().set(can_2017c::od::read_analogue_input_16_bit<1>{},
                                       canopen::raw(static_cast<std::int16_t>(second % 1000)));
      });
}
