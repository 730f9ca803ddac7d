// expect: a TPDO carries ro, rw, rwr and const objects
// expect: canopen::TpdoNumber<1>
// expect: canopen::EntryNumber<1>
// expect: ObjectAt<'2', '6', '0', '3', 'h', ':', '0', '0'>
// expect: other::od::access_rww
//
// Only an RPDO can map a process output (rww).
#include <canopen/pdo/pdo_check.hpp>
#include <every_type/device.hpp>

namespace od = every_type::od;

namespace other::od {
struct cob_id_sync : canopen::Object<0x1005, 0x00, std::uint32_t, canopen::Access::rw, canopen::Mappable::both> {};
struct access_ro : canopen::Object<0x2600, 0x00, std::uint16_t, canopen::Access::rw, canopen::Mappable::both> {};
struct access_rww : canopen::Object<0x2603, 0x00, std::uint16_t, canopen::Access::rw, canopen::Mappable::both> {};
}  // namespace other::od

#ifdef GOOD
using Checked = canopen::CheckedTpdo<every_type::dictionary, 1, canopen::Tpdo<od::access_rw>>;
#else
using Checked = canopen::CheckedTpdo<every_type::dictionary, 1, canopen::Tpdo<other::od::access_rww>>;
#endif

static_assert(Checked::holds);
