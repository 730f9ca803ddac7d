// expect: an event timer is for RPDOs, and for TPDOs of transmission types 254 and 255
// expect: canopen::TpdoNumber<1> .*false, 240, 0, 50, false, false}
// A synchronous TPDO is sent at its SYNC.
#include <canopen/pdo/pdo_check.hpp>
#include <every_type/device.hpp>

namespace od = every_type::od;

#ifdef GOOD
using Checked = canopen::CheckedTpdo<every_type::dictionary, 1, every_type::Tpdo1,
                                     canopen::PdoParameters{.transmission_type = 255, .event_timer = 50}>;
#else
using Checked = canopen::CheckedTpdo<every_type::dictionary, 1, every_type::Tpdo1,
                                     canopen::PdoParameters{.transmission_type = 240, .event_timer = 50}>;
#endif

static_assert(Checked::holds);
