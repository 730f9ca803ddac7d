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

namespace edsc {
namespace {

/// Sections that occur once; names with the same number are the same section.
std::uint32_t identity(const SectionName& name) {
  return (std::uint32_t{name.index} << 16U) | (static_cast<std::uint32_t>(name.kind) << 8U) | name.sub_index;
}

bool stands_once(SectionKind kind) { return kind <= SectionKind::object_links; }

/// On the first section of the file, comments for edsc must not be before it, where they would apply to the file.
void merge_remarks(DocumentSection& first, bool is_first_of_file, const DocumentSection& second) {
  Remarks remarks = second.remarks;
  for (const DocumentEntry& entry : second.entries) append(remarks, entry.remarks);
  for (std::string& remark : remarks) {
    (is_first_of_file && is_for_edsc(remark) ? first.header : first.remarks).push_back(std::move(remark));
  }
}

/// Groups of sections: single sections, each list with its objects, objects in no list, the rest.
constexpr std::uint32_t list_groups = 8;
constexpr std::uint32_t unlisted_objects = 16;
constexpr std::uint32_t other_sections = 17;

std::uint32_t group_of_list(ObjectListKind list) { return list_groups + 2 * static_cast<std::uint32_t>(list); }

struct Place {
  std::uint32_t group = other_sections;
  std::uint32_t in_group = 0;

  friend auto operator<=>(const Place&, const Place&) = default;
};

Place place_of(const SectionName& name, const DataSheet& sheet) {
  if (is_object_list(name.kind)) {
    const auto list =
        static_cast<std::uint32_t>(name.kind) - static_cast<std::uint32_t>(SectionKind::mandatory_objects);
    return {group_of_list(static_cast<ObjectListKind>(list)), 0};
  }
  if (name.kind < SectionKind::object) return {static_cast<std::uint32_t>(name.kind), 0};
  const bool has_object = name.kind != SectionKind::object_links || sheet.find(name.index) != nullptr;
  if (!stands_once(name.kind) || !has_object) return {};
  const auto list = list_for(name.index, sheet);
  return {list ? group_of_list(*list) + 1 : unlisted_objects, identity(name)};
}

}  // namespace

void drop_second_sections(Document& document) {
  std::unordered_map<std::uint32_t, std::size_t> first;
  std::vector<DocumentSection> kept;
  kept.reserve(document.sections.size());
  for (DocumentSection& section : document.sections) {
    if (stands_once(section.kind.kind)) {
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
  std::vector<std::pair<Place, std::size_t>> order;
  order.reserve(document.sections.size());
  for (std::size_t i = 0; i < document.sections.size(); ++i) {
    order.emplace_back(place_of(document.sections[i].kind, sheet), i);
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
