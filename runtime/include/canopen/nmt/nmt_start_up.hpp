/// NMT start-up (1F80h, CiA 302-2) of a device that is not an NMT master.
#pragma once

#include <cstdint>

#include "canopen/nmt/nmt.hpp"
#include "canopen/od/object_store.hpp"

namespace canopen {

/// Whether such a device enters Operational without a command.
template <class Device>
[[nodiscard]] bool starts_itself([[maybe_unused]] const ObjectStore<Device>& store) {
  if constexpr (Device::dictionary.has(0x1F80, 0)) {
    constexpr std::uint32_t waits = nmt_start_up::master | nmt_start_up::no_self_start;
    return (store.template number<0x1F80, 0>() & waits) == 0;
  } else {
    return false;
  }
}

}  // namespace canopen
