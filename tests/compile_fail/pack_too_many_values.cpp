// expect: candidate expects 3 arguments, 4 provided|requires 3 arguments, but 4 were provided
// TPDO 1 maps three objects.
#include <canopen/od/object_store.hpp>
#include <every_type/device.hpp>

namespace od = every_type::od;

#ifdef GOOD
constexpr auto data = every_type::Tpdo1::pack(1, true, 2);
#else
constexpr auto data = every_type::Tpdo1::pack(1, true, 2, 3);
#endif

static_assert(data[0] == 1);
