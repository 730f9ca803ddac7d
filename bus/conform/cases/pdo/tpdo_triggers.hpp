/// What makes a device send a TPDO: SYNC, and changes of the mapped objects.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "conform/cases/pdo/pdo_mapping.hpp"

namespace edsc::conform {

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
  Event(Dut& dut, const std::vector<MappingValue>& mapping);
  Event(const Event&) = delete;
  Event& operator=(const Event&) = delete;
  ~Event();

  /// Changes the object between two values. Returns false if no stimulus changes any of the objects.
  [[nodiscard]] bool apply();
  /// Reads the object, so that the next change is one: the application may have written the former value. Returns false
  /// if it has. A user's command may change any object: then returns true.
  bool read_back();
  /// Selects the next object, because a change of the present one is not an event. Returns false if there is no other
  /// object; the present one remains selected.
  [[nodiscard]] bool use_next();
  [[nodiscard]] std::string object() const;  ///< the object that `apply` changes
  /// Whether a stimulus has succeeded.
  [[nodiscard]] bool has_run() const { return works_; }

 private:
  struct Candidate {
    MappingValue mapped;
    Bytes present, changed;
  };

  [[nodiscard]] bool set(const Candidate& candidate, bool changed);

  Dut& dut_;
  std::vector<Candidate> candidates_;  ///< the first one is selected
  bool works_ = false;
  bool is_changed_ = false;
};

}  // namespace edsc::conform
