// expect: COB-ID: it is restricted .*canopen::ObjectAt<'1', '2', '0', '1', 'h', ':', '0', '2'> .*canopen::CanId<'0',
// '0', '0', 'h'> Frames of a server with CAN-ID 0 would be NMT commands.
#include <canopen/can/cob_id_check.hpp>

#ifdef GOOD
static_assert(canopen::checked_cob_ids<canopen::StartCobId{0x1201, 0x02, 0x80000000}>());
#else
static_assert(canopen::checked_cob_ids<canopen::StartCobId{0x1201, 0x02, 0}>());
#endif
