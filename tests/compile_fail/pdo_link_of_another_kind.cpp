// expect: of another kind
// expect: CompatibleEntry<canopen::EntryNumber<1>, canopen::ObjectAt<'2', '0', '0', '3', 'h', ':', '0', '0'>
// expect: every_type::od::integer16_value
// expect: canopen::ObjectAt<'2', '6', '0', '4', 'h', ':', '0', '0'>, every_type::od::access_rwr
//
// The 16 bits are unsigned.
#include <canopen/pdo/pdo_compatible.hpp>
#include <every_type/device.hpp>

namespace od = every_type::od;

#ifdef GOOD
using Consumer = canopen::Rpdo<od::access_rww>;
#else
using Consumer = canopen::Rpdo<od::integer16_value>;
#endif

static_assert(canopen::CompatiblePdos<every_type::Tpdo1, Consumer>::hold);
