// expect: its COB-ID is restricted .*canopen::RpdoNumber<1> .*canopen::CanId<'5', '0', '3', 'h'>
// 502h + 127 is 581h.
#include <canopen/pdo/pdo_check.hpp>
#include <every_type/device.hpp>

namespace od = every_type::od;

#ifdef GOOD
using Checked = canopen::CheckedRpdo<every_type::dictionary, 1, every_type::Rpdo1,
                                     canopen::PdoParameters{.cob_id = 0x501, .plus_node_id = true}>;
#else
using Checked = canopen::CheckedRpdo<every_type::dictionary, 1, every_type::Rpdo1,
                                     canopen::PdoParameters{.cob_id = 0x502, .plus_node_id = true}>;
#endif

static_assert(Checked::holds);
