// expect: does not call a function of this name .*OnStart
// The name of the handler in place of the name of the function.
#include <canopen/node.hpp>
#include <every_type/device.hpp>

#include "support/omitting.hpp"

struct Bus {
  bool send(const canopen::Frame&) { return true; }
};

struct Application {
#ifdef GOOD
  void start(auto&) {}
#else
  void on_start(auto&) {}
  void on_state(canopen::NmtState) {}
#endif
};

Bus bus;
bench::NodeOf<every_type::Device, Bus, Application> node{bus, canopen::NodeId{5}};
