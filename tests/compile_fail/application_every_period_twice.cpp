// expect: every\(canopen::Seconds<1>.* cannot be overloaded|class member cannot be redeclared .*every
// Two functions of one period.
#include <canopen/node.hpp>
#include <every_type/device.hpp>

#include "support/omitting.hpp"

struct Bus {
  bool send(const canopen::Frame&) { return true; }
};

struct Application {
#ifdef GOOD
  void every(canopen::Milliseconds<1000>) {}
#else
  void every(canopen::Milliseconds<1000>) {}
  void every(canopen::Seconds<1>) {}
#endif
};

Bus bus;
bench::NodeOf<every_type::Device, Bus, Application> node{bus, canopen::NodeId{5}};
