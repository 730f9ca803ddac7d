#include "networks/eight_devices_control.hpp"
#include "plant_log.hpp"

namespace {

struct Devices : plant_bench::PlantBench<EightDevices> {
  Devices() : PlantBench{125'000} {}

  plant_bench::LiveNode<can_2057c::Device> digital_outputs{bus, 1};
  plant_bench::LiveNode<can_2053c::Device> digital_inputs{bus, 2};
  plant_bench::LiveNode<can_2024c::Device> analog_outputs{bus, 3};
  plant_bench::LiveNode<can_2017c::Device> analog_inputs{bus, 4};
  plant_bench::LiveNode<cpc_tc1::Device> drive{bus, 5};
  plant_bench::LiveNode<cpd::Device> second_drive{bus, 6};
  plant_bench::LiveNode<ezd_1136::Device> axis{bus, 7};
  plant_bench::LiveNode<rk5c::Device> sensor{bus, 8};
};

}  // namespace

int main(int argc, char** argv) {
  return plant_log::run<Devices>(argc, argv, 8, 1009, [](Devices& bench, unsigned long second) {
    bench.sensor.node().set(rk5c::od::speed_value<1>{}, canopen::raw(static_cast<std::int16_t>(second % 300)));
    bench.axis.node().set(ezd_1136::od::position_actual_value{}, canopen::raw(static_cast<std::int32_t>(second)));
    bench.digital_inputs.node().set(can_2053c::od::read_input_8_bit<1>{},
                                    canopen::raw(static_cast<std::uint8_t>(second)));
    if (second % 600 == 300) bench.drive.node().emergency(canopen::EmergencyCode{0x4210}, canopen::ErrorRegister{0x08});
    if (second % 600 == 310) bench.drive.node().emergency_over(canopen::ErrorRegister{0x08});
  });
}
