#include "change/change_applier.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <canopen/od/data_type.hpp>
#include <variant>

#include "change/number_style.hpp"
#include "change/text_edit.hpp"
#include "eds/number.hpp"
#include "eds/sections/section_keys.hpp"
#include "format/spelling/key_table.hpp"
#include "text/ascii.hpp"
#include "text/utf8.hpp"

namespace edsc {
namespace {

constexpr std::uint8_t max_mapped_objects = 64;

constexpr bool is_in(std::uint16_t index, std::uint16_t first, std::uint16_t last) {
  return index >= first && index <= last;
}
constexpr bool is_mapping_index(std::uint16_t index) {
  return is_in(index, 0x1600, 0x17FF) || is_in(index, 0x1A00, 0x1BFF);
}

/// The PDO of a mapping parameter.
std::string pdo_of_mapping(std::uint16_t index) {
  return index < 0x1A00 ? fmt::format("RPDO {}", index - 0x1600 + 1) : fmt::format("TPDO {}", index - 0x1A00 + 1);
}

std::string lower_case(std::string_view text) {
  std::string result{text};
  std::ranges::transform(result, result.begin(), to_lower);
  return result;
}

bool has_control_character(std::string_view text) {
  return std::ranges::any_of(text, [](char c) { return (c >= '\0' && c < ' ' && c != '\t') || c == '\x7F'; });
}

/// Why a line cannot have a text; empty if it can.
std::string_view text_problem(std::string_view text) {
  if (has_control_character(text)) return "a text with a control character";
  return is_utf8(text) ? std::string_view{} : "a text that is not UTF-8";
}

bool can_be_key(std::string_view key) {
  return !key.empty() && key.find('=') == std::string_view::npos &&
         std::string_view{";#["}.find(key.front()) == std::string_view::npos && text_problem(key).empty();
}

bool can_be_title(std::string_view title) {
  return !title.empty() && title.find_first_of("[]") == std::string_view::npos && text_problem(title).empty();
}

/// The identity of a device: keys of [DeviceInfo] and sub-indices of 1018h.
struct IdentityRow {
  std::string_view key;
  std::uint8_t sub_index;
};
constexpr std::uint16_t identity_index = 0x1018;
constexpr IdentityRow identity_rows[] = {{"VendorNumber", 1}, {"ProductNumber", 2}, {"RevisionNumber", 3}};

/// The counts of PDOs in [DeviceInfo], with the communication parameters that they count.
struct PdoCountRow {
  std::string_view key;
  std::uint16_t first, last;
};
constexpr PdoCountRow pdo_count_rows[] = {{"NrOfRXPDO", 0x1400, 0x15FF}, {"NrOfTXPDO", 0x1800, 0x19FF}};

/// An entry of a communication parameter (CiA 301, 7.5.2.35 and 7.5.2.37).
struct CommunicationRow {
  std::uint8_t sub_index;
  std::string_view name;
  canopen::DataType type;
  std::string_view usual;  ///< default value of a new entry
};
constexpr CommunicationRow communication_rows[] = {
    {1, "COB-ID used by PDO", canopen::DataType::unsigned32, "0x80000000"},
    {2, "Transmission type", canopen::DataType::unsigned8, "0xFF"},
    {3, "Inhibit time", canopen::DataType::unsigned16, "0"},
    {5, "Event timer", canopen::DataType::unsigned16, "0"},
    {6, "SYNC start value", canopen::DataType::unsigned8, "0"},
};
constexpr std::uint8_t required_communication_entries = 2;

/// The values of a change, in the order of `communication_rows`.
std::vector<std::optional<std::string>> communication_values(const MapPdo& change) {
  const auto text = [](const auto& number) -> std::optional<std::string> {
    return number ? std::optional{fmt::format("{}", *number)} : std::nullopt;
  };
  return {change.cob_id, text(change.transmission_type), text(change.inhibit_time), text(change.event_timer),
          text(change.sync_start)};
}

/// The COB-ID that CiA 301 pre-defines for the first four PDOs; the others are disabled.
std::string usual_cob_id(const MapPdo& change) {
  if (change.number > 4) return "0x80000000";
  const unsigned first = change.direction == PdoDirection::receive ? 0x200 : 0x180;
  return fmt::format("$NODEID+0x{:X}", first + 0x100U * (change.number - 1U));
}

NewSection value_section(std::string title, std::string_view name, canopen::DataType type, std::string_view value,
                         bool is_dcf, std::string_view access = "rw") {
  NewSection section{std::move(title),
                     {{"ParameterName", std::string{name}},
                      {"ObjectType", "0x7"},
                      {"DataType", fmt::format("0x{:04X}", static_cast<unsigned>(type))},
                      {"AccessType", std::string{access}},
                      {"DefaultValue", std::string{value}},
                      {"PDOMapping", "0"}}};
  if (is_dcf) section.keys.emplace_back("ParameterValue", value);
  return section;
}

NewSection record_section(std::uint16_t index, std::string_view name, std::size_t entries) {
  return {fmt::format("{:04X}", index),
          {{"ParameterName", std::string{name}}, {"ObjectType", "0x9"}, {"SubNumber", fmt::format("{}", entries)}}};
}

std::string mapping_text(const MappingValue& value) { return fmt::format("0x{:08X}", value.value()); }

}  // namespace

ChangeApplier::ChangeApplier(std::shared_ptr<const SourceFile> source)
    : source_(std::move(source)), step_(std::make_unique<Step>(*source_)) {}

void ChangeApplier::apply(const SheetChange& change) {
  if (!problem_.empty()) return;
  std::visit([&](const auto& one) { make(one); }, change);
}

std::shared_ptr<const SourceFile> ChangeApplier::finish() {
  flush();
  return source_;
}

void ChangeApplier::reject(std::string problem) {
  if (problem_.empty()) problem_ = std::move(problem);
}

void ChangeApplier::flush() {
  if (!step_->is_changed || !problem_.empty()) return;
  if (const std::vector<std::string> duplicates = step_->edit.duplicate_sections(); !duplicates.empty()) {
    return reject(fmt::format("section [{}] already exists", duplicates.front()));
  }
  const std::vector<TextEdit> edits = step_->edit.finish();
  std::string text = edited_bytes(source_->text(), Encoding::utf8, edits, true).bytes;
  ReadingChoices choices = source_->choices();
  choices.encoding = Encoding::utf8;
  step_.reset();
  source_ = std::make_shared<SourceFile>(source_->name(), std::move(text), Packing::none, choices);
  step_ = std::make_unique<Step>(*source_);
}

const TextSection* ChangeApplier::find(std::string_view title) {
  const TextSection* const section = step_->text.find(title);
  if (section == nullptr) reject(fmt::format("section [{}] is missing", title));
  return section;
}

std::optional<IniEntry> ChangeApplier::find_key(const TextSection& section, std::string_view title,
                                                std::string_view key) {
  auto entry = step_->text.find_entry(section, key);
  if (!entry) {
    const CountedName counted = read_counted_name(key);
    entry = step_->text.find_entry(section, counted.name, counted.occurrence);
  }
  if (!entry) reject(fmt::format("[{}] does not have a key {}", title, key));
  return entry;
}

// Values.

void ChangeApplier::make(const SetValue& change) {
  const SectionName name = read_section_name(change.section, source_->choices().sub_indices);
  if (step_->text.find(change.section) == nullptr && is_single(name.kind) && !is_object_list(name.kind)) {
    make(AddSections{{{change.section, {{change.key, change.value}}}}});
    return;
  }
  const TextSection* section = find(change.section);
  if (section == nullptr) return;
  set(*section, change.key, change.value);
  section = problem_.empty() ? find(change.section) : nullptr;
  if (section != nullptr) follow_identity(*section, change.key, change.value);
}

bool ChangeApplier::is_numeric(const TextSection& section, std::string_view key) const {
  const ValueKind kind = spell_key(section.name, key).value;
  if (kind == ValueKind::text || kind == ValueKind::access) return false;
  if (kind != ValueKind::typed) return true;
  const TextSection* const object =
      step_->text.find(SectionName{.kind = SectionKind::object, .index = section.name.index});
  auto type = step_->text.find_entry(section, "DataType");
  if (!type && object != nullptr) type = step_->text.find_entry(*object, "DataType");
  const auto code = type ? parse_unsigned(strip_inline_comment(type->value)) : std::nullopt;
  const canopen::DataTypeRow* const row =
      code && *code <= UINT16_MAX ? canopen::find_data_type(static_cast<std::uint32_t>(*code)) : nullptr;
  return row != nullptr && row->bits != 0;
}

void ChangeApplier::set(const TextSection& section, std::string_view key, std::string_view value) {
  key = trim(key);
  value = trim(value);
  if (!can_be_key(key)) return reject(fmt::format("{} cannot be a key", key));
  if (const std::string_view problem = text_problem(value); !problem.empty()) {
    return reject(fmt::format("{} of [{}] cannot have {}", key, section.title, problem));
  }
  const std::string title{section.title};
  const TextSection* place = &section;
  auto entry = step_->text.find_entry(section, key);
  const auto added = std::pair{section.line, lower_case(key)};
  if (step_->added_keys.contains(added) || (entry && step_->edit.is_touched(*entry))) {
    flush();
    place = find(title);
    if (place == nullptr) return;
    entry = step_->text.find_entry(*place, key);
  }
  if (entry) return set_existing(*place, *entry, value);
  const KeySpelling spelling = spell_key(place->name, key);
  const std::string text = is_numeric(*place, key) ? restyled(value, "") : std::string{value};
  step_->edit.add_entry(*place, spelling.name,
                        {{fmt::format("{}={}", spelling.name, text), source_->origin(place->line)}});
  step_->added_keys.emplace(place->line, lower_case(key));
  step_->is_changed = true;
}

void ChangeApplier::set_existing(const TextSection& section, const IniEntry& entry, std::string_view value) {
  const bool numeric = is_numeric(section, entry.key);
  const std::string_view old_value = numeric ? strip_inline_comment(entry.value) : entry.value;
  const std::string text = numeric ? restyled(value, old_value) : std::string{value};
  if (text == old_value) return;
  step_->edit.set_value(entry, text, {.file = source_.get(), .line = entry.line}, !numeric);
  step_->is_changed = true;
}

void ChangeApplier::set_in_single(SectionKind kind, std::string_view key, std::string_view value) {
  const TextSection* const section = step_->text.find(SectionName{.kind = kind});
  if (section != nullptr) return set(*section, key, value);
  make(AddSections{{{std::string{section_title(kind)}, {{std::string{key}, std::string{value}}}}}});
}

void ChangeApplier::follow_identity(const TextSection& section, std::string_view key, std::string_view value) {
  const bool is_info = section.name.kind == SectionKind::device_info;
  const bool is_object = section.name.kind == SectionKind::sub_object && section.name.index == identity_index &&
                         equal_ignoring_case(key, "DefaultValue");
  const std::uint8_t sub_index = section.name.sub_index;
  for (const IdentityRow& row : identity_rows) {
    if (is_info && equal_ignoring_case(key, row.key)) {
      const TextSection* const other = step_->text.find(
          SectionName{.kind = SectionKind::sub_object, .index = identity_index, .sub_index = row.sub_index});
      if (other != nullptr) set(*other, "DefaultValue", value);
    } else if (is_object && sub_index == row.sub_index && parse_unsigned(restyled(value, ""))) {
      const TextSection* const other = step_->text.find(SectionName{.kind = SectionKind::device_info});
      if (other != nullptr) set(*other, row.key, value);
    }
  }
}

// Sections.

void ChangeApplier::make(const RemovePart& change) {
  flush();
  const TextSection* const section = find(change.section);
  if (section == nullptr) return;
  if (!change.key.empty()) {
    const auto entry = find_key(*section, change.section, change.key);
    if (!entry) return;
    step_->edit.remove_entry(*entry);
  } else {
    check_unmapped(section->name);
    count_pdos({section->name}, {});
    step_->edit.remove_section(*section);
  }
  step_->is_changed = true;
  flush();
}

void ChangeApplier::check_unmapped(const SectionName& removed) {
  const bool is_object = removed.kind == SectionKind::object;
  if (!is_object && removed.kind != SectionKind::sub_object) return;
  for (const MappedEntry& mapped : mapped_entries()) {
    const bool is_same =
        mapped.value.index == removed.index && (is_object || mapped.value.sub_index == removed.sub_index);
    if (!is_same || !mapped.is_active || mapped.parameter == removed.index) continue;
    objections_.push_back(fmt::format("{:04X}h:{:02X} is mapped by {}", mapped.value.index, mapped.value.sub_index,
                                      pdo_of_mapping(mapped.parameter)));
  }
}

void ChangeApplier::make(const RenamePart& change) {
  flush();
  const TextSection* const section = find(change.section);
  if (section == nullptr) return;
  if (!change.key.empty()) {
    const auto entry = find_key(*section, change.section, change.key);
    if (!entry) return;
    if (!can_be_key(change.name)) return reject(fmt::format("{} cannot be a key", change.name));
    if (step_->text.find_entry(*section, change.name) && !equal_ignoring_case(change.key, change.name)) {
      return reject(fmt::format("[{}] already has a key {}", change.section, change.name));
    }
    step_->edit.rename_entry(*entry, change.name);
  } else {
    const SectionName name = read_section_name(change.name, source_->choices().sub_indices);
    const bool is_object = section->name.kind == SectionKind::object;
    const bool fits =
        can_be_title(change.name) && is_object_section(section->name.kind) && name.kind == section->name.kind;
    if (!fits) return reject(fmt::format("[{}] cannot be renamed to [{}]", section->title, change.name));
    const TextSection* const same = step_->text.find(name);
    if (same != nullptr && same != section) return reject(fmt::format("section [{}] already exists", change.name));
    const SectionName before = section->name;
    count_pdos({before}, {name});
    step_->edit.rename_section(*section, change.name, source_->origin(section->line));
    if (is_object || before.kind == SectionKind::sub_object) follow_renamed(before, name);
  }
  step_->is_changed = true;
  flush();
}

void ChangeApplier::follow_renamed(const SectionName& before, const SectionName& after) {
  const bool is_object = before.kind == SectionKind::object;
  for (const MappedEntry& mapped : mapped_entries()) {
    if (mapped.value.index != before.index || (!is_object && mapped.value.sub_index != before.sub_index)) continue;
    MappingValue value = mapped.value;
    value.index = after.index;
    if (!is_object) value.sub_index = after.sub_index;
    step_->edit.set_value(mapped.entry, restyled(mapping_text(value), strip_inline_comment(mapped.entry.value)),
                          {.file = source_.get(), .line = mapped.entry.line});
  }
  if (!is_object) return;
  for (const TextSection& section : step_->text.sections()) {
    if (section.name.kind != SectionKind::object_links) continue;
    for (const IniEntry& entry : step_->text.entries(section)) {
      const std::string_view value = strip_inline_comment(entry.value);
      if (!parse_unsigned(entry.key) || parse_unsigned(value) != before.index) continue;
      step_->edit.set_value(entry, restyled(fmt::format("0x{:04X}", after.index), value),
                            {.file = source_.get(), .line = entry.line});
    }
  }
}

void ChangeApplier::make(const AddSections& change) {
  flush();
  std::vector<SectionName> added;
  for (const NewSection& section : change.sections) {
    const SectionName name = read_section_name(section.title, source_->choices().sub_indices);
    if (!can_be_title(section.title) || name.kind == SectionKind::malformed) {
      return reject(fmt::format("{} is not a name for a section", section.title));
    }
    if (step_->text.find(section.title) != nullptr) {
      return reject(fmt::format("section [{}] already exists", section.title));
    }
    std::vector<std::pair<KeySpelling, std::string_view>> keys;
    for (const auto& [key, value] : section.keys) {
      if (!can_be_key(trim(key))) return reject(fmt::format("{} cannot be a key", key));
      if (const std::string_view problem = text_problem(value); !problem.empty()) {
        return reject(fmt::format("{} of [{}] cannot have {}", key, section.title, problem));
      }
      keys.emplace_back(spell_key(name, trim(key)), trim(value));
    }
    std::ranges::stable_sort(keys, {}, [](const auto& one) { return one.first.order; });
    std::vector<NewLine> lines{{fmt::format("[{}]", section.title), source_->origin(1)}};
    for (const auto& [key, value] : keys) lines.push_back({fmt::format("{}={}", key.name, value), source_->origin(1)});
    step_->edit.add_section(name, std::move(lines));
    added.push_back(name);
    step_->is_changed = true;
  }
  count_pdos({}, added);
  flush();
}

void ChangeApplier::make(const AllowFinding& change) {
  flush();
  const TextSection* const section = find(change.section);
  if (section == nullptr) return;
  const std::string_view reason = trim(change.reason);
  if (change.rule.empty() || change.rule.find_first_of(" \t") != std::string::npos ||
      !text_problem(change.rule).empty()) {
    return reject(fmt::format("{} is not a rule", change.rule));
  }
  if (reason.empty()) return reject("missing reason");
  if (const std::string_view problem = text_problem(reason); !problem.empty()) {
    return reject(fmt::format("the reason cannot have {}", problem));
  }
  std::uint32_t line = section->line;
  if (!change.key.empty()) {
    const auto entry = find_key(*section, change.section, change.key);
    if (!entry) return;
    line = entry->line;
  }
  step_->edit.add_comments(line, {{fmt::format("; edsc: allow {} - {}", change.rule, reason), source_->origin(line)}});
  step_->is_changed = true;
  flush();
}

void ChangeApplier::count_pdos(const std::vector<SectionName>& removed, const std::vector<SectionName>& added) {
  const TextSection* const info = step_->text.find(SectionName{.kind = SectionKind::device_info});
  if (info == nullptr) return;
  const auto number_of = [&](std::string_view key) {
    const auto entry = step_->text.find_entry(*info, key);
    return entry ? parse_unsigned(strip_inline_comment(entry->value)) : std::nullopt;
  };
  // With CompactPDO, PDOs exist without their objects.
  if (number_of("CompactPDO").value_or(0) != 0) return;
  for (const PdoCountRow& row : pdo_count_rows) {
    const auto is_counted = [&](const SectionName& name) {
      return name.kind == SectionKind::object && is_in(name.index, row.first, row.last);
    };
    const auto more = static_cast<std::uint64_t>(std::ranges::count_if(added, is_counted));
    const auto fewer = static_cast<std::uint64_t>(std::ranges::count_if(removed, is_counted));
    const auto old = number_of(row.key);
    if (more == fewer || !old || *old + more < fewer) continue;
    const auto entry = step_->text.find_entry(*info, row.key);
    set_existing(*info, *entry, fmt::format("{}", *old + more - fewer));
  }
}

// PDOs.

std::optional<std::uint64_t> ChangeApplier::number_of_mapped(std::uint16_t parameter) const {
  const TextSection* const count = step_->text.find(SectionName{.kind = SectionKind::sub_object, .index = parameter});
  if (count == nullptr) return std::nullopt;
  for (const std::string_view key : {"ParameterValue", "DefaultValue"}) {
    const auto entry = step_->text.find_entry(*count, key);
    const auto number = entry ? parse_unsigned(strip_inline_comment(entry->value)) : std::nullopt;
    if (number) return number;
  }
  return std::nullopt;
}

std::vector<ChangeApplier::MappedEntry> ChangeApplier::mapped_entries() const {
  std::vector<MappedEntry> mapped;
  const auto add = [&](const IniEntry& entry, std::uint16_t parameter, std::uint64_t position) {
    const auto number = parse_unsigned(strip_inline_comment(entry.value));
    if (!number || *number > UINT32_MAX || position == 0 || position > max_mapped_objects) return;
    const auto count = number_of_mapped(parameter);
    mapped.push_back({entry, MappingValue::of(static_cast<std::uint32_t>(*number)), parameter,
                      position <= count.value_or(max_mapped_objects)});
  };
  for (const TextSection& section : step_->text.sections()) {
    if (!is_mapping_index(section.name.index)) continue;
    const bool is_compact = section.name.kind == SectionKind::compact_values;
    if (!is_compact && section.name.kind != SectionKind::sub_object) continue;
    for (const IniEntry& entry : step_->text.entries(section)) {
      if (is_compact) {
        if (const auto number = parse_unsigned(entry.key)) add(entry, section.name.index, *number);
      } else if (equal_ignoring_case(entry.key, "DefaultValue") || equal_ignoring_case(entry.key, "ParameterValue")) {
        add(entry, section.name.index, section.name.sub_index);
      }
    }
  }
  return mapped;
}

bool ChangeApplier::is_dcf() const {
  return step_->text.find(SectionName{.kind = SectionKind::device_commissioning}) != nullptr ||
         ends_with_ignoring_case(source_->name(), ".dcf");
}

void ChangeApplier::make(const MapPdo& change) {
  if (change.number == 0 || change.number > 512)
    return reject(fmt::format("{} is not the number of a PDO", change.number));
  if (change.objects && change.objects->size() > max_mapped_objects) {
    return reject(fmt::format("a PDO maps at most {} objects", max_mapped_objects));
  }
  flush();
  const auto [communication, mapping] = parameters_of(change.direction, change.number);
  if (compact_entries(communication)) {
    return reject(fmt::format("{:04X}h has CompactSubObj; write a section for each of its sub-indices", communication));
  }
  set_communication(change, communication);
  if (change.objects || step_->text.find(SectionName{.kind = SectionKind::object, .index = mapping}) == nullptr) {
    set_mapping(change, mapping);
  }
  use_dummies(change);
}

void ChangeApplier::set_or_add_sub(std::uint16_t index, std::uint8_t sub_index, NewSection section,
                                   std::string_view value) {
  if (!problem_.empty()) return;
  const TextSection* const found =
      step_->text.find(SectionName{.kind = SectionKind::sub_object, .index = index, .sub_index = sub_index});
  if (found == nullptr) return make(AddSections{{std::move(section)}});
  set(*found, is_dcf() ? "ParameterValue" : "DefaultValue", value);
}

void ChangeApplier::set_communication(const MapPdo& change, std::uint16_t index) {
  const std::vector<std::optional<std::string>> values = communication_values(change);
  const bool is_new = step_->text.find(SectionName{.kind = SectionKind::object, .index = index}) == nullptr;
  const auto section_of = [&](const CommunicationRow& row, std::string_view value) {
    return value_section(sub_title(index, row.sub_index), row.name, row.type, value, is_dcf());
  };
  std::vector<NewSection> added;
  std::uint8_t highest = 0;
  for (std::size_t i = 0; i < std::size(communication_rows); ++i) {
    const CommunicationRow& row = communication_rows[i];
    if (!values[i] && !(is_new && row.sub_index <= required_communication_entries)) continue;
    const std::string value = values[i]            ? *values[i]
                              : row.sub_index == 1 ? usual_cob_id(change)
                                                   : std::string{row.usual};
    if (is_new) {
      added.push_back(section_of(row, value));
      highest = row.sub_index;
    } else {
      set_or_add_sub(index, row.sub_index, section_of(row, value), value);
    }
  }
  if (!is_new) return;
  const std::string_view name =
      change.direction == PdoDirection::receive ? "RPDO communication parameter" : "TPDO communication parameter";
  added.insert(added.begin(), value_section(sub_title(index, 0), "Highest sub-index supported",
                                            canopen::DataType::unsigned8, fmt::format("{}", highest), false, "const"));
  added.insert(added.begin(), record_section(index, name, added.size()));
  make(AddSections{std::move(added)});
}

std::optional<IniEntry> ChangeApplier::compact_entries(std::uint16_t index) const {
  const TextSection* const object = step_->text.find(SectionName{.kind = SectionKind::object, .index = index});
  auto compact = object != nullptr ? step_->text.find_entry(*object, "CompactSubObj") : std::nullopt;
  const bool is_compact = compact && parse_unsigned(strip_inline_comment(compact->value)).value_or(1) != 0;
  return is_compact ? compact : std::nullopt;
}

void ChangeApplier::set_compact_mapping(const MapPdo& change, std::uint16_t index, const IniEntry& compact) {
  const std::vector<MappingValue> objects = change.objects.value_or(std::vector<MappingValue>{});
  const SectionName count_name{.kind = SectionKind::sub_object, .index = index};
  const TextSection* const count = step_->text.find(count_name);
  // Sub-index 0 is CompactSubObj unless it has a section.
  const auto old_entries = parse_unsigned(strip_inline_comment(compact.value)).value_or(0);
  const bool has_count = count != nullptr || objects.empty();
  const std::size_t entries = has_count ? std::max<std::size_t>(objects.size(), old_entries) : objects.size();
  if (const TextSection* const object = step_->text.find(SectionName{.kind = SectionKind::object, .index = index})) {
    set_existing(*object, compact, fmt::format("{}", entries));
  }
  const SectionName values_name{.kind = SectionKind::compact_values, .index = index};
  const TextSection* values = step_->text.find(values_name);
  if (values == nullptr) {
    NewSection section{fmt::format("{:04X}Value", index), {{"NrOfEntries", fmt::format("{}", objects.size())}}};
    for (std::size_t i = 0; i < objects.size(); ++i) {
      section.keys.emplace_back(fmt::format("{}", i + 1), mapping_text(objects[i]));
    }
    if (!objects.empty()) make(AddSections{{std::move(section)}});
  } else {
    for (const IniEntry& entry : step_->text.entries(*values)) {
      const auto number = parse_unsigned(entry.key);
      if (!number || *number <= objects.size()) continue;
      step_->edit.remove_entry(entry);
      step_->is_changed = true;
    }
    set(*values, "NrOfEntries", fmt::format("{}", objects.size()));
    for (std::size_t i = 0; i < objects.size(); ++i) {
      values = step_->text.find(values_name);
      if (values != nullptr) set(*values, fmt::format("{}", i + 1), mapping_text(objects[i]));
    }
  }
  if (!has_count) return;
  const std::string text = fmt::format("{}", objects.size());
  set_or_add_sub(
      index, 0,
      value_section(sub_title(index, 0), "Number of mapped objects", canopen::DataType::unsigned8, text, is_dcf()),
      text);
}

void ChangeApplier::set_mapping(const MapPdo& change, std::uint16_t index) {
  if (const auto compact = compact_entries(index)) return set_compact_mapping(change, index, *compact);
  const std::vector<MappingValue> objects = change.objects.value_or(std::vector<MappingValue>{});
  const std::string count = fmt::format("{}", objects.size());
  const auto section_of = [&](std::size_t position, const MappingValue& value) {
    return value_section(sub_title(index, static_cast<std::uint8_t>(position)),
                         fmt::format("Mapping entry {}", position), canopen::DataType::unsigned32, mapping_text(value),
                         is_dcf());
  };
  const auto count_section = [&] {
    return value_section(sub_title(index, 0), "Number of mapped objects", canopen::DataType::unsigned8, count,
                         is_dcf());
  };
  if (step_->text.find(SectionName{.kind = SectionKind::object, .index = index}) == nullptr) {
    const std::size_t entries = std::max<std::size_t>(objects.size(), 1);
    const std::string_view name =
        change.direction == PdoDirection::receive ? "RPDO mapping parameter" : "TPDO mapping parameter";
    std::vector<NewSection> added{record_section(index, name, entries + 1), count_section()};
    for (std::size_t i = 0; i < entries; ++i) {
      added.push_back(section_of(i + 1, i < objects.size() ? objects[i] : MappingValue{}));
    }
    return make(AddSections{std::move(added)});
  }
  std::vector<NewSection> added;
  for (std::uint8_t position = 1; position <= max_mapped_objects; ++position) {
    const TextSection* const found =
        step_->text.find(SectionName{.kind = SectionKind::sub_object, .index = index, .sub_index = position});
    const MappingValue value = position <= objects.size() ? objects[position - 1U] : MappingValue{};
    if (found != nullptr) {
      const auto old = step_->text.find_entry(*found, is_dcf() ? "ParameterValue" : "DefaultValue");
      if (!old && value.is_empty() && !is_dcf()) continue;
      set(*found, is_dcf() ? "ParameterValue" : "DefaultValue", mapping_text(value));
    } else if (position <= objects.size()) {
      added.push_back(section_of(position, value));
    }
  }
  if (!added.empty()) make(AddSections{std::move(added)});
  set_or_add_sub(index, 0, count_section(), count);
}

void ChangeApplier::use_dummies(const MapPdo& change) {
  if (!change.objects || change.direction != PdoDirection::receive) return;
  for (const MappingValue& value : *change.objects) {
    if (!problem_.empty() || !value.is_dummy()) continue;
    set_in_single(SectionKind::dummy_usage, fmt::format("Dummy{:04X}", value.index), "1");
  }
}

std::string ChangeApplier::sub_title(std::uint16_t index, std::uint8_t sub_index) const {
  return source_->choices().sub_indices == SubIndexNotation::decimal ? fmt::format("{:04X}sub{}", index, sub_index)
                                                                     : fmt::format("{:04X}sub{:X}", index, sub_index);
}

}  // namespace edsc
