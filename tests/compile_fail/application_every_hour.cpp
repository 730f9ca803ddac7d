// expect: PeriodFrom1UsTo30Minutes
// expect: every\(canopen::Seconds<3600>
// A period above 30 minutes.
#include <canopen/node.hpp>
#include <every_type/device.hpp>

#include "support/omitting.hpp"

struct Bus {
  bool send(const canopen::Frame&) { return true; }
};

struct Application {
#ifdef GOOD
  void every(canopen::Seconds<1800>) {}
#else
  void every(canopen::Seconds<3600>) {}
#endif
};

Bus bus;
bench::NodeOf<every_type::Device, Bus, Application> node{bus, canopen::NodeId{5}};
