// expect: this device has no such object .*other::od::target_torque
// An object of another device need not exist in this one.
#include <canopen/od/object_store.hpp>
#include <every_type/device.hpp>

namespace od = every_type::od;

namespace other::od {
struct target_torque : canopen::Object<0x6071, 0x00, std::int16_t, canopen::Access::rww, canopen::Mappable::rpdo> {};
}  // namespace other::od

auto get(const canopen::ObjectStore<every_type::Device>& store) {
#ifdef GOOD
  return store.get<od::integer16_value>();
#else
  return store.get<other::od::target_torque>();
#endif
}
