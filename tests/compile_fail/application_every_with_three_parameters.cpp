// expect: the node is the only other one .*PeriodicFunctions<Application
// A third parameter.
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
  void every(canopen::Milliseconds<10>, auto&) {}
  void every(canopen::Milliseconds<20>, auto&, int) {}
#endif
};

Bus bus;
bench::NodeOf<every_type::Device, Bus, Application> node{bus, canopen::NodeId{5}};
