// expect: does not call a function of this name.* every .*Tick
// The function that was called each millisecond.
#include <canopen/node.hpp>
#include <every_type/device.hpp>

#include "support/omitting.hpp"

struct Bus {
  bool send(const canopen::Frame&) { return true; }
};

struct Application {
#ifdef GOOD
  void every(canopen::Milliseconds<1>, auto&) {}
#else
  void tick(auto&, canopen::TimePoint) {}
#endif
};

Bus bus;
bench::NodeOf<every_type::Device, Bus, Application> node{bus, canopen::NodeId{5}};
