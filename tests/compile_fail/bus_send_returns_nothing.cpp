// expect: bool send\(const canopen::Frame&\)
// A bus reports whether it has accepted the frame.
#include <canopen/node.hpp>
#include <every_type/device.hpp>

#include "support/omitting.hpp"

struct Bus {
#ifdef GOOD
  bool send(const canopen::Frame&) { return true; }
#else
  void send(const canopen::Frame&) {}
#endif
};

Bus bus;
bench::NodeOf<every_type::Device, Bus> node{bus, canopen::NodeId{5}};
