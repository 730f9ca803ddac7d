// expect: an inhibit time is for TPDOs of transmission types 254 and 255
// expect: canopen::TpdoNumber<1>.*false, 1, 100, 0, false, false}
//
// A synchronous TPDO is sent at its SYNC.
#include <canopen/pdo/pdo_check.hpp>
#include <every_type/device.hpp>

namespace od = every_type::od;

#ifdef GOOD
using Checked = canopen::CheckedTpdo<every_type::dictionary, 1, every_type::Tpdo1,
                                     canopen::PdoParameters{.transmission_type = 254, .inhibit_time = 100}>;
#else
using Checked = canopen::CheckedTpdo<every_type::dictionary, 1, every_type::Tpdo1,
                                     canopen::PdoParameters{.transmission_type = 1, .inhibit_time = 100}>;
#endif

static_assert(Checked::holds);
