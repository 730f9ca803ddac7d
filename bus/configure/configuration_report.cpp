#include "configure/configuration_report.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cstdint>
#include <string_view>
#include <utility>

#include "diagnostics/place.hpp"
#include "text/counted.hpp"

namespace edsc {
namespace {

using Json = nlohmann::ordered_json;

std::string_view verb_of(StepKind kind) {
  switch (kind) {
    case StepKind::write: return "write";
    case StepKind::switch_off: return "switch off";
    case StepKind::switch_on: return "switch on";
    case StepKind::clear: return "clear";
    case StepKind::restore: return "restore";
  }
  return {};
}

/// The value; of many bytes without a type, the first ones.
std::string shown(const LiveEntry& entry, const std::vector<std::uint8_t>& bytes) {
  constexpr std::size_t max_bytes = 32;
  if (entry.type != nullptr || bytes.size() <= max_bytes) return value_of(entry, bytes);
  LiveEntry domain = entry;
  set_type(domain, *canopen::find_data_type(static_cast<std::uint32_t>(canopen::DataType::domain)));
  return value_of(domain, bytes);
}

std::string written_by(const ConfigurationStep& step) {
  switch (step.kind) {
    case StepKind::write: return " = " + shown(step.entry, step.bytes);
    case StepKind::switch_on: return step.bytes.empty() ? " as before" : " = " + shown(step.entry, step.bytes);
    case StepKind::restore:
      return step.bytes.empty() ? " as before" : fmt::format(" as before, at least {}", shown(step.entry, step.bytes));
    case StepKind::switch_off:
    case StepKind::clear: break;
  }
  return {};
}

std::string compared_text(const ConfigurationRun& run) {
  const auto unknown = static_cast<std::size_t>(
      std::ranges::count_if(run.changes, [](const ConfigurationChange& change) { return !change.before.has_value(); }));
  const std::size_t differing = run.changes.size() - unknown;
  std::string text =
      fmt::format("{} of {} {}", differing, counted(run.compared, "value"), differing == 1 ? "differs" : "differ");
  if (unknown != 0) text += fmt::format(", {} cannot be compared", unknown);
  return text;
}

Json changes_json(const std::vector<ConfigurationChange>& changes) {
  Json rows = Json::array();
  for (const ConfigurationChange& change : changes) {
    Json row = entry_json(change.value.entry, &change.value);
    row["before"] = change.before ? Json(shown(change.value.entry, *change.before)) : Json(nullptr);
    row["wanted"] = wanted_text(change);
    rows.push_back(std::move(row));
  }
  return rows;
}

Json steps_json(const std::vector<ConfigurationStep>& steps) {
  Json rows = Json::array();
  for (const ConfigurationStep& step : steps) {
    Json row = entry_json(step.entry, step.value);
    row["action"] = verb_of(step.kind);
    const bool has_value = step.kind != StepKind::switch_off && step.kind != StepKind::clear && !step.bytes.empty();
    row["value"] = !has_value ? Json(nullptr) : Json(shown(step.entry, step.bytes));
    rows.push_back(std::move(row));
  }
  return rows;
}

Json failures_json(const std::vector<ConfigurationFailure>& failures) {
  Json rows = Json::array();
  for (const ConfigurationFailure& failure : failures) {
    Json row = entry_json(failure.entry, failure.value);
    row["text"] = failure.what;
    rows.push_back(std::move(row));
  }
  return rows;
}

}  // namespace

Json entry_json(const LiveEntry& entry, const ConfigurationValue* value) {
  Json row{{"index", entry_label(entry.index, entry.sub_index)}};
  row["name"] = entry.name.empty() ? Json(nullptr) : Json(entry.name);
  const bool placed = value != nullptr && value->position.file != nullptr;
  row["line"] = placed ? Json(origin_of(value->position).line) : Json(nullptr);
  return row;
}

std::string found_text(const ConfigurationChange& change) {
  if (change.before) return shown(change.value.entry, *change.before);
  const Entry* entry = change.value.entry.entry;
  return entry != nullptr && !canopen::readable(entry->access) ? "(write-only)" : "(cannot be read)";
}

std::string wanted_text(const ConfigurationChange& change) { return shown(change.value.entry, change.value.bytes); }

std::string change_text(const ConfigurationChange& change) {
  return fmt::format("{}: {} -> {}", title(change.value.entry), found_text(change), wanted_text(change));
}

std::string withheld_text(const ConfigurationRun& run, const ConfigurationChange& change) {
  if (!run.all) return change_text(change);
  return title(change.value.entry) + " = " + shown(change.value.entry, change.value.bytes);
}

std::string step_text(const ConfigurationStep& step) {
  return fmt::format("{:<10}  {}{}", verb_of(step.kind), title(step.entry), written_by(step));
}

std::string failure_text(const ConfigurationFailure& failure, std::string_view node) {
  std::string place = "edsc: ";
  if (failure.position.file != nullptr) {
    const Place found = place_of(failure.position);
    place = fmt::format("{}:{}:{}: error: ", found.file, found.line, found.column);
  }
  const std::string wanted = failure.value == nullptr ? "" : " = " + shown(failure.entry, failure.value->bytes);
  return fmt::format("{}{}{}{}: {}", place, node, title(failure.entry), wanted, failure.what);
}

std::string summary_text(const ConfigurationRun& run) {
  const ConfigurationResult& result = run.result;
  std::string text = fmt::format("node {}: ", run.node);
  if (!run.all) text += compared_text(run);
  if (run.dry_run) {
    text += "; nothing written";
  } else if (run.all || result.values != 0) {
    text += fmt::format("{}{} of {} written, {} verified", run.all ? "" : "; ", result.written,
                        counted(result.values, "value"), result.verified);
  }
  if (!result.failures.empty()) text += fmt::format(", {} failed", result.failures.size());
  if (run.left_out != 0) text += fmt::format(", {} skipped", run.left_out);
  if (!run.withheld.empty()) text += fmt::format(", {} not written (node-ID, bit rate)", run.withheld.size());
  if (run.time_written) text += ", 1020h written";
  if (run.stored) text += ", stored";
  return text;
}

Json as_json(const ConfigurationRun& run) {
  return {{"schema", 2},
          {"node_id", run.node},
          {"dry_run", run.dry_run},
          {"configured_already", !run.all && run.changes.empty() && run.withheld.empty()},
          {"compared", run.compared},
          {"changes", changes_json(run.changes)},
          {"withheld", changes_json(run.withheld)},
          {"steps", run.dry_run ? steps_json(run.steps) : Json::array()},
          {"values", run.result.values},
          {"written", run.result.written},
          {"verified", run.result.verified},
          {"left_out", run.left_out},
          {"time_written", run.time_written},
          {"stored", run.stored},
          {"failures", failures_json(run.result.failures)},
          {"problems", run.problems}};
}

}  // namespace edsc
