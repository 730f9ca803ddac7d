// expect: first parameter of every is a period .*PeriodicFunctions<Application
// A periodic function for each period: the node does not know which ones.
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
  void every(auto, auto&) {}
#endif
};

Bus bus;
bench::NodeOf<every_type::Device, Bus, Application> node{bus, canopen::NodeId{5}};
