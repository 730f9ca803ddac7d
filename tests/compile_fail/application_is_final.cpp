// expect: application: the class is final .*Application
// The node derives from an application to find its functions.
#include <canopen/node.hpp>
#include <every_type/device.hpp>

#include "support/omitting.hpp"

namespace od = every_type::od;

struct Bus {
  bool send(const canopen::Frame&) { return true; }
};

#ifdef GOOD
#define FINAL
#else
#define FINAL final
#endif

struct Application FINAL {
  void on_state(canopen::NmtState) {}
};

Bus bus;
bench::NodeOf<every_type::Device, Bus, Application> node{bus, canopen::NodeId{5}};
