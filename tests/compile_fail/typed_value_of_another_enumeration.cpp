// expect: a value of another object .*od::modes_of_operation .*heater_state
// An enumerator of another object is not a value of this one.
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
  node.set(od::modes_of_operation{}, od::modes_of_operation::value::homing);
#else
  node.set(od::modes_of_operation{}, od::heater_state::value::off);
#endif
}
