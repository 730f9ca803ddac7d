/// EMCY consumer (CiA 301, 7.2.7 and 7.5.2.31): the errors that other nodes report.
#pragma once

#include <array>
#include <cstdint>
#include <optional>
#include <string_view>

#include "canopen/can/cob_id.hpp"
#include "canopen/can/frame.hpp"
#include "canopen/emcy/error_register.hpp"
#include "canopen/od/object_store.hpp"

namespace canopen {

/// Content of an EMCY. Code 0000h: an error has disappeared, and the register shows the remaining ones.
struct EmergencyMessage {
  std::uint16_t code;
  ErrorRegister error_register;
  std::array<std::uint8_t, 5> info;

  friend constexpr bool operator==(const EmergencyMessage&, const EmergencyMessage&) = default;
};

/// Returns the message in a frame; empty if it has fewer than eight bytes.
[[nodiscard]] constexpr std::optional<EmergencyMessage> emergency_message(const Frame& frame) {
  if (frame.remote || frame.size < 8) return std::nullopt;
  EmergencyMessage message{
      static_cast<std::uint16_t>(frame.data[0] | (frame.data[1] << 8)), static_cast<ErrorRegister>(frame.data[2]), {}};
  for (std::size_t i = 0; i < message.info.size(); ++i) message.info[i] = frame.data[3 + i];
  return message;
}

/// A message, and the sub-index of 1028h for its sender: in CiA 301, the sender's node-ID.
struct ConsumedEmergency {
  std::uint8_t sub_index;
  EmergencyMessage message;
};

/// Receives the EMCYs whose COB-IDs are in 1028h.
template <class Device>
class EmergencyConsumer {
 public:
  static constexpr bool exists = Device::dictionary.has(0x1028, 1);

  [[nodiscard]] static std::optional<ConsumedEmergency> take([[maybe_unused]] EntryAccess<Device> entries,
                                                             [[maybe_unused]] const Frame& frame) {
    if constexpr (exists) {
      const std::uint32_t cob_id = cob_id_of(frame);
      for (std::uint8_t sub_index = 1; sub_index <= highest; ++sub_index) {
        const entry::Word word = entries.find(0x1028, sub_index);
        if (word <= Dictionary::no_sub_index || entries.number(word) != cob_id) continue;
        if (const auto message = emergency_message(frame)) return ConsumedEmergency{sub_index, *message};
      }
    }
    return std::nullopt;
  }

 private:
  static constexpr std::uint8_t highest = [] {
    std::uint8_t sub_index = 0;
    Device::dictionary.for_each_communication_entry([&](std::uint16_t index, std::uint8_t sub, entry::Word) {
      if (index == 0x1028) sub_index = sub;
    });
    return sub_index;
  }();
};

struct EmergencyCodeText {
  std::uint16_t code;
  std::uint16_t mask;  ///< the bits of a code that are compared
  std::string_view text;
};

/// Emergency error codes and their classes (CiA 301, 7.2.7.1, table 26); the first matching row is used.
inline constexpr EmergencyCodeText emergency_code_texts[] = {
    {0x0000, 0xFF00, "no error"},
    {0x1000, 0xFF00, "generic error"},
    {0x2000, 0xFF00, "current"},
    {0x2100, 0xFF00, "current, device input side"},
    {0x2200, 0xFF00, "current inside the device"},
    {0x2300, 0xFF00, "current, device output side"},
    {0x3000, 0xFF00, "voltage"},
    {0x3100, 0xFF00, "mains voltage"},
    {0x3200, 0xFF00, "voltage inside the device"},
    {0x3300, 0xFF00, "output voltage"},
    {0x4000, 0xFF00, "temperature"},
    {0x4100, 0xFF00, "ambient temperature"},
    {0x4200, 0xFF00, "device temperature"},
    {0x5000, 0xFF00, "device hardware"},
    {0x6000, 0xFF00, "device software"},
    {0x6100, 0xFF00, "internal software"},
    {0x6200, 0xFF00, "user software"},
    {0x6300, 0xFF00, "data set"},
    {0x7000, 0xFF00, "additional modules"},
    {0x8110, 0xFFFF, "CAN overrun, objects lost"},
    {0x8120, 0xFFFF, "CAN in error passive mode"},
    {0x8130, 0xFFFF, "life guard or heartbeat error"},
    {0x8140, 0xFFFF, "recovered from bus-off"},
    {0x8150, 0xFFFF, "CAN-ID collision"},
    {0x8210, 0xFFFF, "PDO not processed, too short"},
    {0x8220, 0xFFFF, "PDO too long"},
    {0x8230, 0xFFFF, "DAM-MPDO not processed, destination not available"},
    {0x8240, 0xFFFF, "unexpected length of SYNC"},
    {0x8250, 0xFFFF, "RPDO missed"},
    {0x8260, 0xFFFF, "unexpected length of TIME"},
    {0x8100, 0xFF00, "communication"},
    {0x8200, 0xFF00, "protocol"},
    {0x8000, 0xFF00, "monitoring"},
    {0x9000, 0xFF00, "external error"},
    {0xF000, 0xFF00, "additional functions"},
    {0xFF00, 0xFF00, "device specific"},
};

/// Returns the meaning of an emergency error code as text.
[[nodiscard]] constexpr std::string_view emergency_text(std::uint16_t code) {
  for (const EmergencyCodeText& row : emergency_code_texts) {
    if ((code & row.mask) == row.code) return row.text;
  }
  return "unknown emergency error code";
}

}  // namespace canopen
