/// A mixer with four valves and two zones: arrays and a string.
#pragma once

#include <canopen/node.hpp>
#include <cstdint>
#include <mixer/device.hpp>

namespace od = mixer::od;
using namespace canopen::literals;

struct Mixer {
  /// One function for all valves: an open valve warms its zone.
  template <std::uint8_t I>
  void written(od::valve<I>, od::valve<1>::type opening, auto& node) {
    od::zone_temperature<1>::type temperature = 20_degC;
    if (opening > 0_percent) temperature = 25_degC;
    const std::uint8_t zone = I <= 2 ? 1 : 2;  // a sub-index at run time
    static_cast<void>(node.set(od::zone_temperature{}, zone, temperature));
  }

  /// Read when a TPDO or an upload needs it.
  od::litres_delivered::type read(od::litres_delivered) { return litres; }

  /// Only known recipes are accepted.
  canopen::AbortCode write(od::recipe, const od::recipe::type& name) {
    return name.view().starts_with("water") ? canopen::ok : canopen::AbortCode::invalid_value;
  }

  od::litres_delivered::type litres{};
};

/// The composition of the device, for its program and its conformance test.
using MixerParts = canopen::Composition<mixer::Device, Mixer>;
