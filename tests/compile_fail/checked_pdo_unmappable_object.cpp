// expect: PDOMapping=0
// expect: canopen::TpdoNumber<2>
// expect: canopen::EntryNumber<2>
// expect: ObjectAt<'1', '0', '0', '5', 'h', ':', '0', '0'>
// expect: every_type::od::cob_id_sync
//
// The EDS has PDOMapping=0.
#include <canopen/pdo/pdo_check.hpp>
#include <every_type/device.hpp>

namespace od = every_type::od;

#ifdef GOOD
using Checked = canopen::CheckedTpdo<every_type::dictionary, 2, canopen::Tpdo<od::access_ro, od::unsigned32_value>>;
#else
using Checked = canopen::CheckedTpdo<every_type::dictionary, 2, canopen::Tpdo<od::access_ro, od::cob_id_sync>>;
#endif

static_assert(Checked::holds);
