/// Which values of a device "save" stores, computed at compile time (CiA 301, 7.5.2.13).
#pragma once

#include <array>
#include <bit>
#include <cstddef>
#include <cstdint>
#include <span>

#include "canopen/od/device_options.hpp"
#include "canopen/od/dictionary.hpp"
#include "canopen/od/value.hpp"
#include "canopen/storage/parameter_ranges.hpp"
#include "canopen/storage/stored_format.hpp"

namespace canopen {

/// Consecutive bytes of Values that are stored.
struct StoredRun {
  std::uint16_t offset;
  std::uint16_t size;
};

namespace parameter_detail {

/// Whether an entry is readable and writable, and not process data: rww is a process output, rwr an input (CiA
/// 306-1, 4.6.2).
[[nodiscard]] constexpr bool has_access_of_parameter(entry::Word word) {
  const bool to_tpdo = (word & entry::tpdo) != 0;
  const bool from_rpdo = (word & entry::rpdo) != 0;
  return (word & entry::rw) == entry::rw && to_tpdo == from_rpdo;
}

/// The owner of an entry that is not stored; all others are sections.
inline constexpr std::uint8_t not_stored = 0xFE;

/// Returns the owner of the entries of an object that are parameters.
[[nodiscard]] constexpr std::uint8_t parameter_owner(std::uint16_t index) {
  return can_be_parameter(index) ? static_cast<std::uint8_t>(section_of(index)) : not_stored;
}

/// Returns the section that stores an entry in RAM, by its access and the options of the device, or `not_stored`.
/// `as_parameter` is `parameter_owner(index)`.
[[nodiscard]] constexpr std::uint8_t owner_of(std::uint16_t index, entry::Word word, Storing storing,
                                              std::uint8_t as_parameter) {
  if (entry::is_domain(word)) return not_stored;
  switch (storing) {
    case Storing::never: return not_stored;
    case Storing::always: return static_cast<std::uint8_t>(section_of(index));
    case Storing::with_node_id: return static_cast<std::uint8_t>(ParameterSection::with_node_id);
    case Storing::by_access: break;
    default: return static_cast<std::uint8_t>(std::countr_zero(sections_of(sub_index_of(storing))));
  }
  return has_access_of_parameter(word) ? as_parameter : not_stored;
}

[[nodiscard]] constexpr std::uint32_t mix(std::uint32_t hash, std::uint32_t word) {
  return (std::rotl(hash, 5) ^ word) * 0x9E37'79B1u;
}

/// Adds the limits of an entry to the hash. The limits of array elements have sub-index 1.
[[nodiscard]] constexpr std::uint32_t mix_limits(std::uint32_t hash, const Dictionary& dictionary, std::uint16_t index,
                                                 std::uint8_t sub_index) {
  const bool array = entry::kind_of(dictionary.find_index(index)) == entry::Kind::array;
  const std::uint32_t key = object_key(index, array && sub_index > 1 ? std::uint8_t{1} : sub_index);
  // By position: with UBSan, g++ 12 does not accept a pointer to a row of a table as a constant.
  const std::size_t narrow = dictionary_detail::position_of_key(dictionary.limits, key);
  if (narrow < dictionary.limits.size()) {
    hash = mix(mix(hash, dictionary.limits[narrow].low), dictionary.limits[narrow].high);
  }
  const std::size_t wide = dictionary_detail::position_of_key(dictionary.wide_limits, key);
  if (wide < dictionary.wide_limits.size()) {
    for (const std::uint64_t limit : {dictionary.wide_limits[wide].low, dictionary.wide_limits[wide].high}) {
      hash = mix(mix(hash, static_cast<std::uint32_t>(limit)), static_cast<std::uint32_t>(limit >> 32));
    }
  }
  return hash;
}

}  // namespace parameter_detail

/// Selects the entries to store: those in RAM that are readable and writable over the bus, except DOMAINs, process data
/// (access rww or rwr, or mapped into a PDO by the EDS) and objects that are not parameters. The options of the device
/// can change this.
template <class Device>
class ParameterLayout {
  static constexpr std::size_t ram_bytes = sizeof(typename Device::Values);
  static_assert(ram_bytes <= 0xFFFF, "runs of stored values are counted with 16 bits");

  // Owner of a byte of Values: a section, or one of these.
  static constexpr std::uint8_t padding = 0xFF;
  static constexpr std::uint8_t not_stored = parameter_detail::not_stored;

  [[nodiscard]] static constexpr Storing storing([[maybe_unused]] std::uint16_t index,
                                                 [[maybe_unused]] std::uint8_t sub_index) {
    if constexpr (requires { Device::storing(index, sub_index); }) {
      return Device::storing(index, sub_index);
    } else {
      return Storing::by_access;
    }
  }

  template <class Pdos>
  static constexpr std::size_t entries_of = [] {
    std::size_t entries = 0;
    for (const std::span<const std::uint32_t> keys : Pdos::keys) entries += keys.size();
    return entries;
  }();

  /// The objects that the EDS maps into PDOs.
  static constexpr auto carried = [] {
    std::array<std::uint32_t, entries_of<typename Device::Rpdos> + entries_of<typename Device::Tpdos>> keys{};
    std::size_t i = 0;
    const auto add = [&](const auto& lists) {
      for (const std::span<const std::uint32_t> mapped : lists) {
        for (const std::uint32_t key : mapped) keys[i++] = key;
      }
    };
    add(Device::Rpdos::keys);
    add(Device::Tpdos::keys);
    return keys;
  }();

  /// Sets the owner of the bytes of an entry.
  static constexpr void give(std::uint8_t* bytes, std::uint16_t index, std::uint8_t sub_index, entry::Word word,
                             std::uint8_t owner) {
    std::uint8_t* const begin = bytes + entry::offset_of(word);
    for (std::uint8_t* at = begin + memory_bytes(index, sub_index, word); at != begin;) *--at = owner;
  }

  [[nodiscard]] static constexpr std::size_t memory_bytes(std::uint16_t index, std::uint8_t sub_index,
                                                          entry::Word word) {
    if (entry::is_domain(word)) return sizeof(Domain);
    if (entry::is_string(word)) {
      const bool terminated =
          Device::dictionary.zero_terminated_strings && entry::type_of(word) == entry::visible_string;
      return sizeof(std::uint16_t) + string_capacity(index, sub_index) + (terminated ? 1 : 0);
    }
    const std::size_t size = entry::wire_bytes(word);
    return size <= 2 ? size : size <= 4 ? 4 : 8;
  }

  /// The elements of an ARRAY share the row of sub-index 1.
  [[nodiscard]] static constexpr std::size_t string_capacity(std::uint16_t index, std::uint8_t sub_index) {
    const bool array = entry::kind_of(Device::dictionary.find_index(index)) == entry::Kind::array;
    const std::span<const Limits> rows = Device::dictionary.limits;
    const std::uint32_t key = object_key(index, array && sub_index > 1 ? std::uint8_t{1} : sub_index);
    const std::size_t position = dictionary_detail::position_of_key(rows, key);
    return position < rows.size() ? rows[position].high : 0;
  }

  /// Calls `visit(index, sub_index, word)` for each entry in RAM.
  template <class Visit>
  static constexpr void for_each_in_ram(Visit&& visit) {
    Device::dictionary.for_each_entry([&](std::uint16_t index, std::uint8_t sub_index, entry::Word word) {
      if (entry::place_of(word) == entry::Place::ram) visit(index, sub_index, word);
    });
  }

  static constexpr std::array<std::uint8_t, ram_bytes> owners = [] {
    std::array<std::uint8_t, ram_bytes> bytes{};
    for (std::uint8_t& byte : bytes) byte = padding;
    std::uint16_t object = 0;
    std::uint8_t as_parameter = not_stored;
    for_each_in_ram([&](std::uint16_t index, std::uint8_t sub_index, entry::Word word) {
      if (index != object) as_parameter = parameter_detail::parameter_owner(index);
      object = index;
      const Storing how = storing(index, sub_index);
      give(bytes.data(), index, sub_index, word, parameter_detail::owner_of(index, word, how, as_parameter));
    });
    for (const std::uint32_t key : carried) {
      const auto index = static_cast<std::uint16_t>(key >> 8);
      const auto sub_index = static_cast<std::uint8_t>(key);
      const entry::Word word = Device::dictionary.find(index, sub_index);
      if (word <= Dictionary::no_sub_index || entry::place_of(word) != entry::Place::ram) continue;
      if (storing(index, sub_index) == Storing::by_access) give(bytes.data(), index, sub_index, word, not_stored);
    }
    return bytes;
  }();

  /// Calls `visit(section, run)` for each run, in memory order. Padding between two values of a section belongs to it.
  template <class Visit>
  static constexpr void for_each_run(Visit&& visit) {
    const std::uint8_t* const bytes = owners.data();
    for (std::size_t at = 0; at < ram_bytes; ++at) {
      const std::uint8_t owner = bytes[at];
      if (owner >= parameter_sections) continue;
      const std::size_t begin = at;
      for (std::size_t next = at + 1; next < ram_bytes && (bytes[next] == owner || bytes[next] == padding); ++next) {
        if (bytes[next] == owner) at = next;
      }
      visit(owner, StoredRun{static_cast<std::uint16_t>(begin), static_cast<std::uint16_t>(at + 1 - begin)});
    }
  }

 public:
  /// The sections of this device are those below.
  static constexpr std::size_t section_count = [] {
    std::size_t count = 0;
    for_each_run([&](std::uint8_t section, StoredRun) {
      if (section >= count) count = section + std::size_t{1};
    });
    return count;
  }();

  /// Position in `runs` of the first run of each section.
  static constexpr std::array<std::uint16_t, section_count + 1> firsts = [] {
    std::array<std::uint16_t, section_count + 1> counts{};
    for_each_run([&](std::uint8_t section, StoredRun) { ++counts[section + 1u]; });
    for (std::size_t i = 0; i < section_count; ++i)
      counts[i + 1] = static_cast<std::uint16_t>(counts[i + 1] + counts[i]);
    return counts;
  }();

  static constexpr std::array<StoredRun, firsts[section_count]> runs = [] {
    std::array<StoredRun, firsts[section_count]> rows{};
    auto next = firsts;
    for_each_run([&](std::uint8_t section, StoredRun run) { rows[next[section]++] = run; });
    return rows;
  }();

  /// Bytes of the values of each section in images of the first format.
  static constexpr std::array<std::uint16_t, section_count> sizes = [] {
    std::array<std::uint16_t, section_count> bytes{};
    for_each_run([&](std::uint8_t section, StoredRun run) {
      bytes[section] = static_cast<std::uint16_t>(bytes[section] + run.size);
    });
    return bytes;
  }();

  /// Identifies the values of each section in images of the first format: a hash of the entries, their types, limits
  /// and positions.
  static constexpr std::array<std::uint32_t, section_count> signatures = [] {
    std::array<std::uint16_t, ram_bytes> places{};
    std::array<std::uint16_t, section_count> next{};
    for_each_run([&](std::uint8_t section, StoredRun run) {
      std::uint16_t place = next[section];
      std::uint16_t* const begin = places.data() + run.offset;
      for (std::uint16_t* at = begin; at != begin + run.size; ++at) *at = place++;
      next[section] = place;
    });
    std::array<std::uint32_t, section_count> hashes{};
    for (std::uint32_t i = 0; i < section_count; ++i) hashes[i] = parameter_detail::mix(0x811C'9DC5u, i);
    for_each_in_ram([&](std::uint16_t index, std::uint8_t sub_index, entry::Word word) {
      const std::uint8_t section = owners[entry::offset_of(word)];
      if (section >= parameter_sections) return;
      std::uint32_t& hash = hashes[section];
      hash = parameter_detail::mix(hash, object_key(index, sub_index));
      hash = parameter_detail::mix(hash, entry::type_of(word) | places[entry::offset_of(word)]);
      if ((word & entry::limited) != 0) {
        hash = parameter_detail::mix_limits(hash, Device::dictionary, index, sub_index);
      }
    });
    return hashes;
  }();

  /// Bytes of an image with all values of this device.
  static constexpr std::uint32_t max_image = [] {
    std::uint32_t bytes = stored_format::magic.size();
    if (section_count == 0) return bytes;
    bytes += static_cast<std::uint32_t>(stored_format::header_bytes * (section_count + 1));
    for_each_in_ram([&](std::uint16_t index, std::uint8_t sub_index, entry::Word word) {
      if (owners[entry::offset_of(word)] >= parameter_sections) return;
      const std::size_t value = entry::is_string(word) ? stored_format::length_bytes + string_capacity(index, sub_index)
                                                       : entry::wire_bytes(word);
      bytes += static_cast<std::uint32_t>(stored_format::header_bytes + value);
    });
    return bytes;
  }();

  /// Whether an entry is stored.
  [[nodiscard]] static constexpr bool stores(std::uint16_t index, std::uint8_t sub_index) {
    const entry::Word word = Device::dictionary.find(index, sub_index);
    return word > Dictionary::no_sub_index && entry::place_of(word) == entry::Place::ram &&
           owners[entry::offset_of(word)] < parameter_sections;
  }

  /// Whether any entry belongs to a section.
  [[nodiscard]] static constexpr bool has(ParameterSection section) {
    const auto i = static_cast<std::size_t>(section);
    return i < section_count && sizes[i] != 0;
  }

  /// Returns the sections of a sub-index of 1010h and 1011h; 0 if no entry belongs to a manufacturer-specific one.
  [[nodiscard]] static constexpr SectionSet sections_of(std::uint8_t sub_index) {
    const SectionSet sections = canopen::sections_of(sub_index);
    return sub_index < first_group_sub_index || sections < (1u << section_count) ? sections : SectionSet{0};
  }

  /// The section of an entry that is not stored.
  static constexpr std::uint8_t none = 0xFF;

  /// Returns the section of an entry in RAM.
  [[nodiscard, gnu::noinline]] static std::uint8_t section_at(std::uint16_t offset) {
    for (std::uint8_t section = 0; section < section_count; ++section) {
      for (std::size_t i = firsts[section]; i < firsts[section + 1u]; ++i) {
        if (static_cast<std::uint16_t>(offset - runs[i].offset) < runs[i].size) return section;
      }
    }
    return none;
  }

  /// Whether a section of this device is the one of an image of the first format.
  [[nodiscard]] static bool has_first_format(std::size_t section, std::uint32_t signature, std::uint16_t size) {
    return signatures[section] == signature && sizes[section] == size;
  }

  /// Returns the position of the value at an offset in RAM in an image of the first format, among the values of its
  /// section.
  [[nodiscard]] static std::uint32_t place_in_section(std::size_t section, std::uint16_t offset) {
    std::uint32_t place = 0;
    for (std::size_t i = firsts[section];; ++i) {
      const auto in_run = static_cast<std::uint16_t>(offset - runs[i].offset);
      if (in_run < runs[i].size) return place + in_run;
      place += runs[i].size;
    }
  }

  /// Whether an entry in RAM is stored.
  [[nodiscard]] static bool stores(entry::Word word) { return section_at(entry::offset_of(word)) != none; }
};

}  // namespace canopen
