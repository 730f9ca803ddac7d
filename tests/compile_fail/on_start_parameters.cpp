// expect: parameters are not those of its object or event .*Start
// A handler of power-on with a parameter that it never gets.
#include <canopen/node.hpp>
#include <every_type/device.hpp>

#include "support/omitting.hpp"

struct Bus {
  bool send(const canopen::Frame&) { return true; }
};

Bus bus;
#ifdef GOOD
auto node = bench::make_node<every_type::Device>(bus, canopen::NodeId{5}, canopen::on_start([](auto&) {}));
#else
auto node = bench::make_node<every_type::Device>(bus, canopen::NodeId{5}, canopen::on_start([](canopen::NmtState) {}));
#endif
