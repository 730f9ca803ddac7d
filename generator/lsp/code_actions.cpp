#include <fmt/format.h>

#include <algorithm>
#include <filesystem>
#include <iterator>
#include <memory>
#include <optional>
#include <set>
#include <span>
#include <string>
#include <system_error>
#include <tuple>
#include <utility>
#include <variant>
#include <vector>

#include "change/fixes.hpp"
#include "eds/number.hpp"
#include "lsp/features.hpp"
#include "lsp/text_edits.hpp"
#include "overlay/write_overlay.hpp"
#include "system/path.hpp"

namespace edsc::lsp {
namespace {

constexpr std::string_view quick_fix = "quickfix";
constexpr std::string_view fix_all = "source.fixAll.edsc";

Json as_json(std::span<const SheetChange> changes) {
  Json list = Json::array();
  for (const SheetChange& change : changes) list.push_back(Json(change_as_json(change)));
  return list;
}

/// The lines of an overlay that make a change of its base; none for a change that an overlay cannot express.
std::vector<OverlayChange> in_overlay(const SheetChange& change, const SheetText& base, const std::string& reason) {
  const auto old_text = [&](const std::string& section, const std::string& key) -> std::optional<std::string> {
    const TextSection* const place = base.find(section);
    const CountedName counted = read_counted_name(key);
    const auto entry = place == nullptr ? std::nullopt : base.find_entry(*place, counted.name, counted.occurrence);
    return entry ? std::optional{std::string{strip_inline_comment(entry->value)}} : std::nullopt;
  };
  if (const auto* const set = std::get_if<SetValue>(&change)) {
    return {{set->section, set->key, old_text(set->section, set->key), set->value, reason}};
  }
  if (const auto* const removed = std::get_if<RemovePart>(&change); removed != nullptr && !removed->key.empty()) {
    return {{removed->section, removed->key, old_text(removed->section, removed->key), {}, reason}};
  }
  if (const auto* const renamed = std::get_if<RenamePart>(&change); renamed != nullptr && !renamed->key.empty()) {
    const auto value = old_text(renamed->section, renamed->key);
    return {{renamed->section, renamed->key, value, {}, reason},
            {renamed->section, renamed->name, std::nullopt, value.value_or(""), reason}};
  }
  return {};
}

class CodeActions {
 public:
  CodeActions(const View& view, const TextRange& range, bool is_resolved_later)
      : view_{view},
        range_{range},
        is_resolved_later_{is_resolved_later},
        text_{*view.analysis.own},
        fixes_{text_, view.analysis.diagnostics, view.analysis.device()} {}

  Json run(const Json& context) {
    const Json only = context.value("only", Json::array());
    const auto wants = [&](std::string_view kind) {
      return !only.is_array() || only.empty() || std::ranges::any_of(only, [&](const Json& one) {
        const std::string wanted = one.is_string() ? one.get<std::string>() : std::string{};
        return kind == wanted || kind.starts_with(wanted + ".");
      });
    };
    if (wants(quick_fix)) add_fixes();
    if (wants(fix_all) && view_.document.kind == DocumentKind::device) {
      const std::vector<SheetChange> changes = fixes_.of_lists_and_counts();
      if (!changes.empty()) add("Correct all object lists and counts", fix_all, changes, false);
    }
    return std::move(actions_);
  }

 private:
  /// A finding, or a place that it is merged with, in the range.
  struct Target {
    std::uint32_t line;
    RuleId rule;
    std::string message;
    auto operator<=>(const Target& other) const { return std::tie(line, rule) <=> std::tie(other.line, other.rule); }
  };

  [[nodiscard]] std::set<Target> targets() const {
    std::set<Target> found;
    for (const Diagnostic& one : view_.analysis.diagnostics.all()) {
      if (one.position.file != view_.analysis.own.get() || !overlap(range_of(one.position, view_.encoding), range_)) {
        continue;
      }
      found.insert({one.position.line, one.rule, one.message});
    }
    for (const Remedy& one : view_.analysis.diagnostics.remedies()) {
      const bool is_here = one.place.file == view_.analysis.own.get() && one.place.line >= range_.start.line + 1 &&
                           one.place.line <= range_.end.line + 1;
      if (is_here) found.insert({one.place.line, one.rule, one.reason});
    }
    return found;
  }

  void add_fixes() {
    const std::set<Target> found = targets();
    for (const Target& target : found) {
      bool is_preferred = true;
      for (const Fix& fix : fixes_.at(target.rule, target.line)) {
        add(fix.title, quick_fix, fix.changes, std::exchange(is_preferred, false));
        add_to_overlay(fix, target.message);
      }
    }
    if (view_.document.kind != DocumentKind::device) return;
    std::set<RuleId> allowed;
    for (const Target& target : found) {
      if (!allowed.insert(target.rule).second) continue;
      if (auto fix = fixes_.allowance(target.rule, target.line)) {
        std::get<AllowFinding>(fix->changes.front()).reason = "intended";
        add(fix->title + "; state the reason in the comment", quick_fix, fix->changes, false);
      }
    }
  }

  void add(const std::string& title, std::string_view kind, const std::vector<SheetChange>& changes,
           bool is_preferred) {
    Json action{{"title", title}, {"kind", kind}};
    if (is_preferred) action["isPreferred"] = true;
    if (is_resolved_later_) {
      action["data"] = {{"uri", view_.document.uri}, {"changes", as_json(changes)}};
    } else {
      try {
        if (!before_) before_ = open_document(view_);
        action["edit"] = edit_of_changes(view_, *before_, changes);
      } catch (const RequestFailed&) {  // it cannot be offered
        return;
      }
    }
    actions_.push_back(std::move(action));
  }

  /// The same correction in a new overlay beside the file.
  void add_to_overlay(const Fix& fix, const std::string& reason) {
    if (view_.document.kind != DocumentKind::device || view_.document.path.find("://") != std::string::npos) return;
    const std::filesystem::path path = to_native(view_.document.path).replace_extension(".overlay");
    std::error_code error;
    const std::string overlay = from_native(path);
    if (std::filesystem::exists(path, error) || view_.workspace.find_path(overlay) != nullptr) return;
    NewOverlay created;
    created.base = file_name_of(view_.document.path);
    for (const SheetChange& change : fix.changes) {
      std::ranges::move(in_overlay(change, text_, reason), std::back_inserter(created.changes));
    }
    if (created.changes.empty()) return;
    const std::string uri = uri_of_file(overlay);
    const Json insertion{{"range", to_json(TextRange{})}, {"newText", overlay_text(created)}};
    actions_.push_back({{"title", fmt::format("{} in {} instead", fix.title, file_name_of(overlay))},
                        {"kind", quick_fix},
                        {"edit",
                         {{"documentChanges", Json::array({{{"kind", "create"}, {"uri", uri}},
                                                           {{"textDocument", {{"uri", uri}, {"version", nullptr}}},
                                                            {"edits", Json::array({insertion})}}})}}}});
  }

  const View& view_;
  TextRange range_;
  bool is_resolved_later_;
  SheetText text_;
  Fixes fixes_;
  std::unique_ptr<const OpenSheet> before_;
  Json actions_ = Json::array();
};

}  // namespace

Json code_actions(const View& view, const TextRange& range, const Json& context, bool is_resolved_later) {
  return view.is_sheet() ? CodeActions{view, range, is_resolved_later}.run(context) : Json::array();
}

Json resolved_action(const View& view, Json action) {
  std::vector<SheetChange> changes;
  for (const Json& one : action.at("data").at("changes")) {
    std::string problem;
    auto change = read_change(one, problem);
    if (!change) throw RequestFailed{problem};
    changes.push_back(*std::move(change));
  }
  if (!view.is_sheet()) throw RequestFailed{"the document is not an EDS, DCF or overlay"};
  action["edit"] = edit_of_changes(view, *open_document(view), changes);
  return action;
}

}  // namespace edsc::lsp
