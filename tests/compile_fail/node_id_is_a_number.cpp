// expect: a node-ID is NodeId{n} .*KnownHandler<int
// A number is neither a node-ID nor a handler.
#include <canopen/node.hpp>
#include <every_type/device.hpp>

#include "support/omitting.hpp"

namespace od = every_type::od;

struct Bus {
  bool send(const canopen::Frame&) { return true; }
};

auto make(Bus& bus) {
#ifdef GOOD
  return bench::make_node<every_type::Device>(bus, canopen::NodeId{5});
#else
  return bench::make_node<every_type::Device>(bus, 5);
#endif
}
