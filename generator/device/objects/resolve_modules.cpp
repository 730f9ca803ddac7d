#include "device/objects/resolve_modules.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <map>
#include <set>
#include <unordered_map>
#include <utility>
#include <vector>

#include "device/limits.hpp"
#include "device/resolve_information.hpp"
#include "diagnostics/quote.hpp"
#include "eds/number.hpp"

namespace edsc {
namespace {

/// The number of sub-indices that a module adds: whole ones, or a part of one that it shares with its neighbours.
struct Count {
  std::uint32_t sub_indices = 0;
  std::uint32_t bits = 0;
};

/// A sub-extension that still adds sub-indices.
struct GrowingExtension {
  const SubExtension* description;
  Count count;
  std::uint32_t extend_after;
};

std::optional<std::uint16_t> index_of(const Field& field) {
  const auto index = number_of(field);
  return index && *index <= 0xFFFF ? std::optional{static_cast<std::uint16_t>(*index)} : std::nullopt;
}

class ModuleResolver {
 public:
  ModuleResolver(ObjectResolver& objects, EntryResolver& entries, Device& device, Diagnostics& diagnostics)
      : objects_{objects}, entries_{entries}, device_{device}, diagnostics_{diagnostics} {
    for (const Object& object : device.objects) number_of_entries_ += object.entries.size();
  }

  /// Adds a connected module.
  void add(const ModuleDescription& module) {
    const auto [kind, is_new] = extensions_.try_emplace(module.number);
    if (is_new) {
      add_fixed_objects(module);
      find_extensions(module, kind->second);
    }
    std::erase_if(kind->second, [&](const GrowingExtension& extension) { return !extend(extension); });
  }

  /// Adds the objects of the modules to the device.
  void finish() {
    for (auto& [index, object] : added_) device_.objects.push_back(std::move(object));
    std::ranges::sort(device_.objects, {}, &Object::index);
  }

  /// Once for each supported module, connected or not.
  void check_lists(const ModuleDescription& module) {
    check_list(module.fixed_objects, module.objects, fmt::format("M{}Fixed", module.number));
    check_list(module.sub_extends, module.sub_extensions, fmt::format("M{}SubExt", module.number));
  }

 private:
  template <typename Description>
  void check_list(const std::vector<NumberedField>& list, const std::vector<Description>& described,
                  const std::string& prefix) {
    std::set<std::uint16_t> listed;
    for (const NumberedField& entry : list) {
      const auto index = index_of(entry.field);
      if (!index) {
        diagnostics_.error("number", entry.field.position,
                           fmt::format("{} is not a valid index", quote(entry.field.text)));
      } else if (listed.insert(*index); !std::ranges::binary_search(described, *index, {}, &Description::index)) {
        diagnostics_.warning(
            "object-without-section", entry.field.position,
            fmt::format("{} is listed, but section [{}{:04X}] is missing", index_label(*index), prefix, *index));
      }
    }
    for (const Description& one : described) {
      if (!listed.contains(one.index)) {
        diagnostics_.warning("object-not-listed", one.position,
                             fmt::format("[{}{:04X}] is not in any list of its module", prefix, one.index));
      }
    }
  }

  void add_fixed_objects(const ModuleDescription& module) {
    for (const ObjectDescription& description : module.objects) {
      if (!has_room_) return;
      if (find(description.index) != nullptr) {
        diagnostics_.warning("module-object", description.position,
                             fmt::format("{} already exists; that of module {} is ignored",
                                         index_label(description.index), module.number));
      } else if (auto object = objects_.resolve(description)) {
        const std::size_t entries = object->entries.size();
        added_.emplace(object->index, std::move(*object));
        count_entries(entries, description.position);
      }
    }
  }

  void find_extensions(const ModuleDescription& module, std::vector<GrowingExtension>& extensions) {
    for (const SubExtension& extension : module.sub_extensions) {
      const std::optional<Count> count = read_count(extension.count);
      if (!count || (count->sub_indices == 0 && count->bits == 0)) continue;
      const std::uint32_t extend_after = read_number(extension.object_extend, "module-count", diagnostics_).value_or(0);
      extensions.push_back({&extension, *count, extend_after});
    }
  }

  /// Returns false if the object cannot be extended further, which is reported.
  bool extend(const GrowingExtension& extension) {
    if (extension.count.bits > 0) return share(extension, extension.count.bits);
    for (std::uint32_t i = 0; i < extension.count.sub_indices; ++i) {
      if (!append(extension)) return false;
    }
    return true;
  }

  /// `n`, or `0;m`.
  std::optional<Count> read_count(const Field& field) {
    const std::string_view text = field.text;
    const std::size_t semicolon = text.find(';');
    const auto whole = parse_unsigned(text.substr(0, semicolon));
    const auto bits = semicolon == std::string_view::npos ? std::optional<std::uint64_t>{0}
                                                          : parse_unsigned(text.substr(semicolon + 1));
    const bool fits = whole && bits && *whole <= max_sub_objects && *bits <= 64 && (*whole == 0 || *bits == 0);
    if (fits) return Count{static_cast<std::uint32_t>(*whole), static_cast<std::uint32_t>(*bits)};
    diagnostics_.error(
        "module-count", field.position,
        fmt::format("Count must be a number of sub-indices, or 0;m for m bits of one, not {}", quote(text)));
    return std::nullopt;
  }

  /// Starts a new shared sub-index if the remaining bits of the last one are not sufficient.
  bool share(const GrowingExtension& extension, std::uint32_t bits) {
    std::uint32_t& free = free_bits_[extension.description->index];
    if (free < bits) {
      const Entry* entry = append(extension);
      if (entry == nullptr) return false;
      free = entry->type->bits;
      if (free < bits) {
        diagnostics_.warning(
            "module-count", extension.description->count.position,
            fmt::format("{} into {}", bits == 1 ? "1 bit does not fit" : fmt::format("{} bits do not fit", bits),
                        entry->type->name));
      }
    }
    free -= std::min(free, bits);
    return true;
  }

  /// Adds a sub-index to the object, or to the next one if it is full. Null if there is no space.
  const Entry* append(const GrowingExtension& extension) {
    if (!has_room_) return nullptr;
    const auto place = free_place(extension);
    if (!place) return nullptr;
    const SubExtension& description = *extension.description;
    auto entry = entries_.resolve(description, *place, description.parameter_name.text);
    if (!entry) return nullptr;
    Object& object = object_at(place->index, description);
    object.entries.push_back(std::move(*entry));
    Value& count = *object.entries.front().default_value;
    count.bits = place->sub_index;
    count_entries(1, description.position);
    return &object.entries.back();
  }

  void count_entries(std::size_t added, const Position& position) {
    number_of_entries_ += added;
    if (number_of_entries_ <= max_entries || !has_room_) return;
    has_room_ = false;
    diagnostics_.error("dictionary-size", position,
                       fmt::format("a device can have at most {} entries; the other modules are ignored", max_entries));
  }

  /// ObjExtend: the highest sub-index of an object before the next index is used; 0: no next index.
  std::optional<EntryPlace> free_place(const GrowingExtension& extension) {
    const std::uint16_t first = extension.description->index;
    const bool has_next = extension.extend_after != 0;
    const std::uint32_t highest =
        has_next ? std::min<std::uint32_t>(extension.extend_after, max_sub_objects) : max_sub_objects;
    for (std::uint32_t index = first; index <= 0xFFFF; index = has_next ? next_not_full(highest, index) : 0x10000) {
      const Object* object = find(static_cast<std::uint16_t>(index));
      if (object != nullptr && !object->has_sub_indices()) break;
      const std::uint32_t last = object == nullptr ? 0 : object->entries.back().sub_index;
      if (last < highest) {
        return EntryPlace{static_cast<std::uint16_t>(index), static_cast<std::uint8_t>(last + 1), true};
      }
      full_[highest].try_emplace(static_cast<std::uint16_t>(index), index + 1);
    }
    diagnostics_.error("module-object", extension.description->position,
                       fmt::format("{} cannot hold another sub-index of a module", index_label(first)));
    return std::nullopt;
  }

  /// The first index from `index` on that is not known to be full. Shortens the way for the next search.
  std::uint32_t next_not_full(std::uint32_t highest, std::uint32_t index) {
    std::unordered_map<std::uint32_t, std::uint32_t>& full = full_[highest];
    std::uint32_t end = index;
    for (auto at = full.find(end); at != full.end(); at = full.find(end)) end = at->second;
    for (auto at = full.find(index); at != full.end(); at = full.find(index)) index = std::exchange(at->second, end);
    return end;
  }

  [[nodiscard]] const Object* find(std::uint16_t index) const {
    const auto added = added_.find(index);
    return added != added_.end() ? &added->second : std::as_const(device_).find(index);
  }

  /// The object that a module extends; a new ARRAY if it does not exist.
  Object& object_at(std::uint16_t index, const SubExtension& extension) {
    if (find(index) == nullptr) {
      Object object;
      object.index = index;
      object.type = ObjectType::array;
      object.name = extension.parameter_name.text;
      object.position = extension.position;
      object.entries.push_back(count_entry(index, 0, extension.position));
      added_.emplace(index, std::move(object));
      ++number_of_entries_;
    }
    const auto added = added_.find(index);
    Object& object =
        added != added_.end() ? added->second : *std::ranges::lower_bound(device_.objects, index, {}, &Object::index);
    if (!object.entries.front().default_value) {
      object.entries.front().default_value = count_entry(index, 0, object.position).default_value;
    }
    return object;
  }

  ObjectResolver& objects_;
  EntryResolver& entries_;
  Device& device_;
  Diagnostics& diagnostics_;
  std::map<std::uint16_t, std::vector<GrowingExtension>> extensions_;  ///< that add sub-indices, by the kind of module
  std::map<std::uint16_t, std::uint32_t> free_bits_;  ///< of the last shared sub-index, by the object's index
  std::map<std::uint16_t, Object> added_;             ///< objects that the device does not have yet
  /// By the highest sub-index: full objects, each with a later index up to which all others are full.
  std::map<std::uint32_t, std::unordered_map<std::uint32_t, std::uint32_t>> full_;
  std::size_t number_of_entries_ = 0;
  bool has_room_ = true;
};

}  // namespace

void add_modules(const Modules& modules, ObjectResolver& objects, EntryResolver& entries, Device& device,
                 Diagnostics& diagnostics) {
  ModuleResolver resolver{objects, entries, device, diagnostics};
  for (const ModuleDescription& module : modules.supported) resolver.check_lists(module);
  std::uint32_t place = 0;
  for (const std::uint16_t number : device.information.connected_modules) {
    ++place;
    if (number == 0) continue;  // an empty place
    const auto module = std::ranges::lower_bound(modules.supported, number, {}, &ModuleDescription::number);
    if (module != modules.supported.end() && module->number == number) {
      resolver.add(*module);
    } else {
      const Position position =
          modules.connected.size() >= place ? modules.connected[place - 1].field.position : Position{device.source};
      diagnostics.error("connected-module", position,
                        fmt::format("place {} has module {}, which is not supported", place, number));
    }
  }
  resolver.finish();
}

}  // namespace edsc
