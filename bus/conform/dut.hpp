/// The device under test, as a case sees it: its data sheet, its answers, the frames on the bus, and time.
///
/// A case is a function of it that reads like its clause:
///
///     void missing_sub_index(Dut& dut) {
///       dut.expect_abort(dut.upload(0x1000, 1), abort_rule::no_sub_index);
///     }
///
/// The same function runs on a real bus and in simulated time: time passes only while a member waits.
#pragma once

#include <canopen/cob_id.hpp>
#include <canopen/frame.hpp>
#include <canopen/nmt.hpp>
#include <canopen/node_id.hpp>
#include <canopen/sdo_protocol.hpp>
#include <canopen/time.hpp>
#include <cstdint>
#include <functional>
#include <map>
#include <optional>
#include <random>
#include <set>
#include <span>
#include <string>
#include <utility>
#include <vector>

#include "conform/abort_rule.hpp"
#include "conform/sheet_findings.hpp"
#include "conform/stimuli.hpp"
#include "conform/verdict.hpp"
#include "device/device.hpp"
#include "online/live_bus.hpp"
#include "online/live_entry.hpp"
#include "online/sdo_access.hpp"

namespace edsc::conform {

using std::chrono::microseconds;
using std::chrono::milliseconds;
using canopen::Duration;
using Bytes = std::vector<std::uint8_t>;

/// Ends a case before its last line. Thrown by the members of Dut alone.
struct CaseEnd {
  Verdict verdict;
  std::string reason;
  std::string expected;
  std::string got;
  std::string rule{};  ///< of `edsc check` that finds the same in the EDS
};

struct DutSettings {
  canopen::NodeId node{1};
  SdoSettings sdo;
  Level level = Level::read;
  Permission permissions = Permission::none;
  bool simulated = false;  ///< time passes only while the test waits
  /// By how much times on the bus may differ from what the device promises, without the lag of the test itself. In
  /// simulated time too, frames wait for others on the wire.
  Duration tolerance = microseconds{500};
  std::uint32_t seed = 1;
  /// What `edsc check` finds in the EDS. Nothing when it was not checked.
  std::optional<SheetFindings> findings{};
};

class Dut {
 public:
  Dut(LiveBus& bus, const Device& sheet, Stimuli& stimuli, DutSettings settings);
  ~Dut();
  Dut(const Dut&) = delete;
  Dut& operator=(const Dut&) = delete;

  // ---- what the data sheet says ----

  [[nodiscard]] const Device& sheet() const { return sheet_; }
  [[nodiscard]] canopen::NodeId node() const { return settings_.node; }
  [[nodiscard]] const std::optional<SheetFindings>& findings() const { return settings_.findings; }
  [[nodiscard]] bool has(std::uint16_t index, std::uint8_t sub_index = 0) const;
  [[nodiscard]] const Entry* entry(std::uint16_t index, std::uint8_t sub_index = 0) const;
  /// The entry; the case is not applicable where the data sheet does not have it.
  const Entry& need(std::uint16_t index, std::uint8_t sub_index = 0);
  /// The same for an entry that can be written.
  const Entry& need_writable(std::uint16_t index, std::uint8_t sub_index = 0);
  /// The default value; nothing where the data sheet states none, or where it is a string.
  [[nodiscard]] std::optional<std::uint64_t> default_of(std::uint16_t index, std::uint8_t sub_index = 0) const;
  /// All entries, ascending.
  [[nodiscard]] std::vector<LiveEntry> entries() const;
  /// 1800h.. or 1400h.. of the data sheet, as indices of their communication parameters.
  [[nodiscard]] std::vector<const Pdo*> pdos(PdoDirection direction) const;
  [[nodiscard]] bool allowed(Permission permission) const { return includes(settings_.permissions, permission); }
  [[nodiscard]] Level level() const { return settings_.level; }

  // ---- SDO ----

  /// Reads or writes an entry through the default SDO, expedited where four bytes do, else segmented or in blocks.
  /// A write remembers what was there, and it is put back when the case is over.
  [[nodiscard]] SdoOutcome upload(std::uint16_t index, std::uint8_t sub_index = 0,
                                  SdoTransfer transfer = SdoTransfer::segmented);
  [[nodiscard]] SdoOutcome download(std::uint16_t index, std::uint8_t sub_index, std::span<const std::uint8_t> value,
                                    SdoTransfer transfer = SdoTransfer::segmented);
  /// A number of 1 to 8 bytes, low byte first, as many as the entry's type has in the data sheet (4 without one).
  [[nodiscard]] SdoOutcome download(std::uint16_t index, std::uint8_t sub_index, std::uint64_t number);
  [[nodiscard]] Bytes bytes_of(std::uint16_t index, std::uint8_t sub_index, std::uint64_t number) const;

  /// The value; the case fails where the device refuses.
  Bytes read(std::uint16_t index, std::uint8_t sub_index = 0);
  std::uint64_t read_number(std::uint16_t index, std::uint8_t sub_index = 0);
  /// Writes; the case fails where the device refuses.
  void write(std::uint16_t index, std::uint8_t sub_index, std::uint64_t number);
  /// Writes without remembering what was there: save, load and what a case undoes itself.
  [[nodiscard]] SdoOutcome command(std::uint16_t index, std::uint8_t sub_index, std::span<const std::uint8_t> value);
  /// Reads the entry, which a case then writes by hand-made frames: it is put back when the case is over.
  void remember(std::uint16_t index, std::uint8_t sub_index);

  /// One request to the default SDO server, and its next frame; nothing when none comes in time. The transfer that it
  /// leaves open is aborted when the case is over, or by `end_transfer`.
  std::optional<canopen::sdo::Data> exchange(const canopen::sdo::Data& request);
  /// The same where no answer is waited for: segments of a block.
  void request(const canopen::sdo::Data& request);
  /// The next frame of the server, when no request is due: segments of a block upload.
  std::optional<canopen::sdo::Data> answer();
  /// Aborts what a transfer by `exchange` has left open.
  void end_transfer(std::uint16_t index = 0, std::uint8_t sub_index = 0);
  /// Reads or writes an entry by hand-made segments: the transfer that is asked for, also where the value is short.
  [[nodiscard]] Bytes upload_segmented(std::uint16_t index, std::uint8_t sub_index);
  [[nodiscard]] SdoOutcome download_segmented(std::uint16_t index, std::uint8_t sub_index,
                                              std::span<const std::uint8_t> value);

  // ---- all values at once ----

  using Key = std::pair<std::uint16_t, std::uint8_t>;
  using Values = std::map<Key, Bytes>;

  /// What the device holds in the entries that "save" may store, 1020h among them.
  [[nodiscard]] Values values();
  /// Writes those that differ now, of the application as well, and remembers nothing. What cannot be written is a
  /// warning.
  void restore(const Values& values);

  // ---- frames ----

  /// A place in the record of frames.
  using Mark = std::size_t;
  using Match = std::function<bool(const canopen::Frame&)>;

  [[nodiscard]] Mark mark() const { return frames_.size(); }
  void send(const canopen::Frame& frame);
  void send(std::uint32_t can_id, std::span<const std::uint8_t> data);
  void send_remote(std::uint32_t can_id, std::uint8_t size);
  /// The first frame that the device has sent since the mark, waiting for this long at most.
  std::optional<SeenFrame> wait_for(const Match& match, Duration span, Mark since);
  std::optional<SeenFrame> wait_for(const Match& match, Duration span) { return wait_for(match, span, mark()); }
  /// All such frames of this time, which passes as a whole.
  std::vector<SeenFrame> collect(const Match& match, Duration span);
  void pass_time(Duration span) { (void)collect([](const canopen::Frame&) { return false; }, span); }
  /// Frames received since the mark.
  [[nodiscard]] std::vector<SeenFrame> received_since(Mark since, const Match& match) const;
  [[nodiscard]] std::uint64_t now() const;  ///< microseconds since the run began

  [[nodiscard]] static Match with_id(std::uint32_t can_id);
  /// The CAN-ID of a valid COB-ID as an object holds it; nothing where bit 31 says that it is not valid.
  [[nodiscard]] static Match with_cob_id(std::uint32_t cob_id);
  [[nodiscard]] Match error_control() const;  ///< 700h + node-ID
  [[nodiscard]] Match boot_up() const;
  [[nodiscard]] Match heartbeat() const;      ///< error control without boot-up messages

  // ---- NMT ----

  /// NMT to this node.
  void nmt(canopen::NmtCommand command);
  /// Reset node or reset communication, and the boot-up message. The case fails where none comes.
  void reset(canopen::NmtCommand command);
  /// Start, stop or pre-operational, and time for the device to follow.
  void enter(canopen::NmtState state);
  /// Turns on a heartbeat of at most 100 ms, or takes node guarding. False if the device has neither.
  bool watch_state();
  /// The state in the next message of error control; std::nullopt if none comes. Call `watch_state` first.
  std::optional<canopen::NmtState> state();
  /// Fails if the next message of error control has another state, or none comes.
  void expect_state(canopen::NmtState state);

  // ---- verdicts ----

  [[noreturn]] void fail(std::string expected, std::string got);
  /// The device cannot pass, since its data sheet promises what no device keeps: a rule of `edsc check` says so.
  [[noreturn]] void fail_by_sheet(std::string_view rule, std::string expected, std::string got);
  void expect(bool condition, const std::string& expected, const std::string& got) {
    if (!condition) fail(expected, got);
  }
  /// An abort of the device with a code of the rule.
  void expect_abort(const SdoOutcome& outcome, const AbortRule& rule, const std::string& what = {});
  /// The same for an answer to `exchange`.
  void expect_abort(const std::optional<canopen::sdo::Data>& answer, const AbortRule& rule,
                    const std::string& what = {});
  void expect_done(const SdoOutcome& outcome, const std::string& what);
  void expect_equal(std::uint64_t got, std::uint64_t expected, const std::string& what);
  /// A time that was measured, in microseconds, within limits widened by the tolerance. Inconclusive where the test
  /// itself was late by more than it misses.
  void expect_time(std::uint64_t measured, std::uint64_t low, std::uint64_t high, const std::string& what);
  void warn(std::string text) { warnings_.push_back(std::move(text)); }
  [[noreturn]] void not_applicable(std::string reason);
  [[noreturn]] void inconclusive(std::string reason);
  /// Inconclusive where the run may not do this.
  void need_permission(Permission permission);

  /// By how much a time may differ now: the tolerance of the run and the lag of the test.
  [[nodiscard]] Duration tolerance() const;
  [[nodiscard]] bool simulated() const { return settings_.simulated; }

  // ---- what acts on the device from outside the bus ----

  [[nodiscard]] Stimuli& stimuli() { return stimuli_; }
  std::mt19937& random() { return random_; }

  // ---- of the runner ----

  /// The result names what could not be put back. Throws Interrupted, BusLost.
  void begin_case(const CaseRow& row);
  void end_case(CaseResult& result);
  /// Puts back what was changed and not yet put back: at an interruption, and at the end. Answers what could not be.
  std::vector<std::string> put_back();
  /// The NMT state in which the run has found the device, as far as it was told. Answers what could not be put back.
  [[nodiscard]] std::vector<std::string> find_state();
  [[nodiscard]] std::uint64_t lag() const { return lag_; }

 private:
  [[nodiscard]] LiveEntry live(std::uint16_t index, std::uint8_t sub_index) const;
  void record(const canopen::Frame& frame, canopen::TimePoint at, bool sent);
  void remember_entry(const LiveEntry& entry);
  void remember_configuration();
  void take_frame(Duration longest);
  [[nodiscard]] std::vector<std::string> restore_values(const Values& values, bool application);

  LiveBus& bus_;
  const Device& sheet_;
  Stimuli& stimuli_;
  DutSettings settings_;
  SdoAccess sdo_;
  std::mt19937 random_;

  std::vector<SeenFrame> frames_;  ///< of this case
  std::vector<std::string> warnings_;
  canopen::TimePoint last_time_;
  std::uint64_t elapsed_ = 0;  ///< microseconds since the run began, at last_time_
  std::uint64_t lag_ = 0;
  std::uint64_t case_began_ = 0;

  std::map<Key, Bytes> changed_;        ///< what was there before this case
  std::map<Key, Bytes> configuration_;  ///< of the whole device, before the first reset
  std::set<Key> unreadable_;            ///< written, and not to be read: not put back
  bool configuration_known_ = false;
  bool was_reset_ = false;
  bool state_changed_ = false;
  bool transfer_open_ = false;
  std::optional<Mark> failed_;  ///< where the case failed
  bool guarded_ = false;     ///< the state is asked for by remote frames
  Mark next_answer_ = 0;     ///< of `answer`
  Mark last_match_ = 0;      ///< of `wait_for`
  std::optional<canopen::NmtState> found_state_;  ///< before the run
};

/// `1017h:00`
[[nodiscard]] std::string label(std::uint16_t index, std::uint8_t sub_index);
/// The number of at most eight bytes, low byte first.
[[nodiscard]] std::uint64_t number_of(std::span<const std::uint8_t> bytes);
/// `0609 0011h, sub-index does not exist`, `no answer`, `done`, `the value 01 02`.
[[nodiscard]] std::string outcome_text(const SdoOutcome& outcome);
/// The same of an answer to `exchange`.
[[nodiscard]] std::string answer_text(const std::optional<canopen::sdo::Data>& answer);

}  // namespace edsc::conform
