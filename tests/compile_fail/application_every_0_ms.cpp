// expect: PeriodFrom1UsTo30Minutes
// expect: every\(canopen::Milliseconds<0>
// A period of 0.
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
  void every(canopen::Milliseconds<0>, auto&) {}
#endif
};

Bus bus;
bench::NodeOf<every_type::Device, Bus, Application> node{bus, canopen::NodeId{5}};
