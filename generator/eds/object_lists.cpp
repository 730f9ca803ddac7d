#include "eds/object_lists.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <map>
#include <optional>
#include <string>
#include <string_view>
#include <unordered_map>
#include <utility>

#include "diagnostics/quote.hpp"
#include "eds/number.hpp"
#include "eds/numbered_section.hpp"

namespace edsc {
namespace {

constexpr CountKey supported_objects{"SupportedObjects", "Supported Objects", "object-list-count", true};

/// A range of indices and its list; the first matching row is used.
struct ListRange {
  std::uint16_t first, last;
  ObjectListKind list;
};

constexpr ListRange list_ranges[] = {
    {0x1000, 0x1001, ObjectListKind::mandatory}, {0x1018, 0x1018, ObjectListKind::mandatory},
    {0x1000, 0x1FFF, ObjectListKind::optional},  {0x2000, 0x5FFF, ObjectListKind::manufacturer},
    {0x6000, 0xFFFF, ObjectListKind::optional},
};

class ObjectListReader {
 public:
  ObjectListReader(const SourceFile& source, Diagnostics& diagnostics) : source_(source), diagnostics_(diagnostics) {}

  void read(const IniSection* section, ObjectListKind list) {
    if (section == nullptr) {
      return;
    }
    for (const NumberedField& entry : read_numbered_section(source_, *section, supported_objects, diagnostics_)) {
      const std::optional<std::uint64_t> index = number_of(entry.field);
      if (index && *index >= 0x0001 && *index <= 0xFFFF) {
        add({list, static_cast<std::uint16_t>(*index), entry.field.position});
      } else {
        diagnostics_.error("number", entry.field.position,
                           fmt::format("{} is not a valid index; expected 0x0001 to 0xFFFF", quote(entry.field.text)));
      }
    }
  }

  std::vector<ListedObject> take() { return std::move(listed_); }

 private:
  void add(const ListedObject& object) {
    const auto [first, is_new] = first_place_.try_emplace(object.index, object.position);
    if (!is_new) {
      diagnostics_.warning("object-list", object.position, fmt::format("{:04X}h is listed twice", object.index),
                           {{first->second, "the first time"}});
      return;
    }
    check_list(object);
    listed_.push_back(object);
  }

  void check_list(const ListedObject& object) {
    const std::optional<ObjectListKind> right = list_of(object.index);
    if (right && *right != object.list) {
      diagnostics_.warning("object-list", object.position,
                           fmt::format("{:04X}h is listed in [{}], but belongs in [{}]", object.index,
                                       section_name(object.list), section_name(*right)),
                           {}, fmt::format("{} {}", section_name(object.list), section_name(*right)));
    }
  }

  const SourceFile& source_;
  Diagnostics& diagnostics_;
  std::vector<ListedObject> listed_;
  std::unordered_map<std::uint16_t, Position> first_place_;
};

std::vector<std::uint16_t> sorted_indices(const std::vector<ListedObject>& listed) {
  std::vector<std::uint16_t> indices;
  indices.reserve(listed.size());
  for (const ListedObject& object : listed) {
    indices.push_back(object.index);
  }
  std::sort(indices.begin(), indices.end());
  return indices;
}

/// Reports objects in no list. If many are missing from one list, they have the same cause.
void report_not_listed(const DataSheet& sheet, Diagnostics& diagnostics) {
  const std::vector<std::uint16_t> listed = sorted_indices(sheet.listed);
  std::map<std::optional<ObjectListKind>, std::vector<const ObjectDescription*>> missing;
  for (const ObjectDescription& object : sheet.objects) {
    if (!object.has_section || std::binary_search(listed.begin(), listed.end(), object.index)) continue;
    missing[list_of(object.index)].push_back(&object);
  }
  for (const auto& [list, objects] : missing) {
    const std::string list_name{list ? section_name(*list) : ""};
    const bool one_cause = objects.size() > Diagnostics::max_places;
    for (const ObjectDescription* object : objects) {
      diagnostics.warning("object-not-listed", object->position,
                          fmt::format("{:04X}h is not in any object list{}", object->index,
                                      list ? fmt::format("; it belongs in [{}]", list_name) : ""),
                          {}, one_cause ? list_name : "");
    }
  }
}

}  // namespace

std::string_view section_name(ObjectListKind kind) {
  switch (kind) {
    case ObjectListKind::mandatory: return "MandatoryObjects";
    case ObjectListKind::optional: return "OptionalObjects";
    case ObjectListKind::manufacturer: return "ManufacturerObjects";
  }
  return "";
}

std::optional<ObjectListKind> list_of(std::uint16_t index) {
  for (const ListRange& range : list_ranges) {
    if (index >= range.first && index <= range.last) {
      return range.list;
    }
  }
  return std::nullopt;
}

std::vector<ListedObject> read_object_lists(const SourceFile& source, const ObjectListSections& sections,
                                            Diagnostics& diagnostics) {
  ObjectListReader reader(source, diagnostics);
  reader.read(sections.mandatory, ObjectListKind::mandatory);
  reader.read(sections.optional, ObjectListKind::optional);
  reader.read(sections.manufacturer, ObjectListKind::manufacturer);
  return reader.take();
}

void compare_lists_with_objects(const DataSheet& sheet, Diagnostics& diagnostics) {
  const auto has_object = [&](std::uint16_t index) {
    const auto found =
        std::lower_bound(sheet.objects.begin(), sheet.objects.end(), index,
                         [](const ObjectDescription& object, std::uint16_t i) { return object.index < i; });
    return found != sheet.objects.end() && found->index == index;
  };
  for (const ListedObject& listed : sheet.listed) {
    if (!has_object(listed.index)) {
      diagnostics.warning(
          "object-without-section", listed.position,
          fmt::format("{:04X}h is listed, but section [{:04X}] is missing", listed.index, listed.index));
    }
  }
  report_not_listed(sheet, diagnostics);
}

}  // namespace edsc
