/// A mixer with four valves and two zones: arrays and a string.
#pragma once

#include <array>
#include <canopen/node.hpp>
#include <cstdint>
#include <mixer/device.hpp>

namespace od = mixer::od;

struct Mixer {
  /// One function for all valves.
  template <std::uint8_t I>
  void written(od::valve<I>, std::uint8_t percent) {
    opening[I] = percent;
  }

  /// Temperatures are measured when a TPDO or an upload needs them, in 0.1 °C.
  template <std::uint8_t I>
  std::int16_t read(od::zone_temperature<I>) {
    return static_cast<std::int16_t>(200 + opening[I]);
  }

  /// Only known recipes are accepted.
  canopen::AbortCode write(od::recipe, const od::recipe::type& name) {
    return name.view().starts_with("water") ? canopen::ok : canopen::AbortCode::invalid_value;
  }
  void written(od::recipe, const od::recipe::type&, auto& node) {
    for (std::uint8_t i = 1; i <= 4; ++i) static_cast<void>(node.set(od::valve{}, i, 0));  // sub-index at run time
    opening = {};
  }

  std::array<std::uint8_t, 5> opening{};  ///< percent, by sub-index
};
