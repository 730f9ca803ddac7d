// expect: outside the limits of the object .*every_type::od::integer8_value
// A master cannot write a constant outside the limits of the EDS.
#include <canopen/sdo/remote_node.hpp>
#include <every_type/device.hpp>

namespace od = every_type::od;

struct Bus {
  bool send(const canopen::Frame&) { return true; }
};

bool write(canopen::RemoteNode<every_type::Device, Bus>& remote, canopen::TimePoint now) {
#ifdef GOOD
  return static_cast<bool>(remote.write<od::integer8_value, 100>(now));
#else
  return static_cast<bool>(remote.write<od::integer8_value, 101>(now));
#endif
}
