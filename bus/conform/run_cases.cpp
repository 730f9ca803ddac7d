#include "conform/run_cases.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>

#include "conform/cases/shared/every_frame.hpp"
#include "conform/drive.hpp"
#include "online/identity.hpp"
#include "online/interruption.hpp"

namespace edsc::conform {
namespace {

/// The options that the case needs and the run does not have: `needs --level communication, --store and --outputs`;
/// empty: none.
std::string missing_permission(const CaseRow& row, const DutSettings& settings) {
  std::vector<std::string> missing;
  if (row.level > settings.level) missing.push_back(fmt::format("--level {}", row_of(row.level).name));
  for (const PermissionRow& option : permission_options) {
    if (row.level >= Level::all || includes(settings.permissions, option.permission)) continue;
    if (includes(row.needs, option.permission)) missing.emplace_back(option.option);
  }
  if (missing.empty()) return {};
  const std::string last = std::move(missing.back());
  missing.pop_back();
  return missing.empty() ? "needs " + last : fmt::format("needs {} and {}", fmt::join(missing, ", "), last);
}

bool is_selected(const CaseRow& row, const std::vector<std::string>& only) {
  return only.empty() ||
         std::ranges::any_of(only, [&](const std::string& pattern) { return matches(pattern, row.id); });
}

void set_unmet(CaseResult& result, Unmet unmet) {
  result.verdict = Verdict::inconclusive;
  result.condition = unmet.condition;
  result.reason = std::move(unmet.reason);
}

/// Runs the case once and puts the values of the device back. Throws Interrupted and BusLost.
CaseResult run_once(const CaseRow& row, Dut& dut) {
  CaseResult result;
  result.row = &row;
  dut.begin_case(row);
  try {
    row.run(dut);
    expect_valid_frames(dut, row);
  } catch (CaseEnd& end) {
    result.verdict = end.verdict;
    result.reason = std::move(end.reason);
    result.expected = std::move(end.expected);
    result.got = std::move(end.got);
    result.rule = end.rule;
    result.failed_entries = std::move(end.failed_entries);
    result.condition = end.condition;
  }
  const bool is_of_device = result.verdict == Verdict::failed && result.rule.text().empty();
  if (is_of_device) {
    if (auto unmet = dut.unmet_condition(row)) set_unmet(result, std::move(*unmet));
  }
  if (result.verdict == Verdict::passed) {
    // Silence after a remote frame that was not transmitted proves nothing.
    if (auto unmet = dut.unmet_remote_frames(row)) set_unmet(result, std::move(*unmet));
  }
  dut.end_case(result);
  return result;
}

std::string why_twins(canopen::NodeId node) {
  return fmt::format(
      "each request is answered twice: two devices have node-ID {}, or the device sends each response twice",
      node.value());
}

/// Why the run cannot continue after a case; empty: it can. A device that is silent may respond again after a reset.
std::string why_lost(CaseResult& result, Dut& dut) {
  const auto other = dut.other_boot_up();
  if (!dut.responds()) {
    dut.start_again();
    if (dut.responds()) {
      result.warnings.emplace_back("after the case the device responded only when it was reset");
      return {};
    }
    std::string reason = fmt::format("node {} no longer responds since case {} ({})", dut.node().value(),
                                     result.row->id, result.row->title);
    if (other) reason += fmt::format("; a boot-up message of node {} was received during it", other->value());
    return reason;
  }
  if (result.verdict == Verdict::failed && dut.has_twin()) return why_twins(dut.node());
  return {};
}

/// A failure that ends the run proves nothing about the requirement of the case.
void end_run(CaseResult& result, std::string reason, RunReport& report) {
  if (result.verdict == Verdict::failed) {
    result.verdict = Verdict::inconclusive;
    result.condition = Condition::reachable;
    result.reason = reason;
  }
  report.lost = std::move(reason);
}

/// Runs the case, and again if it has failed: a failure must repeat.
CaseResult run_case(const CaseRow& row, Dut& dut, RunReport& report) {
  CaseResult first = run_once(row, dut);
  if (std::string reason = why_lost(first, dut); !reason.empty()) {
    end_run(first, std::move(reason), report);
    return first;
  }
  if (first.verdict != Verdict::failed || !first.rule.text().empty()) return first;
  dut.start_again();
  CaseResult second = run_once(row, dut);
  second.not_restored.insert(second.not_restored.end(), first.not_restored.begin(), first.not_restored.end());
  if (std::string reason = why_lost(second, dut); !reason.empty()) end_run(second, std::move(reason), report);
  if (second.verdict == Verdict::failed) return second;
  const auto frames = first.verdict_frames();
  second.first_run = FirstRun{
      std::move(first.expected), std::move(first.got), {frames.begin(), frames.end()}, std::move(first.failed_frames)};
  if (second.verdict != Verdict::inconclusive) {
    second.reason = fmt::format("failed, and the repetition has the verdict {}", row_of(second.verdict).text);
    second.verdict = Verdict::inconclusive;
  }
  return second;
}

void run_selected(const std::vector<const CaseRow*>& rows, Dut& dut, const RunSettings& settings, RunReport& report) {
  for (std::size_t i = 0; i != rows.size() && report.lost.empty(); ++i) {
    settings.began(*rows[i], i, rows.size());
    CaseResult result;
    if (std::string missing = missing_permission(*rows[i], settings.dut); !missing.empty()) {
      result.row = rows[i];
      result.verdict = Verdict::not_run;
      result.reason = std::move(missing);
    } else {
      result = run_case(*rows[i], dut, report);
    }
    report.not_restored.insert(report.not_restored.end(), result.not_restored.begin(), result.not_restored.end());
    report.cases.push_back(std::move(result));
    settings.ended(report.cases.back());
  }
}

std::string identity_text(const Identity& identity) {
  std::string text;
  for (const IdentityNumber& row : identity_numbers) {
    const std::optional<std::uint32_t> number = identity.*row.value;
    if (!number) continue;
    text += fmt::format("{}{} {:04X} {:04X}h", text.empty() ? "" : ", ", row.name, *number >> 16, *number & 0xFFFF);
  }
  return text;
}

/// Throws RunRefused for a drive that the permissions of the run may move.
void refuse_enabled_drive(SdoAccess& node, const Device& sheet, const Identity& found, const DutSettings& settings) {
  const bool writes = includes(settings.permissions, Permission::application) && settings.level != Level::read;
  if (settings.simulated || (!writes && !includes(settings.permissions, Permission::outputs))) return;
  const std::string reason = why_drive_may_move(node, sheet, found);
  if (reason.empty()) return;
  throw RunRefused{
      fmt::format("node {} is a drive (device type 402) that may move: {}. Disable it, or omit --outputs, "
                  "--application and --level all",
                  settings.node.value(), reason)};
}

/// The numbers that both state and that differ.
std::vector<IdentityNumber> differing_numbers(const Identity& stated, const Identity& found) {
  std::vector<IdentityNumber> numbers;
  for (const IdentityNumber& number : identity_numbers) {
    const auto &in_eds = stated.*number.value, &in_device = found.*number.value;
    if (in_eds && in_device && *in_eds != *in_device) numbers.push_back(number);
  }
  return numbers;
}

/// Why the run must not write to the device: it is another product. Empty: it may. Nothing can be damaged in simulated
/// time.
std::string why_not_written(const Identity& stated, const Identity& found, const RunSettings& settings,
                            const RunReport& report) {
  const bool writes = settings.dut.level != Level::read || settings.dut.permissions != Permission::none;
  if (!writes || settings.force || settings.dut.simulated) return {};
  const auto numbers = differing_numbers(stated, found);
  const bool is_other_product = std::ranges::any_of(numbers, [](const IdentityNumber& number) {
    return number.value == &Identity::vendor_id || number.value == &Identity::product_code;
  });
  if (!is_other_product) return {};
  return fmt::format(
      "node {} is not the device of {}: {}; nothing was written; --level read only reads, --force writes anyway",
      report.node, report.sheet, report.identity);
}

/// Reads the identity of the device. Returns false if the run cannot begin: the device does not respond in time, two
/// devices respond, or it is another product.
bool find_device(LiveBus& bus, const Device& sheet, const RunSettings& run, Dut& dut, RunReport& report) {
  const DutSettings& settings = run.dut;
  SdoAccess access{bus, settings.node, settings.sdo};
  if (access.upload(device_type, 0).end == SdoEnd::no_answer) {
    report.lost = fmt::format("node {} does not respond within {} ms", settings.node.value(), settings.sdo.timeout_ms);
    if (dut.responds()) {
      report.lost += "; it responds later: give a longer --timeout";
    } else if (dut.has_sent_response()) {
      report.lost =
          fmt::format("node {} sends SDO responses, but none for 1000h:00, which was requested", settings.node.value());
    }
    return false;
  }
  if (dut.has_twin()) {
    report.lost = why_twins(settings.node);
    return false;
  }
  const Identity found = read_identity(access).identity;
  report.read_identity = identity_text(found);
  const Identity stated = identity_of(sheet);
  report.identity = identity_differences(stated, found);
  for (const IdentityNumber& number : differing_numbers(stated, found)) {
    report.identity_entries.push_back({number.index, number.sub_index});
  }
  report.lost = why_not_written(stated, found, run, report);
  if (!report.lost.empty()) return false;
  refuse_enabled_drive(access, sheet, found, settings);
  return true;
}

}  // namespace

void run_cases(LiveBus& bus, const Device& sheet, Stimuli& stimuli, const RunSettings& settings, RunReport& report) {
  report.node = settings.dut.node.value();
  report.level = settings.dut.level;
  report.permissions = settings.dut.permissions;
  report.force = settings.force;
  report.seed = settings.dut.seed;
  std::vector<const CaseRow*> rows = all_cases();
  std::erase_if(rows, [&](const CaseRow* row) { return !is_selected(*row, settings.only); });
  try {
    Dut dut{bus, sheet, stimuli, settings.dut};
    dut.on_record = [&report](const SeenFrame& seen) { report.frames.push_back(seen); };
    if (!find_device(bus, sheet, settings, dut, report)) return;
    try {
      report.not_restored = dut.find_state();
      run_selected(rows, dut, settings, report);
      const std::vector<std::string> left = dut.restore_changed();
      report.not_restored.insert(report.not_restored.end(), left.begin(), left.end());
    } catch (const Interrupted&) {
      report.interrupted = true;
      const std::vector<std::string> left = dut.restore_changed();
      report.not_restored.insert(report.not_restored.end(), left.begin(), left.end());
    }
  } catch (const BusLost& problem) {
    report.lost = fmt::format("the bus is lost: {}", problem.what());
  } catch (const Interrupted&) {
    report.interrupted = true;
  }
}

}  // namespace edsc::conform
