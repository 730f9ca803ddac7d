// expect: not of the type of the object .*every_type::od::unsigned16_value
// A fraction is not a value of an integer.
#include <canopen/node.hpp>
#include <every_type/device.hpp>

#include "support/omitting.hpp"

namespace od = every_type::od;

struct Bus {
  bool send(const canopen::Frame&) { return true; }
};

void set(bench::NodeOf<every_type::Device, Bus>& node) {
#ifdef GOOD
  node.set(od::unsigned16_value{}, 3);
#else
  node.set(od::unsigned16_value{}, 3.5f);
#endif
}
