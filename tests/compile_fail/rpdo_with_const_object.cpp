// expect: an RPDO may not carry this object
// expect: its access is ro, rwr or const
// expect: RpdoEntry<canopen::EntryNumber<1>, canopen::ObjectAt<'2', '0', '0', '1', 'h', ':', '0', '0'>,
// expect: mapped_strings::od::serial_number
//
// A constant cannot be written.
#include <canopen/pdo/pdo.hpp>
#include <mapped_strings/device.hpp>

namespace od = mapped_strings::od;

#ifdef GOOD
using Mapping = canopen::Tpdo<canopen::FixedString<od::serial_number, 4>>;
#else
using Mapping = canopen::Rpdo<canopen::FixedString<od::serial_number, 4>>;
#endif

static_assert(Mapping::entries == 1);
