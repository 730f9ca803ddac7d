// expect: the device has no communication parameter for it .*canopen::RpdoNumber<2>
// The device has one RPDO.
#include <canopen/pdo/pdo_check.hpp>
#include <every_type/device.hpp>

namespace od = every_type::od;

#ifdef GOOD
using Checked = canopen::CheckedRpdo<every_type::dictionary, 1, every_type::Rpdo1>;
#else
using Checked = canopen::CheckedRpdo<every_type::dictionary, 2, every_type::Rpdo1>;
#endif

static_assert(Checked::holds);
