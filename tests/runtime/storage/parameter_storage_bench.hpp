/// A device with stored parameters, one value in each range of 1010h.
#pragma once

#include <canopen/host/memory_storage.hpp>
#include <stored_device/device.hpp>

#include "support/bench.hpp"

namespace storage_bench {

/// A device at power-on, with the values that were stored before.
template <class Device = stored_device::Device, class... Handlers>
using Powered = bench::Bench<Device, canopen::StoredIn<canopen::MemoryStorage>, Handlers...>;

template <class Device = stored_device::Device, class... Handlers>
Powered<Device, Handlers...> powered(canopen::MemoryStorage& storage, Handlers... handlers) {
  return Powered<Device, Handlers...>{canopen::stored_in(storage), std::move(handlers)...};
}

inline constexpr auto save_all = "605 23 10 10 01 73 61 76 65";
inline constexpr auto saved_all = "585 60 10 10 01 00 00 00 00";
inline constexpr auto load_all = "605 23 11 10 01 6C 6F 61 64";
inline constexpr auto loaded_all = "585 60 11 10 01 00 00 00 00";

/// One value of each range.
inline void change(auto& device) {
  device.ask("605 2B 17 10 00 00 08 00 00");
  device.ask("605 23 00 20 00 07 00 00 00");
  device.ask("605 27 00 20 00 07 00 00 00");
  device.ask("605 23 83 60 00 08 00 00 00");
  device.ask("605 2B 00 A0 00 09 00 00 00");
}

struct Ranges {
  int communication, manufacturer, application, other;
  friend bool operator==(const Ranges&, const Ranges&) = default;
};
inline constexpr Ranges defaults{0, -5, 1000, 0};

template <class Bench>
Ranges ranges(const Bench& device) {
  return {device.node.template get<stored_device::od::producer_heartbeat_time>().raw(),
          device.node.template get<stored_device::od::gain>(),
          static_cast<int>(device.node.template get<stored_device::od::profile_acceleration>()),
          device.node.template get<stored_device::od::network_variable>()};
}

}  // namespace storage_bench
