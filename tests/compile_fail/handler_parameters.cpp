// expect: parameters are not those of its object or event .*every_type::od::unsigned16_value
// A handler gets (value) or (node, value).
#include <canopen/node.hpp>
#include <every_type/device.hpp>

#include "support/omitting.hpp"

namespace od = every_type::od;

struct Bus {
  bool send(const canopen::Frame&) { return true; }
};

Bus bus;

void start() {
  auto node =
      bench::make_node<every_type::Device>(bus, canopen::NodeId{5},
#ifdef GOOD
                                           canopen::on_write(od::unsigned16_value{}, [](auto&, std::uint16_t) {})
#else
                                           canopen::on_write(od::unsigned16_value{}, [](auto&, std::uint16_t, int) {})
#endif
      );
  node.start(canopen::TimePoint{});
}
