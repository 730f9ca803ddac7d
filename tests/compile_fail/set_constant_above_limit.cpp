// expect: constant_is_above_the_high_limit .*every_type::od::integer8_value
// The compiler checks a constant against the limits of the EDS.
#include <canopen/node.hpp>
#include <every_type/device.hpp>

#include "support/omitting.hpp"

namespace od = every_type::od;

struct Bus {
  bool send(const canopen::Frame&) { return true; }
};

void set(bench::NodeOf<every_type::Device, Bus>& node) {
#ifdef GOOD
  node.set(od::integer8_value{}, 100);
#else
  node.set(od::integer8_value{}, 101);
#endif
}
