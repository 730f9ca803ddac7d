#include <fmt/format.h>

#include <memory>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "change/change.hpp"
#include "change/sheet_text.hpp"
#include "compare/compare_devices.hpp"
#include "device/resolve.hpp"
#include "diagnostics/place.hpp"
#include "eds/number.hpp"
#include "format/canonical_form.hpp"
#include "lsp/features.hpp"
#include "lsp/sheet_place.hpp"
#include "lsp/text_edits.hpp"
#include "rules/check_rules.hpp"

namespace edsc::lsp {
namespace {

/// The new index, or index and sub-index, that a user writes: `2040`, `0x2040`, `2040h`, `2040sub3`.
struct NewAddress {
  std::uint16_t index = 0;
  std::optional<std::uint8_t> sub_index;
};

std::optional<NewAddress> read_address(std::string_view text) {
  if (text.starts_with("0x") || text.starts_with("0X")) text.remove_prefix(2);
  if (text.ends_with('h') || text.ends_with('H')) text.remove_suffix(1);
  const SectionName name = read_section_name(text);
  if (!name.remark.empty() || text.size() < 4) return std::nullopt;
  if (name.kind == SectionKind::object) return NewAddress{name.index, {}};
  if (name.kind == SectionKind::sub_object) return NewAddress{name.index, name.sub_index};
  return std::nullopt;
}

SheetPlace renamed_place(const View& view, const TextPosition& at) {
  if (view.document.kind != DocumentKind::device) return {};
  return place_in(view.analysis.ini, at.line + 1, view.column_of(at));
}

}  // namespace

Json formatting(const View& view) {
  if (view.document.kind != DocumentKind::device) return Json::array();
  Diagnostics diagnostics;
  for (const AnyRule rule : {AnyRule{"unknown-key"}, AnyRule{"unknown-section"}}) diagnostics.silence(rule);
  const IniFile ini = parse_ini(*view.analysis.own, diagnostics);
  if (ini.sections.empty()) return Json::array();
  const DataSheet sheet = read_data_sheet(ini, diagnostics);
  if (diagnostics.errors() > 0) throw RequestFailed{"the file has errors; it is not formatted"};
  Diagnostics ignored;
  const Device device = resolve_device(sheet, {}, {}, ignored);
  const std::string text = to_text(canonical_form(ini, sheet, device));
  if (text == view.document.text) return Json::array();
  TextRange whole = range_of_lines(view, 1, view.analysis.own->lines());
  whole.start = {0, 0};
  return Json::array({{{"range", lsp::to_json(whole)}, {"newText", text}}});
}

Json code_lenses(const View& view, const Committed& committed) {
  Json lenses = Json::array();
  if (view.document.kind != DocumentKind::device || view.analysis.device() == nullptr || !committed) return lenses;
  const std::shared_ptr<const LoadedDevice> before = committed(view.document.path);
  if (!before || !before->device) return lenses;
  const Changes changes = compare_devices(before->named(), view.analysis.loaded->named());
  if (changes.all().empty()) return lenses;
  const auto add = [&](const TextRange& range, std::string title) {
    lenses.push_back({{"range", lsp::to_json(range)}, {"command", {{"title", std::move(title)}, {"command", ""}}}});
  };
  add({},
      fmt::format("changes since git HEAD: {}, of which {} break something", changes.all().size(), changes.breaking()));
  for (const Change& change : changes.all()) {
    const Position origin = origin_of(change.new_position);
    if (!change.is_breaking() || origin.file != view.analysis.own.get()) continue;
    std::string whom;
    const auto name = [&](bool breaks, std::string_view who) {
      if (breaks) whom += fmt::format("{}{}", whom.empty() ? "" : ", ", who);
    };
    name(change.breaks.master, "masters");
    name(change.breaks.pdo, "PDO partners");
    name(change.breaks.source, "source code");
    name(change.breaks.storage, "stored parameters");
    add(range_of(origin, view.encoding), fmt::format("breaks {}: {}", whom, message_of(change)));
  }
  return lenses;
}

Json prepare_rename(const View& view, const TextPosition& at) {
  const SheetPlace place = renamed_place(view, at);
  const auto target = target_of(place);
  if (!target) return nullptr;
  const bool is_header = place.entry == nullptr;
  const TextRange range = is_header ? range_in(*view.analysis.own, place.section->line, place.section->column,
                                               place.section->name.size(), view.encoding)
                                    : range_in(*view.analysis.own, place.entry->line, place.entry->value_column,
                                               current_value(*place.entry).size(), view.encoding);
  return {{"range", lsp::to_json(range)},
          {"placeholder", target->sub_index && is_header
                              ? fmt::format("{:04X}sub{:X}", target->index, unsigned{*target->sub_index})
                              : fmt::format("{:04X}", target->index)}};
}

Json rename(const View& view, const TextPosition& at, const std::string& new_name) {
  const auto target = target_of(renamed_place(view, at));
  if (!target) throw RequestFailed{"there is no object to renumber here"};
  const auto to = read_address(new_name);
  if (!to)
    throw RequestFailed{fmt::format("\"{}\" is not an index, as 2040, or index and sub-index, as 2040sub1", new_name)};
  const bool is_entry = to->sub_index.has_value();
  if (is_entry && (!target->sub_index || to->index != target->index)) {
    throw RequestFailed{fmt::format("a sub-index can be renumbered within {}", index_label(target->index))};
  }
  const auto before = open_document(view);
  const SheetText text{*before->source};
  const TextSection* const section = text.find(
      is_entry ? SectionName{.kind = SectionKind::sub_object, .index = target->index, .sub_index = *target->sub_index}
               : SectionName{.kind = SectionKind::object, .index = target->index});
  if (section == nullptr) {
    throw RequestFailed{fmt::format("{} does not have a section", index_label(target->index))};
  }
  const RenamePart change{
      std::string{section->title},
      {},
      is_entry ? fmt::format("{:04X}sub{:X}", to->index, unsigned{*to->sub_index}) : fmt::format("{:04X}", to->index)};
  return edit_of_changes(view, *before, std::vector<SheetChange>{change});
}

}  // namespace edsc::lsp
