// expect: nodiscard .*od::integer8_value
// The result of set must be used for an object with limits, which can refuse a value.
#include <canopen/node.hpp>
#include <every_type/device.hpp>

#include "support/omitting.hpp"

#ifdef __clang__
#pragma clang diagnostic error "-Wunused-result"
#endif

namespace od = every_type::od;

struct Bus {
  bool send(const canopen::Frame&) { return true; }
};

void set(bench::NodeOf<every_type::Device, Bus>& node, std::int8_t value) {
#ifdef GOOD
  node.set<od::boolean_value>(true);
  node.set<od::integer8_value>(100);
  if (node.set<od::integer8_value>(value) != canopen::ok) return;
#else
  node.set<od::integer8_value>(value);
#endif
}
