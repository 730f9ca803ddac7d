/// The table of the cases of the conformance test: requirement, clause of the standard, and what a case may do to a
/// device.
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <string_view>
#include <vector>

namespace edsc::conform {

class Dut;

/// What a run may do to the device. Each level includes those before it.
enum class Level : std::uint8_t {
  read,           ///< reads, and requests that each device must refuse without being written
  communication,  ///< writes 1000h to 1FFFh and restores; NMT to this node
  all,            ///< all of `Permission`, and each case but the hostile ones
  hostile,        ///< `all`, and malformed, late, random and repeated frames: only by its name
};

struct LevelRow {
  Level level;
  std::string_view name;  ///< of `--level`, and in reports
};

inline constexpr LevelRow levels[] = {
    {Level::read, "read"},
    {Level::communication, "communication"},
    {Level::all, "all"},
    {Level::hostile, "hostile"},
};

[[nodiscard]] constexpr const LevelRow& row_of(Level level) { return levels[static_cast<std::size_t>(level)]; }

/// What a case needs besides its level. The user allows each by its own option, or all by `Level::all`.
enum class Permission : std::uint8_t {
  none = 0,
  store = 1,        ///< 1010h and 1011h: `--store`
  application = 2,  ///< writes 2000h and above: `--application`
  outputs = 4,      ///< sends RPDOs and produces SYNC: `--outputs`
};

[[nodiscard]] constexpr Permission operator|(Permission a, Permission b) {
  return static_cast<Permission>(static_cast<unsigned>(a) | static_cast<unsigned>(b));
}
[[nodiscard]] constexpr bool includes(Permission all, Permission some) {
  return (static_cast<unsigned>(all) & static_cast<unsigned>(some)) == static_cast<unsigned>(some);
}

struct PermissionRow {
  Permission permission;
  std::string_view option;
};

inline constexpr PermissionRow permission_options[] = {
    {Permission::store, "--store"},
    {Permission::application, "--application"},
    {Permission::outputs, "--outputs"},
};

/// What a case needs of the bus, the host and the device, besides the behaviour that it tests. A failure without it
/// proves nothing: the case is inconclusive.
enum class Condition : std::uint8_t {
  none = 0,
  state = 1,          ///< the device is in the NMT state of the last NMT command
  remote_frames = 2,  ///< the bus carries remote frames
  usable_value = 4,   ///< an object has a value that the case can use
  stimulus = 8,       ///< a stimulus exists and comes in time
  punctual = 16,      ///< the test, and a device on the same host, are not late
  alone = 32,         ///< no other node is on the bus
  error_free = 64,    ///< 1001h:00 is 0: an error may change the NMT state (1029h)
  reachable = 128,    ///< the device responds with its node-ID; each case needs it
};

[[nodiscard]] constexpr Condition operator|(Condition a, Condition b) {
  return static_cast<Condition>(static_cast<unsigned>(a) | static_cast<unsigned>(b));
}
[[nodiscard]] constexpr bool includes(Condition all, Condition some) {
  return (static_cast<unsigned>(all) & static_cast<unsigned>(some)) == static_cast<unsigned>(some);
}

struct ConditionRow {
  Condition condition;
  std::string_view name;  ///< in JSON
  std::string_view text;  ///< in reports
};

inline constexpr ConditionRow conditions[] = {
    {Condition::state, "state", "NMT state"},
    {Condition::remote_frames, "remote_frames", "remote frames"},
    {Condition::usable_value, "usable_value", "usable value"},
    {Condition::stimulus, "stimulus", "stimulus"},
    {Condition::punctual, "punctual", "delay"},
    {Condition::alone, "alone", "other nodes"},
    {Condition::error_free, "error_free", "error of the device"},
    {Condition::reachable, "reachable", "presence"},
};

/// `run` returns if the device passes. A member of Dut ends it with any other verdict.
struct CaseRow {
  std::string_view id;      ///< `2.5`: area and number
  std::string_view title;   ///< the requirement as a sentence
  std::string_view clause;  ///< `CiA 301, 7.2.4.3.4`
  Level level = Level::read;
  Permission needs = Permission::none;
  void (*run)(Dut&) = nullptr;
  Condition relies_on = Condition::none;  ///< besides `reachable`
  std::string_view cause{};               ///< id of the case whose failure also fails this one
};

/// `run` of cases that differ in a value: `with<write_in_block, guard_time>` calls `write_in_block(dut, guard_time)`.
template <auto steps, auto... arguments>
void with(Dut& dut) {
  steps(dut, arguments...);
}

struct AreaRow {
  std::string_view id;     ///< `2`: the first part of the ids of its cases
  std::string_view title;  ///< `SDO`
};

/// The areas in the order in which they run.
[[nodiscard]] std::span<const AreaRow> areas();

/// The cases of an area; all cases, area by area. Each in the order in which they run.
[[nodiscard]] std::vector<const CaseRow*> cases_of(const AreaRow& area);
[[nodiscard]] std::vector<const CaseRow*> all_cases();

/// The area that a case belongs to.
[[nodiscard]] const AreaRow& area_of(const CaseRow& row);

/// Whether a pattern names the case: `2.5`, `3.*`, `*`.
[[nodiscard]] bool matches(std::string_view pattern, std::string_view id);

// One file in cases/ for each table.
[[nodiscard]] std::span<const CaseRow> sheet_cases();
[[nodiscard]] std::span<const CaseRow> sdo_access_cases();
[[nodiscard]] std::span<const CaseRow> sdo_segment_cases();
[[nodiscard]] std::span<const CaseRow> sdo_block_cases();
[[nodiscard]] std::span<const CaseRow> sdo_parameter_cases();
[[nodiscard]] std::span<const CaseRow> sdo_protocol_cases();
[[nodiscard]] std::span<const CaseRow> pdo_parameter_cases();
[[nodiscard]] std::span<const CaseRow> tpdo_event_cases();
[[nodiscard]] std::span<const CaseRow> tpdo_sync_cases();
[[nodiscard]] std::span<const CaseRow> tpdo_silence_cases();
[[nodiscard]] std::span<const CaseRow> new_mapping_cases();
[[nodiscard]] std::span<const CaseRow> refused_mapping_cases();
[[nodiscard]] std::span<const CaseRow> rpdo_cases();
[[nodiscard]] std::span<const CaseRow> dictionary_cases();
[[nodiscard]] std::span<const CaseRow> write_cases();
[[nodiscard]] std::span<const CaseRow> emergency_cases();
[[nodiscard]] std::span<const CaseRow> emergency_register_cases();
[[nodiscard]] std::span<const CaseRow> emergency_history_cases();
[[nodiscard]] std::span<const CaseRow> sync_cases();
[[nodiscard]] std::span<const CaseRow> guarding_cases();
[[nodiscard]] std::span<const CaseRow> heartbeat_cases();
[[nodiscard]] std::span<const CaseRow> error_control_cases();
[[nodiscard]] std::span<const CaseRow> storage_cases();
[[nodiscard]] std::span<const CaseRow> state_cases();
[[nodiscard]] std::span<const CaseRow> error_behavior_cases();
[[nodiscard]] std::span<const CaseRow> transition_cases();
[[nodiscard]] std::span<const CaseRow> nmt_message_cases();
[[nodiscard]] std::span<const CaseRow> lss_cases();
[[nodiscard]] std::span<const CaseRow> hostile_frame_cases();
[[nodiscard]] std::span<const CaseRow> hostile_sdo_cases();

}  // namespace edsc::conform
