#include "eds/sections/object_sections.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cstddef>
#include <span>
#include <string>

#include "eds/sections/duplicates.hpp"
#include "eds/sections/section_keys.hpp"

namespace edsc {
namespace {

using ObjectSections = std::span<const ObjectSection>;

void sort_sections(std::vector<ObjectSection>& sections) {
  const auto before = [](const ObjectSection& a, const ObjectSection& b) { return a.order() < b.order(); };
  if (!std::is_sorted(sections.begin(), sections.end(), before)) {
    std::stable_sort(sections.begin(), sections.end(), before);
  }
}

std::size_t count_indices(ObjectSections sections) {
  std::size_t indices = 0;
  for (std::size_t at = 0; at < sections.size(); ++at) {
    indices += at == 0 || sections[at].name.index != sections[at - 1].name.index ? 1 : 0;
  }
  return indices;
}

/// The number of leading sections with the same index.
std::size_t length_of_object(ObjectSections sections) {
  const std::uint16_t index = sections[0].name.index;
  const auto end = std::find_if(sections.begin(), sections.end(),
                                [&](const ObjectSection& section) { return section.name.index != index; });
  return static_cast<std::size_t>(end - sections.begin());
}

class ObjectReader {
 public:
  ObjectReader(const SourceFile& source, std::string_view prefix, Diagnostics& diagnostics)
      : source_(source), prefix_(prefix), diagnostics_(diagnostics) {}

  /// All `sections` have the same index and are sorted.
  void read(ObjectSections sections, ObjectDescription& object) {
    object.index = sections[0].name.index;
    object.has_section = sections[0].name.kind == SectionKind::object;
    place(section_position(source_, *sections[0].section), object);
    if (!object.has_section) {
      report_missing_section(sections[0], object);
    }
    object.sub_objects.reserve(static_cast<std::size_t>(std::count_if(
        sections.begin(), sections.end(), [](const auto& s) { return s.name.kind == SectionKind::sub_object; })));

    const ObjectSection* first = nullptr;
    for (const ObjectSection& section : sections) {
      if (first != nullptr && first->order() == section.order()) {
        report_duplicate_section(source_, *section.section, *first->section, diagnostics_);
      } else {
        first = &section;
        read_section(section, object);
      }
    }
  }

 private:
  static void place(const Position& position, ObjectDescription& object) {
    place_entry(position, object);
    place_fields(object_keys, position, object);
  }

  void report_missing_section(const ObjectSection& first, const ObjectDescription& object) {
    diagnostics_.warning(
        "sub-object-without-object", object.position,
        fmt::format("[{}] has no parent section [{}{:04X}]", first.section->name, prefix_, object.index));
  }

  void read_section(const ObjectSection& section, ObjectDescription& object) {
    if (section.name.kind == SectionKind::object) {
      read_object(*section.section, object);
    } else if (section.name.kind == SectionKind::sub_object) {
      read_sub_object(section, object.sub_objects.emplace_back());
    } else if (section.name.kind == SectionKind::compact_names) {
      object.compact_names = read_list(*section.section);
    } else if (section.name.kind == SectionKind::compact_values) {
      object.compact_values = read_list(*section.section);
    } else if (section.name.kind == SectionKind::compact_denotations) {
      object.compact_denotations = read_list(*section.section);
    } else if (section.name.kind == SectionKind::object_links) {
      object.object_links = read_numbered_section(source_, *section.section, object_link_count, diagnostics_);
    }
  }

  void read_object(const IniSection& section, ObjectDescription& object) {
    read_keys(
        source_, section, diagnostics_,
        [&](std::string_view key) {
          Field* const field = find_key<EntryDescription>(entry_keys, key, object);
          return field != nullptr ? field : find_key(object_keys, key, object);
        },
        entry_keys, object_keys);
  }

  void read_sub_object(const ObjectSection& section, SubObjectDescription& sub_object) {
    sub_object.sub_index = section.name.sub_index;
    place_entry(section_position(source_, *section.section), sub_object);
    read_keys(
        source_, *section.section, diagnostics_,
        [&](std::string_view key) { return find_key<EntryDescription>(entry_keys, key, sub_object); }, entry_keys);
  }

  std::vector<NumberedField> read_list(const IniSection& section) {
    return read_numbered_section(source_, section, nr_of_entries, diagnostics_);
  }

  const SourceFile& source_;
  std::string_view prefix_;
  Diagnostics& diagnostics_;
};

}  // namespace

std::uint32_t ObjectSection::order() const {
  return (std::uint32_t{name.index} << 16U) | (place_of_section(name.kind) << 8U) | name.sub_index;
}

void place_entry(const Position& position, EntryDescription& entry) {
  entry.position = position;
  place_fields(entry_keys, position, entry);
}

std::vector<ObjectDescription> read_objects(const SourceFile& source, std::vector<ObjectSection> sections,
                                            std::string_view prefix, Diagnostics& diagnostics) {
  sort_sections(sections);
  std::vector<ObjectDescription> objects;
  objects.reserve(count_indices(sections));
  ObjectReader reader(source, prefix, diagnostics);
  for (ObjectSections rest = sections; !rest.empty();) {
    const std::size_t length = length_of_object(rest);
    reader.read(rest.first(length), objects.emplace_back());
    rest = rest.subspan(length);
  }
  return objects;
}

}  // namespace edsc
