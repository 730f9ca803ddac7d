// expect: an RPDO may not carry this object: its access is ro
// expect: RpdoEntry<canopen::EntryNumber<2>, canopen::ObjectAt<'2', '6', '0', '4', 'h', ':', '0', '0'>
// expect: every_type::od::access_rwr
//
// Only a TPDO can map a process input (rwr).
#include <canopen/od/object_store.hpp>
#include <every_type/device.hpp>

namespace od = every_type::od;

#ifdef GOOD
using Mapping = canopen::Rpdo<od::access_wo, od::access_rww>;
#else
using Mapping = canopen::Rpdo<od::access_wo, od::access_rwr>;
#endif

static_assert(Mapping::entries == 2);
