// expect: not a multiple of the device's Granularity
// expect: canopen::TpdoNumber<1>
// expect: canopen::EntryNumber<1>
// expect: ObjectAt<'2', '0', '0', '1', 'h', ':', '0', '0'>
// expect: every_type::od::boolean_value
//
// Granularity 8: whole bytes only.
#include <canopen/pdo/pdo_check.hpp>
#include <every_type/device.hpp>

namespace od = every_type::od;

#ifdef GOOD
using Checked = canopen::CheckedTpdo<every_type::dictionary, 1, canopen::Tpdo<canopen::Padded<od::boolean_value, 8>>,
                                     canopen::PdoParameters{}, 8>;
#else
using Checked =
    canopen::CheckedTpdo<every_type::dictionary, 1, canopen::Tpdo<od::boolean_value>, canopen::PdoParameters{}, 8>;
#endif

static_assert(Checked::holds);
