#include <deque>

#include "networks/twelve_axes_control.hpp"
#include "plant_log.hpp"

namespace {

struct Axes : plant_bench::PlantBench<TwelveAxes> {
  Axes() : PlantBench{1'000'000} {
    for (std::uint8_t i = 1; i <= 12; ++i) axes.emplace_back(bus, i);
  }

  std::deque<plant_bench::LiveNode<ezd_1136::Device>> axes;
};

}  // namespace

int main(int argc, char** argv) {
  return plant_log::run<Axes>(argc, argv, 12, 100'003, [](Axes& bench, unsigned long second) {
    if (second % 10 == 0) bench.control.move_to(static_cast<std::int32_t>(second), 5'000);
    auto& axis = bench.axes[second % bench.axes.size()].node();
    axis.set(ezd_1136::od::position_actual_value{}, canopen::raw(static_cast<std::int32_t>(second)));
    if (second % 900 == 450)
      bench.axes[4].node().emergency(canopen::EmergencyCode{0x4310}, canopen::ErrorRegister{0x08});
    if (second % 900 == 460) bench.axes[4].node().emergency_over(canopen::ErrorRegister{0x08});
  });
}
