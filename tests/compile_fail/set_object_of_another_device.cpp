// expect: this is an object of another device .*other::od::target_torque
// An object of another device that has the index and the type of an object of this one.
#include <canopen/node.hpp>
#include <every_type/device.hpp>

#include "support/omitting.hpp"

namespace od = every_type::od;

struct Bus {
  bool send(const canopen::Frame&) { return true; }
};

namespace other::od {
struct target_torque : canopen::TypedObject<std::uint16_t, canopen::Access::rw> {
  static constexpr std::uint16_t index = every_type::od::access_rw::index;
  static constexpr std::uint8_t sub_index = 0;
  static constexpr auto name = "Target torque";
};
}  // namespace other::od

void use(bench::NodeOf<every_type::Device, Bus>& node) {
#ifdef GOOD
  node.set(od::access_rw{}, 5);
#else
  node.set(other::od::target_torque{}, 5);
#endif
}
