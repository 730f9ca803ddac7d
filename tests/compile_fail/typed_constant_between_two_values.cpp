// expect: this constant is between two values .*od::setpoint .*'2', '1', '\.', '5', '_', 'd', 'e', 'g', 'C' .*'2', '1',
// '\.', '6', '_', 'd', 'e', 'g', 'C' The scale is 0.1 °C: the message has the nearest values.
#include <canopen/node.hpp>
#include <canopen/sdo/remote_node.hpp>

#include <typed_drive/device.hpp>
#include "support/omitting.hpp"

namespace od = typed_drive::od;
using namespace canopen::literals;

struct Bus {
  bool send(const canopen::Frame&) { return true; }
};

void use([[maybe_unused]] bench::NodeOf<typed_drive::Device, Bus>& node,
         [[maybe_unused]] canopen::RemoteNode<typed_drive::Device, Bus>& remote,
         [[maybe_unused]] canopen::TimePoint now) {
#ifdef GOOD
  node.set(od::setpoint{}, 21.5_degC);
#else
  node.set(od::setpoint{}, 21.55_degC);
#endif
}
