#include "networks/twelve_axes_bench.hpp"
#include "plant_log.hpp"

int main(int argc, char** argv) {
  return plant_log::run<plant_bench::Axes>(argc, argv, 12, 100'003, [](plant_bench::Axes& bench, unsigned long second) {
    if (second % 10 == 0) bench.control.move_to(static_cast<std::int32_t>(second), 5'000);
    auto& axis = bench.axes[second % bench.axes.size()].node();
    axis.set(ezd_1136::od::position_actual_value{}, canopen::raw(static_cast<std::int32_t>(second)));
    if (second % 900 == 450)
      bench.axes[4].node().emergency(canopen::EmergencyCode{0x4310}, canopen::ErrorRegister{0x08});
    if (second % 900 == 460) bench.axes[4].node().emergency_over(canopen::ErrorRegister{0x08});
  });
}
