// expect: statusword.* has no member named .halt.|no member named 'halt' in .*statusword
// A field of the control word is not one of the status word.
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
  node.modify(od::controlword{}, [](auto& word) { word.halt(true); });
#else
  node.modify(od::statusword{}, [](auto& word) { word.halt(true); });
#endif
}
