// expect: longer than the string can be .*FixedString<mapped_strings::od::state
// The string has at most five bytes.
#include <canopen/pdo/pdo_check.hpp>
#include <mapped_strings/device.hpp>

namespace od = mapped_strings::od;

#ifdef GOOD
using Mapping = canopen::Tpdo<canopen::FixedString<od::state, 5>>;
#else
using Mapping = canopen::Tpdo<canopen::FixedString<od::state, 6>>;
#endif

static_assert(Mapping::entries == 1);
