// expect: a TPDO may not carry this object: PDOMapping=0
// expect: TpdoEntry<canopen::EntryNumber<2>, canopen::ObjectAt<'1', '0', '0', '5', 'h', ':', '0', '0'>
// expect: every_type::od::cob_id_sync
//
// The EDS has PDOMapping=0.
#include <canopen/od/object_store.hpp>
#include <every_type/device.hpp>

namespace od = every_type::od;

#ifdef GOOD
using Mapping = canopen::Tpdo<od::access_ro, od::unsigned32_value>;
#else
using Mapping = canopen::Tpdo<od::access_ro, od::cob_id_sync>;
#endif

static_assert(Mapping::entries == 2);
