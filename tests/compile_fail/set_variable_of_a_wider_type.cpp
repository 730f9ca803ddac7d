// expect: is wider than that of the object .*every_type::od::access_rw
// A variable whose values may not fit is not converted.
#include <canopen/node.hpp>
#include <every_type/device.hpp>

#include "support/omitting.hpp"

namespace od = every_type::od;

struct Bus {
  bool send(const canopen::Frame&) { return true; }
};

void set(bench::NodeOf<every_type::Device, Bus>& node, int value) {
#ifdef GOOD
  node.set(od::access_rw{}, static_cast<std::uint16_t>(value));
#else
  node.set(od::access_rw{}, value);
#endif
}
