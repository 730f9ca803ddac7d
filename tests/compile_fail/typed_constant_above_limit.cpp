// expect: this constant is above the highest value .*od::setpoint .*'9', '0', '_', 'd', 'e', 'g', 'C'
// The high limit is 90 °C.
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
  node.set(od::setpoint{}, 90_degC);
#else
  node.set(od::setpoint{}, 95_degC);
#endif
}
