// expect: the object is ro or const .*every_type::od::integer24_constant
// A constant cannot be written over the bus: its write handler would never be called.
#include <canopen/node.hpp>
#include <every_type/device.hpp>

#include "support/omitting.hpp"

namespace od = every_type::od;

struct Bus {
  bool send(const canopen::Frame&) { return true; }
};

auto make(Bus& bus) {
#ifdef GOOD
  using object = od::integer24_value;
#else
  using object = od::integer24_constant;
#endif
  return bench::make_node<every_type::Device>(bus, canopen::NodeId{5}, canopen::on_write<object>([](std::int32_t) {}));
}
