// expect: the object has two of them .*every_type::od::integer16_value
// With two write handlers, one may refuse a value that the other has already used.
#include <canopen/node.hpp>
#include <every_type/device.hpp>

#include "support/omitting.hpp"

namespace od = every_type::od;

struct Bus {
  bool send(const canopen::Frame&) { return true; }
};

auto make(Bus& bus) {
#ifdef GOOD
  using second = od::integer32_value;
#else
  using second = od::integer16_value;
#endif
  return bench::make_node<every_type::Device>(bus, canopen::NodeId{5},
                                              canopen::on_write<od::integer16_value>([](std::int16_t) {}),
                                              canopen::on_write<second>([](std::int32_t) {}));
}
