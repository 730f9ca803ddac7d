// expect: an RPDO may not carry this object: its access is ro
// expect: RpdoEntry<canopen::EntryNumber<2>, canopen::ObjectAt<'2', '6', '0', '0', 'h', ':', '0', '0'>
// expect: every_type::od::access_ro
//
// An RPDO cannot write an object that is not writable over the bus.
#include <canopen/od/object_store.hpp>
#include <every_type/device.hpp>

namespace od = every_type::od;

#ifdef GOOD
using Mapping = canopen::Rpdo<od::access_wo, od::access_rww, od::access_rw>;
#else
using Mapping = canopen::Rpdo<od::access_wo, od::access_ro, od::access_rw>;
#endif

static_assert(Mapping::entries == 3);
