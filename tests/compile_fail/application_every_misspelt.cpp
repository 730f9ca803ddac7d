// expect: does not call a function of this name.* every .*Evry
// A periodic function with a name that the node does not call.
#include <canopen/node.hpp>
#include <every_type/device.hpp>

#include "support/omitting.hpp"

struct Bus {
  bool send(const canopen::Frame&) { return true; }
};

struct Application {
#ifdef GOOD
  void every(canopen::Milliseconds<10>) {}
  void every(canopen::Milliseconds<20>) {}
#else
  void every(canopen::Milliseconds<10>) {}
  void evry(canopen::Milliseconds<20>) {}
#endif
};

Bus bus;
bench::NodeOf<every_type::Device, Bus, Application> node{bus, canopen::NodeId{5}};
