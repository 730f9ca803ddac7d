/// Store parameters 1010h, restore default parameters 1011h, verify configuration 1020h (CiA 301, 7.5.2.13, 7.5.2.14
/// and 7.5.2.23).
#pragma once

#include <algorithm>
#include <array>
#include <cstdint>
#include <cstring>
#include <span>
#include <type_traits>

#include "canopen/base/abort_code.hpp"
#include "canopen/can/node_id.hpp"
#include "canopen/od/dictionary.hpp"
#include "canopen/od/object.hpp"
#include "canopen/od/object_store.hpp"
#include "canopen/od/sheet.hpp"
#include "canopen/storage/parameter_layout.hpp"
#include "canopen/storage/storage.hpp"
#include "canopen/storage/stored_format.hpp"
#include "canopen/storage/stored_value.hpp"
#include "canopen/storage/stored_value_check.hpp"

namespace canopen {

inline constexpr std::uint16_t store_parameters = 0x1010;
inline constexpr std::uint16_t restore_parameters = 0x1011;
inline constexpr std::uint16_t verify_configuration = 0x1020;

inline constexpr std::uint32_t save_signature = 0x6576'6173;  ///< "save"
inline constexpr std::uint32_t load_signature = 0x6461'6F6C;  ///< "load"

/// Checks a command to 1010h or 1011h: rejects a wrong signature (by default 0800 0020h), and any command if the
/// default value in the EDS does not have bit 0, "on command", set (0800 0020h).
template <class Device>
[[nodiscard]] AbortCode check_storage_command(EntryAccess<Device> entries, std::uint16_t index, std::uint8_t sub_index,
                                              std::span<const std::uint8_t> bytes) {
  std::uint32_t signature = 0;
  std::memcpy(&signature, bytes.data(), std::min(bytes.size(), sizeof signature));
  if (signature != (index == store_parameters ? save_signature : load_signature)) {
    return static_cast<AbortCode>(options_of<Device>(entries).storage_signature_abort_code);
  }
  const bool on_command = (entries.number(entries.find(index, sub_index)) & 1u) != 0;
  return on_command ? ok : AbortCode::not_stored;
}

/// The stored values of one device. An image contains one record for each stored value, with index, sub-index, type and
/// length, so that a value of another dictionary is loaded if this one accepts it. What is not loaded is reported, and
/// stays in the storage until the application has been able to use it.
template <class Device>
class ParameterStorage {
 public:
  using Layout = ParameterLayout<Device>;

  /// Whether this device stores 1020h.
  static constexpr bool has_configuration =
      Layout::stores(verify_configuration, 1) && Layout::stores(verify_configuration, 2);

  /// Opens the storage at power-on.
  template <Storage StorageType>
  void open(StorageType& storage) {
    damaged_ = storage.open() == StorageState::damaged;
    restored_ = false;
    reported_ = false;
  }

  /// Whether stored values have been lost or not loaded since power-on.
  [[nodiscard]] bool damaged() const { return damaged_; }

  /// Sets 2000h..FFFFh to their default values, then to the stored ones. `hook(value)` is called for each stored value
  /// that is not loaded, or was stored with another `storage_version`.
  template <Storage StorageType, class Hook>
  void reset_application(StorageType& storage, ObjectStore<Device>& store, NodeId node_id, Hook& hook) {
    store.reset_application(node_id);
    if (load(storage, store, Work::load_application, hook)) return;
    damaged_ = true;
    store.reset_application(node_id);
  }

  /// Sets 1000h..1FFFh to their default values, then to the stored ones.
  template <Storage StorageType, class Hook>
  void reset_communication(StorageType& storage, ObjectStore<Device>& store, NodeId node_id, Hook& hook) {
    if constexpr (Check::has_mappings) rejected_ = {};
    store.reset_communication(node_id);
    bool loaded = load(storage, store, Work::load_communication, hook);
    if constexpr (Check::has_mappings) {
      if (loaded && Check::reject_mappings(store.entries(), rejected_)) {
        store.reset_communication(node_id);
        if (Check::has_better_defaults(store.entries(), rejected_)) damaged_ = true;
        loaded = load(storage, store, Work::load_communication, hook);
      }
    }
    if (loaded) return;
    damaged_ = true;
    store.reset_communication(node_id);
  }

  /// Calls `visit(StoredValue)` for each stored value that is not loaded. The next "save" of all parameters removes
  /// them.
  template <Storage StorageType, class Visit>
  void for_each_not_loaded(StorageType& storage, ObjectStore<Device>& store, Visit visit) {
    reported_ = true;
    Lister<Visit> lister{visit};
    Pass pass{&store, Work::list};
    if (walk(storage, pass, lister) == ReadResult::other) visit(StoredValue{{}, NotLoaded::layout, {}, nullptr});
  }

  /// Stores the values of some sections, and 1020h with them. Other stored values are kept. If all values are stored
  /// and the application has been able to use those that were not loaded, by its hook or the list, these are removed,
  /// otherwise they are kept as long as the storage has room. False: storage has not changed.
  template <Storage StorageType, class Hook>
  [[nodiscard]] bool save(StorageType& storage, SectionSet sections, ObjectStore<Device>& store, Hook& hook) {
    Pass pass{&store, Work::keep};
    pass.written = static_cast<SectionSet>(sections | set_of(ParameterSection::configuration));
    pass.keeps_not_loaded = sections != all_sections || !(Hook::exists || reported_);
    return rewrite(storage, pass, hook);
  }

  /// Removes some sections from storage: the next reset or, depending on the options, the next power-on sets their
  /// default values. As 1020h is then no longer valid, it is removed too, and becomes 0 at once. False: storage has
  /// not changed.
  template <Storage StorageType, class Hook>
  [[nodiscard]] bool restore(StorageType& storage, SectionSet sections, ObjectStore<Device>& store, Hook& hook) {
    Pass pass{&store, Work::keep};
    constexpr SectionSet kept = set_of(ParameterSection::with_node_id);
    constexpr SectionSet always = set_of(ParameterSection::configuration);
    pass.given_up = static_cast<SectionSet>((sections & (all_sections ^ kept)) | always);
    pass.keeps_not_loaded = true;
    if (!rewrite(storage, pass, hook)) return false;
    clear_configuration(store);
    restored_ = true;
    return true;
  }

  /// Whether an object belongs to the configuration that 1020h identifies: it is writable over the bus, and "save"
  /// stores it.
  template <DictionaryObject Object>
  static constexpr bool is_configuration = [] {
    if (!has_configuration || Object::index == verify_configuration) return false;
    const entry::Word word = Device::dictionary.find(Object::index, Object::sub_index);
    return (word & entry::writable) != 0 && Layout::stores(Object::index, Object::sub_index);
  }();

  /// Sets 1020h to 0, because the configuration is no longer the one that it identifies.
  static void clear_configuration([[maybe_unused]] ObjectStore<Device>& store) {
    if constexpr (has_configuration) {
      for (const std::uint8_t sub_index : {std::uint8_t{1}, std::uint8_t{2}}) {
        const entry::Word word = Device::dictionary.find(verify_configuration, sub_index);
        std::memset(store.entries().ram(word), 0, entry::wire_bytes(word));
      }
    }
  }

  /// Called before these bytes are written: if they change a stored parameter, 1020h becomes 0.
  static void before_write([[maybe_unused]] ObjectStore<Device>& store, [[maybe_unused]] std::uint16_t index,
                           [[maybe_unused]] std::uint8_t sub_index,
                           [[maybe_unused]] std::span<const std::uint8_t> bytes) {
    if constexpr (has_configuration) {
      if (index == verify_configuration) return;
      const entry::Word word = Device::dictionary.find(index, sub_index);
      if (!Layout::stores(word)) return;
      std::array<std::uint8_t, 8> scratch;
      if (!std::ranges::equal(store.entries().read(word, scratch), bytes)) clear_configuration(store);
    }
  }

 private:
  using Check = StoredValueCheck<Device>;
  using Record = stored_format::Record;
  using SectionHeader = stored_format::SectionHeader;
  using Bytes = std::array<std::uint8_t, 8>;

  /// Bytes of a string that are passed to the application; a number has at most 8.
  static constexpr std::size_t string_bytes = 32;

  /// How the values of an image were read.
  enum class ReadResult : std::uint8_t {
    whole,
    invalid,     ///< the bytes are not an image of stored values, or its rest is not
    other,       ///< an image of the first format has sections of another dictionary
    unreadable,  ///< the storage could not be read, or a new image not be written
  };

  /// What is done with each stored value.
  enum class Work : std::uint8_t {
    load_application,    ///< those that are not in 1000h..1FFFh replace default values
    load_communication,  ///< those in 1000h..1FFFh
    keep,                ///< they are copied to a new image, unless they are removed
    write,               ///< present values are written to a new image
    list,                ///< those that are not loaded are passed to the application
  };

  struct Pass {
    ObjectStore<Device>* store;
    Work work;
    bool keeps_not_loaded = false;
    bool counts = true;         ///< the bytes of the new image are only counted
    bool changes = false;       ///< a value of the present image is not kept as it is
    SectionSet written = 0;     ///< sections whose present values are stored
    SectionSet given_up = 0;    ///< sections that are removed, or marked as valid until power-on
    std::uint16_t context = 0;  ///< node-ID and version of the last context; 0: none, as no node-ID is 0
    std::uint32_t size = 0;     ///< bytes of the new image
  };

  [[nodiscard]] static constexpr bool is_in(SectionSet sections, unsigned i) {
    return ((sections >> i) & SectionSet{1}) != 0;
  }

  // Reading: storage/stored_format.hpp describes the bytes

  /// Does the work of a pass for each stored value.
  template <Storage StorageType, class Hook>
  [[nodiscard, gnu::noinline]] ReadResult walk(StorageType& storage, Pass& pass, Hook& hook) {
    const std::uint32_t end = storage.size();
    Record record;
    std::array<std::uint8_t, stored_format::header_bytes> bytes{};
    for (std::uint32_t at = 0; at != end;) {
      const bool is_first = at == 0;
      if (!read(storage, at, end, bytes)) return failure(at, end, bytes.size());
      if (is_first) {
        if (number_in(bytes) == number_in(stored_format::magic)) continue;
        if constexpr (Device::options.storage_first_format) return walk_sections(storage, pass, hook);
        return ReadResult::invalid;
      }
      const std::uint32_t header = number_in(bytes);
      record.index = static_cast<std::uint16_t>(header);
      if (record.index == 0) {
        record.context = static_cast<std::uint16_t>(header >> 16);
        continue;
      }
      record.sub_index = static_cast<std::uint8_t>(header >> 16);
      record.type = static_cast<std::uint8_t>(header >> 24);
      record.size = entry::wire_bytes(stored_format::word_of(record.type));
      if (stored_format::is_string(record.type)) {
        const std::span<std::uint8_t> length{bytes.data(), stored_format::length_bytes};
        if (!read(storage, at, end, length)) return failure(at, end, length.size());
        record.size = static_cast<std::uint16_t>(number_in(length));
      } else if (record.size > sizeof(Bytes)) {
        return ReadResult::invalid;  // no number has this type
      }
      record.position = at;
      if (end - at < record.size) return ReadResult::invalid;
      at += record.size;
      if (!visit(storage, pass, record, hook)) return ReadResult::unreadable;
    }
    return ReadResult::whole;
  }

  /// Reads the next bytes of an image.
  template <Storage StorageType>
  [[nodiscard]] static bool read(StorageType& storage, std::uint32_t& at, std::uint32_t end,
                                 std::span<std::uint8_t> to) {
    if (end - at < to.size() || !storage.read(at, to)) return false;
    at += static_cast<std::uint32_t>(to.size());
    return true;
  }
  [[nodiscard]] static ReadResult failure(std::uint32_t at, std::uint32_t end, std::size_t size) {
    return end - at < size ? ReadResult::invalid : ReadResult::unreadable;
  }

  /// The same for an image of the first format. A section of this dictionary has the values of all its entries.
  template <Storage StorageType, class Hook>
  [[nodiscard]] ReadResult walk_sections(StorageType& storage, Pass& pass, Hook& hook) {
    const std::uint32_t end = storage.size();
    ReadResult result = ReadResult::whole;
    for (std::uint32_t at = 0; at != end;) {
      SectionHeader header;
      const std::span<std::uint8_t> bytes{reinterpret_cast<std::uint8_t*>(&header), sizeof header};
      if (!read(storage, at, end, bytes)) return failure(at, end, sizeof header);
      if (end - at < header.size) return ReadResult::invalid;
      std::size_t section = Layout::section_count;
      while (section != 0 && !Layout::has_first_format(section - 1, header.signature, header.size)) --section;
      if (section == 0) {
        result = ReadResult::other;
      } else {
        Record record;
        record.context = header.node_id;
        if (header.given_up != 0) record.type = stored_format::given_up;
        record.position = at;
        if (!visit_entries(storage, pass, static_cast<SectionSet>(1u << (section - 1)), record, hook))
          return ReadResult::unreadable;
      }
      at += header.size;
    }
    return result;
  }

  /// Does the work of a pass for each entry of some sections: for its value in an image of the first format, whose
  /// section is at the position of `section`, or for its present value.
  template <Storage StorageType, class Hook>
  [[nodiscard, gnu::noinline]] bool visit_entries(StorageType& storage, Pass& pass, SectionSet sections,
                                                  const Record& section, Hook& hook) {
    bool good = true;
    Device::dictionary.for_each_entry([&](std::uint16_t index, std::uint8_t sub_index, entry::Word word) {
      if (!good || entry::place_of(word) != entry::Place::ram) return;
      const std::uint8_t owner = Layout::section_at(entry::offset_of(word));
      if (owner == Layout::none || !is_in(sections, owner)) return;
      Record record = section;
      record.index = index;
      record.sub_index = sub_index;
      record.type = section.type | stored_format::type_of(word);
      record.size = EntryAccess<Device>::bytes_of(word);
      if (pass.work == Work::write) {
        good = write_present(storage, pass, record, word);
        return;
      }
      if constexpr (Device::options.storage_first_format) {
        record.position += Layout::place_in_section(owner, entry::offset_of(word));
        if (EntryAccess<Device>::kinds.strings_in_ram && entry::is_string(word)) {
          std::array<std::uint8_t, stored_format::length_bytes> length{};
          good = storage.read(record.position, length);
          record.size = static_cast<std::uint16_t>(length[0] | length[1] << 8);
          record.position += static_cast<std::uint32_t>(length.size());
        }
        good = good && visit(storage, pass, record, hook);
      }
    });
    return good;
  }

  /// Does the work of a pass for one stored value. False: storage could not be read or written.
  template <Storage StorageType, class Hook>
  [[nodiscard, gnu::noinline]] bool visit(StorageType& storage, Pass& pass, const Record& record, Hook& hook) {
    const bool loads = pass.work < Work::keep;
    if (loads && is_communication_index(record.index) != (pass.work == Work::load_communication)) return true;
    const bool is_void = record.is_given_up() && !restored_;
    if (is_void && pass.work != Work::keep) return true;
    Bytes bytes;
    const std::span<std::uint8_t> number{bytes.data(), stored_format::is_string(record.type) ? 0u : record.size};
    if (!storage.read(record.position, number)) return false;
    const entry::Word word = EntryAccess<Device>::find(record.index, record.sub_index);
    NotLoaded why = examine(record, word, number);
    if (why == NotLoaded::value && pass.store->entries().holds(word, number)) why = NotLoaded::none;
    if (pass.work == Work::keep) return is_void ? removed(pass) : keep(storage, pass, record, word, why);
    if constexpr (Hook::lists) {
      if (why != NotLoaded::none) report(storage, record, why, number, nullptr, hook);
      return true;
    } else {
      if (why == NotLoaded::none) return load_one(storage, pass, record, word, number, hook);
      if (!asked(storage, pass, record, why, number, hook)) damaged_ = true;
      return true;
    }
  }

  /// Returns why a stored value cannot be loaded.
  [[nodiscard]] NotLoaded examine(const Record& record, entry::Word word, std::span<const std::uint8_t> number) const {
    if (word <= Dictionary::no_sub_index) return NotLoaded::no_object;
    if (entry::place_of(word) != entry::Place::ram || !Layout::stores(word)) return NotLoaded::not_stored;
    if (((stored_format::type_of(word) ^ record.type) & stored_format::type_mask) != 0) return NotLoaded::type;
    if constexpr (EntryAccess<Device>::kinds.strings_in_ram) {
      if (entry::is_string(word)) {
        const bool fits = record.size <= EntryAccess<Device>::capacity(record.index, record.sub_index);
        return fits ? NotLoaded::none : NotLoaded::length;
      }
    }
    const bool is_possible = Check::is_possible(record.index, record.sub_index, word, number) &&
                             !Check::is_rejected(rejected_, record.index);
    return is_possible ? NotLoaded::none : NotLoaded::value;
  }

  // Loading

  /// Replaces default values by the stored ones. False: storage could not be read, and some values are undefined.
  template <Storage StorageType, class Hook>
  [[nodiscard]] bool load(StorageType& storage, ObjectStore<Device>& store, Work work, Hook& hook) {
    Pass pass{&store, work};
    const ReadResult result = walk(storage, pass, hook);
    if (result == ReadResult::unreadable) return false;
    if (result != ReadResult::whole) damaged_ = true;
    if constexpr (Hook::exists) {
      if (result == ReadResult::other && work == Work::load_application)
        hook(StoredValue{{}, NotLoaded::layout, {}, nullptr});
    }
    return true;
  }

  /// Loads a value. False: storage could not be read.
  template <Storage StorageType, class Hook>
  [[nodiscard]] bool load_one(StorageType& storage, Pass& pass, const Record& record, entry::Word word,
                              std::span<const std::uint8_t> number, Hook& hook) {
    const EntryAccess<Device> entries = pass.store->entries();
    if constexpr (Layout::has(ParameterSection::with_node_id)) {
      if (record.node_id() != pass.store->node_id().value() &&
          Layout::section_at(entry::offset_of(word)) == static_cast<std::uint8_t>(ParameterSection::with_node_id))
        return true;
    }
    if constexpr (Hook::exists) {
      if (record.version() != Device::options.storage_version &&
          asked(storage, pass, record, NotLoaded::version, number, hook))
        return true;
    }
    if constexpr (EntryAccess<Device>::kinds.strings_in_ram) {
      if (entry::is_string(word)) {
        const std::span<std::uint8_t> text{entries.ram(word) + stored_format::length_bytes, record.size};
        if (!storage.read(record.position, text)) return false;
        entries.write_value(word, text);
        return true;
      }
    }
    if (!follows_node_id(pass, record, word, number)) entries.write_value(word, number);
    return true;
  }

  /// Asks the application about a value. Returns whether it has replaced or discarded it.
  template <Storage StorageType, class Hook>
  [[nodiscard]] static bool asked([[maybe_unused]] StorageType& storage, [[maybe_unused]] Pass& pass,
                                  [[maybe_unused]] const Record& record, [[maybe_unused]] NotLoaded why,
                                  [[maybe_unused]] std::span<const std::uint8_t> number, [[maybe_unused]] Hook& hook) {
    if constexpr (Hook::exists) {
      StoredValueAnswer answer;
      report(storage, record, why, number, &answer, hook);
      if (answer.size != 0) {
        const auto index = static_cast<std::uint16_t>(answer.key >> 8);
        const auto sub_index = static_cast<std::uint8_t>(answer.key);
        const entry::Word word = EntryAccess<Device>::find(index, sub_index);
        const std::span<const std::uint8_t> value{answer.bytes.data(), answer.size};
        if (is_communication_index(index) != (pass.work == Work::load_communication) ||
            word <= Dictionary::no_sub_index || entry::place_of(word) != entry::Place::ram ||
            !Check::is_possible(index, sub_index, word, value))
          return false;
        pass.store->entries().write_value(word, value);
      }
      return answer.discarded;
    }
    return false;
  }

  /// Passes a value to the application, with its bytes, of a string the first ones.
  template <Storage StorageType, class Hook>
  static void report(StorageType& storage, const Record& record, NotLoaded why, std::span<const std::uint8_t> number,
                     StoredValueAnswer* answer, Hook& hook) {
    std::array<std::uint8_t, string_bytes> text{};
    std::span<const std::uint8_t> bytes = number;
    if (stored_format::is_string(record.type)) {
      const std::span<std::uint8_t> first{text.data(), std::min<std::size_t>(text.size(), record.size)};
      if (storage.read(record.position, first)) bytes = first;
    }
    hook(StoredValue{record, why, bytes, answer});
  }

  /// Passes the values that are not loaded to the application.
  template <class Visit>
  struct Lister {
    static constexpr bool exists = false;
    static constexpr bool lists = true;
    Visit& visit;
    void operator()(const StoredValue& value) const { visit(value); }
  };

  /// Whether a node-ID-dependent value is longer than four bytes.
  static constexpr bool has_wide_relative = [] {
    bool wide = false;
    for (const NodeIdRelative& row : Device::node_id_relative_communication()) wide = wide || row.size > 4;
    for (const NodeIdRelative& row : Device::node_id_relative_application()) wide = wide || row.size > 4;
    return wide;
  }();
  using Relative = std::conditional_t<has_wide_relative, std::uint64_t, std::uint32_t>;
  static constexpr bool has_relative =
      !Device::node_id_relative_communication().empty() || !Device::node_id_relative_application().empty();

  /// Whether a value was the default value for another node-ID: the default value for this node-ID, which is in RAM,
  /// stays. A COB-ID that depends on the node-ID continues to do so (CiA 305).
  [[nodiscard]] static bool follows_node_id([[maybe_unused]] Pass& pass, [[maybe_unused]] const Record& record,
                                            [[maybe_unused]] entry::Word word,
                                            [[maybe_unused]] std::span<const std::uint8_t> number) {
    if constexpr (has_relative) {
      const std::uint8_t node_id = pass.store->node_id().value();
      if (record.node_id() == node_id) return false;
      const std::span<const NodeIdRelative> rows = pass.work == Work::load_communication
                                                       ? Device::node_id_relative_communication()
                                                       : Device::node_id_relative_application();
      for (const NodeIdRelative& row : rows) {
        if (row.offset != entry::offset_of(word)) continue;
        Relative stored = 0;
        Relative by_default = 0;
        std::memcpy(&stored, number.data(), row.size);
        std::memcpy(&by_default, pass.store->entries().ram(word), row.size);
        return stored + node_id == by_default + record.node_id();
      }
    }
    return false;
  }

  // Saving

  /// Writes a new image; if no value is written, only if it differs from the present one. False: storage has not
  /// changed.
  template <Storage StorageType, class Hook>
  [[nodiscard, gnu::noinline]] bool rewrite(StorageType& storage, Pass& pass, Hook& hook) {
    if (!produce(storage, pass, hook)) return false;
    if (pass.written == 0 && !pass.changes) return true;
    if (!storage.begin(pass.size)) {
      if (!pass.keeps_not_loaded) return false;
      pass.keeps_not_loaded = false;  // there is no room for them
      if (!produce(storage, pass, hook) || !storage.begin(pass.size)) return false;
    }
    pass.counts = false;
    return produce(storage, pass, hook) && storage.commit();
  }

  /// Writes the bytes of a new image, or counts them.
  template <Storage StorageType, class Hook>
  [[nodiscard, gnu::noinline]] bool produce(StorageType& storage, Pass& pass, Hook& hook) {
    pass.context = 0;
    pass.size = 0;
    pass.work = Work::keep;
    if (!put(storage, pass, stored_format::magic)) return false;
    const ReadResult result = walk(storage, pass, hook);
    if (result == ReadResult::unreadable) return false;
    if (result != ReadResult::whole) pass.changes = true;
    Record record;
    record.context = static_cast<std::uint16_t>(pass.store->node_id().value() | Device::options.storage_version << 8);
    pass.work = Work::write;
    return visit_entries(storage, pass, pass.written, record, hook);
  }

  /// Writes the present value of an entry, without the 00h after a text.
  template <Storage StorageType>
  [[nodiscard]] static bool write_present(StorageType& storage, Pass& pass, Record& record, entry::Word word) {
    const std::uint8_t* value = pass.store->entries().ram(word);
    if constexpr (EntryAccess<Device>::kinds.strings_in_ram) {
      if (entry::is_string(word)) {
        std::memcpy(&record.size, value, sizeof record.size);
        value += sizeof record.size;
      }
    }
    return put_header(storage, pass, record) && put(storage, pass, {value, record.size});
  }

  /// A stored value is not in the new image.
  [[nodiscard]] static bool removed(Pass& pass) {
    pass.changes = true;
    return true;
  }

  /// Copies a stored value to the new image, unless it is removed.
  template <Storage StorageType>
  [[nodiscard]] static bool keep(StorageType& storage, Pass& pass, Record record, entry::Word word, NotLoaded why) {
    const unsigned section = why == NotLoaded::none ? Layout::section_at(entry::offset_of(word))
                                                    : static_cast<unsigned>(parameter_detail::section_of(record.index));
    if (why == NotLoaded::none ? is_in(pass.written, section) : !pass.keeps_not_loaded) return removed(pass);
    if (is_in(pass.given_up, section)) {
      if (!Device::options.restore_needs_power_cycle || why != NotLoaded::none) return removed(pass);
      if (!record.is_given_up()) pass.changes = true;
      record.type |= stored_format::given_up;
    }
    if (!put_header(storage, pass, record)) return false;
    Bytes bytes;
    for (std::uint32_t done = 0; done < record.size;) {
      const std::span<std::uint8_t> piece{bytes.data(), std::min<std::size_t>(bytes.size(), record.size - done)};
      if (!storage.read(record.position + done, piece) || !put(storage, pass, piece)) return false;
      done += static_cast<std::uint32_t>(piece.size());
    }
    return true;
  }

  /// Writes what is before the bytes of a value.
  template <Storage StorageType>
  [[nodiscard, gnu::noinline]] static bool put_header(StorageType& storage, Pass& pass, const Record& record) {
    if (pass.context != record.context) {
      pass.context = record.context;
      if (!put_word(storage, pass, std::uint32_t{record.context} << 16)) return false;
    }
    if (!put_word(storage, pass,
                  record.index | std::uint32_t{record.sub_index} << 16 | std::uint32_t{record.type} << 24))
      return false;
    if (!stored_format::is_string(record.type)) return true;
    return put(storage, pass, {reinterpret_cast<const std::uint8_t*>(&record.size), sizeof record.size});
  }
  template <Storage StorageType>
  [[nodiscard]] static bool put_word(StorageType& storage, Pass& pass, std::uint32_t word) {
    return put(storage, pass, {reinterpret_cast<const std::uint8_t*>(&word), sizeof word});
  }

  template <Storage StorageType>
  [[nodiscard, gnu::noinline]] static bool put(StorageType& storage, Pass& pass, std::span<const std::uint8_t> bytes) {
    pass.size += static_cast<std::uint32_t>(bytes.size());
    return pass.counts || storage.write(bytes);
  }

  bool damaged_ = false;
  bool restored_ = false;  ///< since power-on
  bool reported_ = false;  ///< the application has read what is not loaded
  [[no_unique_address]] typename Check::Rejected rejected_{};
};

}  // namespace canopen
