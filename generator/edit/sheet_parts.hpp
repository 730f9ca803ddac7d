/// What the page of `edsc edit` shows of an EDS or DCF, as parts in JSON: docs/schema/edit.schema.json.
#pragma once

#include <map>
#include <nlohmann/json.hpp>
#include <string>
#include <string_view>

#include "change/fixes.hpp"
#include "change/open_sheet.hpp"

namespace edsc::edit {

using Json = nlohmann::ordered_json;

/// The entries of an earlier text by their sections, as JSON.
using KnownEntries = std::map<std::string, std::string>;

[[nodiscard]] KnownEntries known_entries(const OpenSheet& sheet);

/// Parts by their names; a part is sent again if its text changes.
class SheetParts {
 public:
  void set(std::string name, const Json& part) {
    texts_[std::move(name)] = part.dump(-1, ' ', false, Json::error_handler_t::replace);
  }
  [[nodiscard]] const std::map<std::string, std::string>& texts() const { return texts_; }

 private:
  std::map<std::string, std::string> texts_;
};

/// Texts to compare the entries with; null without one.
struct EarlierEntries {
  const KnownEntries* committed = nullptr;  ///< the file in git HEAD
  const KnownEntries* base = nullptr;       ///< the base of an overlay
};

/// `tree`, and `object/2000` for each object.
void add_objects(const OpenSheet& sheet, const EarlierEntries& earlier, SheetParts& parts);
/// `device`
void add_device(const OpenSheet& sheet, SheetParts& parts);
/// `pdos`, `candidates/rpdo`, `candidates/tpdo`
void add_pdos(const OpenSheet& sheet, SheetParts& parts);
/// `choices`
void add_choices(SheetParts& parts);
/// `standard`: known objects that the file does not have.
void add_standard_objects(const OpenSheet& sheet, SheetParts& parts);
/// `findings`. `can_allow`: a comment of the file can allow a finding.
void add_findings(const OpenSheet& sheet, bool can_allow, SheetParts& parts);

/// A finding with the place in its file and, if these are given, its fixes.
[[nodiscard]] Json finding_json(const OpenSheet& sheet, const Diagnostic& one, const Fixes* fixes);

/// The profile number in 1000h; 0 without one.
[[nodiscard]] std::uint16_t profile_of(const OpenSheet& sheet);

/// The title of a section as edsc writes it: `2000`, `2000subA`.
[[nodiscard]] std::string section_of(const OpenSheet& sheet, std::uint16_t index, int sub_index);

}  // namespace edsc::edit
