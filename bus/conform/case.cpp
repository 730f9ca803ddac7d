#include "conform/case.hpp"

#include <algorithm>

namespace edsc::conform {
namespace {

constexpr AreaRow area_rows[] = {
    {"1", "EDS", {sheet_cases}},
    {"2", "SDO", {sdo_access_cases, sdo_segment_cases, sdo_block_cases, sdo_parameter_cases}},
    {"3",
     "PDO",
     {pdo_parameter_cases, tpdo_event_cases, tpdo_sync_cases, tpdo_silence_cases, new_mapping_cases,
      refused_mapping_cases}},
    {"4", "Object dictionary", {dictionary_cases, write_cases}},
    {"5", "Emergency", {emergency_cases}},
    {"6", "SYNC", {sync_cases}},
    {"7", "Error control", {guarding_cases, heartbeat_cases, error_control_cases}},
    {"8", "Stored parameters and CAN-IDs", {storage_cases}},
    {"9", "NMT states", {state_cases}},
    {"10", "NMT transitions", {transition_cases}},
    {"11", "LSS", {lss_cases}},
};

}  // namespace

std::span<const AreaRow> areas() { return area_rows; }

std::vector<const CaseRow*> cases_of(const AreaRow& area) {
  std::vector<const CaseRow*> cases;
  for (const CaseTable table : area.tables) {
    if (table == nullptr) continue;
    for (const CaseRow& row : table()) cases.push_back(&row);
  }
  return cases;
}

std::vector<const CaseRow*> all_cases() {
  std::vector<const CaseRow*> all;
  for (const AreaRow& area : area_rows) {
    for (const CaseRow* row : cases_of(area)) all.push_back(row);
  }
  return all;
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
