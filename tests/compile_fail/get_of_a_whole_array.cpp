// expect: give its sub-index .*every_type::od::integer8_array
// An array has many elements.
#include <canopen/node.hpp>
#include <every_type/device.hpp>

#include "support/omitting.hpp"

namespace od = every_type::od;

struct Bus {
  bool send(const canopen::Frame&) { return true; }
};

auto read(bench::NodeOf<every_type::Device, Bus>& node) {
#ifdef GOOD
  return node.get(od::integer8_array<1>{});
#else
  return node.get(od::integer8_array<>{});
#endif
}
