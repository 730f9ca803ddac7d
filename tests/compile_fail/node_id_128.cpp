// expect: node_id_is_not_1_to_127
// A node-ID is 1..127 (CiA 301, 7.2.2); 128 is not a node-ID.
#include <canopen/node.hpp>
#include <every_type/device.hpp>

#include "support/omitting.hpp"

namespace od = every_type::od;

struct Bus {
  bool send(const canopen::Frame&) { return true; }
};

auto make(Bus& bus) {
#ifdef GOOD
  return bench::make_node<every_type::Device>(bus, canopen::NodeId{127});
#else
  return bench::make_node<every_type::Device>(bus, canopen::NodeId{128});
#endif
}
