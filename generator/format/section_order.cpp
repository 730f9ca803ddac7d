#include "format/section_order.hpp"

#include <algorithm>
#include <cstddef>
#include <iterator>
#include <string>
#include <string_view>
#include <unordered_map>
#include <utility>

#include "eds/allow_comments.hpp"
#include "eds/sections/object_lists.hpp"
#include "eds/sections/section_keys.hpp"

namespace edsc {
namespace {

/// On the first section of the file, comments for edsc must not be before it, where they would apply to the file.
void merge_remarks(DocumentSection& first, bool is_first_of_file, const DocumentSection& second) {
  Remarks remarks = second.remarks;
  for (const DocumentEntry& entry : second.entries) append(remarks, entry.remarks);
  for (std::string& remark : remarks) {
    (is_first_of_file && is_for_edsc(remark) ? first.header : first.remarks).push_back(std::move(remark));
  }
}

std::uint64_t object_order(std::uint16_t index, SectionKind kind, std::uint8_t sub_index) {
  return (std::uint64_t{index} << 16U) | (place_of_section(kind) << 8U) | sub_index;
}

}  // namespace

SectionPlace place_of_section(const SectionName& name, std::optional<ObjectListKind> list) {
  if (!is_known(name.kind)) return {.section = place_of_section(name.kind)};
  if (is_object_section(name.kind)) {
    return {.section = place_of_section(list ? section_of(*list) : SectionKind::object),
            .after_list = true,
            .object = object_order(name.index, name.kind, name.sub_index)};
  }
  if (is_module_section(name.kind)) {
    return {.section = place_of_section(SectionKind::module_info),
            .number = name.number,
            .section_of_module = place_of_section(name.kind),
            .object = object_order(name.index, name.part, name.sub_index)};
  }
  return {.section = place_of_section(name.kind), .number = name.number};
}

void drop_second_sections(Document& document) {
  std::unordered_map<std::uint64_t, std::size_t> first;
  std::vector<DocumentSection> kept;
  kept.reserve(document.sections.size());
  for (DocumentSection& section : document.sections) {
    if (is_known(section.kind.kind)) {
      const auto [at, is_new] = first.try_emplace(identity(section.kind), kept.size());
      if (!is_new) {
        merge_remarks(kept[at->second], at->second == 0, section);
        continue;
      }
    }
    kept.push_back(std::move(section));
  }
  document.sections = std::move(kept);
}

void order_sections(Document& document, const DataSheet& sheet) {
  std::vector<std::pair<SectionPlace, std::size_t>> order;
  order.reserve(document.sections.size());
  for (std::size_t i = 0; i < document.sections.size(); ++i) {
    const SectionName& name = document.sections[i].kind;
    const bool is_of_object = is_object_section(name.kind);
    order.emplace_back(place_of_section(name, is_of_object ? list_for(name.index, sheet) : std::nullopt), i);
  }
  std::sort(order.begin(), order.end());
  const bool first_moves = !order.empty() && order.front().second != 0;
  if (first_moves) give_up_first_place(document);
  std::vector<DocumentSection> sorted;
  sorted.reserve(order.size());
  for (const auto& [place, i] : order) sorted.push_back(std::move(document.sections[i]));
  document.sections = std::move(sorted);
  if (first_moves) take_first_place(document);
}

std::optional<ObjectListKind> list_for(std::uint16_t index, const DataSheet& sheet) {
  if (const auto list = list_of(index)) return list;
  const auto listed = std::ranges::find(sheet.listed, index, &ListedObject::index);
  return listed != sheet.listed.end() ? std::optional{listed->list} : std::nullopt;
}

}  // namespace edsc
