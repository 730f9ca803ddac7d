#include <fmt/format.h>

#include <algorithm>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "change/change.hpp"
#include "change/new_objects.hpp"
#include "change/sheet_text.hpp"
#include "commands/commands.hpp"
#include "commands/object_table.hpp"
#include "eds/number.hpp"
#include "eds/sections/section_name.hpp"
#include "lookup/find_entry.hpp"
#include "shared/define_command.hpp"
#include "shared/edit_file.hpp"
#include "shared/exit_code.hpp"
#include "shared/object_words.hpp"
#include "shared/parse_number.hpp"
#include "text/ascii.hpp"

namespace edsc {
namespace {

constexpr const char* examples = R"(Examples:
  edsc object add drive.eds 2000h "Motor temperature" INTEGER16 ro --mappable --unit "0.1 degC"
  edsc object add drive.eds 2010h "Gains" UNSIGNED16[8] rw --default 100
  edsc object add drive.eds 2020h "Limits" --record "Speed:UNSIGNED16:rw=3000,Current:UNSIGNED16:rw=500"
  edsc object add drive.eds 1010h 1011h 6083h               objects of CiA 301 and of the profile in 1000h
  edsc object add drive.eds --like 2010h 2030h 2040h        copies of an object
  edsc object add drive.eds --from other.eds 2000h-20FFh    objects of another file
  edsc object map drive.eds tpdo 2 6041h 2000h --transmission-type 255 --event-timer 100ms
  edsc object set drive.eds 2010h:01-08 HighLimit=500 DefaultValue=20
  edsc object set drive.eds DeviceInfo RevisionNumber=0x20000
  edsc object rename drive.eds 2030h 2050h                  PDOs that map the object follow
  edsc object remove drive.eds 2050h --dry-run
  edsc object export drive.eds -o parameters.csv
  edsc object import drive.eds parameters.csv)";

// Add.

struct AddSettings : EditSettings {
  std::vector<std::string> words;
  std::string record, like, from;
  NewValue value;
  std::string unit;
};

std::uint16_t profile_of(const OpenSheet& file) {
  const Entry* const type = file.device ? file.device->find(0x1000, 0) : nullptr;
  return type != nullptr && type->default_value ? static_cast<std::uint16_t>(type->default_value->bits & 0xFFFFU) : 0;
}

void append_sections(std::vector<NewSection>& sections, std::vector<NewSection> more) {
  std::ranges::move(more, std::back_inserter(sections));
}

std::vector<NewSection> copies_in_file(const AddSettings& settings, const OpenSheet& file) {
  const auto source = parse_entry_address(settings.like);
  if (!source || source->sub_index) throw_invalid("--like", settings.like + " is not an index");
  std::vector<NewSection> sections;
  for (const std::string& word : settings.words) {
    const auto target = read_counted_index(word);
    if (!target) throw_invalid("OBJECT", word + " is not an index");
    std::vector<NewSection> copy = copied_sections(SheetText{*file.source}, source->index, target->index);
    if (copy.empty()) fail(fmt::format("{}: {} does not exist", settings.path, settings.like), exit_input_has_errors);
    append_sections(sections, std::move(copy));
  }
  return sections;
}

std::vector<NewSection> copies_from_file(const AddSettings& settings) {
  const auto other = open_file(settings.from);
  const SheetText text{*other->source};
  const std::vector<std::uint16_t> indices = object_indices(text);
  std::vector<NewSection> sections;
  for (const std::string& word : settings.words) {
    const auto range = read_object_range(word);
    if (!range || range->first_sub) throw_invalid("OBJECT", word + " is not an index or a range of indices");
    bool is_found = false;
    for (const std::uint16_t index : indices) {
      if (index < range->first || index > range->last) continue;
      is_found = true;
      append_sections(sections, copied_sections(text, index, index));
    }
    if (!is_found) fail(fmt::format("{}: {} does not exist", settings.from, word), exit_input_has_errors);
  }
  return sections;
}

std::vector<NewSection> standard_objects(const AddSettings& settings, const OpenSheet& file) {
  std::vector<NewSection> sections;
  const std::uint16_t profile = profile_of(file);
  for (const std::string& word : settings.words) {
    const auto index = read_counted_index(word);
    if (!index) throw_invalid("OBJECT", word + " is not an index; a new object has an index, a name and a data type");
    const auto object = standard_object(index->index, profile, index->elements);
    if (!object) {
      fail(fmt::format(
               "{}: edsc does not know the data type of {:04X}h in CiA 301 or in the profile of 1000h, {}; state "
               "name, data type and access type",
               settings.path, index->index, profile),
           exit_input_has_errors);
    }
    append_sections(sections, sections_of(*object, file.source->choices().sub_indices));
  }
  return sections;
}

/// The object that the words describe: index, name, data type and access type; of a RECORD index and name.
NewObject described_object(const AddSettings& settings) {
  const std::vector<std::string>& words = settings.words;
  const auto index = read_counted_index(words.front());
  if (!index) throw_invalid("OBJECT", words.front() + " is not an index");
  if (words.size() < 2) throw_invalid("--record", "the object has an index and a name");
  NewObject object{index->index, ObjectType::record, words[1], {}};
  if (!settings.record.empty()) {
    auto values = read_record(settings.record);
    if (words.size() != 2) throw_invalid("--record", "the object has an index and a name");
    if (!values) throw_invalid("--record", "expected NAME:TYPE:ACCESS=VALUE, separated by commas");
    object.values = *std::move(values);
    for (NewValue& value : object.values) value.mappable = settings.value.mappable;
    return object;
  }
  const auto type = words.size() > 2 ? read_counted_type(words[2]) : std::nullopt;
  if (!type) throw_invalid("OBJECT", fmt::format("{} is not a data type", words.size() > 2 ? words[2] : words.back()));
  NewValue value = settings.value;
  value.name = words[1];
  value.type = type->type;
  value.access = words.size() > 3 ? words[3] : "rw";
  if (words.size() > 4) throw_invalid("OBJECT", words[4] + " is one word too many");
  if (!is_access_text(value.access)) throw_invalid("OBJECT", value.access + " is not an access type");
  if (value.default_value.empty() && type->type->bits != 0) value.default_value = "0";
  const FactorAndUnit unit = read_unit(settings.unit);
  value.factor = unit.factor;
  value.unit = unit.unit;
  if (!type->elements) {
    object.type = ObjectType::var;
    object.values.push_back(std::move(value));
    return object;
  }
  object.type = ObjectType::array;
  for (unsigned i = 1; i <= *type->elements; ++i) {
    object.values.push_back(value);
    object.values.back().name = fmt::format("{} {}", words[1], i);
  }
  return object;
}

int add(const AddSettings& settings) {
  const auto file = open_file(settings.path);
  const bool is_standard = settings.record.empty() && std::ranges::all_of(settings.words, [](const std::string& word) {
                             return read_counted_index(word).has_value();
                           });
  std::vector<NewSection> sections;
  if (!settings.like.empty()) {
    sections = copies_in_file(settings, *file);
  } else if (!settings.from.empty()) {
    sections = copies_from_file(settings);
  } else if (is_standard) {
    sections = standard_objects(settings, *file);
  } else {
    sections = sections_of(described_object(settings), file->source->choices().sub_indices);
  }
  return edit_file(settings, *file, {AddSections{std::move(sections)}});
}

void add_add_options(Command command, int& exit_code) {
  AddSettings& settings = define_command(command, "", add, exit_code);
  command.add_option("FILE", settings.path, "EDS or DCF").required();
  command
      .add_option("OBJECT", settings.words,
                  "index, name, data type and access type (default: rw) of a new object; or indices of objects of "
                  "CiA 301 and of the profile, such as 1017h and 6000h[4]")
      .required();
  command.add_option("--record", settings.record).excludes(command.add_option("--like", settings.like));
  command.add_option("--from", settings.from).excludes("--like").excludes("--record");
  command.add_flag("--mappable", settings.value.mappable);
  command.add_option("--default", settings.value.default_value);
  command.add_option("--low", settings.value.low_limit);
  command.add_option("--high", settings.value.high_limit);
  command.add_option("--unit", settings.unit);
  settings.add_to(command);
}

// Set, rename and remove.

struct SetSettings : EditSettings {
  std::string object;
  std::vector<std::string> values;
};

/// The sections that a word names: of an object, a range of entries, or one with a title.
std::vector<std::string> titles_of(const SheetText& text, const std::string& word) {
  const auto range = read_object_range(word);
  if (!range) return {word};
  std::vector<std::string> titles;
  for (const TextSection& section : text.sections()) {
    const SectionName& name = section.name;
    if (name.index < range->first || name.index > range->last) continue;
    const bool is_object = name.kind == SectionKind::object && !range->first_sub;
    const bool is_entry = name.kind == SectionKind::sub_object && range->first_sub &&
                          name.sub_index >= *range->first_sub && name.sub_index <= *range->last_sub;
    // Sub-index 0 of a VAR is the object itself.
    const bool is_value = name.kind == SectionKind::object && range->first_sub == 0 &&
                          text.find(SectionName{.kind = SectionKind::sub_object, .index = name.index}) == nullptr;
    if (is_object || is_entry || is_value) titles.emplace_back(section.title);
  }
  return titles;
}

std::vector<std::string> existing_titles(const EditSettings& settings, const SheetText& text, const std::string& word) {
  std::vector<std::string> titles = titles_of(text, word);
  if (titles.empty()) fail(fmt::format("{}: {} does not exist", settings.path, word), exit_input_has_errors);
  return titles;
}

int set(const SetSettings& settings) {
  const auto file = open_file(settings.path);
  const SheetText text{*file->source};
  std::vector<SheetChange> changes;
  for (const std::string& title : existing_titles(settings, text, settings.object)) {
    for (const std::string& pair : settings.values) {
      const std::size_t equals = pair.find('=');
      if (equals == std::string::npos || equals == 0) throw_invalid("KEY=VALUE", pair + " does not have a =");
      std::string key = pair.substr(0, equals);
      std::string value = pair.substr(equals + 1);
      if (value.empty()) {
        changes.emplace_back(RemovePart{title, std::move(key)});
      } else {
        changes.emplace_back(SetValue{title, std::move(key), std::move(value)});
      }
    }
  }
  return edit_file(settings, *file, changes);
}

void add_set_options(Command command, int& exit_code) {
  SetSettings& settings = define_command(command, "", set, exit_code);
  command.add_option("FILE", settings.path, "EDS or DCF").required();
  command.add_option("OBJECT", settings.object, "such as 2000h, 2010h:01-08 or DeviceInfo").required();
  command.add_option("KEY=VALUE", settings.values, "keys of the EDS; KEY= removes a key").required();
  settings.add_to(command);
}

struct RenameSettings : EditSettings {
  std::string object;
  std::string name;
};

/// The title of a new section: `2050` for 2050h, `2050sub1` for 2050h:01.
std::string title_of_word(const std::string& word, SubIndexNotation notation) {
  const auto address = parse_entry_address(word);
  if (!address) throw_invalid("OBJECT", word + " is not an address, such as 2050h or 2050h:01");
  const std::string index = fmt::format("{:04X}", address->index);
  if (!address->sub_index) return index;
  return notation == SubIndexNotation::decimal ? fmt::format("{}sub{}", index, *address->sub_index)
                                               : fmt::format("{}sub{:X}", index, *address->sub_index);
}

int rename(const RenameSettings& settings) {
  const auto file = open_file(settings.path);
  const SubIndexNotation notation = file->source->choices().sub_indices;
  return edit_file(settings, *file,
                   {RenamePart{title_of_word(settings.object, notation), "", title_of_word(settings.name, notation)}});
}

void add_rename_options(Command command, int& exit_code) {
  RenameSettings& settings = define_command(command, "", rename, exit_code);
  command.add_option("FILE", settings.path, "EDS or DCF").required();
  command.add_option("OBJECT", settings.object, "object or entry, such as 2000h or 2010h:01").required();
  command.add_option("NAME", settings.name, "its new index, or index and sub-index").required();
  settings.add_to(command);
}

struct RemoveSettings : EditSettings {
  std::vector<std::string> objects;
};

int remove(const RemoveSettings& settings) {
  const auto file = open_file(settings.path);
  const SheetText text{*file->source};
  std::vector<SheetChange> changes;
  for (const std::string& word : settings.objects) {
    for (std::string& title : existing_titles(settings, text, word)) {
      changes.emplace_back(RemovePart{std::move(title), ""});
    }
  }
  return edit_file(settings, *file, changes);
}

void add_remove_options(Command command, int& exit_code) {
  RemoveSettings& settings = define_command(command, "", remove, exit_code);
  command.add_option("FILE", settings.path, "EDS or DCF").required();
  command.add_option("OBJECT", settings.objects, "objects or entries, such as 2030h, 2000h-20FFh or 2010h:08")
      .required();
  settings.add_to(command);
}

// Map.

struct MapSettings : EditSettings {
  std::string direction;
  unsigned number = 0;
  std::vector<std::string> objects;
  std::string cob_id;
  std::optional<std::uint8_t> transmission_type, sync_start;
  std::optional<std::uint64_t> inhibit_us, event_us;
};

constexpr std::string_view no_objects = "none";

MappingValue mapped_value(const EditSettings& settings, const OpenSheet& file, const std::string& word) {
  if (const auto type = read_counted_type(word); type && !type->elements && type->type->bits != 0) {
    return {static_cast<std::uint16_t>(type->type->type), 0, type->type->bits};
  }
  if (!file.device) fail(settings.path + ": the file does not have objects", exit_input_has_errors);
  const FoundEntry found = find_one_entry(NamedDevice{*file.device, *file.names}, word);
  if (!found.ok()) fail(fmt::format("{}: {}", settings.path, found.problem), exit_input_has_errors);
  const Entry& entry = *found.entry;
  if (entry.type == nullptr || entry.type->bits == 0) {
    fail(fmt::format("{}: {} has a variable length", settings.path, named(entry)), exit_input_has_errors);
  }
  return {entry.index, entry.sub_index, entry.type->bits};
}

/// A time in units of a PDO parameter.
std::optional<std::uint16_t> in_units(const char* option, std::optional<std::uint64_t> microseconds,
                                      std::uint32_t unit) {
  if (!microseconds) return std::nullopt;
  const std::uint64_t units = *microseconds / unit;
  if (*microseconds % unit != 0 || units > UINT16_MAX) {
    throw_invalid(option,
                  fmt::format("expected a multiple of {} us, {} us at most", unit, std::uint64_t{UINT16_MAX} * unit));
  }
  return static_cast<std::uint16_t>(units);
}

int map(const MapSettings& settings) {
  const auto file = open_file(settings.path);
  MapPdo change;
  change.direction = settings.direction == "rpdo" ? PdoDirection::receive : PdoDirection::transmit;
  change.number = static_cast<std::uint16_t>(settings.number);
  if (!settings.objects.empty()) {
    change.objects.emplace();
    const bool maps_nothing = settings.objects.size() == 1 && settings.objects.front() == no_objects;
    for (const std::string& word : settings.objects) {
      if (!maps_nothing) change.objects->push_back(mapped_value(settings, *file, word));
    }
  }
  if (!settings.cob_id.empty()) change.cob_id = settings.cob_id;
  change.transmission_type = settings.transmission_type;
  change.sync_start = settings.sync_start;
  change.inhibit_time = in_units("--inhibit", settings.inhibit_us, file->options.inhibit_time_unit());
  change.event_timer = in_units("--event-timer", settings.event_us, 1000);
  return edit_file(settings, *file, {std::move(change)});
}

void add_map_options(Command command, int& exit_code) {
  MapSettings& settings = define_command(command, "", map, exit_code);
  command.add_option("FILE", settings.path, "EDS or DCF").required();
  command.add_option("DIRECTION", settings.direction, "tpdo or rpdo").required().one_of({"tpdo", "rpdo"});
  command.add_option("NUMBER", settings.number, "of the PDO").required().range(1, 512);
  command.add_option("OBJECT", settings.objects,
                     "objects in the order of the frame, by index or name; a data type is a gap of an RPDO; none: maps "
                     "nothing (default: the mapping remains)");
  command.add_option("--cob-id", settings.cob_id);
  command.add_option("--transmission-type", settings.transmission_type).range(0, 255);
  command.add_option("--sync-start", settings.sync_start).range(0, 240);
  command.add_duration("--inhibit", 0, 6'553'500'000, [&settings](std::uint64_t us) { settings.inhibit_us = us; });
  command.add_duration("--event-timer", 0, 65'535'000, [&settings](std::uint64_t us) { settings.event_us = us; });
  settings.add_to(command);
}

struct ObjectAction {
  const char* name;
  const char* description;
  AddOptions* add_options;
};

constexpr ObjectAction object_actions[] = {
    {"add", "add objects: new ones, objects of CiA 301 and the profile, copies", add_add_options},
    {"set", "set keys of an object, of some of its entries, or of another section", add_set_options},
    {"map", "set the mapping and the communication parameters of a PDO", add_map_options},
    {"rename", "change the index or sub-index of an object or entry", add_rename_options},
    {"remove", "remove objects or entries", add_remove_options},
    {"import", "add and change objects by a CSV file", add_object_import_options},
    {"export", "write the objects as a CSV file", add_object_export_options},
};

}  // namespace

void add_object_options(Command command, int& exit_code) {
  command.footer(examples);
  for (const ObjectAction& row : object_actions) {
    row.add_options(command.add_subcommand(row.name, row.description), exit_code);
  }
}

}  // namespace edsc
