/// Access to the values of one device by index and sub-index, for the services.
#pragma once

#include <bit>
#include <cstddef>
#include <cstdint>
#include <cstring>
#include <span>

#include "canopen/base/abort_code.hpp"
#include "canopen/base/assume_aligned.hpp"
#include "canopen/base/bytes.hpp"
#include "canopen/od/access_probe.hpp"
#include "canopen/od/dictionary.hpp"
#include "canopen/od/entry_search.hpp"
#include "canopen/od/sheet.hpp"
#include "canopen/od/value.hpp"

namespace canopen {

static_assert(std::endian::native == std::endian::little,
              "values lie in memory as CiA 301, 7.1 sends them: low byte first");

template <class Device>
class ObjectStore;

namespace entry {

/// Kinds of entries that a dictionary has; code for the others is omitted from an image.
struct Kinds {
  bool strings_in_ram = false;
  bool domains = false;
  bool booleans = false;
  bool padded = false;  ///< numbers of 24, 40, 48 or 56 bits in RAM, stored in the next wider type
  bool constants = false;
  bool negative_immediates = false;
  bool wide_numbers = false;  ///< numbers of more than 32 bits
};

[[nodiscard]] constexpr Kinds kinds_of(const Dictionary& dictionary) {
  Kinds kinds;
  dictionary.for_each_word([&](Word word) {
    const bool in_ram = place_of(word) == Place::ram;
    const std::uint8_t size = wire_bytes(word);
    if (is_string(word) && in_ram) kinds.strings_in_ram = true;
    if (is_domain(word)) kinds.domains = true;
    if (is_boolean(word)) kinds.booleans = true;
    if ((size & (size - 1)) != 0 && in_ram) kinds.padded = true;
    if (place_of(word) == Place::rom) kinds.constants = true;
    if (class_of(word) != Class::special && size > sizeof(std::uint32_t)) kinds.wide_numbers = true;
    if (place_of(word) == Place::immediate && class_of(word) == Class::signed_integer) kinds.negative_immediates = true;
  });
  return kinds;
}

}  // namespace entry

/// The values of one node, and the tables in which entries are found at run time: those of the type, by static
/// functions.
template <class Device>
struct EntryDirectory {
  ObjectStore<Device>* values;

  [[nodiscard]] static constexpr const Dictionary& dictionary() { return Device::dictionary; }

  /// Finds the word of an entry as Dictionary::find does, with one copy of the code in an image.
  [[nodiscard, gnu::noinline]] static entry::Word find(std::uint16_t index, std::uint8_t sub_index) {
    return Device::dictionary.sub_word(EntrySearch<Device>::find(index), sub_index);
  }
};

/// The same with the tables of the sheet of the node.
template <class Device>
requires has_sheet<Device>
struct EntryDirectory<Device> {
  ObjectStore<Device>* values;

  [[nodiscard]] const Dictionary& dictionary() const { return Device::sheet_of(*values).dictionary; }
  [[nodiscard]] entry::Word find(std::uint16_t index, std::uint8_t sub_index) const {
    return dictionary().find(index, sub_index);
  }
};

/// Access to the entries of one node by index and sub-index, as an SDO server needs it. A reference to an ObjectStore,
/// cheap to copy.
template <class Device>
class EntryAccess : public EntryDirectory<Device> {
  using Directory = EntryDirectory<Device>;
  using Directory::values;

 public:
  static constexpr entry::Kinds kinds = entry::kinds_of(Device::dictionary);

  using Directory::dictionary, Directory::find;

  /// Returns the bytes of an entry as SDO sends them. Immediate values are copied to `scratch`, others are referenced
  /// in place. An unbound domain: no bytes, null pointer.
  [[nodiscard]] std::span<const std::uint8_t> read(entry::Word word, std::span<std::uint8_t, 8> scratch) const {
    if (is_immediate(word)) {
      const std::uint32_t value = immediate_value(word);
      std::memcpy(scratch.data(), &value, sizeof value);
      if (entry::size_of(word) > sizeof value) {
        const std::uint32_t high = is_negative(word) ? 0xFFFF'FFFF : 0;
        std::memcpy(scratch.data() + sizeof value, &high, sizeof high);
      }
      return {scratch.data(), bytes_of(word)};
    }
    if (entry::is_string(word) || is_domain(word)) return read_variable_length(word);
    return {address(word), bytes_of(word)};
  }

  /// The same for a string or a DOMAIN.
  [[nodiscard]] std::span<const std::uint8_t> read_variable_length(entry::Word word) const {
    if (is_domain(word)) {
      const Domain memory = domain(word);
      return {memory.data, memory.size};
    }
    const std::uint8_t* const where = address(word);
    return {where + string_header, load<std::uint16_t>(where) + (is_terminated(word) ? 1u : 0u)};
  }

  /// Returns an unsigned value of up to 32 bits.
  [[nodiscard]] std::uint32_t number(entry::Word word) const { return number_of(values, word); }

  /// Returns an unsigned value of up to 32 bits; the entry must exist.
  [[nodiscard]] std::uint32_t number(std::uint16_t index, std::uint8_t sub_index) const {
    return number_of(values, find(index, sub_index));
  }

  /// Returns an unsigned value of up to 32 bits of an entry that is known at compile time.
  template <std::uint16_t Index, std::uint8_t SubIndex>
  [[nodiscard]] std::uint32_t number() const {
    AccessProbe<Device>::uses(Index, SubIndex);
    return values->template number<Index, SubIndex>();
  }

  /// Returns an unsigned value of `Size` bytes at an offset in RAM.
  template <std::uint8_t Size>
  [[nodiscard]] std::uint32_t number_at(std::size_t offset) const {
    const std::uint8_t* const where = reinterpret_cast<const std::uint8_t*>(values) + offset;
    if constexpr (Size == 1) {
      return *where;
    } else if constexpr (Size == 2) {
      return load<std::uint16_t>(where);
    } else {
      return load<std::uint32_t>(where);
    }
  }

  /// Returns the memory of a DOMAIN.
  [[nodiscard]] Domain domain(entry::Word word) const { return load<Domain>(ram(word)); }

  /// Returns the address of an entry in RAM.
  [[nodiscard]] std::uint8_t* ram(entry::Word word) const {
    return reinterpret_cast<std::uint8_t*>(values) + entry::offset_of(word);
  }

  /// Returns the address of an entry in the constants.
  [[nodiscard]] const std::uint8_t* constant(entry::Word word) const {
    return static_cast<const std::uint8_t*>(dictionary().constants) + entry::offset_of(word);
  }

  /// Sets the number of bytes of a DOMAIN's memory that are its value.
  void resize_domain(entry::Word word, std::uint32_t size) const {
    Domain resized = domain(word);
    resized.size = size;
    store(ram(word), resized);
  }

  /// Checks whether these bytes may be written: their length, then their value (CiA 301, 7.2.4.3.17).
  [[nodiscard, gnu::noinline]] AbortCode check(std::uint16_t index, std::uint8_t sub_index, entry::Word word,
                                               std::span<const std::uint8_t> bytes) const {
    if (const AbortCode length = check_length(index, sub_index, word, bytes.size()); length != ok) return length;
    // Without with_sheet, whose reference to the node would stay a parameter of this function.
    if constexpr (has_sheet<Device>) {
      return check_value(index, sub_index, word, bytes, *this);
    } else {
      return check_value(index, sub_index, word, bytes);
    }
  }

  /// Checks the value of bytes whose length is correct. `of_node`: as in `with_sheet`.
  template <class... OfNode>
  [[nodiscard]] static AbortCode check_value([[maybe_unused]] std::uint16_t index,
                                             [[maybe_unused]] std::uint8_t sub_index, entry::Word word,
                                             [[maybe_unused]] std::span<const std::uint8_t> bytes,
                                             [[maybe_unused]] const OfNode&... of_node) {
    if (entry::place_of(word) != entry::Place::ram)
      return AbortCode::not_stored;  // a command such as 1010h that no service handles
    if constexpr (kinds.booleans) {
      if (entry::is_boolean(word)) return bytes[0] > 1 ? AbortCode::invalid_value : ok;
    }
    if constexpr (has_limits) {
      if ((word & entry::limited) != 0 && entry::class_of(word) != entry::Class::special)
        return check_limits(object_key(index, limits_sub_index(index, sub_index, of_node...)), word, bytes.data(),
                            of_node...);
    }
    return ok;
  }

  /// Checks whether a value of this length fits the entry.
  [[nodiscard]] AbortCode check_length(std::uint16_t index, std::uint8_t sub_index, entry::Word word,
                                       std::size_t length) const {
    const std::size_t fixed = bytes_of(word);
    if (length == fixed) return ok;
    if (length < fixed) return AbortCode::length_too_low;
    return length > longest(index, sub_index, word) ? AbortCode::length_too_high : ok;
  }

  /// Returns the maximum length of a value of the entry, in bytes.
  [[nodiscard]] std::uint32_t longest([[maybe_unused]] std::uint16_t index, [[maybe_unused]] std::uint8_t sub_index,
                                      entry::Word word) const {
    if constexpr (kinds.strings_in_ram) {
      if (entry::is_string(word)) {
        if constexpr (has_sheet<Device>) {
          return capacity(index, sub_index, *this);
        } else {
          return capacity(index, sub_index);
        }
      }
    }
    return is_domain(word) ? domain(word).capacity : bytes_of(word);
  }

  /// Whether a number or a string in RAM has these bytes.
  [[nodiscard]] bool holds(entry::Word word, std::span<const std::uint8_t> bytes) const {
    const std::uint8_t* own = ram(word);
    if (kinds.strings_in_ram && entry::is_string(word)) {
      if (load<std::uint16_t>(own) != bytes.size()) return false;
      own += string_header;
    }
    for (const std::uint8_t byte : bytes) {
      if (byte != *own++) return false;
    }
    return true;
  }

  /// Whether each value in RAM but those of DOMAINs is a number whose bytes are stored as they are transferred.
  static constexpr bool has_plain_numbers = !kinds.padded && !kinds.strings_in_ram && !kinds.booleans;

  /// Stores the bytes of such a number. Returns whether they differ from the present ones.
  [[nodiscard]] bool replace(entry::Word word, std::span<const std::uint8_t> bytes) const requires(has_plain_numbers) {
    std::uint8_t* own = ram(word);
    unsigned changed = 0;
    for (const std::uint8_t byte : bytes) {
      changed |= *own ^ unsigned { byte };
      *own++ = byte;
    }
    return changed != 0;
  }

  /// Stores bytes that `check` has accepted in an entry in RAM, those of a DOMAIN in its memory.
  void write(entry::Word word, std::span<const std::uint8_t> bytes) const {
    if (!is_domain(word)) return write_value(word, bytes);
    resize_domain(word, static_cast<std::uint32_t>(bytes.size()));
    std::uint8_t* const memory = domain(word).data;
    if (memory != bytes.data()) copy_bytes(memory, bytes.data(), bytes.size());
  }
  /// The same for an entry that is not a DOMAIN.
  void write_value(entry::Word word, std::span<const std::uint8_t> bytes) const {
    std::uint8_t* where = ram(word);
    const std::size_t size = bytes.size();
    if (kinds.strings_in_ram && entry::is_string(word)) {
      store(where, static_cast<std::uint16_t>(size));
      where += string_header;
      if (is_terminated(word)) where[size] = 0;
    } else if (kinds.padded && (size & (size - 1)) != 0) {
      return extend(word, where, bytes, size == 3 ? 4 : 8);  // such numbers are stored in the next wider type
    }
    copy_few_bytes(where, bytes.data(), size);
  }

  /// Returns the capacity of a string entry in bytes. `of_node`: as in `with_sheet`.
  template <class... OfNode>
  [[nodiscard]] static std::uint32_t capacity(std::uint16_t index, std::uint8_t sub_index, const OfNode&... of_node) {
    const std::uint32_t key = object_key(index, limits_sub_index(index, sub_index, of_node...));
    const Limits* row = tables(of_node...).find_limits(key);
    return row == nullptr ? 0 : row->high;
  }

  /// Returns the bytes of a value as SDO transfers it; 0: variable length.
  [[nodiscard]] static constexpr std::uint8_t bytes_of(entry::Word word) {
    if constexpr (kinds.booleans) return entry::wire_bytes(word);
    return entry::class_of(word) != entry::Class::special ? entry::size_of(word) : std::uint8_t{0};
  }

  /// Whether an entry is a DOMAIN.
  [[nodiscard]] static constexpr bool is_domain(entry::Word word) { return kinds.domains && entry::is_domain(word); }

 private:
  /// One copy in an image, with the address of the values in a register.
  [[nodiscard, gnu::noinline]] static std::uint32_t number_of(ObjectStore<Device>* store, entry::Word word) {
    const EntryAccess entries{{store}};
    if (is_immediate(word)) return entries.immediate_value(word);
    const std::uint8_t* const where = entries.address(word);
    if (entry::size_of(word) == 1) return *where;
    if (entry::size_of(word) == 2) return load<std::uint16_t>(where);
    return load<std::uint32_t>(where);
  }

  static constexpr bool has_limits = !Device::dictionary.limits.empty() || !Device::dictionary.wide_limits.empty();
  static constexpr std::size_t string_header = sizeof(std::uint16_t);

  /// Whether a 00h follows the text; its storage then has one more byte than the capacity.
  [[nodiscard]] bool is_terminated(entry::Word word) const {
    return dictionary().zero_terminated_strings && entry::type_of(word) == entry::visible_string;
  }

  /// Loads a value that is stored as its C++ type, at an address aligned for it.
  template <class Type>
  [[nodiscard]] static Type load(const std::uint8_t* where) {
    Type value;
    std::memcpy(&value, assume_aligned<alignof(Type)>(where), sizeof value);
    return value;
  }
  template <class Type>
  static void store(std::uint8_t* where, const Type& value) {
    std::memcpy(assume_aligned<alignof(Type)>(where), &value, sizeof value);
  }

  /// Stores a number in a wider type, sign-extended if it is signed.
  static void extend(entry::Word word, std::uint8_t* where, std::span<const std::uint8_t> bytes, std::size_t to) {
    const bool negative = entry::class_of(word) == entry::Class::signed_integer && (bytes.back() & 0x80) != 0;
    for (std::size_t i = 0; i < to; ++i) {
      const auto sign = static_cast<std::uint8_t>(negative ? 0xFF : 0);
      where[i] = i < bytes.size() ? bytes[i] : sign;
    }
  }

  [[nodiscard]] static bool is_immediate(entry::Word word) {
    static_assert(static_cast<unsigned>(entry::Place::immediate) == 2);
    return (word & (entry::Word{2} << entry::place_shift)) != 0;
  }

  /// Returns the address of a value that is not immediate.
  [[nodiscard]] const std::uint8_t* address(entry::Word word) const {
    if (kinds.constants && entry::place_of(word) == entry::Place::rom) return constant(word);
    return ram(word);
  }

  [[nodiscard]] static bool is_negative(entry::Word word) {
    return kinds.negative_immediates && entry::class_of(word) == entry::Class::signed_integer && (word & 0x8000) != 0 &&
           entry::place_of(word) == entry::Place::immediate;
  }

  [[nodiscard]] std::uint32_t immediate_value(entry::Word word) const {
    const std::uint32_t value = entry::offset_of(word);
    if (entry::place_of(word) == entry::Place::immediate_plus_node_id) return value + values->node_id().value();
    return is_negative(word) ? value | 0xFFFF'0000 : value;
  }

  /// Returns the tables of the type, or of the sheet of the node.
  template <class... OfNode>
  [[nodiscard]] static constexpr const Dictionary& tables([[maybe_unused]] const OfNode&... of_node) {
    if constexpr (has_sheet<Device>) {
      return (of_node, ...).dictionary();
    } else {
      return Device::dictionary;
    }
  }

  template <class... OfNode>
  [[nodiscard]] static std::uint8_t limits_sub_index(std::uint16_t index, std::uint8_t sub_index,
                                                     const OfNode&... of_node) {
    const bool array = entry::kind_of(tables(of_node...).find_index(index)) == entry::Kind::array;
    return array && sub_index > 1 ? std::uint8_t{1} : sub_index;
  }

  template <class... OfNode>
  [[nodiscard]] static AbortCode check_limits(std::uint32_t key, entry::Word word, const std::uint8_t* bytes,
                                              const OfNode&... of_node) {
    if constexpr (!Device::dictionary.wide_limits.empty()) {
      if (entry::size_of(word) > 4)
        return check_against(dictionary_detail::find_by_key(tables(of_node...).wide_limits, key), word, bytes);
    }
    return check_against(tables(of_node...).find_limits(key), word, bytes);
  }

  /// `Row` is Limits or WideLimits.
  template <class Row>
  [[nodiscard]] static AbortCode check_against(const Row* row, entry::Word word, const std::uint8_t* bytes) {
    using Raw = decltype(Row::high);
    if (row == nullptr) return ok;
    alignas(Raw) std::uint8_t wide[sizeof(Raw)];
    extend(word, wide, {bytes, entry::size_of(word)}, sizeof wide);
    const auto raw = load<Raw>(wide);
    if (entry::class_of(word) == entry::Class::real && not_a_number(raw)) return AbortCode::invalid_value;
    const Raw value = sortable(word, raw);
    if (value > sortable(word, row->high)) return AbortCode::value_too_high;
    return value < sortable(word, row->low) ? AbortCode::value_too_low : ok;
  }

  /// Maps a value to an unsigned number with the same order: no floating-point library is needed.
  template <class Raw>
  [[nodiscard]] static Raw sortable(entry::Word word, Raw raw) {
    constexpr Raw sign = Raw{1} << (sizeof(Raw) * 8 - 1);
    switch (entry::class_of(word)) {
      case entry::Class::signed_integer: return raw ^ sign;
      case entry::Class::real:
        if ((raw & ~sign) == 0) return sign;  // -0 equals +0
        return (raw & sign) != 0 ? ~raw : raw | sign;
      case entry::Class::unsigned_integer:
      case entry::Class::special: break;
    }
    return raw;
  }

  template <class Raw>
  [[nodiscard]] static bool not_a_number(Raw raw) {
    constexpr Raw infinity = sizeof(Raw) == 4 ? Raw{0xFF00'0000} : static_cast<Raw>(0xFFE0'0000'0000'0000);
    return static_cast<Raw>(raw << 1) > infinity;
  }
};

}  // namespace canopen
