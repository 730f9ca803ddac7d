// expect: octets .*constant expression|octets .*outside the bounds
// A constant list of octets that is longer than its string.
#include <every_type/device.hpp>

namespace od = every_type::od;

#ifdef GOOD
constexpr od::octet_string_value::type octets{1, 2, 3};
#else
constexpr od::octet_string_value::type octets{1, 2, 3, 4};
#endif
