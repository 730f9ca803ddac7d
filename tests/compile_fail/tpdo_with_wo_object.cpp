// expect: a TPDO may not carry this object
// expect: TpdoEntry<canopen::EntryNumber<1>, canopen::ObjectAt<'2', '6', '0', '1', 'h', ':', '0', '0'>
// expect: every_type::od::access_wo
//
// A TPDO cannot send an object that is not readable over the bus.
#include <canopen/pdo/pdo.hpp>
#include <every_type/device.hpp>

namespace od = every_type::od;

#ifdef GOOD
using Mapping = canopen::Tpdo<od::access_ro>;
#else
using Mapping = canopen::Tpdo<od::access_wo>;
#endif

static_assert(Mapping::entries == 1);
