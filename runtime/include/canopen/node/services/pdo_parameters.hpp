/// Writes to the parameters of PDOs (1400h..1BFFh) in a node.
#pragma once

#include <cstdint>
#include <span>

#include "canopen/node/service_set.hpp"
#include "canopen/pdo/communication_parameters.hpp"
#include "canopen/pdo/mpdo_check.hpp"
#include "canopen/pdo/mpdo_service.hpp"
#include "canopen/pdo/pdo_mapping.hpp"
#include "canopen/pdo/rpdo.hpp"
#include "canopen/pdo/tpdo.hpp"

namespace canopen::service {

/// Those of 1400h..15FFh and 1800h..19FFh.
template <class Device>
class PdoCommunication : public ServiceDefaults<PdoCommunication<Device>> {
  static constexpr bool is_writable =
      Device::dictionary.takes_writes(0x1400, 0x15FF) || Device::dictionary.takes_writes(0x1800, 0x19FF);

 public:
  static constexpr bool exists = is_writable || MpdoService<Device>::exists;

  static constexpr bool checks(std::uint16_t index, std::uint8_t) {
    return is_rpdo_communication(index) || is_tpdo_communication(index);
  }
  template <class Host>
  static AbortCode check_write(Host& host, std::uint16_t index, std::uint8_t sub_index, std::span<std::uint8_t> bytes) {
    if constexpr (MpdoService<Device>::exists) {
      const AbortCode code = MpdoCheck<Device>::check(host.store.entries(), index, sub_index, bytes);
      if (code != ok) return code;
    }
    if constexpr (is_writable) return check_pdo_parameter(host.store.entries(), index, sub_index, bytes);
    return ok;
  }
};

/// Those of 1600h..17FFh and 1A00h..1BFFh, if a mapping can change.
template <class Device>
class PdoMapping : public ServiceDefaults<PdoMapping<Device>> {
  static constexpr bool is_dynamic =
      RpdoService<Device>::has_dynamic_mapping || TpdoService<Device>::has_dynamic_mapping;

 public:
  static constexpr bool exists = is_dynamic || MpdoService<Device>::exists;

  static constexpr bool checks(std::uint16_t index, std::uint8_t) {
    return is_rpdo_mapping(index) || is_tpdo_mapping(index);
  }
  template <class Host>
  static AbortCode check_write(Host& host, std::uint16_t index, std::uint8_t sub_index, std::span<std::uint8_t> bytes) {
    if constexpr (MpdoService<Device>::exists) {
      const AbortCode code = MpdoCheck<Device>::check(host.store.entries(), index, sub_index, bytes);
      if (code != ok) return code;
    }
    if constexpr (is_dynamic) {
      const std::uint8_t capacity = is_tpdo_mapping(index)
                                        ? TpdoService<Device>::Mapped::capacity_of(host.store.entries(), index)
                                        : RpdoService<Device>::Mapped::capacity_of(host.store.entries(), index);
      return check_pdo_mapping(host.store.entries(), capacity, index, sub_index, bytes);
    }
    return ok;
  }
};

}  // namespace canopen::service
