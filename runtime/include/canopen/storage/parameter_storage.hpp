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
#include "canopen/od/object_store.hpp"
#include "canopen/storage/parameter_layout.hpp"
#include "canopen/storage/storage.hpp"
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
    return static_cast<AbortCode>(Device::options.storage_signature_abort_code);
  }
  const bool on_command = (entries.number(entries.find(index, sub_index)) & 1u) != 0;
  return on_command ? ok : AbortCode::not_stored;
}

/// The stored values of one device. An image contains one record for each stored section: a header, then the bytes of
/// its values in the order of the layout. Records of another layout are ignored, and removed by the next "save" or
/// "load". If a stored value could not have been written over the bus, the default value is used.
template <class Device>
class ParameterStorage {
 public:
  using Layout = ParameterLayout<Device>;

  /// Whether this device stores 1020h.
  static constexpr bool has_configuration =
      Layout::stores(verify_configuration, 1) && Layout::stores(verify_configuration, 2);

  /// Opens the storage at power-on.
  template <Storage S>
  void open(S& storage) {
    damaged_ = storage.open() == StorageState::damaged;
    restored_ = false;
  }

  /// Whether stored values have been lost since power-on, or some of them could not have been written and were replaced
  /// by default values.
  [[nodiscard]] bool damaged() const { return damaged_; }

  /// Sets 2000h..FFFFh to their default values, then to the stored ones.
  template <Storage S>
  void reset_application(S& storage, ObjectStore<Device>& store, NodeId node_id) {
    reset<false>(storage, store, node_id);
  }

  /// Sets 1000h..1FFFh to their default values, then to the stored ones.
  template <Storage S>
  void reset_communication(S& storage, ObjectStore<Device>& store, NodeId node_id) {
    reset<true>(storage, store, node_id);
  }

  /// Stores the values of some sections, and 1020h with them. Other stored sections are kept. False: storage has
  /// not changed.
  template <Storage S>
  [[nodiscard]] bool save(S& storage, SectionSet sections, ObjectStore<Device>& store) {
    return rewrite(storage, sections | set_of(ParameterSection::configuration), 0, store);
  }

  /// Removes some sections from storage: the next reset or, depending on the options, the next power-on sets their
  /// default values. As 1020h is then no longer valid, it is removed too, and becomes 0 at once. False: storage has
  /// not changed.
  template <Storage S>
  [[nodiscard]] bool restore(S& storage, SectionSet sections, ObjectStore<Device>& store) {
    const unsigned given_up =
        (sections & ~set_of(ParameterSection::with_node_id)) | set_of(ParameterSection::configuration);
    if (!holds_none_of(storage, given_up) && !rewrite(storage, 0, given_up, store)) return false;
    clear_configuration(store);
    restored_ = true;
    return true;
  }

  /// Whether an object belongs to the configuration that 1020h identifies: it is writable over the bus, and "save"
  /// stores it.
  template <DictionaryObject O>
  static constexpr bool is_configuration = [] {
    if (!has_configuration || O::index == verify_configuration) return false;
    const entry::Word word = Device::dictionary.find(O::index, O::sub_index);
    return (word & entry::writable) != 0 && Layout::stores(O::index, O::sub_index);
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
  using Rows = typename Check::Rows;

  /// Header of a section's values. A section is recognised by signature and size.
  struct Header {
    std::uint32_t signature;
    std::uint16_t size;     ///< bytes of the values
    std::uint8_t node_id;   ///< node-ID when they were stored
    std::uint8_t given_up;  ///< 1: valid until the next power-on
  };
  static_assert(sizeof(Header) == Layout::header_bytes);

  /// A section of this device in storage.
  struct Record {
    std::uint32_t position = 0;  ///< of its values; 0: does not exist
    std::uint8_t node_id = 0;
    std::uint8_t given_up = 0;
  };

  [[nodiscard]] static constexpr bool is_in(unsigned sections, std::size_t i) { return ((sections >> i) & 1u) != 0; }

  [[nodiscard]] static std::uint8_t* ram_of(ObjectStore<Device>& store) {
    return reinterpret_cast<std::uint8_t*>(&store.values());
  }

  /// Finds the record of a section that has this device's layout. It is looked up each time, because a table of all
  /// records would take too much stack. False: storage could not be read.
  template <Storage S>
  [[nodiscard, gnu::noinline]] bool find(S& storage, std::size_t section, Record& record) const {
    record = {};
    const std::uint32_t end = storage.size();
    for (std::uint32_t at = 0; at + sizeof(Header) <= end;) {
      Header header;
      if (!storage.read(at, {reinterpret_cast<std::uint8_t*>(&header), sizeof header})) return false;
      at += static_cast<std::uint32_t>(sizeof header);
      const bool same_layout = header.signature == Layout::signatures[section] && header.size == Layout::sizes[section];
      if (same_layout && (header.given_up == 0 || restored_)) record = {at, header.node_id, header.given_up};
      at += header.size;
    }
    return true;
  }

  /// Whether storage could be read, and does not contain these sections.
  template <Storage S>
  [[nodiscard, gnu::noinline]] bool holds_none_of(S& storage, unsigned sections) const {
    Record record;
    for (std::size_t i = 0; i < parameter_sections; ++i) {
      if (is_in(sections, i) && (!find(storage, i, record) || record.position != 0)) return false;
    }
    return true;
  }

  /// The same for the image after the sections in `given_up` have been removed, or marked as valid until power-on.
  template <Storage S>
  [[nodiscard]] bool find_kept(S& storage, std::size_t section, unsigned given_up, Record& record) const {
    if (!find(storage, section, record)) return false;
    if (is_in(given_up, section)) {
      if constexpr (Device::options.restore_needs_power_cycle) {
        record.given_up = 1;
      } else {
        record.position = 0;
      }
    }
    return true;
  }

  /// Writes a new image: the sections in `written` with their present values, the others as they are stored.
  template <Storage S>
  [[nodiscard, gnu::noinline]] bool rewrite(S& storage, unsigned written, unsigned given_up,
                                            ObjectStore<Device>& store) const {
    std::uint32_t size = 0;
    for (std::size_t i = 0; i < parameter_sections; ++i) {
      if (Layout::sizes[i] == 0) continue;
      Record record;
      if (!find_kept(storage, i, given_up, record)) return false;
      if (is_in(written, i) || record.position != 0)
        size += static_cast<std::uint32_t>(sizeof(Header)) + Layout::sizes[i];
    }
    if (!storage.begin(size)) return false;
    for (std::size_t i = 0; i < parameter_sections; ++i) {
      if (Layout::sizes[i] == 0) continue;
      if (!(is_in(written, i) ? write_present(storage, i, store) : write_kept(storage, i, given_up))) return false;
    }
    return storage.commit();
  }

  // Separate functions, so that their buffers do not take stack while the image is committed.
  template <Storage S>
  [[nodiscard, gnu::noinline]] static bool write_present(S& storage, std::size_t section, ObjectStore<Device>& store) {
    return write_header(storage, section, {.node_id = store.node_id().value()}) &&
           write_values(storage, section, ram_of(store));
  }
  template <Storage S>
  [[nodiscard, gnu::noinline]] bool write_kept(S& storage, std::size_t section, unsigned given_up) const {
    Record record;
    if (!find_kept(storage, section, given_up, record)) return false;
    return record.position == 0 || (write_header(storage, section, record) && copy_values(storage, section, record));
  }

  template <Storage S>
  [[nodiscard]] static bool write_header(S& storage, std::size_t section, const Record& record) {
    const Header header{Layout::signatures[section], Layout::sizes[section], record.node_id, record.given_up};
    return storage.write({reinterpret_cast<const std::uint8_t*>(&header), sizeof header});
  }

  template <Storage S>
  [[nodiscard]] static bool write_values(S& storage, std::size_t section, const std::uint8_t* ram) {
    for (std::size_t i = Layout::firsts[section]; i < Layout::firsts[section + 1]; ++i) {
      if (!storage.write({ram + Layout::runs[i].offset, Layout::runs[i].size})) return false;
    }
    return true;
  }

  template <Storage S>
  [[nodiscard, gnu::noinline]] static bool copy_values(S& storage, std::size_t section, const Record& record) {
    std::array<std::uint8_t, 16> bytes;
    for (std::uint32_t done = 0; done < Layout::sizes[section];) {
      const std::uint32_t size = std::min<std::uint32_t>(bytes.size(), Layout::sizes[section] - done);
      const std::span<std::uint8_t> piece{bytes.data(), size};
      if (!storage.read(record.position + done, piece) || !storage.write(piece)) return false;
      done += size;
    }
    return true;
  }

  // Loading

  /// Whether a node-ID-dependent value is longer than four bytes.
  static constexpr bool has_wide_relative = [] {
    bool wide = false;
    for (const NodeIdRelative& row : Device::node_id_relative_communication()) wide = wide || row.size > 4;
    for (const NodeIdRelative& row : Device::node_id_relative_application()) wide = wide || row.size > 4;
    return wide;
  }();
  using Relative = std::conditional_t<has_wide_relative, std::uint64_t, std::uint32_t>;
  static constexpr std::size_t max_relative =
      std::max(Device::node_id_relative_communication().size(), Device::node_id_relative_application().size());

  [[nodiscard]] static Relative relative_value(const std::uint8_t* ram, const NodeIdRelative& row) {
    Relative value = 0;
    std::memcpy(&value, ram + row.offset, row.size);
    return value;
  }

  template <bool Communication>
  static void reset_to_defaults(ObjectStore<Device>& store, NodeId node_id) {
    Communication ? store.reset_communication(node_id) : store.reset_application(node_id);
  }

  /// Sets default values, then the stored ones.
  template <bool Communication, Storage S>
  void reset(S& storage, ObjectStore<Device>& store, NodeId node_id) {
    constexpr std::size_t begin = Communication ? 0 : Check::communication_count;
    constexpr std::size_t end = Communication ? Check::communication_count : Check::checked_count;
    reset_to_defaults<Communication>(store, node_id);
    if (!load<Communication>(storage, nullptr, store)) {
      damaged_ = true;
      reset_to_defaults<Communication>(store, node_id);
    } else if constexpr (begin != end) {
      for (std::size_t i = begin; i < end; ++i) {
        if (!Check::is_possible(store.entries(), Check::checked[i]))
          return leave_out<Communication>(storage, store, node_id, i, end);
      }
    }
  }

  /// Loads again without those values of rows `first` to `end` that could not have been written.
  template <bool Communication, Storage S>
  [[gnu::noinline]] void leave_out(S& storage, ObjectStore<Device>& store, NodeId node_id, std::size_t first,
                                   std::size_t end) {
    Rows left_out{};
    for (std::size_t i = first; i < end; ++i) {
      if (!Check::is_possible(store.entries(), Check::checked[i]))
        left_out[i / 8] |= static_cast<std::uint8_t>(1u << i % 8);
    }
    reset_to_defaults<Communication>(store, node_id);
    for (std::size_t i = first; i < end; ++i) {
      // A default value that could not have been written either is an error in the EDS.
      if (Check::is_row(left_out, i) && Check::is_possible(store.entries(), Check::checked[i])) damaged_ = true;
    }
    if (!load<Communication>(storage, &left_out, store)) {
      damaged_ = true;
      reset_to_defaults<Communication>(store, node_id);
    }
  }

  /// Replaces the default values by the stored ones, except some rows of `checked`. False: storage could not be read,
  /// and some values are undefined.
  template <bool Communication, Storage S>
  [[nodiscard]] bool load(S& storage, const Rows* left_out, ObjectStore<Device>& store) const {
    if constexpr (Communication) {
      return load(storage, communication_sections, Device::node_id_relative_communication(), left_out, store);
    } else {
      return load(storage, all_sections & ~communication_sections, Device::node_id_relative_application(), left_out,
                  store);
    }
  }
  template <Storage S>
  [[nodiscard, gnu::noinline]] bool load(S& storage, unsigned sections, std::span<const NodeIdRelative> relative,
                                         const Rows* left_out, ObjectStore<Device>& store) const {
    for (std::size_t i = 0; i < parameter_sections; ++i) {
      if (!is_in(sections, i) || Layout::sizes[i] == 0) continue;
      Record record;
      if (!find(storage, i, record)) return false;
      if (record.position != 0 && !load_section(storage, i, record, relative, left_out, store)) return false;
    }
    return true;
  }

  /// Loads a section. A value that was the default value for another node-ID becomes the one for this node-ID: a COB-ID
  /// that depends on the node-ID continues to do so (CiA 305).
  template <Storage S>
  [[nodiscard]] static bool load_section(S& storage, std::size_t section, Record record,
                                         std::span<const NodeIdRelative> relative, const Rows* left_out,
                                         ObjectStore<Device>& store) {
    const bool same_node_id = record.node_id == store.node_id().value();
    if (!same_node_id && section == static_cast<std::size_t>(ParameterSection::with_node_id)) return true;
    std::uint8_t* const ram = ram_of(store);
    std::array<Relative, max_relative> defaults;
    for (std::size_t i = 0; i < relative.size(); ++i) defaults[i] = relative_value(ram, relative[i]);
    if (!read_values(storage, section, record.position, left_out, ram)) return false;
    for (std::size_t i = 0; !same_node_id && i < relative.size(); ++i) {
      const Relative stored = relative_value(ram, relative[i]);
      if (stored + store.node_id().value() == defaults[i] + record.node_id)
        std::memcpy(ram + relative[i].offset, &defaults[i], relative[i].size);
    }
    return true;
  }

  template <Storage S>
  [[nodiscard]] static bool read_values(S& storage, std::size_t section, std::uint32_t position, const Rows* left_out,
                                        std::uint8_t* ram) {
    for (std::size_t i = Layout::firsts[section]; i < Layout::firsts[section + 1]; ++i) {
      const StoredRun run = Layout::runs[i];
      if (left_out == nullptr ? !storage.read(position, {ram + run.offset, run.size})
                              : !read_others(storage, position, run, *left_out, ram))
        return false;
      position += run.size;
    }
    return true;
  }

  /// Reads byte by byte, because it is rarely needed.
  template <Storage S>
  [[nodiscard, gnu::noinline]] static bool read_others([[maybe_unused]] S& storage,
                                                       [[maybe_unused]] std::uint32_t position,
                                                       [[maybe_unused]] StoredRun run,
                                                       [[maybe_unused]] const Rows& left_out,
                                                       [[maybe_unused]] std::uint8_t* ram) {
    if constexpr (Check::checked_count != 0) {
      for (std::uint16_t i = 0; i < run.size; ++i) {
        const std::size_t offset = std::size_t{run.offset} + i;
        if (!Check::belongs_to(left_out, offset) && !storage.read(position + i, {ram + offset, 1})) return false;
      }
    }
    return true;
  }

  bool damaged_ = false;
  bool restored_ = false;  ///< since power-on
};

}  // namespace canopen
