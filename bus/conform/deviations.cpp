#include "conform/deviations.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <iterator>
#include <map>
#include <nlohmann/json.hpp>
#include <set>
#include <string_view>

#include "device/device.hpp"
#include "diagnostics/place.hpp"
#include "text/ascii.hpp"
#include "text/suggestion.hpp"

namespace edsc::conform {
namespace {

using json = nlohmann::ordered_json;  // errors in the order of the file

constexpr std::array<std::string_view, 2> file_members = {"$schema", "deviations"};
constexpr std::array<std::string_view, 4> deviation_members = {"case", "object", "reason", "source"};

/// Iterates over the characters of a text and records how far the parser has read.
class CountedText {
 public:
  using iterator_category = std::input_iterator_tag;
  using value_type = char;
  using difference_type = std::ptrdiff_t;
  using pointer = const char*;
  using reference = const char&;

  CountedText(const char* at, const char** taken) : at_{at}, taken_{taken} {}

  reference operator*() const { return *at_; }
  CountedText& operator++() {
    ++at_;
    if (taken_ != nullptr) *taken_ = at_;
    return *this;
  }
  friend bool operator==(const CountedText& a, const CountedText& b) { return a.at_ == b.at_; }

 private:
  const char* at_;
  const char** taken_;
};

class DeviationsReader {
 public:
  DeviationsReader(const SourceFile& source, Diagnostics& diagnostics) : source_{source}, diagnostics_{diagnostics} {
    for (const CaseRow* row : all_cases()) case_ids_.push_back(row->id);
  }

  std::vector<Deviation> read() {
    const std::optional<json> document = parse();
    if (!document) return {};
    if (!document->is_object()) {
      error(Position{&source_, 1, 1}, "expected one JSON object");
      return {};
    }
    bool has_deviations = false;
    for (const auto& [name, value] : document->items()) {
      if (name == "deviations") {
        has_deviations = true;
        deviations(value);
      } else if (name != "$schema") {
        error(position_of(name), fmt::format("unknown member {}{}", name, did_you_mean(name, file_members)));
      }
    }
    if (!has_deviations) error(Position{&source_, 1, 1}, "missing member deviations");
    return std::move(deviations_);
  }

 private:
  /// Positions of an object of the file and of the names of its members.
  struct Places {
    Position begin;
    std::map<std::string, Position, std::less<>> members;
  };

  std::optional<json> parse() {
    const std::string_view text = source_.text();
    const char* taken = text.data();
    const char* token = text.data();  // at the next token, or before it
    const auto note_place = [&](int depth, json::parse_event_t event, json& parsed) {
      while (token < taken && std::string_view{" \t\r\n,:"}.find(*token) != std::string_view::npos) ++token;
      const Position position = position_at(static_cast<std::size_t>(token - text.data()));
      token = taken;
      if (event == json::parse_event_t::object_start && depth == 2 && in_deviations_) rows_.push_back({position, {}});
      if (event == json::parse_event_t::key) note_member(depth, parsed.get<std::string>(), position);
      return true;
    };
    try {
      return json::parse(CountedText{text.data(), &taken}, CountedText{text.data() + text.size(), nullptr}, note_place);
    } catch (const json::parse_error& problem) {
      error(position_at(std::max<std::size_t>(problem.byte, 1) - 1), fmt::format("not JSON: {}", what_of(problem)));
    } catch (const json::out_of_range& problem) {
      error(Position{&source_, 1, 1}, fmt::format("not JSON: {}", what_of(problem)));
    }
    return std::nullopt;
  }

  void note_member(int depth, const std::string& name, const Position& position) {
    if (depth == 1) in_deviations_ = name == "deviations";
    if (depth != 1 && (depth != 3 || !in_deviations_ || rows_.empty())) return;
    auto& members = depth == 1 ? file_.members : rows_.back().members;
    if (!members.emplace(name, position).second) error(position, fmt::format("duplicate member {}", name));
  }

  void deviations(const json& value) {
    const bool valid =
        value.is_array() && std::ranges::all_of(value, [](const json& item) { return item.is_object(); });
    if (!valid || value.size() != rows_.size()) {
      return error(position_of("deviations"),
                   R"(expected an array of objects: [{"case": "3.7", "object": "1800h:02", "reason": "..."}])");
    }
    for (std::size_t i = 0; i < value.size(); ++i) deviation(value[i], rows_[i]);
  }

  void deviation(const json& item, const Places& places) {
    Deviation row;
    row.position = places.begin;
    bool valid = true;
    for (const auto& [name, value] : item.items()) {
      const std::string problem = set_member(row, name, value);
      valid = valid && problem.empty();
      if (!problem.empty()) error(places.members.find(name)->second, problem);
    }
    for (const std::string_view name : {std::string_view{"case"}, std::string_view{"reason"}}) {
      if (item.contains(name)) continue;
      valid = false;
      error(places.begin, fmt::format("missing member {}", name));
    }
    if (valid) deviations_.push_back(std::move(row));
  }

  /// Returns the problem of a member; empty: none.
  std::string set_member(Deviation& row, const std::string& name, const json& value) const {
    if (std::ranges::find(deviation_members, name) == deviation_members.end()) {
      return fmt::format("unknown member {}{}", name, did_you_mean(name, deviation_members));
    }
    const std::string text = value.is_string() ? value.get<std::string>() : std::string{};
    if (trim(text).empty()) return fmt::format("{}: expected a non-empty string", name);
    if (name == "case") {
      if (std::ranges::find(case_ids_, text) == case_ids_.end()) {
        return fmt::format("case: unknown case {}; edsc conform --list prints the cases", text);
      }
      row.id = text;
    } else if (name == "object") {
      row.object = parse_entry_address(text);
      if (!row.object) return "object: expected an object or entry such as \"1800h\" or \"1800h:02\"";
    } else {
      (name == "reason" ? row.reason : row.source) = text;
    }
    return {};
  }

  [[nodiscard]] Position position_of(std::string_view member) const {
    const auto found = file_.members.find(member);
    return found != file_.members.end() ? found->second : Position{&source_, 1, 1};
  }

  [[nodiscard]] Position position_at(std::size_t offset) const {
    const std::string_view before = source_.text().substr(0, offset);
    const std::size_t line_end = before.rfind('\n');
    const std::size_t column = line_end == std::string_view::npos ? before.size() : before.size() - line_end - 1;
    return {&source_, static_cast<std::uint32_t>(1 + std::ranges::count(before, '\n')),
            static_cast<std::uint32_t>(1 + column)};
  }

  /// The parser's message without its exception name and id.
  static std::string what_of(const json::exception& problem) {
    const std::string_view what = problem.what();
    const std::size_t colon = what.find(": ");
    return std::string{colon == std::string_view::npos ? what : what.substr(colon + 2)};
  }

  void error(const Position& position, std::string message) {
    Diagnostic diagnostic;
    diagnostic.position = position;
    diagnostic.message = std::move(message);
    diagnostics_.report(std::move(diagnostic));
  }

  const SourceFile& source_;
  Diagnostics& diagnostics_;
  std::vector<std::string_view> case_ids_;
  Places file_;
  bool in_deviations_ = false;
  std::vector<Places> rows_;  ///< of the deviations
  std::vector<Deviation> deviations_;
};

/// The entries that a text names as `1800h:02`.
std::vector<EntryAddress> entries_in(std::string_view text) {
  constexpr std::size_t label_size = std::string_view{"1800h:02"}.size();
  std::vector<EntryAddress> entries;
  for (std::size_t colon = text.find("h:"); colon != std::string_view::npos; colon = text.find("h:", colon + 1)) {
    if (colon < 4) continue;
    const bool begins = colon == 4 || !is_hex_digit(text[colon - 5]);
    const std::string_view label = text.substr(colon - 4, label_size);
    const auto address = begins && label.size() == label_size ? parse_entry_address(label) : std::nullopt;
    if (address) entries.push_back(*address);
  }
  return entries;
}

bool covers(const EntryAddress& declared, const EntryAddress& entry) {
  return declared.index == entry.index && (!declared.sub_index || declared.sub_index == entry.sub_index);
}

bool applies(const Deviation& deviation, const CaseResult& result, const std::vector<EntryAddress>& named) {
  if (deviation.id != result.row->id) return false;
  if (!deviation.object || named.empty()) return true;
  return std::ranges::any_of(named, [&](const EntryAddress& entry) { return covers(*deviation.object, entry); });
}

std::string reason_of(const Deviation& deviation) {
  return deviation.source.empty() ? deviation.reason : fmt::format("{} ({})", deviation.reason, deviation.source);
}

}  // namespace

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
  for (const Deviation* row : declared) {
    const std::string reason = reason_of(*row);
    if (!reasons.insert(reason).second) continue;
    if (!result.deviation.empty()) result.deviation += "; ";
    result.deviation += reason;
  }
}

void find_unused_deviations(std::span<const Deviation> deviations, RunReport& run) {
  for (const Deviation& deviation : deviations) {
    const auto found =
        std::ranges::find_if(run.cases, [&](const CaseResult& result) { return result.row->id == deviation.id; });
    if (found == run.cases.end() || found->verdict != Verdict::passed) continue;
    const Place place = place_of(deviation.position);
    run.unused_deviations.push_back(
        fmt::format("{}:{}: case {} passed: {}", place.file, place.line, deviation.id, reason_of(deviation)));
  }
}

}  // namespace edsc::conform
