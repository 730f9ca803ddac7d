#include "device/objects/resolve_modules.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <map>
#include <set>

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

std::optional<std::uint16_t> index_of(const Field& field) {
  const auto index = number_of(field);
  return index && *index <= 0xFFFF ? std::optional{static_cast<std::uint16_t>(*index)} : std::nullopt;
}

class ModuleResolver {
 public:
  ModuleResolver(ObjectResolver& objects, EntryResolver& entries, Device& device, Diagnostics& diagnostics)
      : objects_{objects}, entries_{entries}, device_{device}, diagnostics_{diagnostics} {}

  void add(const ModuleDescription& module) {
    if (known_.insert(module.number).second) add_fixed_objects(module);
    for (const SubExtension& extension : module.sub_extensions) extend(extension);
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
      } else if (listed.insert(*index); std::ranges::find(described, *index, &Description::index) == described.end()) {
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
      if (device_.find(description.index) != nullptr) {
        diagnostics_.warning("module-object", description.position,
                             fmt::format("{} already exists; that of module {} is left out",
                                         index_label(description.index), module.number));
      } else if (auto object = objects_.resolve(description)) {
        insert(std::move(*object));
      }
    }
  }

  void extend(const SubExtension& extension) {
    const std::optional<Count> count = read_count(extension.count);
    if (!count) return;
    if (count->bits > 0) {
      share(extension, count->bits);
    } else {
      for (std::uint32_t i = 0; i < count->sub_indices; ++i) {
        if (!append(extension)) return;
      }
    }
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
  void share(const SubExtension& extension, std::uint32_t bits) {
    std::uint32_t& free = free_bits_[extension.index];
    if (free < bits) {
      const Entry* entry = append(extension);
      if (entry == nullptr) return;
      free = entry->type->bits;
      if (free < bits) {
        diagnostics_.warning(
            "module-count", extension.count.position,
            fmt::format("{} into {}", bits == 1 ? "1 bit does not fit" : fmt::format("{} bits do not fit", bits),
                        entry->type->name));
      }
    }
    free -= std::min(free, bits);
  }

  /// Adds a sub-index to the object, or to the next one if it is full. Null if there is no space.
  const Entry* append(const SubExtension& extension) {
    const auto place = free_place(extension);
    if (!place) return nullptr;
    auto entry = entries_.resolve(extension, *place, extension.parameter_name.text);
    if (!entry) return nullptr;
    Object& object = object_at(place->index, extension);
    object.entries.push_back(std::move(*entry));
    Value& count = *object.entries.front().default_value;
    count.bits = place->sub_index;
    return &object.entries.back();
  }

  /// ObjExtend: the highest sub-index of an object before the next index is used; 0: no next index.
  std::optional<EntryPlace> free_place(const SubExtension& extension) {
    const std::uint32_t extend_after = read_number(extension.object_extend, "module-count", diagnostics_).value_or(0);
    const std::uint32_t highest =
        extend_after == 0 ? max_sub_objects : std::min<std::uint32_t>(extend_after, max_sub_objects);
    for (std::uint32_t index = extension.index; index <= 0xFFFF; ++index) {
      const Object* object = device_.find(static_cast<std::uint16_t>(index));
      if (object != nullptr && !object->has_sub_indices()) break;
      const std::uint32_t last = object == nullptr ? 0 : object->entries.back().sub_index;
      if (last < highest) {
        return EntryPlace{static_cast<std::uint16_t>(index), static_cast<std::uint8_t>(last + 1), true};
      }
      if (extend_after == 0) break;
    }
    diagnostics_.error("module-object", extension.position,
                       fmt::format("{} cannot hold another sub-index of a module", index_label(extension.index)));
    return std::nullopt;
  }

  /// The object that a module extends; a new ARRAY if it does not exist.
  Object& object_at(std::uint16_t index, const SubExtension& extension) {
    if (device_.find(index) == nullptr) {
      Object object;
      object.index = index;
      object.type = ObjectType::array;
      object.name = extension.parameter_name.text;
      object.position = extension.position;
      object.entries.push_back(count_entry(index, 0, extension.position));
      insert(std::move(object));
    }
    Object& object = *std::ranges::lower_bound(device_.objects, index, {}, &Object::index);
    if (!object.entries.front().default_value) {
      object.entries.front().default_value = count_entry(index, 0, object.position).default_value;
    }
    return object;
  }

  void insert(Object object) {
    const auto at = std::ranges::lower_bound(device_.objects, object.index, {}, &Object::index);
    device_.objects.insert(at, std::move(object));
  }

  ObjectResolver& objects_;
  EntryResolver& entries_;
  Device& device_;
  Diagnostics& diagnostics_;
  std::set<std::uint16_t> known_;                     ///< kinds of connected modules
  std::map<std::uint16_t, std::uint32_t> free_bits_;  ///< of the last shared sub-index, by the object's index
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
    const auto module = std::ranges::find(modules.supported, number, &ModuleDescription::number);
    if (module != modules.supported.end()) {
      resolver.add(*module);
    } else {
      const Position position =
          modules.connected.size() >= place ? modules.connected[place - 1].field.position : Position{device.source};
      diagnostics.error("connected-module", position,
                        fmt::format("place {} has module {}, which is not supported", place, number));
    }
  }
}

}  // namespace edsc
