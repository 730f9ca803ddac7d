/// SYNC consumer (CiA 301, 7.2.5): what synchronous PDOs wait for.
#pragma once

#include <cstdint>
#include <optional>

#include "canopen/cob_id.hpp"
#include "canopen/frame.hpp"
#include "canopen/object_store.hpp"

namespace canopen {

/// A SYNC message that has been received.
struct Sync {
  std::uint8_t counter;  ///< 1..240; 0: the network counts no SYNCs
  bool good;             ///< its length is the one that 1019h asks for
};

/// Takes the SYNC of 1005h. With a counter overflow value in 1019h other than 0 it has one data byte, else none.
template <class Device>
class SyncConsumer {
 public:
  static constexpr bool exists = Device::dictionary.has(0x1005, 0);
  static constexpr bool has_overflow = Device::dictionary.has(0x1019, 0);

  /// Nothing when the frame is no SYNC of this device. A device without 1019h does not look at the length.
  [[nodiscard]] static std::optional<Sync> take(const ObjectStore<Device>& store, const Frame& frame) {
    if constexpr (exists) {
      const CobId cob_id{store.template number<0x1005, 0>()};
      if (cob_id_of(frame) != (cob_id.value() & (CobId::extended_bit | 0x1FFF'FFFFu))) return std::nullopt;
      if constexpr (has_overflow) {
        const bool counted = store.template number<0x1019, 0>() != 0;
        return Sync{counted ? frame.data[0] : std::uint8_t{0}, frame.size == (counted ? 1 : 0)};
      }
      return Sync{0, true};
    }
    return std::nullopt;
  }
};

}  // namespace canopen
