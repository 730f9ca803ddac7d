#include "eds/data_sheet.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cstddef>
#include <optional>
#include <tuple>
#include <unordered_map>
#include <utility>

#include "diagnostics/quote.hpp"
#include "eds/number.hpp"
#include "eds/sections/duplicates.hpp"
#include "eds/sections/object_lists.hpp"
#include "eds/sections/object_sections.hpp"
#include "eds/sections/other_sections.hpp"
#include "eds/sections/section_keys.hpp"
#include "eds/sections/section_name.hpp"
#include "text/source_file.hpp"
#include "text/suggestion.hpp"

namespace edsc {
namespace {

class DataSheetReader {
 public:
  DataSheetReader(const IniFile& ini, Diagnostics& diagnostics)
      : ini_(ini), source_(*ini.source), diagnostics_(diagnostics) {}

  DataSheet read() {
    sheet_.source = &source_;
    if (!ini_.sections.empty()) {  // otherwise the INI reader has reported why
      sort_sections();
      std::apply([&](const auto&... sections) { (read_plain(sections), ...); }, plain_sections);
      read_dummy_usage();
      read_others();
      read_objects();
    }
    const std::string& name = source_.base().name();  // that of an XDC whose text an overlay changes
    sheet_.is_dcf =
        sheet_.commissioning.present || ends_with_ignoring_case(name, ".dcf") || ends_with_ignoring_case(name, ".xdc");
    return std::move(sheet_);
  }

 private:
  void sort_sections() {
    for (const IniSection& section : ini_.sections) {
      const SectionName name = read_section_name(section.name, source_.choices().sub_indices);
      report_name(section, name);
      if (is_object_section(name.kind)) {
        object_sections_.push_back({name, &section});
      } else if (is_module_section(name.kind)) {
        module_sections_.push_back({name, &section});
      } else if (name.kind == SectionKind::tool) {
        tool_sections_.push_back({name, &section});
      } else if (is_single(name.kind)) {
        place_single(section, name.kind);
      }
    }
  }

  void report_name(const IniSection& section, const SectionName& name) {
    const Position position = section_position(source_, section);
    if (name.kind == SectionKind::malformed) {
      diagnostics_.error("section-name", position,
                         fmt::format("{} is not a valid section name: {}", quote(section.name), name.remark), {},
                         std::string{name.remark});
    } else if (name.kind == SectionKind::unknown) {
      diagnostics_.warning(
          "unknown-section", position,
          fmt::format("unknown section {}; ignored{}", quote(section.name), similar_section(section.name)));
    } else if (!name.remark.empty()) {
      diagnostics_.warning(
          "section-name", position,
          fmt::format("{}; reading {} as [{}]", name.remark, quote(section.name), spell_section_name(name)), {},
          std::string{name.remark});
    }
  }

  [[nodiscard]] std::string similar_section(std::string_view name) const {
    const bool is_listed = !diagnostics_.counts_only("unknown-section", Severity::warning, &source_);
    return is_listed ? did_you_mean(name, known_section_names(name)) : std::string{};
  }

  void place_single(const IniSection& section, SectionKind kind) {
    const IniSection*& place = single_[static_cast<std::size_t>(kind)];
    if (place == nullptr) {
      place = &section;
    } else {
      report_duplicate_section(source_, section, *place, diagnostics_);
    }
  }

  /// The section of a kind that occurs once, or null.
  [[nodiscard]] const IniSection* single(SectionKind kind) const { return single_[static_cast<std::size_t>(kind)]; }

  template <typename Struct, std::size_t n>
  void read_plain(const PlainSection<Struct, n>& plain) {
    const IniSection* const section = single(plain.kind);
    Struct& target = sheet_.*plain.member;
    target.present = section != nullptr;
    target.position = section == nullptr ? Position{&source_} : section_position(source_, *section);
    place_fields(plain.keys, target.position, target);
    if (section == nullptr) return;
    read_keys(
        source_, *section, diagnostics_,
        [&](std::string_view key) {
          Field* const field = find_key(plain.keys, key, target);
          return field != nullptr ? field : find_numbered(key, target);
        },
        plain.keys);
  }

  template <typename Struct>
  static Field* find_numbered(std::string_view /*key*/, const Struct& /*target*/) {
    return nullptr;
  }

  Field* find_numbered(std::string_view key, DeviceInfo& info) {
    const auto rate = match_key(baud_rate_key, key);
    if (!rate) return nullptr;
    const auto kbit_per_second = static_cast<std::uint16_t>(*rate);
    const auto [place, is_new] = baud_rate_places_.try_emplace(kbit_per_second, info.baud_rates.size());
    if (is_new) info.baud_rates.push_back({kbit_per_second, {}});
    return &info.baud_rates[place->second].field;
  }

  void read_dummy_usage() {
    if (const IniSection* const section = single(SectionKind::dummy_usage)) {
      read_keys(source_, *section, diagnostics_, [&](std::string_view key) { return find_dummy(key); });
    }
  }

  /// `Dummy0005`: the index of a data type.
  Field* find_dummy(std::string_view key) {
    const auto index = match_key(dummy_key, key);
    if (!index) return nullptr;
    std::vector<NumberedField>& dummies = sheet_.dummy_usage;
    const auto found = std::ranges::find(dummies, *index, &NumberedField::number);
    return found != dummies.end() ? &found->field : &dummies.emplace_back(NumberedField{*index, {}}).field;
  }

  void read_others() {
    if (const IniSection* const section = single(SectionKind::comments)) {
      sheet_.comments = read_comments(source_, *section, diagnostics_);
    }
    sheet_.tools = read_tools(source_, single(SectionKind::tools), tool_sections_, diagnostics_);
    if (const IniSection* const section = single(SectionKind::dynamic_channels)) {
      sheet_.dynamic_channels = read_dynamic_channels(source_, *section, diagnostics_);
    }
    sheet_.modules = read_modules(
        source_, {single(SectionKind::supported_modules), single(SectionKind::connected_modules), module_sections_},
        diagnostics_);
  }

  /// The EDS of the Common Industrial Protocol has the same extension: [File] and [Device] with VendCode.
  [[nodiscard]] bool is_of_cip() const {
    const auto has_key = [&](std::string_view section, std::string_view key) {
      return std::ranges::any_of(ini_.sections, [&](const IniSection& one) {
        return equal_ignoring_case(one.name, section) && one.find(key) != nullptr;
      });
    };
    return has_key("Device", "VendCode") || has_key("File", "DescText");
  }

  void read_objects() {
    if (object_sections_.empty()) {
      diagnostics_.error("no-objects", {&source_},
                         is_of_cip() ? "this is an EDS of EtherNet/IP, DeviceNet or ControlNet (ODVA), not of CANopen "
                                       "(CiA 306): it has no object section such as [1000]"
                                     : "the file does not have an object section such as [1000]");
      return;
    }
    sheet_.objects = edsc::read_objects(source_, std::move(object_sections_), {}, diagnostics_);
    sheet_.listed = read_object_lists(source_,
                                      {single(SectionKind::mandatory_objects), single(SectionKind::optional_objects),
                                       single(SectionKind::manufacturer_objects)},
                                      diagnostics_);
    compare_lists_with_objects(sheet_, diagnostics_);
  }

  const IniFile& ini_;
  const SourceFile& source_;
  Diagnostics& diagnostics_;
  DataSheet sheet_;
  std::array<const IniSection*, static_cast<std::size_t>(SectionKind::unknown)> single_{};
  std::unordered_map<std::uint16_t, std::size_t> baud_rate_places_;  ///< index in the list of rates with a key
  std::vector<ObjectSection> object_sections_;
  std::vector<NamedSection> tool_sections_;
  std::vector<NamedSection> module_sections_;
};

}  // namespace

const SubObjectDescription* ObjectDescription::find(std::uint64_t sub_index) const {
  const auto at = std::ranges::find(sub_objects, sub_index, &SubObjectDescription::sub_index);
  return at != sub_objects.end() ? &*at : nullptr;
}

const ObjectDescription* DataSheet::find(std::uint64_t index) const {
  const auto at = std::ranges::lower_bound(objects, index, {}, &ObjectDescription::index);
  return at != objects.end() && at->index == index ? &*at : nullptr;
}

ValueFields DataSheet::values_of(const ObjectDescription& object, std::uint8_t sub_index, bool has_sub_indices) const {
  if (const SubObjectDescription* sub = object.find(sub_index)) return {&sub->default_value, &sub->parameter_value};
  if (has_sub_indices && sub_index == 0) return {};
  ValueFields fields{&object.default_value, &object.parameter_value};
  const auto value = std::ranges::find(object.compact_values, sub_index, &NumberedField::number);
  if (has_sub_indices && value != object.compact_values.end()) {
    (is_dcf ? fields.parameter_value : fields.default_value) = &value->field;
  }
  return fields;
}

DataSheet read_data_sheet(const IniFile& ini, Diagnostics& diagnostics) {
  return DataSheetReader(ini, diagnostics).read();
}

}  // namespace edsc
