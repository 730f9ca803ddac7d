// expect: not a handler: pass on_write
// A callable alone does not specify its object.
#include <canopen/node.hpp>
#include <every_type/device.hpp>

#include "support/omitting.hpp"

namespace od = every_type::od;

struct Bus {
  bool send(const canopen::Frame&) { return true; }
};

auto make(Bus& bus) {
  const auto changed = [](std::int16_t) {};
#ifdef GOOD
  return bench::make_node<every_type::Device>(bus, canopen::NodeId{5}, canopen::on_write<od::integer16_value>(changed));
#else
  return bench::make_node<every_type::Device>(bus, canopen::NodeId{5}, changed);
#endif
}
