/// The values of a dynamic device at a reset, and 1010h, 1011h and 1020h: what canopen/node/services/values.hpp does
/// for generated devices with tables that are made at compile time.
#pragma once

#include <algorithm>
#include <array>
#include <canopen/node/services/values.hpp>
#include <canopen/storage/parameter_storage.hpp>
#include <canopen/storage/storage.hpp>
#include <cstdint>
#include <cstring>
#include <span>
#include <vector>

#include "device/dynamic_device.hpp"
#include "device/stored_values.hpp"

namespace canopen::service {

template <class... Handlers>
class StoredValues<edsc::DynamicDevice, Handlers...>
    : public ServiceDefaults<StoredValues<edsc::DynamicDevice, Handlers...>> {
  using Device = edsc::DynamicDevice;
  using Row = edsc::StoredRow;

 public:
  static constexpr bool exists = storage_detail::has_storage<Handlers...>;
  static constexpr bool is_stepped = false;

  template <class Host>
  void on_start(Host& host) {
    auto& storage = host.handlers.storage();
    damaged_ = storage.open() == StorageState::damaged;
    std::vector<std::uint8_t> image(storage.size());
    const bool readable = storage.read(0, image);
    edsc::StoredImage read = edsc::read_stored_image(image);
    damaged_ = damaged_ || !readable || !read.whole;
    rows_ = std::move(read.rows);
    restored_ = false;
  }
  template <class Host>
  void reset_application(Host& host) {
    host.store.reset_application(host.node_id);
    load(host, false);
  }
  template <class Host>
  void reset_communication(Host& host) {
    host.store.reset_communication(host.node_id);
    load(host, true);
    if (!damaged_) return;
    constexpr std::uint16_t code = emergency_code::data_set;
    host.services.template get<Emergency<Device>>().report(host, code, ErrorRegister::generic,
                                                           emergency_info<Device>(host.store, code));
  }

  static constexpr bool has_command(std::uint16_t index) {
    return index == store_parameters || index == restore_parameters;
  }
  template <class Host>
  AbortCode command(Host& host, std::uint16_t index, std::uint8_t sub_index, std::span<std::uint8_t> bytes) {
    const AbortCode code = check_storage_command(host.store.entries(), index, sub_index, bytes);
    if (code != ok) return code;
    return index == store_parameters ? save(host, sub_index) : restore(host, sub_index);
  }

  /// Stores the parameters of a sub-index of 1010h.
  template <class Host>
  [[nodiscard]] AbortCode save(Host& host, std::uint8_t sub_index) {
    const edsc::Sheet& sheet = Device::sheet_of(host.store);
    SectionSet sections = edsc::stored_sections(sheet, sub_index);
    if (sections == 0) return AbortCode::hardware;
    sections = static_cast<SectionSet>(sections | set_of(ParameterSection::configuration));
    std::vector<Row> rows = rows_;
    std::erase_if(rows, [&](const Row& row) {
      const auto* const entry = edsc::find_stored(sheet, row.record.index, row.record.sub_index);
      return entry == nullptr || edsc::has_section(sections, entry->section) ||
             (row.record.is_given_up() && !restored_);
    });
    for (const edsc::SheetStoredEntry& entry : sheet.stored) {
      if (edsc::has_section(sections, entry.section)) rows.push_back(present(host, entry));
    }
    return replace(host, std::move(rows)) ? ok : AbortCode::hardware;
  }

  /// Restores the default values of a sub-index of 1011h.
  template <class Host>
  [[nodiscard]] AbortCode restore(Host& host, std::uint8_t sub_index) {
    const edsc::Sheet& sheet = Device::sheet_of(host.store);
    const SectionSet sections = edsc::stored_sections(sheet, sub_index);
    if (sections == 0) return AbortCode::hardware;
    constexpr SectionSet kept = set_of(ParameterSection::with_node_id);
    const auto given_up =
        static_cast<SectionSet>((sections & (all_sections ^ kept)) | set_of(ParameterSection::configuration));
    const bool until_power_cycle = sheet.options.restore_needs_power_cycle;
    std::vector<Row> rows = rows_;
    std::erase_if(rows, [&](Row& row) {
      const auto* const entry = edsc::find_stored(sheet, row.record.index, row.record.sub_index);
      if (entry == nullptr || !edsc::has_section(given_up, entry->section)) return false;
      row.record.type |= stored_format::given_up;
      return !until_power_cycle;
    });
    if (!replace(host, std::move(rows))) return AbortCode::hardware;
    clear_configuration(host);
    restored_ = true;
    return ok;
  }

  /// Called before these bytes are written to an object: 1020h becomes 0 if they change the configuration.
  template <class Host>
  static void before_change(Host& host, std::uint16_t index, std::uint8_t sub_index,
                            std::span<const std::uint8_t> bytes) {
    if (index == verify_configuration) return;
    const edsc::Sheet& sheet = Device::sheet_of(host.store);
    const auto* const entry = edsc::find_stored(sheet, index, sub_index);
    if (entry == nullptr) return;
    std::array<std::uint8_t, 8> scratch;
    if (!std::ranges::equal(host.store.entries().read(entry->word, scratch), bytes)) clear_configuration(host);
  }
  template <DictionaryObject Object, class Host>
  static void after_change(Host&) {}

 private:
  /// Sets 1020h to 0, if it is stored.
  template <class Host>
  static void clear_configuration(Host& host) {
    const edsc::Sheet& sheet = Device::sheet_of(host.store);
    const auto* const date = edsc::find_stored(sheet, verify_configuration, 1);
    const auto* const time = edsc::find_stored(sheet, verify_configuration, 2);
    if (date == nullptr || time == nullptr) return;
    for (const auto* const entry : {date, time}) {
      std::memset(host.store.entries().ram(entry->word), 0, entry::wire_bytes(entry->word));
    }
  }

  /// Returns the present value of an entry.
  template <class Host>
  [[nodiscard]] static Row present(Host& host, const edsc::SheetStoredEntry& entry) {
    Row row;
    row.record.index = entry.index;
    row.record.sub_index = entry.sub_index;
    row.record.type = stored_format::type_of(entry.word);
    const unsigned version = Device::sheet_of(host.store).options.storage_version;
    row.record.context = static_cast<std::uint16_t>(host.node_id.value() | version << 8);
    const std::uint8_t* value = host.store.entries().ram(entry.word);
    row.record.size = entry::wire_bytes(entry.word);
    if (entry::is_string(entry.word)) {
      std::memcpy(&row.record.size, value, sizeof row.record.size);
      value += sizeof row.record.size;
    }
    row.bytes.assign(value, value + row.record.size);
    return row;
  }

  /// Writes a new image. Returns false if the storage has failed.
  template <class Host>
  [[nodiscard]] bool replace(Host& host, std::vector<Row> rows) {
    auto& storage = host.handlers.storage();
    const std::vector<std::uint8_t> image = edsc::stored_image(rows);
    if (!storage.begin(static_cast<std::uint32_t>(image.size())) || !storage.write(image) || !storage.commit())
      return false;
    rows_ = std::move(rows);
    return true;
  }

  /// Replaces default values by the stored ones.
  template <class Host>
  void load(Host& host, bool communication) {
    for (const Row& row : rows_) {
      const auto& [record, bytes] = row;
      if (is_communication_index(record.index) != communication || (record.is_given_up() && !restored_)) continue;
      if (!is_possible(host, row)) {
        damaged_ = true;
        continue;
      }
      const edsc::Sheet& sheet = Device::sheet_of(host.store);
      const auto& entry = *edsc::find_stored(sheet, record.index, record.sub_index);
      const bool is_of_node_id = entry.section == static_cast<std::uint8_t>(ParameterSection::with_node_id);
      if (record.node_id() == host.node_id.value() || !(is_of_node_id || follows_node_id(host, entry.word, row)))
        host.store.entries().write(entry.word, bytes);
    }
  }

  /// Whether the value could have been written over the bus.
  template <class Host>
  [[nodiscard]] static bool is_possible(Host& host, const Row& row) {
    const auto& [record, bytes] = row;
    const edsc::Sheet& sheet = Device::sheet_of(host.store);
    const auto* const entry = edsc::find_stored(sheet, record.index, record.sub_index);
    if (entry == nullptr) return false;
    if (((stored_format::type_of(entry->word) ^ record.type) & stored_format::type_mask) != 0) return false;
    return host.store.entries().check(record.index, record.sub_index, entry->word, bytes) == ok &&
           sheet.check_closed(record.index, record.sub_index, bytes) == ok;
  }

  /// Whether a value was the default value for another node-ID: the default value for this node-ID, which is in RAM,
  /// stays.
  template <class Host>
  [[nodiscard]] static bool follows_node_id(Host& host, entry::Word word, const Row& row) {
    for (const edsc::SheetNodeIdRow& relative : Device::sheet_of(host.store).node_id_rows) {
      if (relative.offset != entry::offset_of(word)) continue;
      std::uint64_t stored = 0, by_default = 0;
      std::memcpy(&stored, row.bytes.data(), std::min(row.bytes.size(), sizeof stored));
      std::memcpy(&by_default, host.store.entries().ram(word),
                  std::min<std::size_t>(row.bytes.size(), sizeof by_default));
      return stored + host.node_id.value() == by_default + row.record.node_id();
    }
    return false;
  }

  std::vector<Row> rows_;
  bool damaged_ = false;
  bool restored_ = false;  ///< since power-on
};

}  // namespace canopen::service
