/// The master of eight_devices.json: the outputs follow the inputs, and two analogue outputs show the sensor and the
/// axis.
#pragma once

#include <algorithm>
#include <canopen_plant/plant.hpp>
#include <cstdint>
#include <eight_devices.hpp>

template <canopen::Bus B>
class EightDevices {
 public:
  explicit EightDevices(B& bus) : plant{bus} {
    namespace signals = eight_devices::signals;
    plant.on(signals::digital_inputs::read_input_8_bit_1{},
             [this](auto levels) { plant.digital_outputs.write_output_8_bit_1(canopen::raw(levels.raw())); });
    plant.on(signals::digital_inputs::read_input_8_bit_2{},
             [this](auto levels) { plant.digital_outputs.write_output_8_bit_2(canopen::raw(levels.raw())); });
    plant.on(signals::analog_inputs::read_analogue_input_16_bit_1{},
             [this](auto level) { plant.analog_outputs.write_analogue_output_16_bit_1(level); });
    plant.on(signals::sensor::speed_value_1{},
             [this](auto speed) { plant.analog_outputs.write_analogue_output_16_bit_2(canopen::raw(speed.raw())); });
    plant.on(signals::axis::position_actual_value{}, [this](auto position) {
      plant.analog_outputs.write_analogue_output_16_bit_3(canopen::raw(level_of(canopen::to_raw(position))));
    });
  }

  canopen::Plant<eight_devices::Network, B> plant;

 private:
  /// The full scale of the output is 32,767 increments.
  [[nodiscard]] static std::int16_t level_of(std::int32_t position) {
    return static_cast<std::int16_t>(std::clamp(position, -32'768, 32'767));
  }
};
