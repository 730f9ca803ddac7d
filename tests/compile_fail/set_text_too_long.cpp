// expect: longer than the string of the object .*od::visible_string_value
// A literal that is longer than the string of its object.
#include <canopen/node.hpp>
#include <every_type/device.hpp>

#include "support/omitting.hpp"

namespace od = every_type::od;

struct Bus {
  bool send(const canopen::Frame&) { return true; }
};

void use(bench::NodeOf<every_type::Device, Bus>& node) {
#ifdef GOOD
  node.set(od::visible_string_value{}, "abcde");
#else
  node.set(od::visible_string_value{}, "abcdef");
#endif
}
