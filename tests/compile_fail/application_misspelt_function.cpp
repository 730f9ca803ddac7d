// expect: does not call a function of this name .*Writen
// A function that the node does not call.
#include <canopen/node.hpp>
#include <every_type/device.hpp>

#include "support/omitting.hpp"

namespace od = every_type::od;

struct Bus {
  bool send(const canopen::Frame&) { return true; }
};

struct Application {
#ifdef GOOD
  void written(od::unsigned16_value, std::uint16_t) {}
  void on_state(canopen::NmtState) {}
#else
  void writen(od::unsigned16_value, std::uint16_t) {}
  void on_state(canopen::NmtState) {}
#endif
};

Bus bus;
bench::NodeOf<every_type::Device, Bus, Application> node{bus, canopen::NodeId{5}};
