/// Errors of the CAN controller in a node: lost frames, error passive, bus-off.
#pragma once

#include "canopen/can/bus_status.hpp"
#include "canopen/node/service_set.hpp"
#include "canopen/node/services/error_reaction.hpp"

namespace canopen::service {

template <class Device>
class BusErrors : public ServiceDefaults<BusErrors<Device>> {
 public:
  /// Reports what has changed since the last call.
  template <class Host>
  void on_bus_status(Host& host, const BusStatus& status) {
    const auto report = [&host](ServiceError error, bool there, bool was_there) {
      if (there && !was_there) host.report(error);
      if (!there) host.end(error);
    };
    const bool off = status.state == BusState::off;
    const bool was_off = status_.state == BusState::off;
    report(ServiceError::overrun, status.overrun, status_.overrun);
    report(ServiceError::bus_passive, status.state == BusState::passive, status_.state == BusState::passive);
    report(ServiceError::bus_off, off, was_off);
    status_ = status;
    if (off && !was_off) communication_failed(host);
  }

 private:
  BusStatus status_{};
};

}  // namespace canopen::service
