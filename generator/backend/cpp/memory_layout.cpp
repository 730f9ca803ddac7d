#include "backend/cpp/memory_layout.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <map>

#include "backend/cpp/compiled_format.hpp"
#include "backend/cpp/cpp_text.hpp"
#include "device/identifier.hpp"
#include "device/index_range.hpp"
#include "device/stored_eds.hpp"

namespace edsc {
namespace {

using canopen::Access;
using canopen::DataClass;
using canopen::DataType;

/// Capacity of strings in RAM without a default value, unless the options set it.
constexpr std::uint32_t default_string_capacity = 16;

constexpr std::uint16_t last_communication_index = 0x1FFF;

/// Read-only objects of the communication profile that do not change at run time.
constexpr std::array constant_ranges = {
    IndexRange{0x1000, 0x1000}, IndexRange{0x1005, 0x100F}, IndexRange{0x1012, 0x1012}, IndexRange{0x1014, 0x1019},
    IndexRange{0x1200, 0x12FF}, IndexRange{0x1400, 0x15FF}, IndexRange{0x1800, 0x19FF},
};

/// Store and restore: a write is a command; a read returns the capabilities of the device.
constexpr std::array command_ranges = {IndexRange{0x1010, 0x1011}};

/// Name of sub-index 0 in the struct of an array whose sub-index 0 changes.
constexpr std::string_view count_member = "highest_sub_index";

/// Generated types other than those of records.
constexpr std::array taken_type_names = {"Values",
                                         "Constants",
                                         "Device",
                                         "CommunicationPreset",
                                         "CommunicationCleared",
                                         "ApplicationPreset",
                                         "ApplicationCleared"};

enum class Place : std::uint8_t { ram, rom, immediate, immediate_plus_node_id };

struct TypeWord {
  DataType type;
  std::string_view word;  ///< constant of canopen::entry
  unsigned alignment;     ///< of the C++ type, at most
};

constexpr std::array type_words = {
    TypeWord{DataType::boolean, "boolean", 1},
    TypeWord{DataType::integer8, "i8", 1},
    TypeWord{DataType::integer16, "i16", 2},
    TypeWord{DataType::integer24, "i24", 4},
    TypeWord{DataType::integer32, "i32", 4},
    TypeWord{DataType::integer40, "i40", 8},
    TypeWord{DataType::integer48, "i48", 8},
    TypeWord{DataType::integer56, "i56", 8},
    TypeWord{DataType::integer64, "i64", 8},
    TypeWord{DataType::unsigned8, "u8", 1},
    TypeWord{DataType::unsigned16, "u16", 2},
    TypeWord{DataType::unsigned24, "u24", 4},
    TypeWord{DataType::unsigned32, "u32", 4},
    TypeWord{DataType::unsigned40, "u40", 8},
    TypeWord{DataType::unsigned48, "u48", 8},
    TypeWord{DataType::unsigned56, "u56", 8},
    TypeWord{DataType::unsigned64, "u64", 8},
    TypeWord{DataType::real32, "r32", 4},
    TypeWord{DataType::real64, "r64", 8},
    TypeWord{DataType::time_of_day, "time48", 4},
    TypeWord{DataType::time_difference, "time48", 4},
    TypeWord{DataType::visible_string, "visible_string", 2},
    TypeWord{DataType::octet_string, "octet_string", 2},
    TypeWord{DataType::unicode_string, "octet_string", 2},
    TypeWord{DataType::domain, "domain", 8},
};

const TypeWord& type_word(const Entry& entry) {
  return *std::ranges::find(type_words, entry.type->type, &TypeWord::type);
}

/// Bytes from one element of an array to the next.
unsigned stride(const Entry& entry) {
  if (entry.type->kind == DataClass::boolean) return 1;
  if (entry.type->kind == DataClass::time) return 8;
  return entry.type->bits <= 8 ? 1 : entry.type->bits <= 16 ? 2 : entry.type->bits <= 32 ? 4 : 8;
}

bool is_zero(const Entry& entry) {
  if (!entry.default_value) return true;
  return entry.default_value->bits == 0 && entry.default_value->bytes.empty() && !entry.default_value->plus_node_id;
}

std::uint32_t string_capacity(const Entry& entry, const Options& options) {
  if (const auto at = options.string_capacity.find({entry.index, entry.sub_index});
      at != options.string_capacity.end()) {
    return at->second;
  }
  const std::size_t length = entry.default_value ? wire_length(*entry.default_value, *entry.type) : 0;
  if (length > 0) return std::max(static_cast<std::uint32_t>(length), entry.octets);
  if (entry.octets != 0) return entry.octets;
  return entry.access == Access::constant ? 0 : default_string_capacity;
}

/// Bytes of a string type: its capacity, and a terminator if the options require one.
std::uint32_t room(const Entry& entry, const Options& options) {
  const bool terminated = options.zero_terminated_strings && entry.type->type == DataType::visible_string;
  return string_capacity(entry, options) + (terminated ? 1 : 0);
}

/// The address range of the words of the tables.
constexpr std::size_t max_bytes = 0x10000;
constexpr std::size_t max_rows = 0xFFFF;

/// Of canopen::Domain with 32-bit pointers; for larger ones, the generated code computes the size itself.
constexpr std::size_t domain_size = 12;

std::size_t round_up(std::size_t size, std::size_t alignment) { return (size + alignment - 1) / alignment * alignment; }

/// Bytes of an entry's C++ type.
std::size_t size_of(const Entry& entry, const Options& options) {
  if (entry.type->kind == DataClass::domain) return domain_size;
  if (entry.type->kind != DataClass::string) return stride(entry);
  constexpr std::size_t length_size = 2;
  return round_up(length_size + std::max(room(entry, options), 1u), length_size);
}

/// The end of these members, if the first begins at `begin`.
std::size_t end_of(const std::vector<Member>& members, std::size_t begin) {
  for (const Member& member : members) begin = round_up(begin, member.alignment) + member.size;
  return begin;
}

/// Bytes of a struct with these members; the first has the widest alignment.
std::size_t size_of(const std::vector<Member>& members) {
  return round_up(end_of(members, 0), members.front().alignment);
}

bool less_key(const TableRow& a, const TableRow& b) { return a.text < b.text; }

void sort_by_alignment(std::vector<Member>& members) {
  std::ranges::stable_sort(members, std::ranges::greater{}, &Member::alignment);
}

/// Builds the layout object by object, in ascending index.
class Builder {
 public:
  Builder(const Device& device, const Options& options, Diagnostics& diagnostics)
      : device_{device}, options_{options}, diagnostics_{diagnostics}, settable_{options.settable} {
    for (const char* name : taken_type_names) static_cast<void>(type_scope_.take(name, ""));
    std::ranges::sort(settable_);
    for (const Pdo& pdo : device.pdos) {
      if (!pdo.dynamic) continue;
      dynamic_mappings_.push_back(pdo.mapping->index);  // ascending: RPDOs come first
      has_dynamic_tpdo_ = has_dynamic_tpdo_ || pdo.direction == PdoDirection::transmit;
    }
  }

  MemoryLayout build() {
    for (const Object& object : device_.objects) add_run(object.index);
    layout_.runs.push_back({fmt::format("{{0xFFFF, {}}}", device_.objects.size()), ""});
    for (const Object& object : device_.objects) {
      if (object.has_sub_indices()) {
        add_group(object);
      } else {
        const Entry& entry = object.entries.front();
        const std::string path = add_single(entry, object.identifier);
        layout_.entries.push_back({word(entry, path), entry_label(entry.index, 0)});
      }
    }
    finish();
    return std::move(layout_);
  }

 private:
  void add_run(std::uint16_t index) {
    const std::size_t position = next_position_++;
    if (position > 0 && index == last_index_ + 1) {
      last_index_ = index;
      return;
    }
    last_index_ = index;
    layout_.runs.push_back({compiled_format(FMT_COMPILE("{{0x{:04X}, {}}}"), index, position), ""});
  }

  // ---- places ----

  [[nodiscard]] bool settable(const Entry& entry) const {
    return std::ranges::binary_search(settable_, EntryKey{entry.index, entry.sub_index});
  }

  /// A mapping parameter of a static PDO: a constant regardless of its access type in the EDS.
  [[nodiscard]] bool is_static_mapping(std::uint16_t index) const {
    return contains(mapping_parameters, index) && !std::ranges::binary_search(dynamic_mappings_, index);
  }

  [[nodiscard]] bool is_constant(const Object& object, const Entry& entry) const {
    if (contains(mapping_parameters, entry.index)) return is_static_mapping(entry.index);
    if (settable(entry)) return false;
    if (contains(command_ranges, entry.index)) return true;
    if (entry.index == store_format && options_.stored_eds != StoredEds::of_application) return true;
    if (entry.access == Access::constant) return true;
    if (entry.access != Access::ro) return false;
    if (object.has_sub_indices() && entry.sub_index == 0) return entry.index != 0x1003;
    return contains(constant_ranges, entry.index);
  }

  [[nodiscard]] Place place(const Object& object, const Entry& entry) const {
    if (!is_constant(object, entry) || entry.type->kind == DataClass::domain) return Place::ram;
    const std::uint64_t bits = entry.default_value ? entry.default_value->bits : 0;
    const bool plus_node_id = entry.default_value && entry.default_value->plus_node_id;
    // All static mapping parameters of a device then share one table of words.
    if (contains(mapping_parameters, entry.index)) return Place::rom;
    if (needs_address(entry)) return plus_node_id ? Place::ram : Place::rom;
    switch (entry.type->kind) {
      case DataClass::boolean: return Place::immediate;
      case DataClass::unsigned_integer:
        if (bits > 0xFFFF) return plus_node_id ? Place::ram : Place::rom;
        return plus_node_id ? Place::immediate_plus_node_id : Place::immediate;
      case DataClass::signed_integer: {
        const auto value = static_cast<std::int64_t>(bits);
        if (plus_node_id) return Place::ram;
        return value >= -0x8000 && value <= 0x7FFF ? Place::immediate : Place::rom;
      }
      case DataClass::real:
      case DataClass::string:
      case DataClass::time:
      case DataClass::domain: break;
    }
    return Place::rom;
  }

  /// A TPDO with dynamic mapping reads its objects, including constants, from memory.
  [[nodiscard]] bool needs_address(const Entry& entry) const {
    return has_dynamic_tpdo_ && canopen::allows(entry.mappable(), canopen::Mappable::tpdo);
  }

  // ---- words ----

  [[nodiscard]] std::string word(const Entry& entry, const std::string& where) {
    const canopen::AccessRow& row = canopen::row_of(is_static_mapping(entry.index) ? Access::ro : entry.access);
    std::string text = compiled_format(FMT_COMPILE("{} | {} | {}"), where, type_word(entry).word,
                                       row.readable && row.writable ? "rw"
                                       : row.readable               ? "ro"
                                                                    : "wo");
    if (canopen::allows(entry.mappable(), canopen::Mappable::tpdo)) text += " | tpdo";
    const bool in_rpdo = canopen::allows(entry.mappable(), canopen::Mappable::rpdo);
    if (in_rpdo && !is_constant(*device_.find(entry.index), entry)) text += " | rpdo";
    if (has_limits(entry)) text += " | limited";
    return text;
  }

  /// Limits are needed for values that can be written over the bus; the same table contains the capacity of each string
  /// that can change. Mapping entries are checked against the dictionary instead.
  [[nodiscard]] bool has_limits(const Entry& entry) const {
    if (entry.type->kind == DataClass::string) return place(*device_.find(entry.index), entry) == Place::ram;
    return canopen::writable(entry.access) && !contains(mapping_parameters, entry.index) &&
           (entry.low_limit || entry.high_limit);
  }

  [[nodiscard]] static std::string immediate_text(const Entry& entry, Place where) {
    const std::uint64_t bits = entry.default_value ? entry.default_value->bits : 0;
    const std::uint64_t value = bits & 0xFFFF;
    const bool hexadecimal = (entry.default_value && entry.default_value->hexadecimal) || bits > 0xFFFF;
    return compiled_format(
        FMT_COMPILE("{} | {}"), where == Place::immediate ? "immediate" : "immediate_plus_node_id",
        hexadecimal ? compiled_format(FMT_COMPILE("0x{:X}"), value) : compiled_format(FMT_COMPILE("{}"), value));
  }

  void add_limits(const Entry& entry) {
    if (!has_limits(entry)) return;
    const std::string key =
        compiled_format(FMT_COMPILE("canopen::object_key(0x{:04X}, 0x{:02X})"), entry.index, entry.sub_index);
    if (entry.type->kind == DataClass::string) {
      const std::uint32_t capacity = string_capacity(entry, options_);
      layout_.limits.push_back({fmt::format("{{{}, 0, {}}}", key, capacity), entry.name});
      if (canopen::writable(entry.access)) layout_.longest_download = std::max(layout_.longest_download, capacity);
      return;
    }
    const unsigned bits = entry.type->bits <= 32 ? 32 : 64;
    const std::uint64_t mask = bits == 32 ? 0xFFFF'FFFF : ~std::uint64_t{0};
    const std::uint64_t low = (entry.low_limit ? entry.low_limit->bits : lowest(entry)) & mask;
    const std::uint64_t high = (entry.high_limit ? entry.high_limit->bits : highest(entry)) & mask;
    auto& table = bits == 32 ? layout_.limits : layout_.wide_limits;
    table.push_back({compiled_format(FMT_COMPILE("{{{}, 0x{:X}, 0x{:X}}}"), key, low, high), range_comment(entry)});
  }

  static std::string range_comment(const Entry& entry) {
    return fmt::format("{}..{}", entry.low_limit ? cpp_literal(*entry.low_limit, *entry.type) : "",
                       entry.high_limit ? cpp_literal(*entry.high_limit, *entry.type) : "");
  }

  /// Bits of the minimum and maximum of a type.
  static std::uint64_t lowest(const Entry& entry) {
    if (entry.type->kind == DataClass::real) return entry.type->bits == 32 ? 0xFF7F'FFFF : 0xFFEF'FFFF'FFFF'FFFF;
    if (entry.type->kind != DataClass::signed_integer) return 0;
    return ~std::uint64_t{0} << (entry.type->bits - 1);
  }
  static std::uint64_t highest(const Entry& entry) {
    if (entry.type->kind == DataClass::real) return entry.type->bits == 32 ? 0x7F7F'FFFF : 0x7FEF'FFFF'FFFF'FFFF;
    const unsigned bits = entry.type->bits - (entry.type->kind == DataClass::signed_integer ? 1u : 0u);
    return bits >= 64 ? ~std::uint64_t{0} : (std::uint64_t{1} << bits) - 1;
  }

  // ---- single values ----

  /// Adds a value to its section, and returns its place for the word.
  std::string add_single(const Entry& entry, const std::string& identifier) {
    const Object& object = *device_.find(entry.index);
    const Place where = place(object, entry);
    add_limits(entry);
    if (where == Place::rom) {
      layout_.constants.members.push_back(member(object, entry, identifier));
      return compiled_format(FMT_COMPILE("rom | offsetof(Constants, {})"), identifier);
    }
    if (where != Place::ram) return immediate_text(entry, where);
    const std::string_view section = section_of(entry.index, !is_zero(entry));
    values_[section].push_back(member(object, entry, identifier));
    const std::string path = compiled_format(FMT_COMPILE("{}.{}"), section, identifier);
    add_node_id_relative(entry, compiled_format(FMT_COMPILE("offsetof(Values, {})"), path));
    note_download(entry);
    return compiled_format(FMT_COMPILE("ram | offsetof(Values, {})"), path);
  }

  [[nodiscard]] Member member(const Object& object, const Entry& entry, const std::string& identifier) const {
    Member result;
    result.type = cpp_type(entry, options_);
    result.name = identifier;
    result.initializer = initializer(entry);
    result.comment =
        compiled_format(FMT_COMPILE("{}  {}"), entry_label(entry.index, entry.sub_index), cpp_comment(entry.name));
    result.alignment = type_word(entry).alignment;
    result.size = size_of(entry, options_);
    result.object = &object;
    return result;
  }

  static std::string initializer(const Entry& entry) {
    if (entry.default_value) return cpp_initializer(*entry.default_value, *entry.type);
    return entry.type->kind == DataClass::boolean                         ? "false"
           : entry.type->bits == 0 || entry.type->kind == DataClass::time ? "{}"
                                                                          : "0";
  }

  static std::string_view section_of(std::uint16_t index, bool preset) {
    if (index <= last_communication_index) return preset ? "communication_preset" : "communication_cleared";
    return preset ? "application_preset" : "application_cleared";
  }

  void add_node_id_relative(const Entry& entry, const std::string& offset) {
    if (!entry.default_value || !entry.default_value->plus_node_id) return;
    auto& rows = entry.index <= last_communication_index ? layout_.node_id_relative_communication
                                                         : layout_.node_id_relative_application;
    rows.push_back({fmt::format("{{{}, {}}}", offset, stride(entry)), entry_label(entry.index, entry.sub_index)});
  }

  void note_download(const Entry& entry) {
    if (canopen::writable(entry.access) && entry.type->bits > 32) {
      layout_.longest_download = std::max(layout_.longest_download, 8u);
    }
  }

  // ---- arrays and records ----

  void add_group(const Object& object) {
    std::vector<TableRow> subs;
    std::string ram = "0";
    std::string rom = "0";
    unsigned step = 0;
    const bool array = is_uniform_array(object);
    if (array) {
      step = stride(object.entries.back());
      subs = add_array(object, ram, rom);
    } else {
      subs = add_record(object, ram, rom);
    }
    const std::uint8_t highest = object.entries.back().sub_index;
    layout_.entries.push_back(
        {compiled_format(FMT_COMPILE("{} | {}"), array ? "array" : "record", layout_.groups.size()),
         compiled_format(FMT_COMPILE("{}  {}"), index_label(object.index), cpp_comment(object.name))});
    layout_.groups.push_back(
        {compiled_format(FMT_COMPILE("{{.ram = {}, .rom = {}, .subs = {}, .highest = {}, .stride = {}}}"), ram, rom,
                         shared_subs(subs, object), highest, step),
         index_label(object.index)});
  }

  /// Elements of the same numeric type and access in the same memory, without gaps: they share one word.
  [[nodiscard]] bool is_uniform_array(const Object& object) const {
    if (!describes_uniform_array(object)) return false;
    const Place first = place(object, object.entries[1]);
    if (first != Place::ram && first != Place::rom) return false;
    if (first == Place::rom && place(object, object.entries[0]) == Place::rom) return false;  // a record can have both
    return std::ranges::all_of(object.entries.begin() + 1, object.entries.end(),
                               [&](const Entry& entry) { return place(object, entry) == first; });
  }

  std::vector<TableRow> add_array(const Object& object, std::string& ram, std::string& rom) {
    const Entry& count = object.entries.front();
    const Entry& first = object.entries[1];
    const std::size_t length = object.entries.size() - 1;
    const bool in_rom = place(object, first) == Place::rom;
    const Place count_place = place(object, count);
    add_limits(count);
    add_limits(first);

    Member elements;
    elements.type = fmt::format("std::array<{}, {}>", cpp_type(first, options_), length);
    elements.initializer = element_list(object);
    elements.alignment = type_word(first).alignment;
    elements.size = stride(first) * length;
    elements.object = &object;
    elements.comment = fmt::format("{}:01..{:02X}  {}", index_label(object.index), length, cpp_comment(object.name));
    elements.name = object.identifier;
    const std::string element_word = word(first, in_rom ? "rom" : "ram");
    if (in_rom) {
      rom = compiled_format(FMT_COMPILE("offsetof(Constants, {})"), object.identifier);
      layout_.constants.members.push_back(elements);
      return {{word(count, immediate_text(count, count_place)), ""}, {element_word, ""}};
    }
    const bool preset = std::ranges::any_of(object.entries.begin() + (count_place == Place::ram ? 0 : 1),
                                            object.entries.end(), [](const Entry& e) { return !is_zero(e); });
    const std::string_view section = section_of(object.index, preset);
    std::string path = compiled_format(FMT_COMPILE("{}.{}"), section, object.identifier);
    ram = compiled_format(FMT_COMPILE("offsetof(Values, {})"), path);
    std::string count_word;
    if (count_place == Place::ram) {
      add_counted_array(object, elements, section);
      path += ".elements";
      count_word = word(count, compiled_format(FMT_COMPILE("ram | offsetof({}, {})"), counted_type_, count_member));
    } else {
      values_[section].push_back(elements);
      count_word = constant_count(object, count, rom);
    }
    for (const Entry& entry : object.entries) {
      if (entry.sub_index == 0) continue;
      note_download(entry);
      add_node_id_relative(entry,
                           fmt::format("offsetof(Values, {}) + {}", path, (entry.sub_index - 1) * stride(entry)));
    }
    return {{count_word, ""}, {element_word, ""}};
  }

  /// The word of a constant sub-index 0 of an object with variable elements.
  std::string constant_count(const Object& object, const Entry& count, std::string& rom) {
    const Place where = place(object, count);
    if (where != Place::rom) return word(count, immediate_text(count, where));
    layout_.constants.members.push_back(member(object, count, object.identifier));
    rom = compiled_format(FMT_COMPILE("offsetof(Constants, {})"), object.identifier);
    return word(count, "rom");
  }

  /// An array whose sub-index 0 changes, such as 1003h: elements and count in one struct, elements first.
  void add_counted_array(const Object& object, const Member& elements, std::string_view section) {
    const Entry& count = object.entries.front();
    Struct type;
    Member list = elements;
    list.name = "elements";
    type.members = {list, member(object, count, std::string{count_member})};
    Member whole;
    whole.size = size_of(type.members);
    whole.object = &object;
    counted_type_ = record_type(object, std::move(type));
    whole.type = counted_type_;
    whole.name = object.identifier;
    whole.alignment = elements.alignment;
    whole.comment = compiled_format(FMT_COMPILE("{}  {}"), index_label(object.index), cpp_comment(object.name));
    whole.initializer =
        fmt::format("{{.elements = {}, .{} = {}}}", elements.initializer, count_member, initializer(count));
    values_[section].push_back(whole);
  }

  static std::string element_list(const Object& object) {
    std::string list;
    bool zero = true;
    for (const Entry& entry : object.entries) {
      if (entry.sub_index == 0) continue;
      if (!list.empty()) list += ", ";
      list += initializer(entry);
      zero = zero && is_zero(entry);
    }
    return zero ? "{}" : "{{" + list + "}}";
  }

  std::vector<TableRow> add_record(const Object& object, std::string& ram, std::string& rom) {
    Struct in_ram;
    Struct in_rom;
    for (const Entry& entry : object.entries) {
      const Place where = place(object, entry);
      if (where == Place::ram) in_ram.members.push_back(member(object, entry, entry.identifier));
      if (where == Place::rom) in_rom.members.push_back(member(object, entry, entry.identifier));
    }
    std::string ram_type;
    std::string rom_type;
    if (!in_ram.members.empty()) {
      const bool preset = std::ranges::any_of(
          object.entries, [&](const Entry& e) { return place(object, e) == Place::ram && !is_zero(e); });
      const std::string_view section = section_of(object.index, preset);
      ram = compiled_format(FMT_COMPILE("offsetof(Values, {}.{})"), section, object.identifier);
      values_[section].push_back(whole_record(object, in_ram, ram_type));
      for (const Entry& entry : object.entries) {
        if (place(object, entry) != Place::ram) continue;
        note_download(entry);
        add_node_id_relative(entry, compiled_format(FMT_COMPILE("offsetof(Values, {}.{}.{})"), section,
                                                    object.identifier, entry.identifier));
      }
    }
    if (!in_rom.members.empty()) {
      rom = compiled_format(FMT_COMPILE("offsetof(Constants, {})"), object.identifier);
      layout_.constants.members.push_back(whole_record(object, in_rom, rom_type));
    }
    return record_words(object, ram_type, rom_type);
  }

  std::vector<TableRow> record_words(const Object& object, const std::string& ram_type, const std::string& rom_type) {
    std::vector<TableRow> subs;
    for (const Entry& entry : object.entries) {
      while (subs.size() < entry.sub_index) subs.push_back({"gap", ""});
      const Place where = place(object, entry);
      add_limits(entry);
      if (where == Place::ram) {
        subs.push_back(
            {word(entry, compiled_format(FMT_COMPILE("ram | offsetof({}, {})"), ram_type, entry.identifier)), ""});
      } else if (where == Place::rom) {
        subs.push_back(
            {word(entry, compiled_format(FMT_COMPILE("rom | offsetof({}, {})"), rom_type, entry.identifier)), ""});
      } else {
        subs.push_back({word(entry, immediate_text(entry, where)), ""});
      }
    }
    return subs;
  }

  /// The member for a record; records of the same shape share a type.
  Member whole_record(const Object& object, Struct shape, std::string& type_name) {
    sort_by_alignment(shape.members);
    Member whole;
    whole.name = object.identifier;
    whole.alignment = shape.members.front().alignment;
    whole.size = size_of(shape.members);
    whole.object = &object;
    whole.comment = compiled_format(FMT_COMPILE("{}  {}"), index_label(object.index), cpp_comment(object.name));
    std::string list;
    for (const Member& m : shape.members) {
      list += compiled_format(FMT_COMPILE("{}.{} = {}"), list.empty() ? "" : ", ", m.name, m.initializer);
    }
    whole.initializer = "{" + list + "}";
    type_name = record_type(object, std::move(shape));
    whole.type = type_name;
    return whole;
  }

  /// Finds or creates the struct for a shape: the same member types and names in the same order.
  std::string record_type(const Object& object, Struct shape) {
    std::string key;
    for (Member& m : shape.members) {
      key += m.type + ' ' + m.name + ';';
      m.comment.clear();
      m.initializer.clear();
    }
    if (const auto at = shapes_.find(key); at != shapes_.end()) return at->second;
    std::string base = object.identifier;
    while (!base.empty() && (base.back() == '_' || (base.back() >= '0' && base.back() <= '9'))) base.pop_back();
    std::string wanted = to_camel_case(base.empty() ? object.identifier : base);
    shape.type = type_scope_.take(wanted.empty() ? "Record" : wanted, fmt::format("{:04X}", object.index));
    shape.comment = cpp_comment(object.name);
    shapes_[key] = shape.type;
    layout_.record_types.push_back(std::move(shape));
    return layout_.record_types.back().type;
  }

  /// Position of these words in the table of sub-indices, which contains equal ones only once.
  std::size_t shared_subs(const std::vector<TableRow>& rows, const Object& object) {
    std::string key;
    for (const TableRow& row : rows) key += row.text + '\n';
    const auto [at, inserted] = sub_positions_.try_emplace(key, layout_.subs.size());
    if (inserted) {
      for (std::size_t i = 0; i < rows.size(); ++i) {
        layout_.subs.push_back({rows[i].text, i == 0 ? index_label(object.index) : ""});
      }
      check_rows(object);
    }
    return at->second;
  }

  // ---- the end ----

  void check_rows(const Object& object) {
    if (layout_.subs.size() <= max_rows || found_too_many_rows_) return;
    found_too_many_rows_ = true;
    diagnostics_.error("dictionary-size", object.position,
                       fmt::format("{} \"{}\" does not fit: a dictionary can have {} rows for distinct sub-indices",
                                   index_label(object.index), object.name, max_rows));
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
      diagnostics_.error(
          "dictionary-size", member.object->position,
          fmt::format("{} \"{}\" does not fit: a dictionary has 64 KiB for {}, and {} bytes lie before it",
                      index_label(member.object->index), member.object->name, what, before));
      break;
    }
    return end;
  }

  struct Section {
    std::string_view name;
    std::string_view type;
    std::string_view comment;
  };
  static constexpr std::array sections = {
      Section{"communication_preset", "CommunicationPreset", "1000h..1FFFh with a default other than zero."},
      Section{"communication_cleared", "CommunicationCleared", "1000h..1FFFh that start from zero."},
      Section{"application_preset", "ApplicationPreset", "2000h..FFFFh with a default other than zero."},
      Section{"application_cleared", "ApplicationCleared", "2000h..FFFFh that start from zero."},
  };

  void finish() {
    for (const Section& section : sections) {
      const auto at = values_.find(section.name);
      if (at == values_.end()) continue;
      sort_by_alignment(at->second);
      layout_.values.push_back(
          {std::string{section.type}, std::string{section.name}, std::string{section.comment}, std::move(at->second)});
    }
    sort_by_alignment(layout_.constants.members);
    std::ranges::sort(layout_.limits, less_key);
    std::ranges::sort(layout_.wide_limits, less_key);
    std::size_t end = 0;
    for (const Struct& section : layout_.values) end = check_size(section, end, "values in RAM");
    static_cast<void>(check_size(layout_.constants, 0, "constants"));
  }

  const Device& device_;
  const Options& options_;
  Diagnostics& diagnostics_;
  std::vector<EntryKey> settable_;               ///< ascending
  std::vector<std::uint16_t> dynamic_mappings_;  ///< indices, ascending
  bool has_dynamic_tpdo_ = false;
  MemoryLayout layout_;
  std::map<std::string_view, std::vector<Member>> values_;
  std::map<std::string, std::string> shapes_;
  std::map<std::string, std::size_t> sub_positions_;
  IdentifierScope type_scope_;
  std::string counted_type_;
  std::size_t next_position_ = 0;
  std::uint32_t last_index_ = 0;
  bool found_too_many_rows_ = false;
};

}  // namespace

std::string cpp_type(const Entry& entry, const Options& options) {
  if (entry.type->kind != DataClass::string) return std::string{entry.type->cpp_type};
  return fmt::format("{}<{}>", entry.type->cpp_type, room(entry, options));
}

bool describes_uniform_array(const Object& object) {
  if (object.type != ObjectType::array || object.entries.size() < 2 || object.entries.front().sub_index != 0)
    return false;
  const Entry& first = object.entries[1];
  if (first.type->bits == 0) return false;
  const auto same = [](const std::optional<Value>& a, const std::optional<Value>& b) {
    return a.has_value() == b.has_value() && (!a || a->bits == b->bits);
  };
  for (std::size_t i = 1; i < object.entries.size(); ++i) {
    const Entry& entry = object.entries[i];
    if (entry.sub_index != i || entry.type != first.type || entry.access != first.access ||
        entry.pdo_mapping != first.pdo_mapping || !same(entry.low_limit, first.low_limit) ||
        !same(entry.high_limit, first.high_limit)) {
      return false;
    }
  }
  return true;
}

MemoryLayout lay_out(const Device& device, const Options& options, Diagnostics& diagnostics) {
  return Builder{device, options, diagnostics}.build();
}

}  // namespace edsc
