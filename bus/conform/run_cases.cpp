#include "conform/run_cases.hpp"

#include <fmt/format.h>

#include <algorithm>

#include "conform/drive.hpp"
#include "online/identity.hpp"
#include "online/interruption.hpp"

namespace edsc::conform {
namespace {

/// The first option that the case needs and the run does not have; empty: none.
std::string missing_permission(const CaseRow& row, const DutSettings& settings) {
  if (row.level > settings.level) {
    return fmt::format("needs --level {}", row_of(row.level).name);
  }
  for (const PermissionRow& option : permission_options) {
    if (includes(row.needs, option.permission) && !includes(settings.permissions, option.permission)) {
      return fmt::format("needs {}", option.option);
    }
  }
  return {};
}

bool is_selected(const CaseRow& row, const std::vector<std::string>& only) {
  return only.empty() ||
         std::ranges::any_of(only, [&](const std::string& pattern) { return matches(pattern, row.id); });
}

/// Runs the case and puts the values of the device back. Throws Interrupted and BusLost.
CaseResult run_case(const CaseRow& row, Dut& dut) {
  CaseResult result;
  result.row = &row;
  dut.begin_case(row);
  try {
    row.run(dut);
  } catch (CaseEnd& end) {
    result.verdict = end.verdict;
    result.reason = std::move(end.reason);
    result.expected = std::move(end.expected);
    result.got = std::move(end.got);
    result.rule = end.rule;
    result.failed_entries = std::move(end.failed_entries);
  }
  dut.end_case(result);
  return result;
}

void run_selected(const std::vector<const CaseRow*>& rows, Dut& dut, const RunSettings& settings, RunReport& report) {
  for (std::size_t i = 0; i != rows.size(); ++i) {
    settings.began(*rows[i], i, rows.size());
    CaseResult result;
    if (std::string missing = missing_permission(*rows[i], settings.dut); !missing.empty()) {
      result.row = rows[i];
      result.verdict = Verdict::not_run;
      result.reason = std::move(missing);
    } else {
      result = run_case(*rows[i], dut);
    }
    report.not_put_back.insert(report.not_put_back.end(), result.not_put_back.begin(), result.not_put_back.end());
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

/// Reads the identity of the device. Returns false if it does not answer.
bool find_device(LiveBus& bus, const Device& sheet, const DutSettings& settings, RunReport& report) {
  SdoAccess access{bus, settings.node, settings.sdo};
  const SdoOutcome answer = access.upload(0x1000, 0);
  if (answer.end == SdoEnd::no_answer) {
    report.lost = fmt::format("node {} does not answer", settings.node.value());
    return false;
  }
  const Identity found = read_identity(access).identity;
  report.read_identity = identity_text(found);
  report.identity = identity_differences(identity_of(sheet), found);
  refuse_enabled_drive(access, sheet, found, settings);
  return true;
}

}  // namespace

void run_cases(LiveBus& bus, const Device& sheet, Stimuli& stimuli, const RunSettings& settings, RunReport& report) {
  report.node = settings.dut.node.value();
  report.level = settings.dut.level;
  report.permissions = settings.dut.permissions;
  report.seed = settings.dut.seed;
  std::vector<const CaseRow*> rows = all_cases();
  std::erase_if(rows, [&](const CaseRow* row) { return !is_selected(*row, settings.only); });
  try {
    if (!find_device(bus, sheet, settings.dut, report)) return;
    Dut dut{bus, sheet, stimuli, settings.dut};
    try {
      report.not_put_back = dut.find_state();
      run_selected(rows, dut, settings, report);
    } catch (const Interrupted&) {
      report.interrupted = true;
      const std::vector<std::string> left = dut.put_back();
      report.not_put_back.insert(report.not_put_back.end(), left.begin(), left.end());
    }
  } catch (const BusLost& problem) {
    report.lost = fmt::format("the bus is lost: {}", problem.what());
  } catch (const Interrupted&) {
    report.interrupted = true;
  }
}

}  // namespace edsc::conform
