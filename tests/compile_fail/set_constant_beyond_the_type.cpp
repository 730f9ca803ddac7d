// expect: constant_is_above_the_high_limit .*every_type::od::access_rw
// 70,000 does not fit into 16 bits.
#include <canopen/node.hpp>
#include <every_type/device.hpp>

#include "support/omitting.hpp"

namespace od = every_type::od;

struct Bus {
  bool send(const canopen::Frame&) { return true; }
};

void set(bench::NodeOf<every_type::Device, Bus>& node) {
#ifdef GOOD
  node.set(od::access_rw{}, 0xFFFF);
#else
  node.set(od::access_rw{}, 70'000);
#endif
}
