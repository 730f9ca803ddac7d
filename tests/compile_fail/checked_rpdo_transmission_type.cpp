// expect: its transmission type is reserved .*canopen::RpdoNumber<1>.*false, 253, 0, 0, false, false}
// A remote frame cannot request an RPDO.
#include <canopen/pdo/pdo_check.hpp>
#include <every_type/device.hpp>

namespace od = every_type::od;

#ifdef GOOD
using Checked = canopen::CheckedRpdo<every_type::dictionary, 1, every_type::Rpdo1,
                                     canopen::PdoParameters{.transmission_type = 254}>;
#else
using Checked = canopen::CheckedRpdo<every_type::dictionary, 1, every_type::Rpdo1,
                                     canopen::PdoParameters{.transmission_type = 253}>;
#endif

static_assert(Checked::holds);
