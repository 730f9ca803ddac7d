#include "accept/acceptance.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <utility>

#include "conform/report/report_facts.hpp"
#include "text/counted.hpp"

namespace edsc::accept {
namespace {

/// The area of the cases about the object dictionary.
constexpr std::string_view dictionary_cases = "4.";

bool covers(const conform::Deviation& deviation, const Difference& difference) {
  if (!deviation.id.starts_with(dictionary_cases) || !deviation.object) return false;
  const EntryAddress& object = *deviation.object;
  return object.index == difference.index && (!object.sub_index || *object.sub_index == difference.sub_index);
}

/// An identity that no entry of the comparison shows, such as a number of [DeviceInfo] without 1018h.
bool is_shown(const Comparison& comparison, const IdentityNumber& number) {
  return std::ranges::any_of(comparison.differences, [&](const Difference& difference) {
    return difference.index == number.index && difference.sub_index == number.sub_index;
  });
}

}  // namespace

std::vector<IdentityRow> Acceptance::identity() const {
  std::vector<IdentityRow> rows;
  for (const IdentityNumber& number : identity_numbers) {
    IdentityRow row{&number, comparison.in_eds.*number.value, comparison.in_device.*number.value, false};
    row.differs = row.in_eds && row.in_device && row.in_eds != row.in_device;
    if (row.in_eds || row.in_device) rows.push_back(row);
  }
  return rows;
}

std::vector<std::string> Acceptance::objections() const {
  std::vector<std::string> list;
  if (findings.errors() > 0) list.push_back(fmt::format("the EDS has {}", counted(findings.errors(), "error")));
  if (!comparison.lost.empty()) list.push_back(fmt::format("the comparison ended early: {}", comparison.lost));
  if (comparison.interrupted) list.emplace_back("the comparison was interrupted");
  for (const IdentityRow& row : identity()) {
    if (row.differs && !is_shown(comparison, *row.number)) {
      list.push_back(
          fmt::format("{} {:08X}h differs from the EDS, {:08X}h", row.number->name, *row.in_device, *row.in_eds));
    }
  }
  if (const std::size_t count = comparison.undeclared(); count > 0) {
    list.push_back(fmt::format("the dictionary of the device and the EDS have {}", counted(count, "difference")));
  }
  if (!run.passed()) list.push_back(fmt::format("conformance test failed: {}", conform::verdict_sentence(run)));
  return list;
}

void apply_deviations(std::span<const conform::Deviation> deviations, Comparison& comparison) {
  for (Difference& difference : comparison.differences) {
    const auto found = std::ranges::find_if(
        deviations, [&](const conform::Deviation& deviation) { return covers(deviation, difference); });
    if (found == deviations.end()) continue;
    difference.deviation = found->source.empty() ? found->reason : fmt::format("{} ({})", found->reason, found->source);
  }
}

std::string differences_sentence(const Comparison& comparison) {
  if (comparison.differences.empty()) return comparison.is_complete() ? "no difference" : "not complete";
  std::string text = counted(comparison.differences.size(), "difference");
  std::string_view separator = ": ";
  for (const MarkRow& row : marks) {
    const std::size_t count = comparison.count(row.mark);
    if (count == 0) continue;
    text += fmt::format("{}{} {}", separator, count, row.text);
    separator = ", ";
  }
  const std::size_t declared = comparison.differences.size() - comparison.undeclared();
  if (declared > 0) text += fmt::format("; {} declared", declared);
  return text;
}

std::string entries_sentence(const Comparison& comparison) {
  const auto read = std::ranges::count_if(
      comparison.entries, [](const ComparedEntry& entry) { return entry.exists != Aspect::not_compared; });
  return fmt::format("{} of {} compared", read, counted(comparison.entries.size(), "entry", "entries"));
}

std::string result_text(const ComparedEntry& entry) {
  if (entry.exists == Aspect::differs) return entry.in_eds ? "missing in the device" : "missing in the EDS";
  const std::pair<Aspect, std::string_view> rows[] = {{entry.length, "length differs"},
                                                      {entry.readable, "access differs"},
                                                      {entry.value, "value differs"},
                                                      {entry.limits, "outside its limits"}};
  std::string text;
  for (const auto& [aspect, what] : rows) {
    if (aspect == Aspect::differs) text += fmt::format("{}{}", text.empty() ? "" : ", ", what);
  }
  if (!text.empty()) return text;
  if (entry.value == Aspect::may_differ) return "differs from its default value, as stored or live values may";
  if (!entry.remark.empty()) return entry.remark;
  return entry.exists == Aspect::not_compared ? "not compared" : "same";
}

bool differs(const ComparedEntry& entry) {
  const Aspect all[] = {entry.exists, entry.length, entry.readable, entry.value, entry.limits};
  return std::ranges::find(all, Aspect::differs) != std::end(all);
}

std::string correction_text(const Correction& correction) {
  return fmt::format("[{}] {}", correction.section, overlay_line(correction));
}

}  // namespace edsc::accept
