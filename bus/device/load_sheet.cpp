#include "device/load_sheet.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <canopen/od/value.hpp>
#include <canopen/storage/parameter_layout.hpp>
#include <limits>
#include <set>
#include <utility>

#include "backend/cpp/placement.hpp"
#include "backend/cpp/typed_values.hpp"
#include "device/drive_modes.hpp"
#include "device/dynamic_device.hpp"
#include "device/index_range.hpp"
#include "device/sheet_options.hpp"
#include "device/stored_eds.hpp"
#include "values/value_bytes.hpp"

namespace edsc {
namespace {

using canopen::DataClass;
using canopen::Dictionary;
using canopen::object_key;
namespace entry = canopen::entry;

constexpr std::uint16_t first_object = 0x1000;
constexpr std::uint16_t last_communication_index = 0x1FFF;
/// The address range of the words of the tables.
constexpr std::size_t max_values = DynamicDevice::value_bytes, max_constants = 0x10000;
constexpr std::size_t max_rows = 0xFFFF, max_shapes = 0x4000;
/// Communication and mapping parameters of PDOs.
constexpr std::array rpdo_parameters = {IndexRange{0x1400, 0x17FF}};
constexpr std::array tpdo_parameters = {IndexRange{0x1800, 0x1BFF}};

entry::Word type_word(const canopen::DataTypeRow& type) {
  const entry::Word bytes = type.bits / 8u;
  switch (type.kind) {
    case DataClass::boolean: return entry::boolean;
    case DataClass::unsigned_integer: return entry::type_word(entry::Class::unsigned_integer, bytes);
    case DataClass::signed_integer: return entry::type_word(entry::Class::signed_integer, bytes);
    case DataClass::real: return entry::type_word(entry::Class::real, bytes);
    case DataClass::time: return entry::time48;
    case DataClass::string:
      return type.type == canopen::DataType::visible_string ? entry::visible_string : entry::octet_string;
    case DataClass::domain: break;
  }
  return entry::domain;
}

/// Builds a sheet object by object, in ascending index.
class Builder {
 public:
  Builder(const Device& device, const Options& options)
      : device_{device}, options_{options}, placement_{device, options}, end_{frame::bytes} {}

  LoadedSheet build() {
    add_settings();
    image().resize(frame::bytes);
    frame::for_each_neutral(
        [&](std::size_t offset, std::uint32_t value, std::size_t bytes) { put(offset, value, bytes); });
    add_pdo_numbers();
    bool application = false;
    for (const Object& object : device_.objects) {
      if (object.index < first_object || object.entries.empty()) continue;
      if (object.index > last_communication_index && !std::exchange(application, true)) end_communication();
      add_object(object);
    }
    if (!application) end_communication();
    image().resize(round_up(end_, 8));
    if (!fits()) {
      note(fmt::format("does not fit: a node has {} bytes for values, {} for constants, and {} sub-indices", max_values,
                       max_constants, max_rows));
      return std::move(loaded_);
    }
    finish();
    loaded_.sheet = std::move(sheet_);
    return std::move(loaded_);
  }

 private:
  std::vector<std::uint8_t>& image() { return sheet_->image; }

  /// Whether the words of the tables can address all values and rows.
  [[nodiscard]] bool fits() const {
    return sheet_->image.size() <= max_values && sheet_->constants.size() <= max_constants &&
           sheet_->subs.size() <= max_rows && sheet_->shapes.size() <= max_shapes;
  }

  void add_settings() {
    Sheet& sheet = *sheet_;
    sheet.options = device_options(options_);
    if (std::exchange(sheet.options.mpdo, false)) note("multiplex PDOs are not supported");
    sheet.lss_options = lss_options(device_, options_);
    for (const std::uint16_t type : device_.dummies) {
      if (type < 32) sheet.dummies |= std::uint32_t{1} << type;
    }
    sheet.granularity = device_.information.capabilities.granularity.value_or(1);
    sheet.emergency_infos = options_.emergency_info;
    for (const EntryAddress& address : options_.no_event) {
      const std::uint8_t sub_index = address.sub_index.value_or(0);
      bool& all = sheet.without_event[object_key(address.index, sub_index)];
      all = all || !address.sub_index;
    }
  }

  /// The PDOs that the node serves, by their order. The mapping of a static PDO that is invalid is not used.
  void add_pdo_numbers() {
    for (const Pdo& pdo : device_.pdos) {
      auto& numbers = pdo.direction == PdoDirection::receive ? sheet_->rpdo_numbers : sheet_->tpdo_numbers;
      if (numbers.size() < frame::max_pdos) {
        numbers.push_back(pdo.number);
      } else {
        note(fmt::format("{} is not served: a node serves {} PDOs of each direction", pdo_label(pdo), frame::max_pdos));
      }
      if (pdo.mapping != nullptr && (pdo.broken || pdo.multiplexed) && !pdo.dynamic) unused_.insert(pdo.mapping->index);
      for (const PdoEntry& mapped : pdo.entries) {
        if (mapped.object == nullptr || pdo.broken) continue;
        mapped_.insert(object_key(mapped.index, mapped.sub_index));
        if (entry::is_string(type_word(*mapped.object->type)))
          note(fmt::format("{} is not served: it maps {}, a string", pdo_label(pdo),
                           entry_label(mapped.index, mapped.sub_index)));
      }
    }
  }

  /// Returns the word of the frame for an entry of the EDS; `no_object` if no service knows it.
  [[nodiscard]] entry::Word frame_word(std::uint16_t index, std::uint8_t sub_index) const {
    if (index > last_communication_index) return Dictionary::no_object;
    const bool receive = contains(rpdo_parameters, index);
    if (!receive && !contains(tpdo_parameters, index)) return frame::dictionary.find(index, sub_index);
    const auto& numbers = receive ? sheet_->rpdo_numbers : sheet_->tpdo_numbers;
    const auto at = std::ranges::find(numbers, (index & 0x1FF) + 1);
    if (at == numbers.end()) return Dictionary::no_object;
    const auto place = static_cast<std::uint16_t>((index & ~0x1FF) + (at - numbers.begin()));
    return frame::dictionary.find(place, sub_index);
  }

  void add_object(const Object& object) {
    Sheet& sheet = *sheet_;
    if (sheet.runs.empty() ||
        sheet.runs.back().first + (sheet.entries.size() - sheet.runs.back().position) != object.index)
      sheet.runs.push_back({object.index, static_cast<std::uint16_t>(sheet.entries.size())});
    if (!object.has_sub_indices()) {
      sheet.entries.push_back(add_entry(object, object.entries.front()));
      return;
    }
    const std::uint8_t highest = object.entries.back().sub_index;
    std::vector<entry::Word> words(highest + 1u, entry::gap);
    for (const Entry& one : object.entries) words[one.sub_index] = add_entry(object, one);
    sheet.entries.push_back(entry::record | entry::shape(static_cast<entry::Word>(sheet.shapes.size())));
    sheet.shapes.push_back({static_cast<std::uint16_t>(sheet.subs.size()), highest, 0});
    sheet.subs.insert(sheet.subs.end(), words.begin(), words.end());
  }

  /// Returns the word of an entry, after its value and its limits have been added.
  entry::Word add_entry(const Object& object, const Entry& one) {
    const entry::Word type = type_word(*one.type);
    const entry::Word known = frame_word(one.index, one.sub_index);
    const bool in_frame = known > Dictionary::no_sub_index && entry::place_of(known) == entry::Place::ram &&
                          entry::type_of(known) == type;
    if (in_frame && !unused_.contains(one.index)) set_number(entry::offset_of(known), one);
    if (!in_frame && known > Dictionary::no_sub_index && entry::place_of(known) == entry::Place::ram)
      note(fmt::format("{} does not have the type of CiA 301: no service of the node uses it",
                       entry_label(one.index, one.sub_index)));
    const MemoryPlace place = place_of(object, one, type);
    entry::Word word = type | rights(object, one);
    switch (place) {
      case MemoryPlace::immediate: word |= entry::immediate | immediate_bits(one); break;
      case MemoryPlace::immediate_plus_node_id: word |= entry::immediate_plus_node_id | immediate_bits(one); break;
      case MemoryPlace::rom: word |= entry::rom | add_constant(one, type); break;
      case MemoryPlace::ram:
        word |= entry::ram | (in_frame ? entry::offset_of(known) : add_value(one, type));
        note_download(one, type);
        break;
    }
    if (placement_.is_limited(object, one) || (entry::is_string(type) && place == MemoryPlace::ram))
      word |= entry::limited;
    add_limits(object, one, type, place);
    add_accepted(one);
    if (place == MemoryPlace::ram) add_stored(one, word);
    return word;
  }

  /// The place of the generated code, except that a TPDO can map each constant, and that a long text cannot be in RAM.
  [[nodiscard]] MemoryPlace place_of(const Object& object, const Entry& one, entry::Word type) const {
    const MemoryPlace place = placement_.place(object, one);
    const bool in_word = place == MemoryPlace::immediate || place == MemoryPlace::immediate_plus_node_id;
    if (in_word && canopen::allows(one.mappable(), canopen::Mappable::tpdo))
      return place == MemoryPlace::immediate ? MemoryPlace::rom : MemoryPlace::ram;
    const bool is_text = entry::is_string(type) && !canopen::writable(one.access);
    return is_text && string_capacity(one, options_) > frame::detail::text_bytes ? MemoryPlace::rom : place;
  }

  [[nodiscard]] entry::Word rights(const Object& object, const Entry& one) const {
    const canopen::AccessRow& row =
        canopen::row_of(placement_.is_static_mapping(one.index) ? canopen::Access::ro : one.access);
    entry::Word word = (row.readable ? entry::readable : 0) | (row.writable ? entry::writable : 0);
    if (canopen::allows(one.mappable(), canopen::Mappable::tpdo)) word |= entry::tpdo;
    if (canopen::allows(one.mappable(), canopen::Mappable::rpdo) && !placement_.is_constant(object, one))
      word |= entry::rpdo;
    return word;
  }

  [[nodiscard]] static entry::Word immediate_bits(const Entry& one) {
    return one.default_value ? static_cast<std::uint16_t>(one.default_value->bits) : 0;
  }

  entry::Word add_value(const Entry& one, entry::Word type) {
    if (entry::is_domain(type)) {
      const std::size_t offset = allocate(sizeof(canopen::Domain), alignof(canopen::Domain));
      const bool is_eds = one.index == store_eds && options_.stored_eds != StoredEds::of_application;
      sheet_->domains.push_back({static_cast<std::uint32_t>(offset), canopen::readable(one.access),
                                 is_eds ? stored_eds(device_, options_) : std::string{}});
      return static_cast<entry::Word>(offset & entry::offset_mask);
    }
    if (entry::is_string(type)) {
      const std::size_t offset = allocate(2u + capacity_of(one) + 1u, 2);
      put_text(image(), offset, one);
      return static_cast<entry::Word>(offset & entry::offset_mask);
    }
    const std::size_t bytes = frame::detail::memory_bytes(type);
    const std::size_t offset = allocate(bytes, bytes);
    set_number(offset, one);
    return static_cast<entry::Word>(offset & entry::offset_mask);
  }

  entry::Word add_constant(const Entry& one, entry::Word type) {
    std::vector<std::uint8_t>& constants = sheet_->constants;
    const std::size_t offset = round_up(constants.size(), 8);
    if (entry::is_string(type)) {
      constants.resize(offset + 2u + text_of(one).size() + 1u);
      put_text(constants, offset, one);
    } else {
      constants.resize(offset + 8);
      const std::uint64_t bits = one.default_value ? one.default_value->bits : 0;
      for (unsigned i = 0; i < 8; ++i) constants[offset + i] = static_cast<std::uint8_t>(bits >> (8 * i));
    }
    return static_cast<entry::Word>(offset & entry::offset_mask);
  }

  std::size_t allocate(std::size_t bytes, std::size_t alignment) {
    end_ = round_up(end_, alignment);
    const std::size_t offset = end_;
    end_ += bytes;
    image().resize(end_);
    return offset;
  }

  void put(std::size_t offset, std::uint64_t bits, std::size_t bytes) {
    for (std::size_t i = 0; i < bytes; ++i) image()[offset + i] = static_cast<std::uint8_t>(bits >> (8 * i));
  }

  void set_number(std::size_t offset, const Entry& one) {
    const std::size_t bytes = frame::detail::memory_bytes(type_word(*one.type));
    put(offset, one.default_value ? one.default_value->bits : 0, bytes);
    if (one.default_value && one.default_value->plus_node_id)
      sheet_->node_id_rows.push_back({static_cast<std::uint32_t>(offset), static_cast<std::uint32_t>(bytes)});
  }

  [[nodiscard]] static std::string text_of(const Entry& one) {
    return one.default_value ? bytes_of(*one.default_value, *one.type) : std::string{};
  }
  void put_text(std::vector<std::uint8_t>& into, std::size_t offset, const Entry& one) const {
    const std::string text = text_of(one).substr(0, std::numeric_limits<std::uint16_t>::max());
    into[offset] = static_cast<std::uint8_t>(text.size());
    into[offset + 1] = static_cast<std::uint8_t>(text.size() >> 8);
    std::ranges::copy(text, into.begin() + static_cast<std::ptrdiff_t>(offset) + 2);
  }

  /// Bytes that a string in RAM can have: those of the buffer of an SDO server at most.
  [[nodiscard]] std::uint32_t capacity_of(const Entry& one) const {
    return std::min(string_capacity(one, options_), frame::detail::text_bytes);
  }

  void note_download(const Entry& one, entry::Word type) {
    if (!canopen::writable(one.access)) return;
    const std::size_t bytes = entry::is_string(type) ? capacity_of(one) : entry::wire_bytes(type);
    if (bytes > 4) sheet_->longest_download = std::max(sheet_->longest_download, std::max<std::size_t>(bytes, 8));
  }

  void add_limits(const Object& object, const Entry& one, entry::Word type, MemoryPlace place) {
    const std::uint32_t key = object_key(one.index, one.sub_index);
    if (entry::is_string(type)) {
      if (place == MemoryPlace::ram) sheet_->limits.push_back({key, 0, capacity_of(one)});
      return;
    }
    if (!placement_.has_limits(object, one)) return;
    const std::uint64_t low = one.low_limit ? one.low_limit->bits : lowest(*one.type);
    const std::uint64_t high = one.high_limit ? one.high_limit->bits : highest(*one.type);
    if (one.type->bits > 32) {
      sheet_->wide_limits.push_back({key, low, high});
    } else {
      sheet_->limits.push_back({key, static_cast<std::uint32_t>(low), static_cast<std::uint32_t>(high)});
    }
  }

  /// The modes of operation of a drive, and the values of closed enumerations.
  void add_accepted(const Entry& one) {
    const std::uint32_t key = object_key(one.index, one.sub_index);
    for (const ModeRange& range : accepted_modes(device_, options_, one)) {
      sheet_->accepted[key].push_back({range.low, range.high});
    }
    if (!is_closed_enumeration(one, options_)) return;
    for (const NamedValue& value : one.meaning->values->values)
      sheet_->accepted[key].push_back({value.value, value.value});
  }

  void add_stored(const Entry& one, entry::Word word) {
    namespace rules = canopen::parameter_detail;
    const canopen::Storing how = storing_of(options_, one.index, one.sub_index);
    const std::uint8_t owner = rules::owner_of(one.index, word, how, rules::parameter_owner(one.index));
    const bool is_process_data =
        how == canopen::Storing::by_access && mapped_.contains(object_key(one.index, one.sub_index));
    if (owner == rules::not_stored || is_process_data) return;
    sheet_->stored.push_back({one.index, one.sub_index, owner, word});
  }

  void end_communication() {
    end_ = round_up(end_, 8);
    image().resize(end_);
    sheet_->communication_end = end_;
  }

  void finish() {
    Sheet& sheet = *sheet_;
    sheet.runs.push_back({0xFFFF, static_cast<std::uint16_t>(sheet.entries.size())});
    if (sheet.subs.empty()) sheet.subs.push_back(entry::gap);
    sheet.dictionary = {sheet.runs,   sheet.entries,     sheet.shapes,           sheet.subs,
                        sheet.limits, sheet.wide_limits, sheet.constants.data(), options_.zero_terminated_strings};
  }

  void note(std::string text) { loaded_.notes.push_back(std::move(text)); }

  const Device& device_;
  const Options& options_;
  Placement placement_;
  LoadedSheet loaded_;
  std::unique_ptr<Sheet> sheet_ = std::make_unique<Sheet>();
  std::size_t end_;
  std::set<std::uint16_t> unused_;  ///< mapping parameters of static PDOs that are not served
  std::set<std::uint32_t> mapped_;  ///< keys of the objects that PDOs map by default
};

}  // namespace

LoadedSheet load_sheet(const Device& device, const Options& options) { return Builder{device, options}.build(); }

}  // namespace edsc
