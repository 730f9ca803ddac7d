// expect: COB-ID: it is restricted .*canopen::ObjectAt<'1', '0', '1', '4', 'h', ':', '0', '0'> .*canopen::CanId<'5',
// '8', '1', 'h'> 580h + node-ID is the COB-ID of the default SDO's answers.
#include <canopen/can/cob_id_check.hpp>

#ifdef GOOD
static_assert(
    canopen::checked_cob_ids<canopen::StartCobId{0x1005, 0x00, 0x80}, canopen::StartCobId{0x1014, 0x00, 0x80, true}>());
#else
static_assert(canopen::checked_cob_ids<canopen::StartCobId{0x1005, 0x00, 0x80},
                                       canopen::StartCobId{0x1014, 0x00, 0x580, true}>());
#endif
