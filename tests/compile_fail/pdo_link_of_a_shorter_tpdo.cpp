// expect: the TPDO ends before
// expect: CompatibleEntry<canopen::EntryNumber<2>, canopen::ObjectAt<'2', '6', '0', '2', 'h', ':', '0', '0'>
// expect: every_type::od::access_rw
//
// TPDO 1 has 41 bits.
#include <canopen/pdo/pdo_compatible.hpp>
#include <every_type/device.hpp>

namespace od = every_type::od;

#ifdef GOOD
using Consumer = canopen::Rpdo<canopen::Dummy<0x0018, 40>>;
#else
using Consumer = canopen::Rpdo<canopen::Dummy<0x0018, 40>, od::access_rw>;
#endif

static_assert(canopen::CompatiblePdos<every_type::Tpdo1, Consumer>::hold);
