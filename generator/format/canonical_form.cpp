#include "format/canonical_form.hpp"

#include "format/object_list_sections.hpp"
#include "format/section_order.hpp"
#include "format/spelling/spell_section.hpp"

namespace edsc {

Document canonical_form(const IniFile& ini, const DataSheet& sheet, const Device& device) {
  Document document = document_of(ini);
  drop_second_sections(document);
  for (DocumentSection& section : document.sections) {
    spell_section(section, sheet, device);
  }
  renew_object_lists(document, sheet);
  order_sections(document, sheet);
  return document;
}

}  // namespace edsc
