#include "edit/edited_network.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cstddef>
#include <iterator>
#include <optional>
#include <string_view>
#include <utility>
#include <vector>

#include "change/line_diff.hpp"
#include "change/text_edit.hpp"
#include "diagnostics/new_errors.hpp"
#include "diagnostics/place.hpp"
#include "edit/network_changes.hpp"
#include "edit/network_parts.hpp"
#include "json/json_file.hpp"
#include "json/json_ranges.hpp"
#include "load/load_device.hpp"
#include "network/checks/check_network.hpp"
#include "network/network.hpp"
#include "system/file_stamps.hpp"
#include "system/path.hpp"

namespace edsc::edit {
namespace {

/// An edit that makes a bus load or time less, but not enough, does not add an error.
constexpr std::array<std::string_view, 3> calculated_rules{"network-load", "network-sync-window",
                                                           "network-response-time"};

std::ptrdiff_t errors_of(const RuleId& rule, const Diagnostics& diagnostics) {
  return std::ranges::count_if(
      diagnostics.all(), [&](const Diagnostic& one) { return one.rule == rule && one.severity == Severity::error; });
}

/// The errors that reject an edit. If there are fewer of a rule than before, it corrects one of them; the others can
/// then have other names: of three nodes with one node-ID, the second and third, not the first and third.
std::vector<Diagnostic> rejecting_errors(const Diagnostics& after, const Diagnostics& before, bool is_renamed) {
  std::vector<Diagnostic> errors = new_errors(after, before, is_renamed, calculated_rules);
  std::erase_if(errors,
                [&](const Diagnostic& one) { return errors_of(one.rule, after) < errors_of(one.rule, before); });
  return errors;
}

/// The files that a network names, also missing ones, and those that they name.
std::vector<std::string> files_of(const LoadedNetwork& loaded) {
  const Network& network = loaded.network;
  const std::string folder = from_native(to_native(network.source->name()).parent_path());
  std::vector<std::string> paths;
  const auto add = [&](const WrittenText& file) {
    if (file) paths.push_back(join_path(folder, file->value));
  };
  add(network.description.dbc);
  for (const NodeDescription& node : network.description.nodes) {
    for (const WrittenText* file : {&node.eds, &node.dcf, &node.options}) add(*file);
  }
  for (const auto& file : network.files) {
    if (file->source) std::ranges::copy(input_files(*file), std::back_inserter(paths));
  }
  return paths;
}

class EditedNetwork final : public EditedFile {
 public:
  EditedNetwork(std::string path, std::string bytes, bool is_committed)
      : path_{std::move(path)}, bytes_{std::move(bytes)}, is_committed_{is_committed} {
    diagnostics_.silence_errors();
    loaded_ = load_network(std::make_unique<SourceFile>(path_, bytes_), diagnostics_);
    check_network(loaded_->network, diagnostics_);
    const JsonFile json{source()};
    if (json.is_valid() && json.root().is_object()) ranges_.emplace(source().text());
    stamps_ = FileStamps{files_of(*loaded_)};
  }

  [[nodiscard]] std::unique_ptr<const EditedFile> with_bytes(const std::string& bytes,
                                                             std::string& /*problem*/) const override {
    return std::make_unique<EditedNetwork>(path_, bytes, is_committed_);
  }

  [[nodiscard]] ChangedFile changed(const EditRequests& requests) const override {
    const std::size_t count = requests.list.size();
    if (count == 0) return {};
    if (!ranges_) return rejected(0, "the text is not JSON, or not a JSON object; correct it in an editor first");
    Attempt attempt = made(requests, count);
    if (!attempt.rejection) {
      const bool has_changed = !attempt.changed.step.edits.empty();
      return has_changed ? std::move(attempt.changed) : ChangedFile{};
    }
    if (!attempt.is_refused) {  // by new errors: of a request that adds some to those before it
      for (std::size_t without = 0, with = count; with - without > 1;) {
        const std::size_t middle = without + (with - without) / 2;
        Attempt first = made(requests, middle);
        if (first.rejection) {
          attempt = std::move(first);
          with = middle;
        } else {
          without = middle;
        }
      }
    }
    return {std::move(attempt.rejection), {}, {}, {}};
  }

  [[nodiscard]] bool is_outdated() const override { return stamps_.has_changed(); }

  [[nodiscard]] EditedFileFacts facts() const override { return {"network", std::nullopt, is_committed_}; }
  [[nodiscard]] const Diagnostics& diagnostics() const override { return diagnostics_; }
  [[nodiscard]] Json finding(const Diagnostic& one) const override {
    return network_finding_json(source(), ranges(), one);
  }
  [[nodiscard]] Json broken_since_commit() const override { return Json::array(); }
  [[nodiscard]] nlohmann::json requests_for_major_revision() const override { return nlohmann::json::array(); }
  [[nodiscard]] Json unreadable_lines() const override { return Json::array(); }

  void add_parts(EditParts& parts) const override {
    add_network(loaded_->network, ranges(), parts);
    add_network_findings(source(), ranges(), diagnostics_, parts);
  }

  [[nodiscard]] Json section(std::string_view title) const override {
    const auto path = json_path(title);
    std::uint32_t first = 1, last = source().lines();
    if (const auto at = ranges_ && path ? ranges_->find(*path) : std::nullopt) {
      first = position_at(source(), (*ranges_)[*at].first()).line;
      last = position_at(source(), (*ranges_)[*at].end - 1).line;
    } else if (ranges_ || !title.empty()) {  // not the whole of a text that is not JSON
      return nullptr;
    }
    Json lines = Json::array();
    for (std::uint32_t line = first; line <= last; ++line) lines.push_back(source().line(line));
    return {{"title", title}, {"line", first}, {"lines", std::move(lines)}};
  }

 private:
  /// What requests make of the file.
  struct Attempt {
    ChangedFile changed;
    std::optional<EditRejection> rejection;
    bool is_refused = false;  ///< a request is not possible
  };

  static ChangedFile rejected(std::size_t index, std::string problem) {
    return {EditRejection{index, std::move(problem)}, {}, {}, {}};
  }

  [[nodiscard]] const SourceFile& source() const { return *loaded_->network.source; }
  [[nodiscard]] const JsonRanges* ranges() const { return ranges_ ? &*ranges_ : nullptr; }

  /// The first `count` requests.
  [[nodiscard]] Attempt made(const EditRequests& requests, std::size_t count) const {
    const ChangedNetwork made = change_network(source().text(), requests.list, count);
    if (!made.problem.empty()) return {{}, EditRejection{made.problem_at, made.problem}, true};
    std::string problem;
    std::string bytes = bytes_of(made.text, problem);
    if (!problem.empty()) return {{}, EditRejection{count - 1, problem}, true};
    auto after = std::make_unique<EditedNetwork>(path_, bytes, is_committed_);
    const std::vector<Diagnostic> errors = rejecting_errors(after->diagnostics_, diagnostics_, made.is_renamed);
    if (!errors.empty() && !requests.is_forced) {
      EditRejection rejection{count - 1, errors.front().message};
      for (const Diagnostic& one : errors) rejection.findings.push_back(after->finding(one));
      rejection.can_force = true;
      return {{}, std::move(rejection), false};
    }
    EditStep step{made.name, bytes_between(bytes_, bytes)};
    return {{{}, std::move(step), std::move(bytes), std::move(after)}, {}, false};
  }

  /// The bytes of the file with another text, in its encoding.
  [[nodiscard]] std::string bytes_of(const std::string& text, std::string& problem) const {
    if (source().is_verbatim()) return text;
    EditedBytes edited = edited_bytes(bytes_, source().encoding(), line_edits(source(), SourceFile{path_, text}), true);
    problem = std::move(edited.error);
    return std::move(edited.bytes);
  }

  std::string path_;
  std::string bytes_;
  bool is_committed_ = false;
  Diagnostics diagnostics_;
  std::unique_ptr<LoadedNetwork> loaded_;
  std::optional<JsonRanges> ranges_;  ///< nothing if the text is not a JSON object
  FileStamps stamps_;                 ///< of the files that it names
};

}  // namespace

std::unique_ptr<const EditedFile> open_edited_network(const EditedFileSettings& settings, const std::string& bytes) {
  return std::make_unique<EditedNetwork>(settings.path, bytes, settings.committed.has_value());
}

}  // namespace edsc::edit
