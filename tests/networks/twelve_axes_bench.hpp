/// The plant of examples/networks/twelve_axes.json.
#pragma once

#include <cstdint>
#include <deque>

#include "networks/twelve_axes_control.hpp"
#include "plant_bench.hpp"

namespace plant_bench {

struct Axes : PlantBench<TwelveAxes> {
  Axes() : PlantBench{1'000'000} {
    for (std::uint8_t i = 1; i <= 12; ++i) axes.emplace_back(bus, i);
  }

  auto& plant() { return control.plant; }
  auto& node(std::size_t number) { return axes[number - 1].node(); }

  std::deque<LiveNode<ezd_1136::Device>> axes;
};

}  // namespace plant_bench
