// expect: od::octet_string_value .*outside the bounds
// A list of octets that is longer than the string of its object.
#include <canopen/node.hpp>
#include <every_type/device.hpp>

#include "support/omitting.hpp"

namespace od = every_type::od;

struct Bus {
  bool send(const canopen::Frame&) { return true; }
};

void use(bench::NodeOf<every_type::Device, Bus>& node) {
#ifdef GOOD
  node.set(od::octet_string_value{}, {1, 2, 3});
#else
  node.set(od::octet_string_value{}, {1, 2, 3, 4});
#endif
}
