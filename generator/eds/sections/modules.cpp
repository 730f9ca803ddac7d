#include "eds/sections/other_sections.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <map>
#include <optional>
#include <vector>

#include "eds/number.hpp"
#include "eds/sections/duplicates.hpp"
#include "eds/sections/numbered_section.hpp"
#include "eds/sections/object_sections.hpp"
#include "eds/sections/section_keys.hpp"

namespace edsc {
namespace {

/// Reads the sections of one module, in file order.
class ModuleReader {
 public:
  ModuleReader(const SourceFile& source, ModuleDescription& module, Diagnostics& diagnostics)
      : source_(source), module_(module), diagnostics_(diagnostics) {}

  void read(std::span<const NamedSection> sections) {
    for (const NamedSection& section : sections) {
      read_section(section);
    }
    const std::string prefix = fmt::format("M{}Fixed", module_.number);
    module_.objects = read_objects(source_, std::move(object_sections_), prefix, diagnostics_);
    std::ranges::sort(module_.sub_extensions, {}, &SubExtension::index);
    if (!has_info_) {
      diagnostics_.warning("modules", module_.position, fmt::format("missing section [M{}ModuleInfo]", module_.number));
    }
  }

 private:
  void read_section(const NamedSection& section) {
    if (section.name.kind == SectionKind::module_fixed_object) {
      SectionName name = section.name;
      name.kind = name.part;
      object_sections_.push_back({name, section.section});
    } else if (is_first(section)) {
      read_first(section);
    }
  }

  /// Sections other than those of objects, whose reader detects duplicates itself.
  bool is_first(const NamedSection& section) {
    const auto [first, is_new] = first_.try_emplace({section.name.kind, section.name.index}, section.section);
    if (!is_new) {
      report_duplicate_section(source_, *section.section, *first->second, diagnostics_);
    }
    return is_new;
  }

  void read_first(const NamedSection& section) {
    const IniSection& keys = *section.section;
    if (section.name.kind == SectionKind::module_info) {
      has_info_ = true;
      place_fields(module_info_keys, section_position(source_, keys), module_);
      read_keys(
          source_, keys, diagnostics_, [&](std::string_view key) { return find_key(module_info_keys, key, module_); },
          module_info_keys);
    } else if (section.name.kind == SectionKind::module_comments) {
      module_.comments = read_comments(source_, keys, diagnostics_);
    } else if (section.name.kind == SectionKind::module_fixed_objects) {
      module_.fixed_objects = read_numbered_section(source_, keys, nr_of_list_entries, diagnostics_);
    } else if (section.name.kind == SectionKind::module_sub_extends) {
      module_.sub_extends = read_numbered_section(source_, keys, nr_of_list_entries, diagnostics_);
    } else if (section.name.kind == SectionKind::module_sub_extension) {
      read_extension(section.name.index, keys);
    }
  }

  void read_extension(std::uint16_t index, const IniSection& section) {
    SubExtension& extension = module_.sub_extensions.emplace_back();
    extension.index = index;
    place_entry(section_position(source_, section), extension);
    place_fields(sub_extension_keys, section_position(source_, section), extension);
    read_keys(
        source_, section, diagnostics_,
        [&](std::string_view key) {
          Field* const field = find_key<EntryDescription>(entry_keys, key, extension);
          return field != nullptr ? field : find_key(sub_extension_keys, key, extension);
        },
        entry_keys, sub_extension_keys);
  }

  const SourceFile& source_;
  ModuleDescription& module_;
  Diagnostics& diagnostics_;
  std::vector<ObjectSection> object_sections_;
  std::map<std::pair<SectionKind, std::uint16_t>, const IniSection*> first_;
  bool has_info_ = false;
};

void check_count(const SourceFile& source, const IniSection* section, const Modules& modules,
                 Diagnostics& diagnostics) {
  if (section == nullptr) {
    if (!modules.supported.empty()) {
      diagnostics.warning("modules", modules.supported[0].position, "missing section [SupportedModules]");
    }
    return;
  }
  const std::string_view text = strip_inline_comment(modules.nr_of_entries.text);
  const std::optional<std::uint64_t> count = parse_unsigned(text);
  const std::size_t highest = modules.supported.empty() ? 0 : modules.supported.back().number;
  if (!count || *count != modules.supported.size() || *count != highest) {
    diagnostics.warning(
        "modules", modules.nr_of_entries.present ? modules.nr_of_entries.position : section_position(source, *section),
        fmt::format("the modules are not numbered 1 to {}; {} are described", text, modules.supported.size()));
  }
}

}  // namespace

Modules read_modules(const SourceFile& source, const ModuleSections& sections, Diagnostics& diagnostics) {
  std::map<std::uint16_t, std::vector<NamedSection>> by_number;
  for (const NamedSection& section : sections.modules) {
    by_number[section.name.number].push_back(section);
  }
  Modules modules;
  modules.supported.reserve(by_number.size());
  for (const auto& [number, of_module] : by_number) {
    ModuleDescription& module = modules.supported.emplace_back();
    module.number = number;
    module.position = section_position(source, *of_module[0].section);
    ModuleReader(source, module, diagnostics).read(of_module);
  }
  if (sections.supported != nullptr) {
    read_keys(
        source, *sections.supported, diagnostics,
        [&](std::string_view key) {
          return equal_ignoring_case(key, module_count_key.name) ? &modules.nr_of_entries : nullptr;
        },
        module_count_key.name);
  }
  check_count(source, sections.supported, modules, diagnostics);
  if (sections.connected != nullptr) {
    modules.connected = read_numbered_section(source, *sections.connected, nr_of_list_entries, diagnostics);
  }
  return modules;
}

}  // namespace edsc
