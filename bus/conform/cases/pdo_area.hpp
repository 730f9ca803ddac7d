/// What the cases of the PDO area share: a TPDO as the device has it, its configuration, and the SYNC of the test.
#pragma once

#include <canopen/cob_id.hpp>
#include <canopen/nmt.hpp>
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

/// How long a device may take to send what an event, a SYNC or a remote frame asks for. CiA 301 gives no limit.
inline constexpr Duration to_answer = milliseconds{500};
/// How long nothing must come for nothing to come at all.
inline constexpr Duration silence = milliseconds{100};

/// Fails for a value of an entry: by the EDS where that is its default (0 without one), as the rule of `edsc check`
/// says, too.
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
/// 1600h of 1400h, 1A00h of 1800h.
[[nodiscard]] std::uint16_t mapping_of(std::uint16_t communication);
[[nodiscard]] unsigned bits_of(const std::vector<Mapped>& mapping);
/// The mapping that the device has now; nothing where the PDO is an MPDO.
[[nodiscard]] std::optional<std::vector<Mapped>> read_mapping(Dut& dut, std::uint16_t communication);
/// `2000h:00 and 2001h:00`
[[nodiscard]] std::string objects_text(const std::vector<Mapped>& mapping);

/// Why the EDS does not let a PDO carry an entry of its mapping.
struct MappingFault {
  std::string_view rule;  ///< of `edsc check`
  std::string expected;
  std::string got;
};
[[nodiscard]] std::optional<MappingFault> fault_of(const Dut& dut, PdoDirection direction, const Mapped& mapped);
/// Why the mapping that a PDO has is none: `TPDO 1 maps 6041h:00, ...`. Nothing when it is one, also of no objects.
[[nodiscard]] std::optional<std::string> reason_against(const Dut& dut, const Pdo& pdo,
                                                        const std::vector<Mapped>& mapping);
/// An entry whose PDOMapping and access let a PDO of this direction carry it.
[[nodiscard]] bool may_carry(PdoDirection direction, const Entry& entry);

/// The data of a PDO as SDO reads it from the mapped objects, and which of its bits are known.
struct Image {
  std::uint64_t bits = 0;
  std::uint64_t known = 0;
};
[[nodiscard]] Image read_image(Dut& dut, const std::vector<Mapped>& mapping);

/// Puts values into a PDO, the first object in the lowest bits (CiA 301, 7.5.2.36).
[[nodiscard]] std::uint64_t pack(const std::vector<Mapped>& mapping, std::span<const std::uint64_t> values);

/// Another value for an entry than this one, which its limits allow; nothing where none is known. `salt` gives others.
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

/// Nothing where it cannot be tested; `reason` then says why.
[[nodiscard]] std::optional<Tpdo> read_tpdo(Dut& dut, const Pdo& pdo, std::string& reason);
/// Those that can be tested, in Pre-operational. The case is not applicable where there is none.
[[nodiscard]] std::vector<Tpdo> tpdos(Dut& dut);

/// What a case asks of a TPDO. Event-driven ones have no inhibit time and no event timer unless the case asks for them.
struct Transmission {
  std::uint8_t type = event_driven;        ///< 254 does as well as 255
  std::optional<bool> remote_frames = {};  ///< whether bit 30 of the COB-ID allows them; nothing: as it is
  std::uint16_t inhibit_time = 0;          ///< 100 us
  std::uint16_t event_timer = 0;           ///< ms
  std::uint8_t sync_start = 0;
};

/// Makes the TPDO so, in Pre-operational or Operational. Nothing when that is done, else why the device does not
/// support it: `1800h:05 does not exist in the EDS`. The TPDO is then as it was found.
[[nodiscard]] std::optional<std::string> configure(Dut& dut, const Tpdo& tpdo, const Transmission& wanted);
/// Puts the parameters back as they were found.
void put_back(Dut& dut, const Tpdo& tpdo);

/// A value for an entry that its limits in the EDS allow, as near to this one as can be.
[[nodiscard]] std::uint64_t within_limits(const Dut& dut, std::uint16_t index, std::uint8_t sub_index,
                                          std::uint64_t value);

// ---- frames ----

/// The frame has the length of the mapped objects and carries these values of them.
void expect_data(Dut& dut, const Tpdo& tpdo, const SeenFrame& seen, const Image& image);
/// The same with what SDO read before the frame and reads now; of values that change meanwhile nothing is asked.
void expect_present_data(Dut& dut, const Tpdo& tpdo, const SeenFrame& seen, const Image& before);

[[nodiscard]] std::uint64_t data_of(const canopen::Frame& frame);
/// `181h, 3 bytes 01 02 03`
[[nodiscard]] std::string frame_text(const canopen::Frame& frame);
[[nodiscard]] std::string frames_text(const std::vector<SeenFrame>& frames);

/// Lets what a TPDO sends on entering Operational, or after its configuration, go by.
void settle(Dut& dut, const Tpdo& tpdo);

/// Data and remote frames with the CAN-ID of a COB-ID.
[[nodiscard]] canopen::Frame make_frame(std::uint32_t cob_id, std::span<const std::uint8_t> data);
[[nodiscard]] canopen::Frame make_remote_frame(std::uint32_t cob_id, std::uint8_t size);

// ---- what makes a TPDO be sent ----

/// The SYNC of the test, with the COB-ID of 1005h and the counter that 1019h asks for. A device that produces SYNC is
/// told not to. The case is not applicable without 1005h. To be made in Pre-operational or Operational.
class SyncSource {
 public:
  enum class Counter { as_it_is, enabled };

  explicit SyncSource(Dut& dut, Counter counter = Counter::as_it_is);

  /// One SYNC. Inconclusive where another node produces SYNC.
  void send();
  /// The frames that come within the communication cycle of the test after one SYNC.
  [[nodiscard]] std::vector<SeenFrame> send_and_collect(const Dut::Match& match);
  /// The counter of the next SYNC.
  void set_next(std::uint8_t counter) { next_ = counter; }
  [[nodiscard]] std::uint8_t overflow() const { return overflow_; }
  [[nodiscard]] std::uint64_t sent_at() const { return sent_at_; }  ///< the last one
  /// Between the SYNCs of `send_and_collect`.
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

/// What makes a TPDO be sent by event: one of its objects changes, from outside the bus. It is changed back when this
/// goes out of scope. To be made in a state in which the device answers SDO.
class Event {
 public:
  Event(Dut& dut, const std::vector<Mapped>& mapping);
  Event(const Event&) = delete;
  Event& operator=(const Event&) = delete;
  ~Event();

  /// The other value each time. False where no stimulus changes any of the objects.
  [[nodiscard]] bool apply();
  /// Another object from now on, as a change of the last one is not an event. False where there is none: the last one
  /// stays.
  [[nodiscard]] bool use_next();
  [[nodiscard]] std::string object() const;  ///< that `apply` has changed

 private:
  struct Candidate {
    Mapped mapped;
    Bytes present, changed;
  };

  [[nodiscard]] bool set(const Candidate& candidate, bool changed);

  Stimuli& stimuli_;
  std::vector<Candidate> candidates_;  ///< the first one is that which works, once one has
  bool works_ = false;
  bool is_changed_ = false;
};

}  // namespace edsc::conform::pdo_area
