// expect: not of the type of the object .*every_type::od::integer24_value
// A master cannot write a fraction to an integer.
#include <canopen/sdo/remote_node.hpp>
#include <every_type/device.hpp>

namespace od = every_type::od;

struct Bus {
  bool send(const canopen::Frame&) { return true; }
};

bool write(canopen::RemoteNode<every_type::Device, Bus>& remote, canopen::TimePoint now) {
#ifdef GOOD
  return static_cast<bool>(remote.write<od::integer24_value>(3, now));
#else
  return static_cast<bool>(remote.write<od::integer24_value>(3.5, now));
#endif
}
