#include "accept/acceptance.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cstddef>
#include <iterator>
#include <utility>

#include "conform/report/report_facts.hpp"
#include "text/counted.hpp"

namespace edsc::accept {
namespace {

/// An identity that no entry of the comparison shows, such as a number of [DeviceInfo] without 1018h.
bool is_shown(const Comparison& comparison, const IdentityNumber& number) {
  return std::ranges::any_of(comparison.differences, [&](const Difference& difference) {
    return difference.index == number.index && difference.sub_index == number.sub_index;
  });
}

}  // namespace

std::vector<IdentityRow> Acceptance::identity() const {
  std::vector<IdentityRow> rows;
  for (std::size_t i = 0; i != std::size(identity_numbers); ++i) {
    const IdentityNumber& number = identity_numbers[i];
    IdentityRow row{&number, comparison.in_eds.*number.value, comparison.in_device.*number.value,
                    comparison.differs(number), comparison.identity_deviations[i]};
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
    if (row.differs && row.deviation.empty() && !is_shown(comparison, *row.number)) {
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

std::string headline(const Acceptance& acceptance) {
  if (!acceptance.objections().empty()) return "not accepted";
  const std::string coverage = conform::coverage_text(acceptance.run);
  return coverage.empty() ? "accepted" : fmt::format("accepted ({})", coverage);
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
