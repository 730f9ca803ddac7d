/// The list of services of a node. A service that the device does not have takes neither flash nor RAM.
#pragma once

#include "canopen/node/service_set.hpp"
#include "canopen/node/services/bound_domains.hpp"
#include "canopen/node/services/bus_errors.hpp"
#include "canopen/node/services/closed_values.hpp"
#include "canopen/node/services/drive_modes.hpp"
#include "canopen/node/services/emergency.hpp"
#include "canopen/node/services/emergency_consumer.hpp"
#include "canopen/node/services/error_reaction.hpp"
#include "canopen/node/services/guarding.hpp"
#include "canopen/node/services/heartbeat.hpp"
#include "canopen/node/services/heartbeat_consumer.hpp"
#include "canopen/node/services/lss.hpp"
#include "canopen/node/services/mpdos.hpp"
#include "canopen/node/services/pdo_parameters.hpp"
#include "canopen/node/services/periodic.hpp"
#include "canopen/node/services/posted_values.hpp"
#include "canopen/node/services/rpdos.hpp"
#include "canopen/node/services/sdo.hpp"
#include "canopen/node/services/stored_eds.hpp"
#include "canopen/node/services/sync.hpp"
#include "canopen/node/services/time.hpp"
#include "canopen/node/services/tpdos.hpp"
#include "canopen/node/services/values.hpp"

namespace canopen {

/// One row per service. The order is that of importance: of frames that are due at the same time, the first service
/// sends first. Posted values are set before periodic functions
/// use them and before anything is sent. A reset needs the node-ID of LSS before the values, and
/// those before the services that read them.
// clang-format off
template <class Device, class... Handlers>
using NodeServices = ServiceSet<
    service::PostedValues<Device, Handlers...>,
    service::Periodic<Device, Handlers...>,
    service::PdoCommunication<Device>,
    service::PdoMapping<Device>,
    service::Sync<Device>,
    service::BootUp<Device>,
    service::BusErrors<Device>,
    service::Lss<Device, Handlers...>,
    service::NodeGuarding<Device>,
    service::Sdo<Device, Handlers...>,
    service::Heartbeat<Device>,
    service::Emergency<Device>,
    service::DefaultValues<Device, Handlers...>,
    service::StoredValues<Device, Handlers...>,
    service::HeartbeatConsumer<Device>,
    service::LifeGuarding<Device>,
    service::HighResolutionTime<Device>,
    service::Time<Device>,
    service::EmergencyConsumer<Device>,
    service::Tpdos<Device>,
    service::Rpdos<Device>,
    service::Mpdos<Device>,
    service::ErrorReaction<Device>,
    service::StoredEds<Device>,
    service::DriveModes<Device>,
    service::ClosedValues<Device>,
    service::BoundDomains<Device, Handlers...>>;
// clang-format on

}  // namespace canopen
