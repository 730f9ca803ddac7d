// expect: constant_is_below_the_low_limit .*every_type::od::unsigned16_value
// An unsigned object does not have negative values.
#include <canopen/node.hpp>
#include <every_type/device.hpp>

#include "support/omitting.hpp"

namespace od = every_type::od;

struct Bus {
  bool send(const canopen::Frame&) { return true; }
};

void set(bench::NodeOf<every_type::Device, Bus>& node) {
#ifdef GOOD
  node.set(od::unsigned16_value{}, 1);
#else
  node.set(od::unsigned16_value{}, -1);
#endif
}
