// expect: every: the handler returns nothing .*PeriodicHandler
// A result that nobody uses.
#include <canopen/node.hpp>
#include <every_type/device.hpp>

#include "support/omitting.hpp"

struct Bus {
  bool send(const canopen::Frame&) { return true; }
};

Bus bus;
#ifdef GOOD
auto node =
    bench::make_node<every_type::Device>(bus, canopen::NodeId{5}, canopen::every<canopen::Milliseconds<10>>([] {}));
#else
auto node = bench::make_node<every_type::Device>(bus, canopen::NodeId{5},
                                                 canopen::every<canopen::Milliseconds<10>>([] { return 1; }));
#endif
