/// A TPDO as the device has it, its configuration, and its frames.
#pragma once

#include <canopen/can/cob_id.hpp>
#include <canopen/nmt/nmt.hpp>
#include <cstdint>
#include <map>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "conform/cases/pdo/pdo_mapping.hpp"

namespace edsc::conform {

inline constexpr std::uint8_t acyclic = 0, remote_synchronous = 252, remote = 253, event_driven = 255;

/// The time that a device may need to send a TPDO after an event, a SYNC or a remote frame. CiA 301 does not specify a
/// limit.
inline constexpr Duration to_send = milliseconds{500};
/// A TPDO that is not received within this time is considered not sent.
inline constexpr Duration silence = milliseconds{100};

/// A valid TPDO, or one that can be made valid, as it was found.
struct Tpdo {
  const Pdo* pdo = nullptr;
  std::uint16_t index = 0;  ///< 1800h..
  std::uint32_t found_cob_id = 0;
  std::uint32_t cob_id = 0;  ///< without bit 31
  std::vector<MappingValue> mapping;
  std::map<std::uint8_t, std::uint64_t> found;  ///< sub-indices 2 and above of the communication parameter

  [[nodiscard]] bool was_valid() const { return canopen::CobId{found_cob_id}.valid(); }
  [[nodiscard]] std::uint8_t size() const { return static_cast<std::uint8_t>(bytes_for(total_bits(mapping))); }
  [[nodiscard]] Dut::Match frames() const { return Dut::with_cob_id(cob_id); }
  [[nodiscard]] std::string name() const;  ///< `TPDO 1 (1800h, CAN-ID 181h)`
};

/// Returns std::nullopt, and `reason`, if the TPDO cannot be tested.
[[nodiscard]] std::optional<Tpdo> read_tpdo(Dut& dut, const Pdo& pdo, std::string& reason);
/// Enters Pre-operational and returns the TPDOs that can be tested. The case is not applicable without one.
[[nodiscard]] std::vector<Tpdo> tpdos(Dut& dut);

/// The parameters that a case needs in a TPDO. By default an event-driven TPDO without inhibit time and event timer.
struct Transmission {
  std::uint8_t type = event_driven;        ///< 255; 254 is also accepted
  std::optional<bool> remote_frames = {};  ///< whether bit 30 of the COB-ID allows them; std::nullopt: unchanged
  std::uint16_t inhibit_time = 0;          ///< 100 us
  std::uint16_t event_timer = 0;           ///< ms
  std::uint8_t sync_start = 0;
};

/// Configures the TPDO, in Pre-operational or Operational. If the device does not support the parameters, returns the
/// reason, `1800h:05 does not exist in the EDS`, and puts the TPDO back as it was found.
[[nodiscard]] std::optional<std::string> configure(Dut& dut, const Tpdo& tpdo, const Transmission& wanted);
/// Puts the parameters back as they were found.
void restore(Dut& dut, const Tpdo& tpdo);

// ---- frames ----

/// Expects the length of the mapped objects and these values in the frame.
void expect_data(Dut& dut, const Tpdo& tpdo, const SeenFrame& seen, const Image& image);
/// Likewise with the values that SDO read before the frame and reads now. Ignores values that differ between the two.
void expect_present_data(Dut& dut, const Tpdo& tpdo, const SeenFrame& seen, const Image& before);

/// `181h, 3 bytes 01 02 03`
[[nodiscard]] std::string frame_text(const canopen::Frame& frame);
[[nodiscard]] std::string frames_text(const std::vector<SeenFrame>& frames);

/// Waits until the TPDO is silent: entering Operational or a new configuration may have triggered it.
void settle(Dut& dut, const Tpdo& tpdo);

/// Data and remote frames with the CAN-ID of a COB-ID.
[[nodiscard]] canopen::Frame make_frame(std::uint32_t cob_id, std::span<const std::uint8_t> data);
[[nodiscard]] canopen::Frame make_remote_frame(std::uint32_t cob_id, std::uint8_t size);

}  // namespace edsc::conform
