#include "conform/case.hpp"

#include <algorithm>

namespace edsc::conform {
namespace {

constexpr AreaRow area_rows[] = {
    {"1", "EDS"},           {"2", "SDO"},
    {"3", "PDO"},           {"4", "Object dictionary"},
    {"5", "Emergency"},     {"6", "SYNC"},
    {"7", "Error control"}, {"8", "Stored parameters and CAN-IDs"},
    {"9", "NMT states"},    {"10", "NMT transitions"},
    {"11", "LSS"},          {"12", "Hostile"},
};

/// In the order in which they run. Tables of one area follow each other.
constexpr std::span<const CaseRow> (*case_tables[])() = {
    sheet_cases,
    sdo_access_cases,
    sdo_segment_cases,
    sdo_block_cases,
    sdo_parameter_cases,
    sdo_protocol_cases,
    pdo_parameter_cases,
    tpdo_event_cases,
    tpdo_sync_cases,
    tpdo_silence_cases,
    new_mapping_cases,
    refused_mapping_cases,
    rpdo_cases,
    dictionary_cases,
    write_cases,
    emergency_cases,
    emergency_register_cases,
    emergency_history_cases,
    sync_cases,
    guarding_cases,
    heartbeat_cases,
    error_control_cases,
    storage_cases,
    state_cases,
    error_behavior_cases,
    transition_cases,
    nmt_message_cases,
    lss_cases,
    hostile_frame_cases,
    hostile_sdo_cases,
};

}  // namespace

std::span<const AreaRow> areas() { return area_rows; }

std::vector<const CaseRow*> all_cases() {
  std::vector<const CaseRow*> all;
  for (const auto table : case_tables) {
    for (const CaseRow& row : table()) all.push_back(&row);
  }
  return all;
}

std::vector<const CaseRow*> cases_of(const AreaRow& area) {
  std::vector<const CaseRow*> cases = all_cases();
  std::erase_if(cases, [&](const CaseRow* row) { return area_of(*row).id != area.id; });
  return cases;
}

const AreaRow& area_of(const CaseRow& row) {
  const std::string_view id = row.id.substr(0, row.id.find('.'));
  return *std::ranges::find(area_rows, id, &AreaRow::id);
}

bool matches(std::string_view pattern, std::string_view id) {
  const std::size_t star = pattern.find('*');
  if (star == std::string_view::npos) return pattern == id;
  return id.starts_with(pattern.substr(0, star)) && id.ends_with(pattern.substr(star + 1)) &&
         id.size() + 1 >= pattern.size();
}

}  // namespace edsc::conform
