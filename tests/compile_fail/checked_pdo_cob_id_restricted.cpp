// expect: its COB-ID is restricted .*canopen::TpdoNumber<1> .*canopen::CanId<'5', '8', '1', 'h'>
// 580h + node-ID is the COB-ID of the default SDO's answers.
#include <canopen/pdo/pdo_check.hpp>
#include <every_type/device.hpp>

namespace od = every_type::od;

#ifdef GOOD
using Checked = canopen::CheckedTpdo<every_type::dictionary, 1, every_type::Tpdo1,
                                     canopen::PdoParameters{.cob_id = 0x500, .plus_node_id = true}>;
#else
using Checked = canopen::CheckedTpdo<every_type::dictionary, 1, every_type::Tpdo1,
                                     canopen::PdoParameters{.cob_id = 0x580, .plus_node_id = true}>;
#endif

static_assert(Checked::holds);
