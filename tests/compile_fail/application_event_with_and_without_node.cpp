// expect: second function of this name can never be called .*OnState
// The node calls one of the two.
#include <canopen/node.hpp>
#include <every_type/device.hpp>

#include "support/omitting.hpp"

namespace od = every_type::od;

struct Bus {
  bool send(const canopen::Frame&) { return true; }
};

struct Application {
#ifdef GOOD
  void on_state(canopen::NmtState, auto&) {}
#else
  void on_state(canopen::NmtState) {}
  void on_state(canopen::NmtState, auto&) {}
#endif
};

Bus bus;
bench::NodeOf<every_type::Device, Bus, Application> node{bus, canopen::NodeId{5}};
