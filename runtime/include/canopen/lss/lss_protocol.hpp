/// The bytes of LSS frames, for slave and master (CiA 305).
#pragma once

#include <cstdint>
#include <cstring>

#include "canopen/can/frame.hpp"
#include "canopen/can/node_id.hpp"
#include "canopen/lss/lss_options.hpp"

namespace canopen {

/// The node-ID of a device that has not been configured.
inline constexpr NodeId unconfigured_node_id{std::uint8_t{255}};

/// The four numbers of 1018h that identify a device.
struct LssAddress {
  std::uint32_t vendor_id = 0;
  std::uint32_t product_code = 0;
  std::uint32_t revision_number = 0;
  std::uint32_t serial_number = 0;

  friend constexpr bool operator==(const LssAddress&, const LssAddress&) = default;
};

/// A bit rate by its position in a table.
struct LssBitTiming {
  std::uint8_t table = 0;  ///< 0: the rates of CiA 301, see `lss::bit_rates`; 128..255: manufacturer-specific
  std::uint8_t index = 0;

  friend constexpr bool operator==(LssBitTiming, LssBitTiming) = default;
};

/// The states of a slave, with the codes of switch state global.
enum class LssState : std::uint8_t { waiting = 0, configuration = 1 };

/// Result of configure node-ID, configure bit timing parameters and store configuration: bytes 1 and 2 of the response.
struct LssError {
  std::uint8_t code = 0;      ///< 0: success
  std::uint8_t specific = 0;  ///< with code 255: manufacturer-specific code

  friend constexpr bool operator==(LssError, LssError) = default;
};

namespace lss {

inline constexpr std::uint16_t response_id = 0x7E4;  ///< slaves to master
inline constexpr std::uint16_t request_id = 0x7E5;   ///< master to slaves

/// Byte 0. A response has the command of its request unless a row says otherwise.
enum class Command : std::uint8_t {
  none = 0,
  switch_state_global = 0x04,
  configure_node_id = 0x11,
  configure_bit_timing = 0x13,
  activate_bit_timing = 0x15,  ///< no response
  store_configuration = 0x17,
  select_vendor_id = 0x40,  ///< switch state selective: four frames in this order, then a response
  select_product_code = 0x41,
  select_revision_number = 0x42,
  select_serial_number = 0x43,
  selected = 0x44,            ///< response
  identify_vendor_id = 0x46,  ///< identify remote slave: six frames in this order, then a response
  identify_product_code = 0x47,
  identify_revision_number_low = 0x48,
  identify_revision_number_high = 0x49,
  identify_serial_number_low = 0x4A,
  identify_serial_number_high = 0x4B,
  identify_non_configured = 0x4C,
  identified = 0x4F,                 ///< response, also to Fastscan
  identified_non_configured = 0x50,  ///< response
  fastscan = 0x51,
  inquire_vendor_id = 0x5A,
  inquire_product_code = 0x5B,
  inquire_revision_number = 0x5C,
  inquire_serial_number = 0x5D,
  inquire_node_id = 0x5E,
};

inline constexpr LssError success{};
inline constexpr LssError node_id_out_of_range{1};
inline constexpr LssError bit_timing_not_supported{1};
inline constexpr LssError store_not_supported{1};
inline constexpr LssError storage_access_error{2};
inline constexpr std::uint8_t implementation_specific = 255;

/// Fastscan: the value of BitCheck to which all slaves without node-ID respond, and which starts a scan.
inline constexpr std::uint8_t fastscan_reset = 0x80;

/// Returns bytes 1..4 as a number.
[[nodiscard]] inline std::uint32_t word_of(const Frame& frame) {
  std::uint32_t word = 0;
  std::memcpy(&word, &frame.data[1], sizeof word);
  return word;
}

/// Returns a frame with a command and a number; its other bytes are 0.
[[nodiscard]] inline Frame make_frame(std::uint16_t id, Command command, std::uint32_t word) {
  Frame frame{};
  frame.id = id;
  frame.size = 8;
  frame.data[0] = static_cast<std::uint8_t>(command);
  std::memcpy(&frame.data[1], &word, sizeof word);
  return frame;
}

/// Whether a frame is an LSS frame in this direction, of exactly eight bytes.
[[nodiscard]] constexpr bool is_lss(const Frame& frame, std::uint16_t id) {
  return frame.size == 8 && !frame.remote && frame.id == id && !frame.extended;
}

}  // namespace lss
}  // namespace canopen
