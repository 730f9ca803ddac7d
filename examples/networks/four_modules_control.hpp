/// The master of four_modules.json: the outputs follow the inputs.
#pragma once

#include <canopen_plant/plant.hpp>
#include <cstdint>
#include <four_modules.hpp>

template <canopen::Bus B>
class FourModules {
 public:
  explicit FourModules(B& bus) : plant{bus} {
    namespace digital = four_modules::signals::digital_inputs;
    namespace analog = four_modules::signals::analog_inputs;
    plant.on(digital::read_input_8_bit_1{},
             [this](auto levels) { plant.digital_outputs.write_output_8_bit_1(canopen::raw(levels.raw())); });
    plant.on(digital::read_input_8_bit_2{},
             [this](auto levels) { plant.digital_outputs.write_output_8_bit_2(canopen::raw(levels.raw())); });
    plant.on(analog::read_analogue_input_16_bit_1{},
             [this](auto level) { plant.analog_outputs.write_analogue_output_16_bit_1(level); });
  }

  canopen::Plant<four_modules::Network, B> plant;
};
