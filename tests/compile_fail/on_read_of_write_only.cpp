// expect: the object is wo .*every_type::od::access_wo
// An object of access type wo cannot be read over the bus.
#include <canopen/node.hpp>
#include <every_type/device.hpp>

#include "support/omitting.hpp"

namespace od = every_type::od;

struct Bus {
  bool send(const canopen::Frame&) { return true; }
};

auto make(Bus& bus) {
#ifdef GOOD
  using object = od::unsigned16_value;
#else
  using object = od::access_wo;
#endif
  return bench::make_node<every_type::Device>(bus, canopen::NodeId{5}, canopen::on_read<object>([] {}));
}
