// expect: the object is ro or const .*every_type::od::integer24_constant
// A master cannot write an object that can only be read over the bus.
#include <canopen/sdo/remote_node.hpp>
#include <every_type/device.hpp>

namespace od = every_type::od;

struct Bus {
  bool send(const canopen::Frame&) { return true; }
};

bool write(canopen::RemoteNode<every_type::Device, Bus>& remote, canopen::TimePoint now) {
#ifdef GOOD
  return static_cast<bool>(remote.write<od::integer24_value>(1, now));
#else
  return static_cast<bool>(remote.write<od::integer24_constant>(1, now));
#endif
}
