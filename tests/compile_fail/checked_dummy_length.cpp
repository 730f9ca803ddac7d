// expect: the dummy has another length than its data type
// expect: canopen::RpdoNumber<1>
// expect: canopen::EntryNumber<1>
// expect: ObjectAt<'0', '0', '0', '5', 'h', ':', '0', '0'>
// expect: canopen::Dummy<5, 16>
//
// An UNSIGNED8 has 8 bits.
#include <canopen/pdo/pdo_check.hpp>
#include <every_type/device.hpp>

namespace od = every_type::od;

#ifdef GOOD
using Checked = canopen::CheckedRpdo<every_type::dictionary, 1, canopen::Rpdo<canopen::Dummy<0x0005, 8>>>;
#else
using Checked = canopen::CheckedRpdo<every_type::dictionary, 1, canopen::Rpdo<canopen::Dummy<0x0005, 16>>>;
#endif

static_assert(Checked::holds);
