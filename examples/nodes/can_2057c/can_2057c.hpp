/// A digital output module, 16 channels in two blocks.
#pragma once

#include <can_2057c/device.hpp>
#include <canopen/can/frame.hpp>
#include <canopen/can/node_id.hpp>

#include "shared/description.hpp"
#include "shared/io_module.hpp"

template <canopen::Bus B>
class Can2057c : public nodes::IoModule<can_2057c::Device, B> {
 public:
  static constexpr nodes::Description description{
      "can_2057c", "A digital output module, 16 channels in two blocks.", "1",
      "  switches TENS UNITS              the node-ID from the next power-on: switches 3 2\n"
      "  fault NAME | fault over          can-controller, eeprom, rx-buffer or tx-buffer: its EMCY\n",
      99};  // two rotary switches

  Can2057c(B& bus, nodes::Surroundings& around)
      : nodes::IoModule<can_2057c::Device, B>{bus, around, canopen::NodeId{1}} {}
};
