#include "eds/data_sheet.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cstddef>
#include <limits>
#include <optional>
#include <unordered_map>
#include <utility>

#include "diagnostics/quote.hpp"
#include "eds/comments.hpp"
#include "eds/duplicates.hpp"
#include "eds/dynamic_channels.hpp"
#include "eds/keys.hpp"
#include "eds/modules.hpp"
#include "eds/number.hpp"
#include "eds/object_lists.hpp"
#include "eds/object_sections.hpp"
#include "eds/section_name.hpp"
#include "eds/sheet_keys.hpp"
#include "eds/tools.hpp"
#include "text/source_file.hpp"
#include "text/suggestion.hpp"

namespace edsc {
namespace {

constexpr std::string_view dummy_prefix = "Dummy";
constexpr std::size_t dummy_digits = 4;
constexpr std::uint16_t last_dummy = 0xFF;

constexpr bool is_object_kind(SectionKind kind) {
  return kind >= SectionKind::object && kind <= SectionKind::object_links;
}

constexpr bool is_module_kind(SectionKind kind) {
  return kind >= SectionKind::module_info && kind <= SectionKind::module_sub_extension;
}

class DataSheetReader {
 public:
  DataSheetReader(const IniFile& ini, Diagnostics& diagnostics)
      : ini_(ini), source_(*ini.source), diagnostics_(diagnostics) {}

  DataSheet read() {
    sheet_.source = &source_;
    if (!ini_.sections.empty()) {  // otherwise the INI reader has reported why
      sort_sections();
      read_file_info();
      read_device_info();
      read_commissioning();
      read_dummy_usage();
      read_others();
      read_objects();
    }
    sheet_.is_dcf = sheet_.commissioning.present || ends_with_ignoring_case(source_.name(), ".dcf");
    return std::move(sheet_);
  }

 private:
  void sort_sections() {
    for (const IniSection& section : ini_.sections) {
      const SectionName name = read_section_name(section.name);
      report_name(section, name);
      if (is_object_kind(name.kind)) {
        object_sections_.push_back({name, &section});
      } else if (is_module_kind(name.kind)) {
        module_sections_.push_back({name, &section});
      } else if (name.kind == SectionKind::tool) {
        tool_sections_.push_back({name, &section});
      } else if (name.kind < SectionKind::malformed) {
        place_single(section, name.kind);
      }
    }
  }

  void report_name(const IniSection& section, const SectionName& name) {
    const Position position = section_position(source_, section);
    if (name.kind == SectionKind::malformed) {
      diagnostics_.error("section-name", position,
                         fmt::format("{} is not a valid section name: {}", quote(section.name), name.remark));
    } else if (name.kind == SectionKind::unknown) {
      diagnostics_.warning(
          "unknown-section", position,
          fmt::format("unknown section {}; it is left out{}", quote(section.name), similar_section(section.name)));
    } else if (name.has_short_index) {
      diagnostics_.warning(
          "section-name", position,
          fmt::format("an index has four digits; reading {} as {:04X}h", quote(section.name), name.index));
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

  /// The position for a missing field of this section: the section, or the file if the section is missing too.
  [[nodiscard]] Position place_of(const IniSection* section) const {
    return section == nullptr ? Position{&source_} : section_position(source_, *section);
  }

  void read_file_info() {
    const IniSection* const section = single(SectionKind::file_info);
    sheet_.file_info.present = section != nullptr;
    sheet_.file_info.position = place_of(section);
    place_fields(file_info_keys, place_of(section), sheet_.file_info);
    if (section != nullptr) {
      read_keys(
          source_, *section, diagnostics_,
          [&](std::string_view key) { return find_key(file_info_keys, key, sheet_.file_info); }, file_info_keys);
    }
  }

  void read_device_info() {
    const IniSection* const section = single(SectionKind::device_info);
    sheet_.device_info.present = section != nullptr;
    sheet_.device_info.position = place_of(section);
    place_fields(device_info_keys, place_of(section), sheet_.device_info);
    if (section != nullptr) {
      read_keys(
          source_, *section, diagnostics_,
          [&](std::string_view key) {
            const KeyMatch match = find_key(device_info_keys, key, sheet_.device_info);
            return match.is_known ? match : find_baud_rate(key);
          },
          device_info_keys);
    }
  }

  /// `BaudRate_125` etc., including rates for which CiA 306 does not define a key.
  KeyMatch find_baud_rate(std::string_view key) {
    if (!starts_with_ignoring_case(key, baud_rate_prefix)) {
      return {};
    }
    const std::optional<std::uint64_t> rate = parse_unsigned(key.substr(baud_rate_prefix.size()));
    if (!rate || *rate > std::numeric_limits<std::uint16_t>::max()) {
      return {};
    }
    std::vector<DeviceInfo::BaudRate>& rates = sheet_.device_info.baud_rates;
    const auto kbit_per_second = static_cast<std::uint16_t>(*rate);
    const auto [place, is_new] = baud_rate_places_.try_emplace(kbit_per_second, rates.size());
    if (is_new) {
      rates.push_back({kbit_per_second, {}});
    }
    return {true, &rates[place->second].field};
  }

  void read_commissioning() {
    const IniSection* const section = single(SectionKind::device_commissioning);
    sheet_.commissioning.present = section != nullptr;
    sheet_.commissioning.position = place_of(section);
    place_fields(commissioning_keys, place_of(section), sheet_.commissioning);
    if (section != nullptr) {
      read_keys(
          source_, *section, diagnostics_,
          [&](std::string_view key) { return find_key(commissioning_keys, key, sheet_.commissioning); },
          commissioning_keys);
    }
  }

  void read_dummy_usage() {
    if (const IniSection* const section = single(SectionKind::dummy_usage)) {
      read_keys(source_, *section, diagnostics_, [&](std::string_view key) { return find_dummy(key); });
    }
  }

  /// `Dummy0005`: the index of a data type, in hexadecimal.
  KeyMatch find_dummy(std::string_view key) {
    if (!starts_with_ignoring_case(key, dummy_prefix) || key.size() != dummy_prefix.size() + dummy_digits) {
      return {};
    }
    const std::optional<std::uint16_t> index = parse_hex(key.substr(dummy_prefix.size()), dummy_digits);
    if (!index || *index == 0 || *index > last_dummy) {
      return {};
    }
    std::vector<NumberedField>& dummies = sheet_.dummy_usage;
    const auto found = std::find_if(dummies.begin(), dummies.end(),
                                    [&](const NumberedField& known) { return known.number == *index; });
    return {true, found != dummies.end() ? &found->field : &dummies.emplace_back(NumberedField{*index, {}}).field};
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

  void read_objects() {
    if (object_sections_.empty()) {
      diagnostics_.error("no-objects", {&source_}, "the file does not have an object section such as [1000]");
      return;
    }
    sheet_.objects = edsc::read_objects(source_, std::move(object_sections_), {}, diagnostics_);
    const ObjectListSections lists{single(SectionKind::mandatory_objects), single(SectionKind::optional_objects),
                                   single(SectionKind::manufacturer_objects)};
    sheet_.listed = read_object_lists(source_, lists, diagnostics_);
    compare_lists_with_objects(sheet_, diagnostics_);
  }

  const IniFile& ini_;
  const SourceFile& source_;
  Diagnostics& diagnostics_;
  DataSheet sheet_;
  std::array<const IniSection*, static_cast<std::size_t>(SectionKind::malformed)> single_{};
  std::unordered_map<std::uint16_t, std::size_t> baud_rate_places_;  ///< index in the list of rates with a key
  std::vector<ObjectSection> object_sections_;
  std::vector<NamedSection> tool_sections_;
  std::vector<NamedSection> module_sections_;
};

}  // namespace

DataSheet read_data_sheet(const IniFile& ini, Diagnostics& diagnostics) {
  return DataSheetReader(ini, diagnostics).read();
}

}  // namespace edsc
