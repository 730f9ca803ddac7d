/// Shared by the cases of the PDO area: a TPDO as the device has it, its configuration, and the SYNC of the test.
#pragma once

#include <canopen/can/cob_id.hpp>
#include <canopen/nmt/nmt.hpp>
#include <cstdint>
#include <functional>
#include <map>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "conform/case.hpp"
#include "conform/dut.hpp"

namespace edsc::conform::pdo_area {

using canopen::NmtState;

/// Sub-indices of 1400h and 1800h.
inline constexpr std::uint8_t cob_id_parameter = 1, type_parameter = 2, inhibit_parameter = 3, reserved_parameter = 4,
                              timer_parameter = 5, sync_start_parameter = 6;

inline constexpr std::uint8_t acyclic = 0, remote_synchronous = 252, remote = 253, event_driven = 255;

/// The time that a device may need to send a TPDO after an event, a SYNC or a remote frame. CiA 301 does not specify a
/// limit.
inline constexpr Duration to_answer = milliseconds{500};
/// A TPDO that is not received within this time is considered not sent.
inline constexpr Duration silence = milliseconds{100};

/// Fails because of the value of an entry. If it is the default value of the EDS (0 without one), the failure names the
/// rule of `edsc check` that reports it.
[[noreturn]] void fail_value(Dut& dut, std::uint16_t index, std::uint8_t sub_index, std::uint64_t value,
                             std::string_view rule, const std::string& expected, const std::string& got);

// ---- mapping ----

/// An entry of a mapping parameter.
struct Mapped {
  std::uint16_t index = 0;
  std::uint8_t sub_index = 0;
  std::uint8_t bits = 0;

  [[nodiscard]] std::uint32_t value() const {
    return std::uint32_t{index} << 16 | std::uint32_t{sub_index} << 8 | bits;
  }
  [[nodiscard]] bool is_dummy() const { return index < 0x20; }
  friend bool operator==(const Mapped&, const Mapped&) = default;
};

[[nodiscard]] Mapped mapped_of(std::uint64_t value);
/// Returns 1600h for 1400h, and 1A00h for 1800h.
[[nodiscard]] std::uint16_t mapping_of(std::uint16_t communication);
[[nodiscard]] unsigned bits_of(const std::vector<Mapped>& mapping);
/// Reads the present mapping; std::nullopt for an MPDO.
[[nodiscard]] std::optional<std::vector<Mapped>> read_mapping(Dut& dut, std::uint16_t communication);
/// `2000h:00 and 2001h:00`
[[nodiscard]] std::string objects_text(const std::vector<Mapped>& mapping);

/// Why the EDS does not allow an entry of a mapping.
struct MappingFault {
  std::string_view rule;  ///< of `edsc check`
  std::string expected;
  std::string got;
};
[[nodiscard]] std::optional<MappingFault> fault_of(const Dut& dut, PdoDirection direction, const Mapped& mapped);
/// Returns why a mapping is not valid: `TPDO 1 maps 6041h:00, ...`; std::nullopt if it is valid. An empty mapping is
/// valid.
[[nodiscard]] std::optional<std::string> reason_against(const Dut& dut, const Pdo& pdo,
                                                        const std::vector<Mapped>& mapping);
/// Whether PDOMapping and AccessType of an entry allow a PDO of this direction to map it.
[[nodiscard]] bool may_carry(PdoDirection direction, const Entry& entry);

/// The data of a PDO as read from the mapped objects by SDO, and the mask of its known bits.
struct Image {
  std::uint64_t bits = 0;
  std::uint64_t known = 0;
};
[[nodiscard]] Image read_image(Dut& dut, const std::vector<Mapped>& mapping);

/// Packs values into PDO data, the first object in the least significant bits (CiA 301, 7.5.2.36).
[[nodiscard]] std::uint64_t pack(const std::vector<Mapped>& mapping, std::span<const std::uint64_t> values);

/// A value within the limits of an entry that differs from the present one; std::nullopt if none is known. Another
/// `salt` gives another value.
[[nodiscard]] std::optional<std::uint64_t> other_value(const Dut& dut, const Mapped& mapped, std::uint64_t present,
                                                       std::uint64_t salt = 1);

// ---- a TPDO ----

/// A valid TPDO, or one that can be made valid, as it was found.
struct Tpdo {
  const Pdo* pdo = nullptr;
  std::uint16_t index = 0;  ///< 1800h..
  std::uint32_t found_cob_id = 0;
  std::uint32_t cob_id = 0;  ///< without bit 31
  std::vector<Mapped> mapping;
  std::map<std::uint8_t, std::uint64_t> found;  ///< sub-indices 2 and above of the communication parameter

  [[nodiscard]] bool was_valid() const { return canopen::CobId{found_cob_id}.valid(); }
  [[nodiscard]] std::uint8_t size() const { return static_cast<std::uint8_t>((bits_of(mapping) + 7) / 8); }
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
void put_back(Dut& dut, const Tpdo& tpdo);

/// Returns the value nearest to `value` within the limits of the EDS.
[[nodiscard]] std::uint64_t within_limits(const Dut& dut, std::uint16_t index, std::uint8_t sub_index,
                                          std::uint64_t value);

// ---- frames ----

/// Expects the length of the mapped objects and these values in the frame.
void expect_data(Dut& dut, const Tpdo& tpdo, const SeenFrame& seen, const Image& image);
/// Likewise with the values that SDO read before the frame and reads now. Ignores values that differ between the two.
void expect_present_data(Dut& dut, const Tpdo& tpdo, const SeenFrame& seen, const Image& before);

[[nodiscard]] std::uint64_t data_of(const canopen::Frame& frame);
/// `181h, 3 bytes 01 02 03`
[[nodiscard]] std::string frame_text(const canopen::Frame& frame);
[[nodiscard]] std::string frames_text(const std::vector<SeenFrame>& frames);

/// Waits until the TPDO is silent: entering Operational or a new configuration may have triggered it.
void settle(Dut& dut, const Tpdo& tpdo);

/// Data and remote frames with the CAN-ID of a COB-ID.
[[nodiscard]] canopen::Frame make_frame(std::uint32_t cob_id, std::span<const std::uint8_t> data);
[[nodiscard]] canopen::Frame make_remote_frame(std::uint32_t cob_id, std::uint8_t size);

// ---- triggers of a TPDO ----

/// The SYNC producer of the test, with the CAN-ID of 1005h and the counter of 1019h. Stops the SYNC producer of the
/// device. The case is not applicable without 1005h. Create it in Pre-operational or Operational.
class SyncSource {
 public:
  enum class Counter { as_it_is, enabled };

  explicit SyncSource(Dut& dut, Counter counter = Counter::as_it_is);

  /// Sends one SYNC. Inconclusive if another node produces SYNC.
  void send();
  /// Sends one SYNC and returns the matching frames within the communication cycle of the test.
  [[nodiscard]] std::vector<SeenFrame> send_and_collect(const Dut::Match& match);
  /// Sets the counter of the next SYNC.
  void set_next(std::uint8_t counter) { next_ = counter; }
  [[nodiscard]] std::uint8_t overflow() const { return overflow_; }
  [[nodiscard]] std::uint64_t sent_at() const { return sent_at_; }  ///< time of the last SYNC
  /// The time between the SYNCs of `send_and_collect`.
  static constexpr Duration cycle = milliseconds{50};

 private:
  void stop_production(std::uint64_t cob_id);
  void enable_counter();

  Dut& dut_;
  Dut::Mark since_;
  std::uint32_t cob_id_ = 0;
  std::uint8_t overflow_ = 0;
  std::uint8_t next_ = 1;
  std::uint64_t sent_at_ = 0;
};

/// Triggers an event of a TPDO: a stimulus changes one of its objects. The destructor changes it back. Create it in a
/// state in which the device answers SDO requests.
class Event {
 public:
  Event(Dut& dut, const std::vector<Mapped>& mapping);
  Event(const Event&) = delete;
  Event& operator=(const Event&) = delete;
  ~Event();

  /// Changes the object between two values. Returns false if no stimulus changes any of the objects.
  [[nodiscard]] bool apply();
  /// Selects the next object, because a change of the present one is not an event. Returns false if there is no other
  /// object; the present one remains selected.
  [[nodiscard]] bool use_next();
  [[nodiscard]] std::string object() const;  ///< the object that `apply` changes

 private:
  struct Candidate {
    Mapped mapped;
    Bytes present, changed;
  };

  [[nodiscard]] bool set(const Candidate& candidate, bool changed);

  Stimuli& stimuli_;
  std::vector<Candidate> candidates_;  ///< the first one is selected
  bool works_ = false;
  bool is_changed_ = false;
};

}  // namespace edsc::conform::pdo_area
