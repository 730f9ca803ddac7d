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
  communication,  ///< writes 1000h to 1FFFh and puts back; NMT to this node
  all,            ///< everything, with all of `Permission`
};

struct LevelRow {
  Level level;
  std::string_view name;  ///< of `--level`, and in reports
};

inline constexpr LevelRow levels[] = {
    {Level::read, "read"},
    {Level::communication, "communication"},
    {Level::all, "all"},
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

/// `run` returns if the device passes. A member of Dut ends it with any other verdict.
struct CaseRow {
  std::string_view id;      ///< `2.5`: area and number
  std::string_view title;   ///< the requirement as a sentence
  std::string_view clause;  ///< `CiA 301, 7.2.4.3.4`
  Level level = Level::read;
  Permission needs = Permission::none;
  void (*run)(Dut&) = nullptr;
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
[[nodiscard]] std::span<const CaseRow> pdo_parameter_cases();
[[nodiscard]] std::span<const CaseRow> tpdo_event_cases();
[[nodiscard]] std::span<const CaseRow> tpdo_sync_cases();
[[nodiscard]] std::span<const CaseRow> tpdo_silence_cases();
[[nodiscard]] std::span<const CaseRow> new_mapping_cases();
[[nodiscard]] std::span<const CaseRow> refused_mapping_cases();
[[nodiscard]] std::span<const CaseRow> dictionary_cases();
[[nodiscard]] std::span<const CaseRow> write_cases();
[[nodiscard]] std::span<const CaseRow> emergency_cases();
[[nodiscard]] std::span<const CaseRow> sync_cases();
[[nodiscard]] std::span<const CaseRow> guarding_cases();
[[nodiscard]] std::span<const CaseRow> heartbeat_cases();
[[nodiscard]] std::span<const CaseRow> error_control_cases();
[[nodiscard]] std::span<const CaseRow> storage_cases();
[[nodiscard]] std::span<const CaseRow> state_cases();
[[nodiscard]] std::span<const CaseRow> transition_cases();
[[nodiscard]] std::span<const CaseRow> lss_cases();

}  // namespace edsc::conform
