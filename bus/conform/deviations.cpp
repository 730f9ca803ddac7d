#include "conform/deviations.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cstddef>
#include <iterator>
#include <set>
#include <string_view>
#include <utility>

#include "conform/named_entries.hpp"
#include "device/device.hpp"
#include "diagnostics/place.hpp"
#include "json/json_file.hpp"
#include "text/ascii.hpp"
#include "text/suggestion.hpp"

namespace edsc::conform {
namespace {

using json = JsonFile::Json;

constexpr std::array<std::string_view, 2> file_members = {"$schema", "deviations"};

std::string set_case(Deviation& deviation, const std::string& text) {
  if (std::ranges::none_of(all_cases(), [&](const CaseRow* row) { return row->id == text; })) {
    return fmt::format("unknown case {}; edsc conform --list prints the cases", text);
  }
  deviation.id = text;
  return {};
}

std::string set_object(Deviation& deviation, const std::string& text) {
  deviation.object = parse_entry_address(text);
  return deviation.object ? "" : "expected an object or entry such as \"1800h\" or \"1800h:02\"";
}

template <std::string Deviation::*member>
std::string set_text(Deviation& deviation, const std::string& text) {
  deviation.*member = text;
  return {};
}

constexpr DeviationMember members[] = {
    {"case", true, "^[0-9]+\\.[0-9]+$", "number of the case, as printed by edsc conform --list", set_case},
    {"object", false,
     // As parse_entry_address() reads it: the sub-index is decimal after an index with 0x, else hexadecimal.
     R"(^\s*(0[xX][0-9A-Fa-f]{4}(:(0[xX]0*[0-9A-Fa-f]{1,2}|0*[0-9A-Fa-f]{1,2}[hH]|)"
     R"(0*([0-9]|[1-9][0-9]|1[0-9]{2}|2[0-4][0-9]|25[0-5])))?|)"
     R"([0-9A-Fa-f]{4}[hH]?(:(0[xX]0*[0-9A-Fa-f]{1,2}|0*[0-9A-Fa-f]{1,2}[hH]?))?)\s*$)",
     "object or entry for which the failure is expected; if missing, all", set_object},
    {"reason", true, "\\S", "behaviour of the device, and why", set_text<&Deviation::reason>},
    {"source", false, "\\S", "where it is documented: the manual, its page or line", set_text<&Deviation::source>},
};

class DeviationsReader {
 public:
  DeviationsReader(const SourceFile& source, Diagnostics& diagnostics) : file_{source}, diagnostics_{diagnostics} {}

  std::vector<Deviation> read() {
    for (const JsonFault& fault : file_.faults()) error(fault.position, fault.message, fault.notes);
    if (!file_.is_valid()) return {};
    const json& root = file_.root();
    if (!root.is_object()) {
      error(file_.value_position(root), "expected one JSON object");
      return {};
    }
    for (const auto& [name, value] : file_.members(root)) {
      if (name == "deviations") {
        deviations(*value);
      } else if (name != "$schema") {
        error(file_.name_position(*value), fmt::format("unknown member {}{}", name, did_you_mean(name, file_members)));
      }
    }
    if (!root.contains("deviations")) error(file_.value_position(root), "missing member deviations");
    return std::move(deviations_);
  }

 private:
  void deviations(const json& value) {
    const bool valid =
        value.is_array() && std::ranges::all_of(value, [](const json& item) { return item.is_object(); });
    if (!valid) {
      return error(file_.name_position(value),
                   R"(expected an array of objects: [{"case": "3.7", "object": "1800h:02", "reason": "..."}])");
    }
    for (const json& item : value) deviation(item);
  }

  void deviation(const json& item) {
    Deviation row;
    row.position = file_.value_position(item);
    bool valid = true;
    for (const auto& [name, value] : file_.members(item)) {
      const std::string problem = set_member(row, name, *value);
      valid = valid && problem.empty();
      if (!problem.empty()) error(file_.name_position(*value), problem);
    }
    for (const DeviationMember& member : members) {
      if (!member.is_required || item.contains(member.name)) continue;
      valid = false;
      error(row.position, fmt::format("missing member {}", member.name));
    }
    if (valid) deviations_.push_back(std::move(row));
  }

  /// Returns the problem of a member; empty: none.
  static std::string set_member(Deviation& row, const std::string& name, const json& value) {
    const auto* const member = std::ranges::find(members, std::string_view{name}, &DeviationMember::name);
    if (member == std::end(members)) {
      std::vector<std::string_view> names;
      for (const DeviationMember& one : members) names.push_back(one.name);
      return fmt::format("unknown member {}{}", name, did_you_mean(name, names));
    }
    const std::string text = value.is_string() ? value.get<std::string>() : std::string{};
    std::string problem = trim(text).empty() ? "expected a non-empty string" : member->set(row, text);
    return problem.empty() ? problem : fmt::format("{}: {}", name, problem);
  }

  void error(const Position& position, std::string message, std::vector<Note> notes = {}) {
    Diagnostic diagnostic;
    diagnostic.position = position;
    diagnostic.message = std::move(message);
    diagnostic.notes = std::move(notes);
    diagnostics_.report(std::move(diagnostic));
  }

  JsonFile file_;
  Diagnostics& diagnostics_;
  std::vector<Deviation> deviations_;
};

bool covers(const EntryAddress& declared, const EntryAddress& entry) {
  return declared.index == entry.index && (!declared.sub_index || declared.sub_index == entry.sub_index);
}

bool applies(const Deviation& deviation, const CaseResult& result, const std::vector<EntryAddress>& named) {
  if (deviation.id != result.row->id) return false;
  if (!deviation.object || named.empty()) return true;
  return std::ranges::any_of(named, [&](const EntryAddress& entry) { return covers(*deviation.object, entry); });
}

/// The case that compares the constants of 1000h to 1FFFh, of which the identity is a part.
constexpr std::string_view constants_case = "4.2";

void append_reason(std::string& text, std::set<std::string>& reasons, const Deviation& deviation) {
  const std::string reason = reason_of(deviation);
  if (!reasons.insert(reason).second) return;
  if (!text.empty()) text += "; ";
  text += reason;
}

}  // namespace

std::span<const DeviationMember> deviation_members() { return members; }

std::string reason_of(const Deviation& deviation) {
  return deviation.source.empty() ? deviation.reason : fmt::format("{} ({})", deviation.reason, deviation.source);
}

std::vector<Deviation> read_deviations(const SourceFile& source, Diagnostics& diagnostics) {
  return DeviationsReader{source, diagnostics}.read();
}

void apply_deviations(std::span<const Deviation> deviations, CaseResult& result) {
  if (result.verdict != Verdict::failed) return;
  const bool knows_each = !result.failed_entries.empty();
  const std::vector<EntryAddress> named =
      knows_each ? result.failed_entries : entries_in(result.expected + ' ' + result.got);
  std::vector<const Deviation*> declared;
  for (const Deviation& deviation : deviations) {
    if (applies(deviation, result, named)) declared.push_back(&deviation);
  }
  const auto is_declared = [&](const EntryAddress& entry) {
    return std::ranges::any_of(declared,
                               [&](const Deviation* row) { return !row->object || covers(*row->object, entry); });
  };
  if (declared.empty() || (knows_each && !std::ranges::all_of(named, is_declared))) return;
  result.verdict = Verdict::deviates;
  std::set<std::string> reasons;
  for (const Deviation* row : declared) append_reason(result.deviation, reasons, *row);
}

void apply_deviations(std::span<Deviation> deviations, RunReport& run) {
  std::string text;
  std::set<std::string> reasons;
  std::size_t declared = 0;
  for (const EntryAddress& entry : run.identity_entries) {
    bool is_declared = false;
    for (Deviation& deviation : deviations) {
      if (deviation.id != constants_case || !deviation.object || !covers(*deviation.object, entry)) continue;
      deviation.is_used = is_declared = true;
      append_reason(text, reasons, deviation);
    }
    if (is_declared) ++declared;
  }
  if (declared == run.identity_entries.size()) run.identity_deviation = text;
}

void find_unused_deviations(std::span<const Deviation> deviations, RunReport& run) {
  for (const Deviation& deviation : deviations) {
    if (deviation.is_used) continue;
    const auto found =
        std::ranges::find_if(run.cases, [&](const CaseResult& result) { return result.row->id == deviation.id; });
    if (found == run.cases.end() || found->verdict != Verdict::passed) continue;
    const Place place = place_of(deviation.position);
    run.unused_deviations.push_back(
        fmt::format("{}:{}: case {} passed: {}", place.file, place.line, deviation.id, reason_of(deviation)));
  }
}

}  // namespace edsc::conform
