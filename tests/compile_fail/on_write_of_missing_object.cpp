// expect: this device does not have the object .*other::od::target_torque
// A handler must be for an object of the device.
#include <canopen/node.hpp>
#include <every_type/device.hpp>

#include "support/omitting.hpp"

namespace od = every_type::od;

struct Bus {
  bool send(const canopen::Frame&) { return true; }
};

namespace other::od {
struct target_torque : canopen::Object<0x6071, 0x00, std::int16_t, canopen::Access::rww, canopen::Mappable::rpdo> {};
}  // namespace other::od

auto make(Bus& bus) {
#ifdef GOOD
  using object = od::integer16_value;
#else
  using object = other::od::target_torque;
#endif
  return bench::make_node<every_type::Device>(bus, canopen::NodeId{5}, canopen::on_write<object>([](std::int16_t) {}));
}
