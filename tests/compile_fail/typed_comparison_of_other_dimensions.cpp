// expect: values of different objects or dimensions are compared .*unit::degree_celsius .*unit::revolution_per_minute
// A temperature is not compared with a speed.
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
  if (node.get(od::temperature{}) > 5_degC) return;
#else
  if (node.get(od::temperature{}) > 5_rpm) return;
#endif
}
