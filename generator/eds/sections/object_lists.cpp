#include "eds/sections/object_lists.hpp"

#include <fmt/format.h>

#include <optional>
#include <string>
#include <string_view>
#include <unordered_map>
#include <unordered_set>
#include <utility>

#include "diagnostics/quote.hpp"
#include "eds/number.hpp"
#include "eds/sections/section_keys.hpp"

namespace edsc {
namespace {

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

std::string_view name_of(ObjectListKind list) { return section_title(section_of(list)); }

class ObjectListReader {
 public:
  ObjectListReader(const SourceFile& source, Diagnostics& diagnostics) : source_(source), diagnostics_(diagnostics) {}

  void read(const IniSection& section, ObjectListKind list) {
    for (const NumberedField& entry : read_numbered_section(source_, section, supported_objects, diagnostics_)) {
      const std::string_view text = strip_inline_comment(entry.field.text);
      std::optional<std::uint64_t> index = parse_unsigned(text);
      if (!index && (index = parse_h_suffix(text))) {
        diagnostics_.warning("number-spelling", entry.field.position,
                             fmt::format("a hexadecimal number must be written with 0x, not as {}", quote(text)), {},
                             "list");
      }
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
                                       name_of(object.list), name_of(*right)),
                           {}, fmt::format("{} {}", name_of(object.list), name_of(*right)));
    }
  }

  const SourceFile& source_;
  Diagnostics& diagnostics_;
  std::vector<ListedObject> listed_;
  std::unordered_map<std::uint16_t, Position> first_place_;
};

/// Reports objects in no list.
void report_not_listed(const DataSheet& sheet, Diagnostics& diagnostics) {
  std::unordered_set<std::uint16_t> listed;
  for (const ListedObject& object : sheet.listed) listed.insert(object.index);
  for (const ObjectDescription& object : sheet.objects) {
    if (!object.has_section || listed.contains(object.index)) continue;
    const auto list = list_of(object.index);
    diagnostics.warning("object-not-listed", object.position,
                        fmt::format("{:04X}h is not in any object list{}", object.index,
                                    list ? fmt::format("; it belongs in [{}]", name_of(*list)) : ""),
                        {}, "not listed");
    if (!list) continue;
    diagnostics.offer({Remedy::Kind::listing, RuleId{WarningRule{"object-not-listed"}.row()}, object.position,
                       std::string{name_of(*list)}, fmt::format("0x{:04X}", object.index),
                       fmt::format("{:04X}h is described", object.index)});
  }
}

}  // namespace

SectionKind section_of(ObjectListKind list) {
  switch (list) {
    case ObjectListKind::mandatory: break;
    case ObjectListKind::optional: return SectionKind::optional_objects;
    case ObjectListKind::manufacturer: return SectionKind::manufacturer_objects;
  }
  return SectionKind::mandatory_objects;
}

std::optional<ObjectListKind> list_of(std::uint16_t index) {
  for (const ListRange& range : list_ranges) {
    if (index >= range.first && index <= range.last) return range.list;
  }
  return std::nullopt;
}

std::vector<ListedObject> read_object_lists(const SourceFile& source, const std::array<const IniSection*, 3>& sections,
                                            Diagnostics& diagnostics) {
  ObjectListReader reader(source, diagnostics);
  for (std::size_t list = 0; list < sections.size(); ++list) {
    if (sections[list] != nullptr) reader.read(*sections[list], static_cast<ObjectListKind>(list));
  }
  return reader.take();
}

void compare_lists_with_objects(const DataSheet& sheet, Diagnostics& diagnostics) {
  for (const ListedObject& listed : sheet.listed) {
    if (sheet.find(listed.index) == nullptr) {
      diagnostics.warning(
          "object-without-section", listed.position,
          fmt::format("{:04X}h is listed, but section [{:04X}] is missing", listed.index, listed.index));
    }
  }
  report_not_listed(sheet, diagnostics);
}

}  // namespace edsc
