// expect: parameters are not those of its object or event .*PeriodicHandler
// A periodic handler with a parameter that it never gets.
#include <canopen/node.hpp>
#include <every_type/device.hpp>

#include "support/omitting.hpp"

struct Bus {
  bool send(const canopen::Frame&) { return true; }
};

Bus bus;
#ifdef GOOD
auto node = bench::make_node<every_type::Device>(bus, canopen::NodeId{5},
                                                 canopen::every<canopen::Milliseconds<10>>([](auto&) {}));
#else
auto node = bench::make_node<every_type::Device>(bus, canopen::NodeId{5},
                                                 canopen::every<canopen::Milliseconds<10>>([](int) {}));
#endif
