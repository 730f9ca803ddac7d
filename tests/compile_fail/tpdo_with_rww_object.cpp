// expect: a TPDO may not carry this object: its access is wo
// expect: TpdoEntry<canopen::EntryNumber<2>, canopen::ObjectAt<'2', '6', '0', '3', 'h', ':', '0', '0'>
// expect: every_type::od::access_rww
//
// Only an RPDO can map a process output (rww).
#include <canopen/od/object_store.hpp>
#include <every_type/device.hpp>

namespace od = every_type::od;

#ifdef GOOD
using Mapping = canopen::Tpdo<od::access_ro, od::access_rwr, od::access_rw>;
#else
using Mapping = canopen::Tpdo<od::access_ro, od::access_rww, od::access_rw>;
#endif

static_assert(Mapping::entries == 3);
