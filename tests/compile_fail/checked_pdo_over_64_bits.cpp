// expect: longer than its 64 bits
// expect: canopen::TpdoNumber<2>
// expect: PdoEntry<canopen::EntryNumber<2>, canopen::ObjectAt<'2', '6', '0', '0', 'h', ':', '0', '0'>
// expect: every_type::od::access_ro
//
// A CAN frame has at most 64 data bits.
#include <canopen/pdo/pdo_check.hpp>
#include <every_type/device.hpp>

namespace od = every_type::od;

#ifdef GOOD
using Checked = canopen::CheckedTpdo<every_type::dictionary, 2, canopen::Tpdo<od::integer48_value, od::access_ro>>;
#else
using Checked = canopen::CheckedTpdo<every_type::dictionary, 2, canopen::Tpdo<od::integer64_value, od::access_ro>>;
#endif

static_assert(Checked::holds);
