/// A mixer with four valves and two zones: arrays and a string.
#pragma once

#include <canopen/node.hpp>
#include <cstdint>
#include <mixer/device.hpp>

namespace od = mixer::od;

struct Mixer {
  /// One function for all valves: an open valve warms its zone, in 0.1 °C.
  template <std::uint8_t I>
  void written(od::valve<I>, std::uint8_t percent, auto& node) {
    const std::uint8_t zone = I <= 2 ? 1 : 2;  // a sub-index at run time
    static_cast<void>(node.set(od::zone_temperature{}, zone, static_cast<std::int16_t>(200 + percent)));
  }

  /// Read when a TPDO or an upload needs it.
  std::uint32_t read(od::litres_delivered) { return litres; }

  /// Only known recipes are accepted.
  canopen::AbortCode write(od::recipe, const od::recipe::type& name) {
    return name.view().starts_with("water") ? canopen::ok : canopen::AbortCode::invalid_value;
  }

  std::uint32_t litres = 0;
};

/// The composition of the device, for its program and its conformance test.
using MixerParts = canopen::Composition<mixer::Device, Mixer>;
