// expect: is_not_an_emergency_error_code
// 0081h is 8100h with swapped bytes; it is not an emergency error code (CiA 301, 7.2.7).
#include <canopen/node.hpp>
#include <every_type/device.hpp>

#include "support/omitting.hpp"

namespace od = every_type::od;

struct Bus {
  bool send(const canopen::Frame&) { return true; }
};

void use(bench::NodeOf<every_type::Device, Bus>& node) {
#ifdef GOOD
  node.emergency(0x8100, canopen::ErrorRegister::communication);
#else
  node.emergency(0x0081, canopen::ErrorRegister::communication);
#endif
}
