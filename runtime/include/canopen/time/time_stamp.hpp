/// TIME (CiA 301, 7.2.6), the time of day for all nodes of a network: consumer and producer.
#pragma once

#include <cstdint>
#include <cstring>
#include <optional>
#include <span>

#include "canopen/base/abort_code.hpp"
#include "canopen/can/cob_id.hpp"
#include "canopen/can/frame.hpp"
#include "canopen/od/device_options.hpp"
#include "canopen/od/object_store.hpp"
#include "canopen/od/sheet.hpp"
#include "canopen/od/value.hpp"

namespace canopen {

/// The TIME of 1012h: bit 31 enables this device to consume it, bit 30 to produce it.
template <class Device>
class TimeStamp {
 public:
  static constexpr bool exists = Device::dictionary.has(0x1012, 0);
  static constexpr std::uint8_t size = 6;

  /// Returns the time in a frame; empty if it is not a TIME message for this device, or is too short.
  [[nodiscard]] static std::optional<TimeOfDay> take(const ObjectStore<Device>& store, const Frame& frame) {
    if constexpr (exists) {
      const std::uint32_t cob_id = store.template number<0x1012, 0>();
      const bool consumes = (cob_id & consume_bit) != 0;
      if (consumes && cob_id_of(frame) == (cob_id & CobId::identifier) && frame.size >= size) {
        TimeOfDay time;
        std::memcpy(&time.milliseconds, &frame.data[0], sizeof time.milliseconds);
        std::memcpy(&time.days, &frame.data[4], sizeof time.days);
        time.milliseconds &= 0x0FFF'FFFF;
        return time;
      }
    }
    return std::nullopt;
  }

  /// Sends the time of day. Returns false if this device does not produce TIME, or the bus had no room.
  template <Bus BusType>
  [[nodiscard]] static bool send(const ObjectStore<Device>& store, BusType& bus, TimeOfDay time) {
    static_assert(exists, "this device has no 1012h");
    const CobId cob_id{store.template number<0x1012, 0>()};
    if ((cob_id.value() & produce_bit) == 0 || !is_usable(cob_id.value() & CobId::identifier)) return false;
    Frame frame{};
    frame.id = cob_id.can_id();
    frame.extended = cob_id.extended();
    frame.size = size;
    std::memcpy(&frame.data[0], &time.milliseconds, sizeof time.milliseconds);
    std::memcpy(&frame.data[4], &time.days, sizeof time.days);
    return bus.send(frame);
  }

  static constexpr std::uint32_t consume_bit = 0x8000'0000;
  static constexpr std::uint32_t produce_bit = 0x4000'0000;
};

/// Checks whether these bytes may be written to 1012h (CiA 301, 7.5.2.15). 0609 0030h: the CAN-ID changes while TIME is
/// consumed or produced, is a restricted one, or has 29 bits although the device supports 11.
template <class Device>
[[nodiscard]] AbortCode check_time_parameter(EntryAccess<Device> entries, std::span<const std::uint8_t> bytes) {
  constexpr std::uint32_t in_use = 0xC000'0000;
  const std::uint32_t after = number_in(bytes);
  const std::uint32_t before = entries.template number<0x1012, 0>();
  if ((before & after & in_use) != 0 && ((before ^ after) & ~in_use) != 0) return AbortCode::invalid_value;
  return may_be_written(CobId{after}, true, options_of<Device>(entries).pdo_extended_ids) ? ok
                                                                                          : AbortCode::invalid_value;
}

}  // namespace canopen
