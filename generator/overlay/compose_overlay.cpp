#include "overlay/compose_overlay.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <filesystem>
#include <map>
#include <system_error>
#include <utility>

#include "change/sheet_text.hpp"
#include "diagnostics/quote.hpp"
#include "eds/sections/section_keys.hpp"
#include "format/sheet_document.hpp"
#include "system/path.hpp"
#include "xdd/read_xdd.hpp"

namespace edsc {
namespace {

namespace fs = std::filesystem;

class OverlayComposer {
 public:
  OverlayComposer(const ComposeSettings& settings, Diagnostics& diagnostics)
      : settings_(settings), diagnostics_(diagnostics) {}

  ComposedOverlay compose(std::shared_ptr<const SourceFile> overlay) {
    std::shared_ptr<const SourceFile> file = std::move(overlay);
    while (true) {
      composed_.parts.push_back(file);
      if (!is_overlay(*file)) break;
      overlays_.push_back(read_overlay(*file, diagnostics_));
      file = read_base(overlays_.back());
      if (!file) return std::move(composed_);
    }
    composed_.base_path = file->name();
    apply(text_of_base(std::move(file)));
    return std::move(composed_);
  }

  ComposedOverlay compose(std::shared_ptr<const SourceFile> overlay, std::shared_ptr<const SourceFile> base) {
    overlays_.push_back(read_overlay(*overlay, diagnostics_));
    composed_.parts = {std::move(overlay), base};
    composed_.base_path = base->name();
    apply(text_of_base(std::move(base)));
    return std::move(composed_);
  }

 private:
  std::shared_ptr<const SourceFile> read_base(const OverlayFile& overlay) {
    const Field& base = overlay.header.base;
    const auto fail = [&](std::string message) {
      diagnostics_.error("overlay-base", base.position, std::move(message));
      return nullptr;
    };
    if (base.empty()) {
      if (!overlay.header.vendor_number.present) return nullptr;  // which is reported
      return fail("this overlay selects a file by its identity and is used from a folder of EDSC_OVERLAYS");
    }
    if (composed_.parts.size() > max_bases) {
      return fail(fmt::format("more than {} bases below each other", max_bases));
    }
    const std::string path = path_beside(overlay.source->name(), base.text);
    for (const auto& part : composed_.parts) {
      if (is_same_file(path, part->name())) return fail(fmt::format("{} is based on itself", quote(base.text)));
    }
    std::string error;
    const ReadingChoices choices = choices_of(overlay);
    std::unique_ptr<SourceFile> file =
        settings_.read ? settings_.read(path, choices, error) : read_source_file(path, error, choices);
    composed_.is_unreadable = !file;
    if (!file) return fail(error);
    return file;
  }

  /// The choices of the overlay, and those of the caller where it has none. An invalid one is reported with the
  /// overlay.
  [[nodiscard]] ReadingChoices choices_of(const OverlayFile& overlay) const {
    ReadingChoices choices = settings_.choices;
    for (const ReadingChoiceRow& row : reading_choice_rows()) {
      const Field& field = reading_choice(overlay.header, row);
      if (!field.empty()) static_cast<void>(row.set(field.text, choices));
    }
    return choices;
  }

  [[nodiscard]] static bool is_same_file(const std::string& a, const std::string& b) {
    if (to_native(a).lexically_normal() == to_native(b).lexically_normal()) return true;
    std::error_code missing;
    return fs::equivalent(to_native(a), to_native(b), missing);
  }

  void apply(std::shared_ptr<const SourceFile> text) {
    for (std::size_t i = overlays_.size(); i-- > 0;) {
      OverlayEdits edits = edits_of(overlays_[i], SheetText{*text}, i == 0 && settings_.needs_reasons, diagnostics_);
      std::unique_ptr<SourceFile> edited = edited_text(text, edits.edits, composed_.parts[i]);
      composed_.edits.push_back(std::move(edits.edits));
      if (i == 0) {
        composed_.outcomes = std::move(edits.outcomes);
        composed_.text = std::move(edited);
      } else {
        text = std::move(edited);
      }
    }
  }

  const ComposeSettings& settings_;
  Diagnostics& diagnostics_;
  ComposedOverlay composed_;
  std::vector<OverlayFile> overlays_;
};

/// The positions of the parts of an XDD, by the section and the key that they become.
class XddOrigins {
 public:
  explicit XddOrigins(const DataSheet& sheet) {
    for (const ObjectDescription& object : sheet.objects) {
      add({.kind = SectionKind::object, .index = object.index}, object);
      for (const SubObjectDescription& sub : object.sub_objects) {
        add({.kind = SectionKind::sub_object, .index = object.index, .sub_index = sub.sub_index}, sub);
      }
    }
  }

  [[nodiscard]] Position find(const SectionName& section, std::string_view key) const {
    const auto entry = entries_.find(identity(section));
    if (!is_object_section(section.kind) || entry == entries_.end()) return {};
    for (const KeyRow<EntryDescription>& row : entry_keys) {
      const Field& field = entry->second->*row.field;
      if (row.key.name == key && field.position.line != 0) return field.position;
    }
    return entry->second->position;
  }

 private:
  void add(const SectionName& name, const EntryDescription& entry) { entries_[identity(name)] = &entry; }

  std::map<std::uint64_t, const EntryDescription*> entries_;
};

}  // namespace

std::string path_beside(const std::string& from, std::string_view path) {
  return from_native((to_native(from).parent_path() / to_native(path)).lexically_normal());
}

std::shared_ptr<const SourceFile> text_of_base(std::shared_ptr<const SourceFile> file) {
  if (!is_xml(*file)) return file;
  Diagnostics ignored;
  const DataSheet sheet = read_xdd(*file, ignored);
  if (sheet.objects.empty()) return file;
  fs::path name = to_native(file_name_of(file->name()));
  name.replace_extension(sheet.is_dcf ? ".dcf" : ".eds");
  const SourceFile converted{from_native(name), to_text(document_of(sheet, from_native(name)))};
  const XddOrigins origins{sheet};
  std::vector<ComposedPart> lines;
  SectionName section;
  for (std::uint32_t line = 1; line <= converted.lines(); ++line) {
    const std::string_view text = converted.line(line);
    if (const auto header = read_ini_header(text)) section = read_section_name(*header);
    const auto entry = read_ini_entry(text, line);
    const Position place = origins.find(section, entry ? entry->key : std::string_view{});
    LineOrigin origin{.file = file.get(), .line = place.line};
    origin.value_column = 1;
    origin.origin_value_column = std::max<std::uint32_t>(place.column, 1);
    if (entry) {
      origin.value_column = entry->value_column;
      origin.origin_key_column = origin.origin_value_column;
    }
    lines.emplace_back(ComposedLine{text, converted.line_end(line), origin});
  }
  return std::make_shared<const SourceFile>(file->name(), lines, std::vector<std::shared_ptr<const SourceFile>>{file});
}

ComposedOverlay compose_overlay(std::shared_ptr<const SourceFile> overlay, const ComposeSettings& settings,
                                Diagnostics& diagnostics) {
  return OverlayComposer(settings, diagnostics).compose(std::move(overlay));
}

ComposedOverlay compose_overlay(std::shared_ptr<const SourceFile> overlay, std::shared_ptr<const SourceFile> base,
                                const ComposeSettings& settings, Diagnostics& diagnostics) {
  return OverlayComposer(settings, diagnostics).compose(std::move(overlay), std::move(base));
}

}  // namespace edsc
