/// What the page of `edsc edit` shows of an EDS or DCF, as parts in JSON: docs/schema/edit.schema.json.
#pragma once

#include <map>
#include <string>

#include "change/fixes.hpp"
#include "change/open_sheet.hpp"
#include "edit/edit_parts.hpp"

namespace edsc::edit {

/// The entries of an earlier text by their sections, as JSON.
using KnownEntries = std::map<std::string, std::string>;

[[nodiscard]] KnownEntries known_entries(const OpenSheet& sheet);

/// Texts to compare the entries with; null without one.
struct EarlierEntries {
  const KnownEntries* committed = nullptr;  ///< the file in git HEAD
  const KnownEntries* base = nullptr;       ///< the base of an overlay
};

/// `tree`, and `object/2000` for each object.
void add_objects(const OpenSheet& sheet, const EarlierEntries& earlier, EditParts& parts);
/// `device`
void add_device(const OpenSheet& sheet, EditParts& parts);
/// `pdos`, `candidates/rpdo`, `candidates/tpdo`
void add_pdos(const OpenSheet& sheet, EditParts& parts);
/// `choices`
void add_choices(EditParts& parts);
/// `standard`: known objects that the file does not have.
void add_standard_objects(const OpenSheet& sheet, EditParts& parts);
/// `findings`. `can_allow`: a comment of the file can allow a finding.
void add_findings(const OpenSheet& sheet, bool can_allow, EditParts& parts);

/// A finding with the place in its file and, if these are given, its fixes.
[[nodiscard]] Json finding_json(const OpenSheet& sheet, const Diagnostic& one, const Fixes* fixes);

/// The profile number in 1000h; 0 without one.
[[nodiscard]] std::uint16_t profile_of(const OpenSheet& sheet);

/// The title of a section as edsc writes it: `2000`, `2000subA`.
[[nodiscard]] std::string section_of(const OpenSheet& sheet, std::uint16_t index, int sub_index);

}  // namespace edsc::edit
