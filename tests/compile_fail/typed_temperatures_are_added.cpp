// expect: temperatures are not added: add or subtract a difference .*unit::degree_celsius
// 20 °C and 20 °C are not 40 °C.
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
  if (node.get(od::temperature{}) + 20_K > 40_degC) return;
#else
  if (node.get(od::temperature{}) + 20_degC > 40_degC) return;
#endif
}
