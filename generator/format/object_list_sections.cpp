#include "format/object_list_sections.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <map>
#include <utility>
#include <vector>

#include "eds/number.hpp"
#include "eds/sections/object_lists.hpp"
#include "format/section_order.hpp"
#include "format/spelling/key_table.hpp"
#include "format/spelling/number_spelling.hpp"

namespace edsc {
namespace {

constexpr ObjectListKind lists[] = {ObjectListKind::mandatory, ObjectListKind::optional, ObjectListKind::manufacturer};

/// The contents of an old list other than objects.
struct OldList {
  Remarks remarks;                     ///< before the count, or before entries that are removed
  std::vector<DocumentEntry> unknown;  ///< unknown keys
};

class ListWriter {
 public:
  ListWriter(Document& document, const DataSheet& sheet) : document_(document), sheet_(sheet) {}

  void write() {
    for (const ObjectDescription& object : sheet_.objects) {
      if (const auto list = list_for(object.index, sheet_)) listed_[*list].push_back(object.index);
    }
    std::map<SectionKind, OldList> old;
    for (DocumentSection& section : document_.sections) {
      if (is_object_list(section.kind.kind)) old[section.kind.kind] = take_apart(section);
    }
    for (const ObjectListKind list : lists) write_list(list, old[section_of(list)]);
  }

 private:
  OldList take_apart(DocumentSection& section) {
    OldList old;
    for (DocumentEntry& entry : section.entries) {
      const KeySpelling key = spell_key(section.kind, entry.key);
      if (key.value == ValueKind::count || equal_ignoring_case(entry.key, supported_objects.misspelling)) {
        append(old.remarks, remarks_of(entry));
      } else if (key.is_known) {
        keep_remarks(entry, old);
      } else {
        old.unknown.push_back(std::move(entry));
      }
    }
    section.entries.clear();
    return old;
  }

  /// The comments before the entry and after its value.
  static Remarks remarks_of(const DocumentEntry& entry) {
    Remarks remarks = entry.remarks;
    const std::string_view comment = inline_comment(entry.value);
    if (!comment.empty()) remarks.push_back(remark_line(comment));
    return remarks;
  }

  void keep_remarks(const DocumentEntry& entry, OldList& old) {
    const auto index = parse_unsigned(strip_inline_comment(entry.value));
    const bool stays = index && sheet_.find(*index) != nullptr && list_for(static_cast<std::uint16_t>(*index), sheet_);
    append(stays ? remarks_[static_cast<std::uint16_t>(*index)] : old.remarks, remarks_of(entry));
  }

  void write_list(ObjectListKind list, OldList& old) {
    const std::vector<std::uint16_t>& objects = listed_[list];
    DocumentSection* const section = find_or_add(section_of(list), !objects.empty());
    if (section == nullptr) return;
    section->title = section_title(section_of(list));
    section->entries.push_back(
        {std::move(old.remarks), std::string{supported_objects.name}, fmt::format("{}", objects.size())});
    for (std::size_t i = 0; i < objects.size(); ++i) {
      section->entries.push_back(
          {std::move(remarks_[objects[i]]), fmt::format("{}", i + 1), fmt::format("0x{:04X}", objects[i])});
    }
    for (DocumentEntry& entry : old.unknown) section->entries.push_back(std::move(entry));
  }

  DocumentSection* find_or_add(SectionKind kind, bool is_needed) {
    for (DocumentSection& section : document_.sections) {
      if (section.kind.kind == kind) return &section;
    }
    if (!is_needed) return nullptr;
    DocumentSection& added = document_.sections.emplace_back();
    added.kind.kind = kind;
    return &added;
  }

  Document& document_;
  const DataSheet& sheet_;
  std::map<ObjectListKind, std::vector<std::uint16_t>> listed_;
  std::map<std::uint16_t, Remarks> remarks_;  ///< before the entry of an object, in any list
};

}  // namespace

void renew_object_lists(Document& document, const DataSheet& sheet) { ListWriter(document, sheet).write(); }

}  // namespace edsc
