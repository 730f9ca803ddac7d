// expect: its transmission type is reserved .*canopen::TpdoNumber<1>.*false, 241, 0, 0, false, false}
// 241 to 251 are reserved.
#include <canopen/pdo/pdo_check.hpp>
#include <every_type/device.hpp>

namespace od = every_type::od;

#ifdef GOOD
using Checked = canopen::CheckedTpdo<every_type::dictionary, 1, every_type::Tpdo1,
                                     canopen::PdoParameters{.transmission_type = 240}>;
#else
using Checked = canopen::CheckedTpdo<every_type::dictionary, 1, every_type::Tpdo1,
                                     canopen::PdoParameters{.transmission_type = 241}>;
#endif

static_assert(Checked::holds);
