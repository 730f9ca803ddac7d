// expect: a parameter in 1000h..1FFFh is set in the context of the node
#include <canopen/node.hpp>
#include <canopen/node/mailbox.hpp>
#include <every_service/device.hpp>

namespace od = every_service::od;

#ifdef GOOD
canopen::Mailbox<od::measured_value> measured;
#else
canopen::Mailbox<od::producer_heartbeat_time> measured;
#endif
