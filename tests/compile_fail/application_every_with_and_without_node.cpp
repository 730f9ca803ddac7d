// expect: second function every of this period can never be called .*Microseconds<10000
// Two functions of one period, with the node and without it.
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
  void every(canopen::Milliseconds<10>) {}
#endif
};

Bus bus;
bench::NodeOf<every_type::Device, Bus, Application> node{bus, canopen::NodeId{5}};
