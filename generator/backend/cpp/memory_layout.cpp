#include "backend/cpp/memory_layout.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <map>
#include <tuple>
#include <utility>

#include "backend/cpp/cpp_text.hpp"
#include "backend/cpp/identifier.hpp"
#include "device/drive_modes.hpp"
#include "values/value_bytes.hpp"

namespace edsc {
namespace {

using canopen::Access;
using canopen::DataClass;

constexpr std::uint16_t last_communication_index = 0x1FFF;

/// Name of sub-index 0 in the struct of an array whose sub-index 0 changes, and of the elements.
constexpr const char* count_member = "highest_sub_index";
constexpr const char* elements_member = "elements";

/// A part of Values.
struct Section {
  std::string_view name, type;
  bool communication, preset;
  std::string_view comment;
};
constexpr std::array sections = {
    Section{"communication_preset", "CommunicationPreset", true, true, "1000h..1FFFh with a default other than zero."},
    Section{"communication_cleared", "CommunicationCleared", true, false, "1000h..1FFFh that start from zero."},
    Section{"application_preset", "ApplicationPreset", false, true, "2000h..FFFFh with a default other than zero."},
    Section{"application_cleared", "ApplicationCleared", false, false, "2000h..FFFFh that start from zero."},
};

/// Other generated types except those of records.
constexpr std::array taken_type_names = {"Values", "Constants", "Device", "Objects"};

/// The address range of the words of the tables.
constexpr std::size_t max_bytes = 0x10000;
constexpr std::size_t max_rows = 0xFFFF;
constexpr std::size_t max_shapes = 0x4000;

std::string_view section_of(std::uint16_t index, bool preset) {
  return sections[(index <= last_communication_index ? 0 : 2) + (preset ? 0 : 1)].name;
}

/// The end of these members, if the first begins at `begin`.
std::size_t end_of(const std::vector<Member>& members, std::size_t begin) {
  for (const Member& member : members) begin = round_up(begin, member.alignment) + member.size;
  return begin;
}

void sort_by_alignment(std::vector<Member>& members) {
  std::ranges::stable_sort(members, std::ranges::greater{}, &Member::alignment);
}

std::string_view access_of(const canopen::AccessRow& row) {
  return row.readable && row.writable ? "rw" : row.readable ? "ro" : "wo";
}

/// Builds the layout object by object, in ascending index.
class Builder {
 public:
  Builder(const NamedDevice& named, const Options& options, Diagnostics& diagnostics)
      : device_{named.device},
        names_{named.names},
        options_{options},
        diagnostics_{diagnostics},
        placement_{named.device, options} {
    for (const char* name : taken_type_names) static_cast<void>(type_scope_.take(name, ""));
    for (const Section& section : sections) static_cast<void>(type_scope_.take(std::string{section.type}, ""));
  }

  MemoryLayout build() {
    add_runs();
    for (const Object& object : device_.objects) {
      if (object.has_sub_indices()) {
        add_group(object);
      } else {
        layout_.entries.push_back({&object, add_single(object, object.entries.front())});
      }
    }
    finish();
    return std::move(layout_);
  }

 private:
  void add_runs() {
    for (std::size_t i = 0; i < device_.objects.size(); ++i) {
      const std::uint16_t index = device_.objects[i].index;
      if (i == 0 || index != device_.objects[i - 1].index + 1) layout_.runs.push_back({index, i});
    }
    layout_.runs.push_back({0xFFFF, device_.objects.size()});
  }

  [[nodiscard]] Word word(const Object& object, const Entry& entry, Location location) const {
    Word word;
    word.place = placement_.place(object, entry);
    if (word.place == MemoryPlace::ram || word.place == MemoryPlace::rom) {
      word.location = std::move(location);
    } else {
      const std::uint64_t bits = entry.default_value ? entry.default_value->bits : 0;
      word.number = static_cast<std::uint16_t>(bits);
      word.hexadecimal = (entry.default_value && entry.default_value->hexadecimal) || bits > 0xFFFF;
    }
    word.type = type_word(*entry.type);
    word.access = access_of(canopen::row_of(placement_.is_static_mapping(entry.index) ? Access::ro : entry.access));
    word.tpdo = canopen::allows(entry.mappable(), canopen::Mappable::tpdo);
    word.rpdo = canopen::allows(entry.mappable(), canopen::Mappable::rpdo) && !placement_.is_constant(object, entry);
    word.limited = placement_.is_limited(object, entry);
    return word;
  }

  void add_limits(const Object& object, const Entry& entry) {
    for (const ModeRange& range : accepted_modes(device_, options_, entry)) layout_.accepted.push_back({&entry, range});
    if (!placement_.has_limits(object, entry)) return;
    if (entry.type->kind == DataClass::string) {
      const std::uint32_t capacity = string_capacity(entry, options_);
      layout_.limits.push_back({&entry, 0, capacity});
      if (canopen::writable(entry.access)) layout_.longest_download = std::max(layout_.longest_download, capacity);
      return;
    }
    const bool is_wide = entry.type->bits > 32;
    const std::uint64_t mask = low_bits(is_wide ? 64 : 32);
    (is_wide ? layout_.wide_limits : layout_.limits)
        .push_back({&entry, (entry.low_limit ? entry.low_limit->bits : lowest(*entry.type)) & mask,
                    (entry.high_limit ? entry.high_limit->bits : highest(*entry.type)) & mask});
  }

  void add_node_id_relative(const Entry& entry, Location location, std::optional<std::size_t> offset = {}) {
    if (!entry.default_value || !entry.default_value->plus_node_id) return;
    auto& rows = entry.index <= last_communication_index ? layout_.node_id_relative_communication
                                                         : layout_.node_id_relative_application;
    rows.push_back({&entry, std::move(location), offset});
  }

  void note_download(const Entry& entry) {
    if (canopen::writable(entry.access) && entry.type->bits > 32) {
      layout_.longest_download = std::max(layout_.longest_download, 8U);
    }
  }

  /// Adds a value to its section, and returns its word.
  Word add_single(const Object& object, const Entry& entry) {
    add_limits(object, entry);
    Location location;
    const MemoryPlace place = placement_.place(object, entry);
    if (place == MemoryPlace::rom) location = add_constant(member(object, entry, names_.of(object)));
    if (place == MemoryPlace::ram) {
      location = add_value(section_of(entry.index, !is_zero(entry)), member(object, entry, names_.of(object)));
      add_node_id_relative(entry, location);
      note_download(entry);
    }
    return word(object, entry, std::move(location));
  }

  [[nodiscard]] Member member(const Object& object, const Entry& entry, std::string name) const {
    return {cpp_type(entry, options_), std::move(name),         &object, &entry, {},
            alignment_of(entry),       size_of(entry, options_)};
  }

  Location add_value(std::string_view section, Member member) {
    Location location{"Values", fmt::format("{}.{}", section, member.name)};
    values_[section].push_back(std::move(member));
    return location;
  }

  Location add_constant(Member member) {
    Location location{"Constants", member.name};
    layout_.constants.members.push_back(std::move(member));
    return location;
  }

  using SubWords = std::vector<std::optional<Word>>;

  void add_group(const Object& object) {
    const bool is_array = placement_.is_uniform_array(object);
    Location begin;
    const std::size_t subs = shared_subs(is_array ? add_array(object, begin) : add_record(object, begin), object);
    layout_.entries.push_back({&object, {}, std::move(begin), shared_shape(object, subs, is_array), is_array});
  }

  /// Adds the elements and the count of an array. `begin` is the location to which the offsets in their words are
  /// relative; it remains empty if one of them is in RAM and the other in flash.
  SubWords add_array(const Object& object, Location& begin) {
    const Entry& count = object.entries.front();
    const Entry& first = object.entries[1];
    const std::size_t length = object.entries.size() - 1;
    add_limits(object, count);
    add_limits(object, first);
    Member elements{fmt::format("std::array<{}, {}>", cpp_type(first, options_), length),
                    names_.of(object),
                    &object,
                    nullptr,
                    {},
                    alignment_of(first),
                    stride(first) * length};
    if (placement_.place(object, first) == MemoryPlace::rom) {
      begin = add_constant(std::move(elements));
      return {word(object, count, {}), word(object, first, {})};
    }
    const MemoryPlace count_place = placement_.place(object, count);
    const bool preset = std::ranges::any_of(object.entries.begin() + (count_place == MemoryPlace::ram ? 0 : 1),
                                            object.entries.end(), [](const Entry& entry) { return !is_zero(entry); });
    const std::string_view section = section_of(object.index, preset);
    Location count_location;
    Location elements_location;  // as in the word
    Location first_element;      // in Values
    if (count_place == MemoryPlace::ram) {
      Member both = counted_array(object, std::move(elements));
      count_location = {both.type, count_member};
      first_element = begin = add_value(section, std::move(both));
      first_element.member.append(".").append(elements_member);
    } else {
      first_element = add_value(section, std::move(elements));
      const bool apart = count_place == MemoryPlace::rom;
      if (apart) count_location = add_constant(member(object, count, names_.of(object)));
      (apart ? elements_location : begin) = first_element;
    }
    for (const Entry& entry : object.entries) {
      if (entry.sub_index == 0) continue;
      note_download(entry);
      add_node_id_relative(entry, first_element, (entry.sub_index - 1U) * stride(entry));
    }
    return {word(object, count, std::move(count_location)), word(object, first, std::move(elements_location))};
  }

  /// An array whose sub-index 0 changes, such as 1003h: elements and count in one struct, elements first.
  Member counted_array(const Object& object, Member elements) {
    elements.name = elements_member;
    std::vector<Member> parts;
    parts.push_back(std::move(elements));
    parts.push_back(member(object, object.entries.front(), count_member));
    return whole(object, std::move(parts));
  }

  /// Adds the values of a record, with `begin` as for an array.
  SubWords add_record(const Object& object, Location& begin) {
    std::vector<Member> in_ram, in_rom;
    bool preset = false;
    for (const Entry& entry : object.entries) {
      const MemoryPlace place = placement_.place(object, entry);
      if (place == MemoryPlace::ram) in_ram.push_back(member(object, entry, names_.of(entry)));
      if (place == MemoryPlace::rom) in_rom.push_back(member(object, entry, names_.of(entry)));
      preset = preset || (place == MemoryPlace::ram && !is_zero(entry));
    }
    const bool in_both = !in_ram.empty() && !in_rom.empty();
    std::string type;
    Location ram, rom;
    sort_by_alignment(in_ram);
    sort_by_alignment(in_rom);
    if (!in_ram.empty()) {
      Member record = whole(object, std::move(in_ram));
      type = record.type;
      ram = add_value(section_of(object.index, preset), std::move(record));
    }
    if (!in_rom.empty()) {
      Member record = whole(object, std::move(in_rom));
      type = record.type;
      rom = add_constant(std::move(record));
    }
    if (!in_both) begin = ram.type.empty() ? rom : ram;
    SubWords subs;
    for (const Entry& entry : object.entries) {
      subs.resize(entry.sub_index);  // with gaps
      add_limits(object, entry);
      const MemoryPlace place = placement_.place(object, entry);
      const Location& record = place == MemoryPlace::rom ? rom : ram;
      const Location absolute{record.type, fmt::format("{}.{}", record.member, names_.of(entry))};
      subs.emplace_back(word(object, entry, in_both ? absolute : Location{type, names_.of(entry)}));
      if (place != MemoryPlace::ram) continue;
      note_download(entry);
      add_node_id_relative(entry, absolute);
    }
    return subs;
  }

  /// The member for several values; members of the same shape share a type.
  Member whole(const Object& object, std::vector<Member> parts) {
    const unsigned alignment = parts.front().alignment;
    const std::size_t size = round_up(end_of(parts, 0), alignment);
    std::string type = record_type(object, parts);
    return {std::move(type), names_.of(object), &object, nullptr, std::move(parts), alignment, size};
  }

  /// Finds or creates the struct for a shape: the same member types and names in the same order.
  std::string record_type(const Object& object, const std::vector<Member>& members) {
    std::vector<std::pair<std::string, std::string>> shape;
    shape.reserve(members.size());
    for (const Member& member : members) shape.emplace_back(member.type, member.name);
    const auto [at, is_new] = shapes_.try_emplace(std::move(shape));
    if (!is_new) return at->second;
    std::string base = names_.of(object);
    while (!base.empty() && (base.back() == '_' || (base.back() >= '0' && base.back() <= '9'))) base.pop_back();
    const std::string wanted = to_camel_case(base.empty() ? names_.of(object) : base);
    at->second = type_scope_.take(wanted.empty() ? "Record" : wanted, fmt::format("{:04X}", object.index));
    layout_.record_types.push_back({object.name, at->second, {}, members});
    return at->second;
  }

  /// Position of these words in the table of sub-indices, which contains equal ones only once.
  std::size_t shared_subs(SubWords words, const Object& object) {
    const auto [at, is_new] = sub_positions_.try_emplace(std::move(words), layout_.subs.size());
    if (is_new) {
      for (const std::optional<Word>& word : at->first) layout_.subs.push_back({word, nullptr});
      layout_.subs[at->second].first_of = &object;
      check_rows(object, layout_.subs.size(), max_rows, "rows for distinct sub-indices");
    }
    return at->second;
  }

  /// Position of the shape with these words in the table of shapes, which contains equal ones only once.
  std::size_t shared_shape(const Object& object, std::size_t subs, bool is_array) {
    const std::uint8_t highest = object.entries.back().sub_index;
    const unsigned distance = is_array ? stride(object.entries.back()) : 0;
    const auto [at, is_new] = shape_positions_.try_emplace({subs, highest, distance}, layout_.shapes.size());
    if (is_new) {
      layout_.shapes.push_back({&object, subs, highest, distance});
      check_rows(object, layout_.shapes.size(), max_shapes, "different structures of ARRAYs and RECORDs");
    }
    return at->second;
  }

  void check_rows(const Object& object, std::size_t rows, std::size_t limit, std::string_view what) {
    if (rows <= limit || found_too_many_rows_) return;
    found_too_many_rows_ = true;
    diagnostics_.error("dictionary-size", object.position,
                       fmt::format("{} does not fit: a dictionary can have {} {}", named(object), limit, what));
  }

  /// The end of a struct that begins at `begin`. Reports its first member that cannot be addressed.
  std::size_t check_size(const Struct& part, std::size_t begin, std::string_view what) {
    if (part.members.empty()) return begin;
    begin = round_up(begin, part.members.front().alignment);
    const std::size_t end = end_of(part.members, begin);
    if (begin > max_bytes || end <= max_bytes) return end;
    for (std::size_t at = begin; const Member& member : part.members) {
      const std::size_t before = at;
      at = round_up(at, member.alignment) + member.size;
      if (at <= max_bytes) continue;
      diagnostics_.error("dictionary-size", member.object->position,
                         fmt::format("{} does not fit: a dictionary has 64 KiB for {}, and {} bytes lie before it",
                                     named(*member.object), what, before));
      break;
    }
    return end;
  }

  void finish() {
    for (const Section& section : sections) {
      const auto at = values_.find(section.name);
      if (at == values_.end()) continue;
      sort_by_alignment(at->second);
      layout_.values.push_back({section.comment, std::string{section.type}, std::string{section.name},
                                std::move(at->second), section.communication, section.preset});
    }
    sort_by_alignment(layout_.constants.members);
    const auto key = [](const LimitRow& row) { return EntryKey{row.entry->index, row.entry->sub_index}; };
    std::ranges::sort(layout_.limits, {}, key);
    std::ranges::sort(layout_.wide_limits, {}, key);
    std::size_t end = 0;
    for (const Struct& section : layout_.values) end = check_size(section, end, "values in RAM");
    static_cast<void>(check_size(layout_.constants, 0, "constants"));
  }

  const Device& device_;
  const CppNames& names_;
  const Options& options_;
  Diagnostics& diagnostics_;
  Placement placement_;
  MemoryLayout layout_;
  std::map<std::string_view, std::vector<Member>> values_;  ///< by section
  std::map<std::vector<std::pair<std::string, std::string>>, std::string> shapes_;
  std::map<SubWords, std::size_t> sub_positions_;
  std::map<std::tuple<std::size_t, std::uint8_t, unsigned>, std::size_t> shape_positions_;
  IdentifierScope type_scope_;
  bool found_too_many_rows_ = false;
};

}  // namespace

MemoryLayout lay_out(const NamedDevice& named, const Options& options, Diagnostics& diagnostics) {
  return Builder{named, options, diagnostics}.build();
}

}  // namespace edsc
