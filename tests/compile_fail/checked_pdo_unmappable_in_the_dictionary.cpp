// expect: cannot be mapped, its EDS says PDOMapping=0
// expect: canopen::TpdoNumber<2>
// expect: canopen::EntryNumber<1>
// expect: ObjectAt<'1', '0', '0', '5', 'h', ':', '0', '0'>
// expect: other::od::cob_id_sync
//
// The check uses the dictionary, not the object type.
#include <canopen/pdo/pdo_check.hpp>
#include <every_type/device.hpp>

namespace od = every_type::od;

namespace other::od {
struct cob_id_sync : canopen::Object<0x1005, 0x00, std::uint32_t, canopen::Access::rw, canopen::Mappable::both> {};
struct access_ro : canopen::Object<0x2600, 0x00, std::uint16_t, canopen::Access::rw, canopen::Mappable::both> {};
struct access_rww : canopen::Object<0x2603, 0x00, std::uint16_t, canopen::Access::rw, canopen::Mappable::both> {};
}  // namespace other::od

#ifdef GOOD
using Checked = canopen::CheckedTpdo<every_type::dictionary, 2, canopen::Tpdo<od::access_ro>>;
#else
using Checked = canopen::CheckedTpdo<every_type::dictionary, 2, canopen::Tpdo<other::od::cob_id_sync>>;
#endif

static_assert(Checked::holds);
