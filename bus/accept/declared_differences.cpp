#include "accept/declared_differences.hpp"

#include <algorithm>
#include <cstddef>
#include <iterator>
#include <string>

#include "device/objects/object_structure.hpp"

namespace edsc::accept {
namespace {

constexpr IndexRange communication{0x1000, 0x1FFF}, application{0x2000, 0xFFFF}, all_objects{0x1000, 0xFFFF};
constexpr std::string_view communication_text = "1000h to 1FFFh", application_text = "2000h and above";

constexpr Kind read_kinds[] = {Kind::object_missing, Kind::sub_index_missing, Kind::not_in_eds, Kind::length,
                               Kind::access,         Kind::unreadable,        Kind::no_response};
constexpr Kind value_kinds[] = {Kind::value};
constexpr Kind access_kinds[] = {Kind::access};
constexpr Kind structure_kinds[] = {Kind::sub_index_missing, Kind::length,     Kind::access, Kind::value,
                                    Kind::unreadable,        Kind::no_response};
constexpr Kind limit_kinds[] = {Kind::limit};

constexpr DeclaringCase rows[] = {
    {"4.1", communication, communication_text, read_kinds},
    {"4.2", communication, communication_text, value_kinds},
    {"4.4", all_objects, "all", access_kinds},
    {"4.5", all_objects, "sub-index FFh of all", structure_kinds, true},
    {"4.6", all_objects, "all", limit_kinds},
    {"4.7", application, application_text, read_kinds},
    {"4.8", application, application_text, value_kinds},
};

/// Marks the deviations that cover the difference. Returns the reason of the first one; empty: none.
std::string declare(std::span<conform::Deviation> deviations, Kind kind, std::uint16_t index, std::uint8_t sub_index) {
  std::string reason;
  for (conform::Deviation& deviation : deviations) {
    if (!covers(deviation, kind, index, sub_index)) continue;
    deviation.is_used = true;
    if (reason.empty()) reason = conform::reason_of(deviation);
  }
  return reason;
}

}  // namespace

std::span<const DeclaringCase> declaring_cases() { return rows; }

bool covers(const conform::Deviation& deviation, Kind kind, std::uint16_t index, std::uint8_t sub_index) {
  if (!deviation.object || deviation.object->index != index) return false;
  if (deviation.object->sub_index && deviation.object->sub_index != sub_index) return false;
  return std::ranges::any_of(rows, [&](const DeclaringCase& row) {
    return row.id == deviation.id && index >= row.objects.first && index <= row.objects.last &&
           std::ranges::find(row.kinds, kind) != row.kinds.end() &&
           (!row.only_sub_index_255 || sub_index == structure_sub_index);
  });
}

void apply_deviations(std::span<conform::Deviation> deviations, Comparison& comparison) {
  for (Difference& difference : comparison.differences) {
    difference.deviation = declare(deviations, difference.kind, difference.index, difference.sub_index);
  }
  for (std::size_t i = 0; i != std::size(identity_numbers); ++i) {
    const IdentityNumber& number = identity_numbers[i];
    if (!comparison.differs(number)) continue;
    comparison.identity_deviations[i] = declare(deviations, Kind::value, number.index, number.sub_index);
  }
}

}  // namespace edsc::accept
