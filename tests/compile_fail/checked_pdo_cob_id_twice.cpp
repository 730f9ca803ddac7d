// expect: two of the device have the same COB-ID
// expect: DistinctCobIds<canopen::TpdoNumber<1>, canopen::TpdoNumber<2>, canopen::CanId<'1', '8', '0', 'h'>
//
// A frame has one producer.
#include <canopen/pdo/pdo_check.hpp>
#include <every_type/device.hpp>

namespace od = every_type::od;

using First = canopen::CheckedTpdo<every_type::dictionary, 1, every_type::Tpdo1,
                                   canopen::PdoParameters{.cob_id = 0x180, .plus_node_id = true}>;
#ifdef GOOD
using Second = canopen::CheckedTpdo<every_type::dictionary, 2, every_type::Tpdo2,
                                    canopen::PdoParameters{.cob_id = 0x280, .plus_node_id = true}>;
#else
using Second =
    canopen::CheckedTpdo<every_type::dictionary, 2, every_type::Tpdo2, canopen::PdoParameters{.cob_id = 0x181}>;
#endif

static_assert(canopen::distinct_cob_ids<First, Second>());
