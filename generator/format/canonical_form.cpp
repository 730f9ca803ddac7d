#include "format/canonical_form.hpp"

#include <vector>

#include "format/object_list_sections.hpp"
#include "format/section_order.hpp"
#include "format/spelling/spell_section.hpp"

namespace edsc {
namespace {

/// Spells all sections. Returns false after the section of an object whose entries are not spelled so, if `stops`
/// there.
bool spell_sections(Document& document, const DataSheet& sheet, const Device& device, bool stops) {
  for (DocumentSection& section : document.sections) {
    if (!stops || !is_object_section(section.kind.kind)) {
      spell_section(section, sheet, device);
      continue;
    }
    const std::vector<DocumentEntry> before = section.entries;
    spell_section(section, sheet, device);
    if (section.entries != before) return false;
  }
  return true;
}

void order_document(Document& document, const DataSheet& sheet) {
  renew_object_lists(document, sheet);
  order_sections(document, sheet);
}

}  // namespace

Document canonical_form(const IniFile& ini, const DataSheet& sheet, const Device& device) {
  Document document = document_of(ini);
  drop_second_sections(document);
  static_cast<void>(spell_sections(document, sheet, device, false));
  order_document(document, sheet);
  return document;
}

bool is_canonical_form(std::string_view text, const IniFile& ini, const DataSheet& sheet, const Device& device) {
  Document document = document_of(ini);
  drop_second_sections(document);
  if (!spell_sections(document, sheet, device, true)) return false;
  order_document(document, sheet);
  return to_text(document) == text;
}

}  // namespace edsc
