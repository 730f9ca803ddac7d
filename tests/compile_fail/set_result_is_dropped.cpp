// expect: nodiscard .*od::integer8_value
// A value that an object with limits can refuse is not dropped silently. Any value fits one without.
#include <canopen/node.hpp>
#include <every_type/device.hpp>

#ifdef __clang__
#pragma clang diagnostic error "-Wunused-result"
#endif

namespace od = every_type::od;

struct Bus {
  bool send(const canopen::Frame&) { return true; }
};

void set(canopen::Node<every_type::Device, Bus>& node) {
#ifdef GOOD
  node.set<od::boolean_value>(true);
  if (node.set<od::integer8_value>(100) != canopen::ok) return;
#else
  node.set<od::integer8_value>(101);
#endif
}
