// expect: a number without meaning: give the value by its name, with its unit or as canopen::raw .*od::temperature
// A number is not a temperature, unless it is declared as the raw number.
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
  node.set(od::temperature{}, canopen::raw(215));
#else
  node.set(od::temperature{}, 215);
#endif
}
