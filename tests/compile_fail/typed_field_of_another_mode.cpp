// expect: profile_position_fields.* has no member named .speed.|no member named 'speed' in .*profile_position_fields
// A bit of another mode of operation.
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
  if (node.get(od::statusword{}).profile_velocity().speed()) return;
#else
  if (node.get(od::statusword{}).profile_position().speed()) return;
#endif
}
