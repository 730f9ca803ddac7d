// expect: no entry of the TPDO begins
// expect: CompatibleEntry<canopen::EntryNumber<3>, canopen::ObjectAt<'2', '0', '0', '1', 'h', ':', '0', '0'>
// expect: every_type::od::boolean_value
// expect: canopen::ObjectAt<'0', '0', '0', '0', 'h', ':', '0', '0'>, canopen::pdo_detail::NoObject
//
// Bit 16 is a BOOLEAN, the INTEGER24 begins at bit 17.
#include <canopen/pdo/pdo_compatible.hpp>
#include <every_type/device.hpp>

namespace od = every_type::od;

#ifdef GOOD
using Consumer = canopen::Rpdo<canopen::Dummy<0x0006, 16>, od::boolean_value, od::integer24_value>;
#else
using Consumer = canopen::Rpdo<canopen::Dummy<0x0006, 16>, canopen::Dummy<0x0005, 8>, od::boolean_value>;
#endif

static_assert(canopen::CompatiblePdos<every_type::Tpdo1, Consumer>::hold);
