// expect: a constant of the EDS cannot be set .*every_type::od::integer24_constant
// A constant of the EDS is in flash.
#include <canopen/od/object_store.hpp>
#include <every_type/device.hpp>

namespace od = every_type::od;

void set(canopen::ObjectStore<every_type::Device>& store) {
#ifdef GOOD
  store.set<od::integer24_value>(1);
#else
  store.set<od::integer24_constant>(1);
#endif
}
