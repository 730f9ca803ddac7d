// expect: every returns nothing .*Microseconds<10000
// A result that nobody uses.
#include <canopen/node.hpp>
#include <every_type/device.hpp>

#include "support/omitting.hpp"

struct Bus {
  bool send(const canopen::Frame&) { return true; }
};

struct Application {
#ifdef GOOD
  void every(canopen::Milliseconds<10>, auto&) {}
#else
  bool every(canopen::Milliseconds<10>, auto&) { return true; }
#endif
};

Bus bus;
bench::NodeOf<every_type::Device, Bus, Application> node{bus, canopen::NodeId{5}};
