#include "networks/eight_devices_bench.hpp"
#include "plant_log.hpp"

int main(int argc, char** argv) {
  return plant_log::run<plant_bench::Devices>(
      argc, argv, 8, 1009, [](plant_bench::Devices& bench, unsigned long second) {
        bench.sensor.node().set(rk5c::od::speed_value<1>{}, canopen::raw(static_cast<std::int16_t>(second % 300)));
        bench.axis.node().set(ezd_1136::od::position_actual_value{}, canopen::raw(static_cast<std::int32_t>(second)));
        bench.digital_inputs.node().set(can_2053c::od::read_input_8_bit<1>{},
                                        canopen::raw(static_cast<std::uint8_t>(second)));
        if (second % 600 == 300)
          bench.drive.node().emergency(canopen::EmergencyCode{0x4210}, canopen::ErrorRegister{0x08});
        if (second % 600 == 310) bench.drive.node().emergency_over(canopen::ErrorRegister{0x08});
      });
}
