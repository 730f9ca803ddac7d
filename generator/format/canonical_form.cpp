#include "format/canonical_form.hpp"

#include <vector>

#include "format/object_list_sections.hpp"
#include "format/section_order.hpp"
#include "format/spelling/spell_section.hpp"

namespace edsc {
namespace {

void order_document(Document& document, const DataSheet& sheet) {
  renew_object_lists(document, sheet);
  order_sections(document, sheet);
}

}  // namespace

Document canonical_form(const IniFile& ini, const DataSheet& sheet, const Device& device) {
  Document document = document_of(ini);
  drop_second_sections(document);
  for (DocumentSection& section : document.sections) spell_section(section, sheet, device);
  order_document(document, sheet);
  return document;
}

bool is_canonical_form(std::string_view text, const IniFile& ini, const DataSheet& sheet, const Device& device) {
  bool is_spelled = true;
  const auto spell = [&](DocumentSection& section) {
    const bool is_of_object = is_object_section(section.kind.kind);
    const std::vector<DocumentEntry> before = is_of_object ? section.entries : std::vector<DocumentEntry>{};
    spell_section(section, sheet, device);
    is_spelled = !is_of_object || section.entries == before;
    return is_spelled;
  };
  Document document = document_of(ini, spell);
  if (!is_spelled) return false;
  drop_second_sections(document);
  order_document(document, sheet);
  return to_text(document) == text;
}

}  // namespace edsc
