/// The device under test, as a case sees it: its EDS, its answers, the frames on the bus, and time.
///
/// A case is a function that reads like its clause:
///
///     void missing_sub_index(Dut& dut) {
///       dut.expect_abort(dut.upload(0x1000, 1), abort_rule::no_sub_index);
///     }
///
/// The same function runs on a real bus and in simulated time: time passes only while a member waits.
#pragma once

#include <canopen/base/clock.hpp>
#include <canopen/can/cob_id.hpp>
#include <canopen/can/frame.hpp>
#include <canopen/can/node_id.hpp>
#include <canopen/nmt/nmt.hpp>
#include <canopen/sdo/sdo_protocol.hpp>
#include <cstdint>
#include <optional>
#include <random>
#include <span>
#include <string>
#include <utility>
#include <vector>

#include "configure/configure_node.hpp"
#include "conform/dut/abort_rule.hpp"
#include "conform/dut/case_frames.hpp"
#include "conform/dut/found_values.hpp"
#include "conform/dut/stimuli.hpp"
#include "conform/objects.hpp"
#include "conform/sheet_findings.hpp"
#include "conform/verdict.hpp"
#include "device/device.hpp"
#include "online/live_bus.hpp"
#include "online/live_entry.hpp"
#include "online/sdo_access.hpp"
#include "rules/check_rules.hpp"
#include "values/append.hpp"
#include "values/little_endian.hpp"

namespace edsc::conform {

using std::chrono::microseconds;
using std::chrono::milliseconds;
using Bytes = std::vector<std::uint8_t>;

/// Ends a case with another verdict than passed. Only members of Dut throw it.
struct CaseEnd {
  Verdict verdict;
  std::string reason;
  std::string expected;
  std::string got;
  RuleId rule{};                               ///< of `edsc check` that reports the cause in the EDS
  std::vector<EntryAddress> failed_entries{};  ///< all of them, of a case that tries many
  Condition condition{};                       ///< that does not hold, of an inconclusive case
};

/// A condition of a case that does not hold, and how that was seen.
struct Unmet {
  Condition condition;
  std::string reason;
};

struct DutSettings {
  canopen::NodeId node{1};
  SdoSettings sdo;
  Level level = Level::read;
  Permission permissions = Permission::none;
  bool simulated = false;  ///< time passes only while the test waits
  /// Parts that the program of a simulated device omits: see SimulatedComposition.
  std::vector<std::string> omitted{};
  /// By how much a time on the bus may differ, without the lag of the test itself. Not 0 in simulated time either: a
  /// frame waits until the bus is free.
  Duration tolerance = microseconds{500};
  std::uint32_t seed = 1;
  /// Findings of `edsc check` in the EDS; std::nullopt if it was not checked.
  std::optional<SheetFindings> findings{};
  std::optional<RunClock> clock{};  ///< of a run that has begun; std::nullopt: it begins now
};

class Dut : public CaseFrames {
 public:
  Dut(LiveBus& bus, const Device& sheet, Stimuli& stimuli, const DutSettings& settings);

  // ---- the EDS ----

  [[nodiscard]] const Device& sheet() const { return sheet_; }
  [[nodiscard]] canopen::NodeId node() const { return settings_.node; }
  [[nodiscard]] const std::optional<SheetFindings>& findings() const { return settings_.findings; }
  [[nodiscard]] bool has(std::uint16_t index, std::uint8_t sub_index = 0) const;
  [[nodiscard]] const Entry* entry(std::uint16_t index, std::uint8_t sub_index = 0) const;
  /// Whether the EDS has the entry, and its AccessType allows the access.
  [[nodiscard]] bool is_readable(std::uint16_t index, std::uint8_t sub_index = 0) const;
  [[nodiscard]] bool is_writable(std::uint16_t index, std::uint8_t sub_index = 0) const;
  /// Returns the entry. The case is not applicable if the EDS does not have it.
  const Entry& need(std::uint16_t index, std::uint8_t sub_index = 0);
  /// Like `need`, but the entry must also be writable.
  const Entry& need_writable(std::uint16_t index, std::uint8_t sub_index = 0);
  /// The default value; std::nullopt if the EDS has none, and for a variable-length data type.
  [[nodiscard]] std::optional<std::uint64_t> default_of(std::uint16_t index, std::uint8_t sub_index = 0) const;
  /// All entries, ascending.
  [[nodiscard]] std::vector<LiveEntry> entries() const;
  /// TPDOs or RPDOs of the EDS that have a communication parameter (1800h or 1400h and above).
  [[nodiscard]] std::vector<const Pdo*> pdos(PdoDirection direction) const;
  [[nodiscard]] bool allowed(Permission permission) const { return includes(settings_.permissions, permission); }

  // ---- SDO ----

  /// Reads or writes an entry through the default SDO: expedited if four bytes suffice, else segmented or in blocks.
  /// A write first reads the present value, which is restored when the case ends.
  [[nodiscard]] SdoOutcome upload(std::uint16_t index, std::uint8_t sub_index = 0,
                                  SdoTransfer transfer = SdoTransfer::segmented);
  [[nodiscard]] SdoOutcome download(std::uint16_t index, std::uint8_t sub_index, std::span<const std::uint8_t> value,
                                    SdoTransfer transfer = SdoTransfer::segmented);
  /// Writes a number, little-endian, as 1 to 8 bytes: the size of the entry's data type in the EDS (4 without one).
  [[nodiscard]] SdoOutcome download(std::uint16_t index, std::uint8_t sub_index, std::uint64_t number);
  [[nodiscard]] Bytes bytes_of(std::uint16_t index, std::uint8_t sub_index, std::uint64_t number) const;

  /// Returns the value. The case fails if the device does not answer with one.
  Bytes read(std::uint16_t index, std::uint8_t sub_index = 0);
  std::uint64_t read_number(std::uint16_t index, std::uint8_t sub_index = 0);
  /// Writes. The case fails if the device does not confirm the write.
  void write(std::uint16_t index, std::uint8_t sub_index, std::uint64_t number);
  /// Writes without reading the present value: "save", "load", and what a case undoes itself.
  [[nodiscard]] SdoOutcome command(std::uint16_t index, std::uint8_t sub_index, std::span<const std::uint8_t> value);
  /// Writes the values in the sequence of CiA 301 (`order_writes`). They are restored when the case ends.
  [[nodiscard]] ConfigurationResult write_in_order(const std::vector<ConfigurationValue>& values);
  /// Reads an entry that the case then writes frame by frame. The value is restored when the case ends.
  void remember(std::uint16_t index, std::uint8_t sub_index) { found_values_.remember(index, sub_index); }

  /// Sends one request to the default SDO server and returns its next frame; std::nullopt after the timeout. A transfer
  /// that remains open is aborted by `end_transfer` or when the case ends.
  std::optional<canopen::sdo::Data> exchange(const canopen::sdo::Data& request);
  /// Sends a request without waiting for an answer, such as a segment of a block.
  void request(const canopen::sdo::Data& request);
  /// Returns the next frame of the server without a request, such as a segment of a block upload.
  std::optional<canopen::sdo::Data> answer();
  /// Aborts a transfer that `exchange` or `request` has left open, unless the last response ended it.
  void end_transfer(std::uint16_t index = 0, std::uint8_t sub_index = 0);

  // ---- all values at once ----

  using Values = FoundValues::Values;

  /// Returns the present values of the entries that "save" may store, and of 1020h.
  [[nodiscard]] Values values();
  /// Writes the values that differ now, also at 2000h and above, without recording the present ones. A value that
  /// cannot be written adds a warning.
  void restore(const Values& values);

  // ---- NMT ----

  [[nodiscard]] Match error_control() const;  ///< 700h + node-ID
  [[nodiscard]] Match boot_up() const;
  [[nodiscard]] Match heartbeat() const;  ///< error control without boot-up messages
  /// NMT to this node.
  void nmt(canopen::NmtCommand command);
  /// Sends reset node or reset communication and waits for the boot-up message. The case fails without it.
  void reset(canopen::NmtCommand command);
  /// Sends the command for the state and gives the device time to follow. Initialisation is a reset node.
  void enter(canopen::NmtState state);
  /// Enables a heartbeat of at most 100 ms, or selects node guarding. Returns false if the device has neither.
  bool watch_state();
  /// Returns the NMT state in the next error control message; std::nullopt without one. Call `watch_state` first.
  std::optional<canopen::NmtState> state();
  /// Fails if the next error control message has another state or is missing.
  void expect_state(canopen::NmtState state);

  // ---- verdicts ----

  [[noreturn]] void fail(std::string expected, std::string got, std::vector<EntryAddress> failed_entries = {});
  /// Fails because of an error in the EDS, which a rule of `edsc check` reports: no device could pass with this EDS.
  [[noreturn]] void fail_by_sheet(AnyRule rule, std::string expected, std::string got);
  void expect(bool condition, const std::string& expected, const std::string& got) {
    if (!condition) fail(expected, got);
  }
  /// The same, about these frames.
  void expect(bool condition, const std::string& expected, const std::string& got, std::span<const SeenFrame> frames) {
    if (condition) return;
    name_frames(frames);
    fail(expected, got);
  }
  /// Names the frames that a failure is about: reports show and mark them. Without this call, these are the last SDO
  /// transfers of the entries that the text of the failure names.
  void name_frames(std::span<const SeenFrame> frames);
  /// The same for the last SDO transfer of an entry.
  void name_transfer(std::uint16_t index, std::uint8_t sub_index);
  /// Expects an SDO abort with a code of the rule.
  void expect_abort(const SdoOutcome& outcome, const AbortRule& rule, const std::string& what = {});
  /// Expects an abort as the answer to `exchange`.
  void expect_abort(const std::optional<canopen::sdo::Data>& answer, const AbortRule& rule,
                    const std::string& what = {});
  void expect_done(const SdoOutcome& outcome, const std::string& what);
  void expect_equal(std::uint64_t got, std::uint64_t expected, const std::string& what);
  /// Expects a measured time, in microseconds, within limits widened by the tolerance. Inconclusive if it misses the
  /// limits by no more than the tolerance, the lag of the test and the lag of the device together.
  void expect_time(std::uint64_t measured, std::uint64_t low, std::uint64_t high, const std::string& what);
  /// The same of the times between frames that are sent periodically. On a bus, less than half of them outside the
  /// limits prove nothing: the computer of the device may have been busy at these times.
  void expect_times(std::span<const std::uint64_t> measured, std::uint64_t low, std::uint64_t high,
                    const std::string& what);
  void warn(std::string text) { warnings_.push_back(std::move(text)); }
  [[noreturn]] void not_applicable(std::string reason);
  /// Ends the case as not applicable if the program of the device omits this part.
  void need_part(std::string_view name);
  [[noreturn]] void inconclusive(std::string reason);
  /// Ends the case as inconclusive because a condition does not hold.
  [[noreturn]] void inconclusive(Condition condition, std::string reason);
  /// Ends the case as inconclusive if the run does not have the permission.
  void need_permission(Permission permission);

  /// A remote frame was answered: the bus carries them.
  void note_remote_frame_answered() { remote_frames_carried_ = true; }

  /// By how much a time may differ: the tolerance of the run.
  [[nodiscard]] Duration tolerance() const;
  [[nodiscard]] bool simulated() const { return settings_.simulated; }

  // ---- actions on the device that do not use the bus ----

  [[nodiscard]] Stimuli& stimuli() { return stimuli_; }
  std::mt19937& random() { return random_; }

  // ---- for the runner ----

  /// The result names what could not be restored. Throws Interrupted, BusLost.
  void begin_case(const CaseRow& row);
  /// After a failure: the first condition of the case that does not hold. Call it before `end_case`.
  [[nodiscard]] std::optional<Unmet> unmet_condition(const CaseRow& row);
  /// Whether the case relies on remote frames that the bus may not carry: none was answered.
  [[nodiscard]] std::optional<Unmet> unmet_remote_frames(const CaseRow& row);
  /// Whether the device responds to an SDO request. Gives a slow device several seconds.
  [[nodiscard]] bool responds();
  /// Whether any frame with the CAN-ID of an SDO response was received since the case began.
  [[nodiscard]] bool has_sent_response() const;
  /// Whether the device sends two responses to each request, so that two devices may have the node-ID.
  [[nodiscard]] bool has_twin();
  /// Another node-ID with which a device has sent a boot-up message during the case.
  [[nodiscard]] std::optional<canopen::NodeId> other_boot_up() const;
  /// Resets the device, as far as the permissions allow, so that a case begins again from a known state. Does not fail
  /// without a boot-up message.
  void start_again();
  void end_case(CaseResult& result);
  /// Restores what was changed and not yet restored: at an interruption, and at the end. Returns what could not be.
  std::vector<std::string> restore_changed();
  /// Finds the NMT state of the device before the run, if error control reports it. Returns what could not be restored.
  [[nodiscard]] std::vector<std::string> find_state();

 private:
  /// Whether the last response to `request` ends the transfer.
  [[nodiscard]] bool is_answered_to_end() const;
  [[nodiscard]] LiveEntry live(std::uint16_t index, std::uint8_t sub_index) const;
  [[nodiscard]] std::optional<std::string> unmet_state();
  [[nodiscard]] std::optional<std::string> unmet_error_free();
  [[nodiscard]] std::optional<std::string> too_late_for_sdo() const;
  [[nodiscard]] std::optional<std::string> late() const;
  [[nodiscard]] bool is_within(std::uint64_t measured, std::uint64_t low, std::uint64_t high) const;
  void measure_device_lag();
  void set_failed_frames(CaseResult& result);
  [[nodiscard]] bool answers_guarding();
  void probe_remote_frames();

  const Device& sheet_;
  Stimuli& stimuli_;
  DutSettings settings_;
  SdoAccess sdo_;
  FoundValues found_values_;
  std::mt19937 random_;

  std::vector<std::string> warnings_;
  std::uint64_t case_began_ = 0;
  bool state_changed_ = false;
  bool transfer_open_ = false;
  canopen::sdo::Data last_request_{};
  Mark requested_at_ = 0;
  std::optional<Mark> failed_;                    ///< where the case failed
  std::vector<Mark> failed_frames_;               ///< of `name_frames`
  bool guarded_ = false;                          ///< the state is read by node guarding
  bool remote_frames_carried_ = false;            ///< seen in this run
  bool remote_frames_probed_ = false;             ///< by node guarding
  std::optional<canopen::NmtState> commanded_;    ///< by the last NMT command of this case
  Mark next_answer_ = 0;                          ///< of `answer`
  std::optional<canopen::NmtState> found_state_;  ///< before the run
};

/// `1017h:00`
[[nodiscard]] std::string label(std::uint16_t index, std::uint8_t sub_index);
/// `0609 0011h, sub-index does not exist`, `no answer`, `done`, `the value 01 02`.
[[nodiscard]] std::string outcome_text(const SdoOutcome& outcome);
/// `12.003 ms`
[[nodiscard]] std::string milliseconds_text(std::uint64_t microseconds);

}  // namespace edsc::conform
