/// Store EDS (1021h) in a node: bound automatically if the EDS has been generated into the device.
#pragma once

#include "canopen/node/service_set.hpp"
#include "canopen/od/object.hpp"
#include "canopen/od/value.hpp"

namespace canopen::service {

template <class Device>
class StoredEds : public ServiceDefaults<StoredEds<Device>> {
  using Eds = Object<0x1021, 0x00, Domain, Access::ro>;

 public:
  static constexpr bool exists = requires { Device::stored_eds; };

  template <class Host>
  static void on_start(Host& host) {
    host.node().template bind_constant<Eds>(Device::stored_eds);
  }
};

}  // namespace canopen::service
