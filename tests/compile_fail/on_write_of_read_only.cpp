// expect: the object is ro or const .*every_type::od::error_register
// An object of access type ro cannot be written over the bus.
#include <canopen/node.hpp>
#include <every_type/device.hpp>

#include "support/omitting.hpp"

namespace od = every_type::od;

struct Bus {
  bool send(const canopen::Frame&) { return true; }
};

auto make(Bus& bus) {
#ifdef GOOD
  using object = od::unsigned8_value;
#else
  using object = od::error_register;
#endif
  return bench::make_node<every_type::Device>(bus, canopen::NodeId{5}, canopen::on_write<object>([](object::type) {}));
}
