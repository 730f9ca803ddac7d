/// The error register 1001h (CiA 301, 7.5.2.2) and the emergency error codes of the services.
#pragma once

#include <concepts>
#include <cstdint>

namespace canopen {

enum class ErrorRegister : std::uint8_t {
  none = 0x00,
  generic = 0x01,  ///< set whenever another bit is set
  current = 0x02,
  voltage = 0x04,
  temperature = 0x08,
  communication = 0x10,
  device_profile = 0x20,
  manufacturer = 0x80,
};

[[nodiscard]] constexpr ErrorRegister operator|(ErrorRegister a, ErrorRegister b) {
  return static_cast<ErrorRegister>(static_cast<std::uint8_t>(a) | static_cast<std::uint8_t>(b));
}

namespace emergency_code_detail {

// A constant that is not a code reads the element after the only one: the compiler's message has the name of the array.
inline constexpr bool is_not_an_emergency_error_code[1] = {};

/// Whether a code has a class of CiA 301, 7.2.7.1: 10xxh to 9xxxh, Fxxxh. 00xxh is "error reset or no error".
[[nodiscard]] constexpr bool has_class(std::uint64_t code) {
  return (code >= 0x1000 && code <= 0x9FFF) || (code >= 0xF000 && code <= 0xFFFF);
}

}  // namespace emergency_code_detail

/// An emergency error code as the parameter of a function. The compiler checks the class of a constant: codes with
/// swapped bytes do not compile. A variable is a std::uint16_t.
class EmergencyCode {
 public:
  template <std::unsigned_integral Code>
  requires(sizeof(Code) <= sizeof(std::uint16_t)) constexpr EmergencyCode(Code code)
      : value_{code} {}  // NOLINT(google-explicit-constructor): a code is one
  template <std::integral Code>
  requires(!std::unsigned_integral<Code> || sizeof(Code) > sizeof(std::uint16_t))
      // NOLINTNEXTLINE(google-explicit-constructor)
      consteval EmergencyCode(const Code& code)
      : value_{static_cast<std::uint16_t>(code)} {
    using namespace emergency_code_detail;
    if (is_not_an_emergency_error_code[has_class(static_cast<std::uint64_t>(code)) ? 0 : 1]) value_ = 0;
  }
  [[nodiscard]] constexpr std::uint16_t value() const { return value_; }

 private:
  std::uint16_t value_;
};

/// Emergency error codes (CiA 301, 7.2.7.1, table 26).
namespace emergency_code {
inline constexpr std::uint16_t reset = 0x0000;     ///< an error has disappeared
inline constexpr std::uint16_t data_set = 0x6300;  ///< stored parameters have been lost
inline constexpr std::uint16_t communication = 0x8100;
inline constexpr std::uint16_t overrun = 0x8110;  ///< frames have been lost
inline constexpr std::uint16_t bus_passive = 0x8120;
inline constexpr std::uint16_t error_control = 0x8130;     ///< a monitored node or the guarding master is lost
inline constexpr std::uint16_t bus_off = 0x8140;           ///< recovered from bus-off
inline constexpr std::uint16_t pdo_length = 0x8210;        ///< a PDO is shorter than its mapping
inline constexpr std::uint16_t mpdo_destination = 0x8230;  ///< the destination of a DAM-MPDO does not exist
inline constexpr std::uint16_t sync_length = 0x8240;
inline constexpr std::uint16_t rpdo_timeout = 0x8250;
}  // namespace emergency_code

}  // namespace canopen
