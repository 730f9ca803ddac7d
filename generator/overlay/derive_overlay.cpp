#include "overlay/derive_overlay.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <iterator>
#include <map>
#include <optional>
#include <set>
#include <utility>

#include "change/sheet_edit.hpp"
#include "change/sheet_text.hpp"
#include "change/text_edit.hpp"
#include "eds/sections/section_keys.hpp"
#include "overlay/overlay_keys.hpp"
#include "text/ascii.hpp"

namespace edsc {
namespace {

std::string lower_case(std::string_view text) {
  std::string result{text};
  std::ranges::transform(result, result.begin(), to_lower);
  return result;
}

/// The name of a section or key in an overlay: `1018sub1`, `DefaultValue#2`.
std::string counted_text(std::string_view name, unsigned occurrence) {
  return occurrence == 1 ? std::string{name} : fmt::format("{}#{}", name, occurrence);
}

struct SheetKey {
  std::string_view name;
  unsigned occurrence = 1;
  std::string_view value;
};

struct SheetSection {
  const TextSection* section = nullptr;
  unsigned occurrence = 1;
  std::vector<std::string> order;        ///< the keys, as in `keys`
  std::map<std::string, SheetKey> keys;  ///< by name in lower case and occurrence

  [[nodiscard]] std::string_view value(const std::string& key) const {
    const auto found = keys.find(key);
    return found == keys.end() ? std::string_view{} : found->second.value;
  }
};

/// The contents of a text by the names of sections and keys.
class SheetContents {
 public:
  explicit SheetContents(const SourceFile& source) : text_(source) {
    std::map<std::string, unsigned> seen;
    for (const TextSection& section : text_.sections()) {
      const std::string name =
          is_known(section.name.kind) ? lower_case(spell_section_name(section.name)) : "?" + lower_case(section.title);
      SheetSection read;
      read.section = &section;
      read.occurrence = ++seen[name];
      std::map<std::string, unsigned> seen_keys;
      for (const IniEntry& entry : text_.entries(section)) {
        const std::string key = lower_case(entry.key);
        const unsigned occurrence = ++seen_keys[key];
        read.order.push_back(counted_text(key, occurrence));
        read.keys.emplace(read.order.back(), SheetKey{entry.key, occurrence, entry.value});
      }
      order_.push_back(counted_text(name, read.occurrence));
      sections_.emplace(order_.back(), std::move(read));
    }
  }

  [[nodiscard]] const std::vector<std::string>& order() const { return order_; }
  [[nodiscard]] const SheetSection& at(const std::string& name) const { return sections_.at(name); }
  [[nodiscard]] const SheetSection* find(const std::string& name) const {
    const auto found = sections_.find(name);
    return found == sections_.end() ? nullptr : &found->second;
  }

 private:
  SheetText text_;
  std::vector<std::string> order_;
  std::map<std::string, SheetSection> sections_;
};

/// The keys of two sections: those of `a`, then the others of `b`.
std::vector<std::string> joined_keys(const SheetSection& a, const SheetSection& b) {
  std::vector<std::string> keys = a.order;
  std::ranges::copy_if(b.order, std::back_inserter(keys),
                       [&](const std::string& key) { return !a.keys.contains(key); });
  return keys;
}

class OverlayDeriver {
 public:
  OverlayDeriver(const std::shared_ptr<const SourceFile>& base, const SourceFile& edited, std::string_view base_path)
      : base_file_(base), base_(*base), edited_(edited), base_path_(base_path) {}

  DerivedOverlay derive() {
    std::string text = write();
    if (find_derived_keys(text)) text = write();
    const std::string difference = difference_of(text);
    if (problem_.empty()) problem_ = difference;
    return {std::move(text), std::move(problem_)};
  }

 private:
  /// Keys that other changes adapt: object lists, SubNumber, and sub-index 0.
  [[nodiscard]] static bool is_derived(const SectionName& section, std::string_view key) {
    if (is_object_list(section.kind)) return true;
    if (section.kind == SectionKind::object) return equal_ignoring_case(key, "SubNumber");
    return section.kind == SectionKind::sub_object && section.sub_index == 0 &&
           equal_ignoring_case(key, "DefaultValue");
  }

  std::string write() {
    std::string out = fmt::format("[Overlay]\nVersion=1\nBase={}\n", base_path_);
    problem_.clear();
    for (const std::string& name : base_.order()) {
      const SheetSection& before = base_.at(name);
      const SheetSection* const after = edited_.find(name);
      const std::string title = counted_text(before.section->title, before.occurrence);
      if (after != nullptr) {
        const std::string lines = changed_lines(name, before, *after);
        if (!lines.empty()) out += fmt::format("\n[{}]\n{}", title, lines);
      } else if (is_removed_by_itself(before)) {
        out += fmt::format("\n[{}]\nRemove=1\n", title);
      }
    }
    for (const std::string& name : edited_.order()) {
      if (base_.find(name) == nullptr) out += added_section(edited_.at(name));
    }
    return out;
  }

  /// Whether a removed section is not removed with the section of its object.
  bool is_removed_by_itself(const SheetSection& section) {
    const SectionName& name = section.section->name;
    if (section.occurrence > 1 || !is_object_section(name.kind)) return true;
    const std::string object = lower_case(spell_section_name({.kind = SectionKind::object, .index = name.index}));
    const bool object_goes = base_.find(object) != nullptr && edited_.find(object) == nullptr;
    return name.kind == SectionKind::object || !object_goes;
  }

  std::string added_section(const SheetSection& section) {
    std::string out = fmt::format("\n[{}]\n", counted_text(section.section->title, section.occurrence));
    for (const std::string& key : section.order) {
      const SheetKey& one = section.keys.at(key);
      const bool needs_arrow = one.value.find(arrow) != std::string_view::npos;
      out += fmt::format("{}={}{}\n", counted_text(one.name, one.occurrence), needs_arrow ? " => " : "", one.value);
    }
    return out;
  }

  std::string changed_lines(const std::string& name, const SheetSection& before, const SheetSection& after) {
    std::string out;
    for (const std::string& key : joined_keys(before, after)) {
      const bool has_before = before.keys.contains(key);
      const SheetKey& one = has_before ? before.keys.at(key) : after.keys.at(key);
      const bool is_explicit = explicit_.contains({name, key});
      if (is_derived(before.section->name, one.name) && !is_explicit) continue;
      const std::string_view old_value = before.value(key);
      const std::string_view new_value = after.value(key);
      if (old_value == new_value && !(is_explicit && has_before)) continue;
      const bool is_plain = !has_before && new_value.find(arrow) == std::string_view::npos;
      out += fmt::format("{}={}", counted_text(one.name, one.occurrence), old_value);
      if (is_plain) {
        out += fmt::format("{}\n", new_value);
      } else {
        out += fmt::format("{}=>{}{}\n", " ", new_value.empty() ? "" : " ", new_value);
      }
    }
    return out;
  }

  [[nodiscard]] std::unique_ptr<SourceFile> result_of(const std::string& overlay) const {
    const auto file = std::make_shared<const SourceFile>("derived.overlay", overlay);
    Diagnostics ignored;
    const OverlayFile read = read_overlay(*file, ignored);
    const OverlayEdits edits = edits_of(read, SheetText{*base_file_}, false, ignored);
    return edited_text(base_file_, edits.edits, file);
  }

  /// Finds the keys that the overlay must state although other changes adapt them. Returns whether there are any.
  bool find_derived_keys(const std::string& overlay) {
    const std::unique_ptr<SourceFile> result = result_of(overlay);
    const SheetContents composed{*result};
    for (const std::string& name : base_.order()) {
      const SheetSection& before = base_.at(name);
      const SheetSection* const wanted = edited_.find(name);
      const SheetSection* const got = composed.find(name);
      if (wanted == nullptr || got == nullptr) continue;
      const bool is_list = is_object_list(before.section->name.kind);
      bool list_differs = false;
      for (const std::string& key : joined_keys(*wanted, *got)) {
        if (wanted->value(key) == got->value(key)) continue;
        list_differs = is_list;
        explicit_.insert({name, key});
      }
      if (!list_differs) continue;
      for (const std::string& key : joined_keys(before, *wanted)) explicit_.insert({name, key});
    }
    return !explicit_.empty();
  }

  /// What differs between the edited copy and the result of the overlay.
  [[nodiscard]] std::string difference_of(const std::string& overlay) const {
    const std::unique_ptr<SourceFile> result = result_of(overlay);
    const SheetContents composed{*result};
    for (const std::string& name : edited_.order()) {
      const SheetSection& wanted = edited_.at(name);
      const SheetSection* const got = composed.find(name);
      if (got == nullptr) return fmt::format("section [{}]", wanted.section->title);
      for (const std::string& key : joined_keys(wanted, *got)) {
        if (wanted.value(key) != got->value(key)) return fmt::format("{} of [{}]", key, wanted.section->title);
      }
    }
    for (const std::string& name : composed.order()) {
      const TextSection& section = *composed.at(name).section;
      const bool is_new_list = is_object_list(section.name.kind) && base_.find(name) == nullptr;  // of added objects
      if (edited_.find(name) == nullptr && !is_new_list) return fmt::format("the missing section [{}]", section.title);
    }
    return {};
  }

  const std::shared_ptr<const SourceFile>& base_file_;
  SheetContents base_;
  SheetContents edited_;
  std::string_view base_path_;
  std::set<std::pair<std::string, std::string>> explicit_;  ///< section and key
  std::string problem_;
};

}  // namespace

DerivedOverlay derive_overlay(const std::shared_ptr<const SourceFile>& base, const SourceFile& edited,
                              std::string_view base_path) {
  return OverlayDeriver(base, edited, base_path).derive();
}

EditedBytes rebased_overlay(const OverlayFile& overlay, std::string_view bytes,
                            const std::vector<LineOutcome>& outcomes, std::string_view base_path) {
  const SheetText text{*overlay.source};
  SheetEdit edit{text};
  std::set<std::uint32_t> obsolete;
  for (const LineOutcome& outcome : outcomes) {
    if (outcome.state == LineState::obsolete) obsolete.insert(outcome.line);
  }
  for (const TextSection& section : text.sections()) {
    const std::vector<IniEntry> entries = text.entries(section);
    if (equal_ignoring_case(section.title, overlay_section)) {
      for (const IniEntry& entry : entries) {
        if (equal_ignoring_case(entry.key, "Base")) edit.set_value(entry, base_path, {}, true);
      }
      continue;
    }
    const auto is_obsolete = [&](const IniEntry& entry) { return obsolete.contains(entry.line); };
    const auto remains = [&](const IniEntry& entry) {
      return !is_obsolete(entry) && !equal_ignoring_case(entry.key, count_key);
    };
    if (std::ranges::none_of(entries, is_obsolete)) continue;
    if (std::ranges::none_of(entries, remains)) {
      edit.remove_lines(section);
      continue;
    }
    for (const IniEntry& entry : entries) {
      if (is_obsolete(entry)) edit.remove_entry(entry);
    }
  }
  return edited_bytes(bytes, overlay.source->encoding(), edit.finish(), true);
}

}  // namespace edsc
