#include "compare/compare_devices.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <set>
#include <utility>

#include "compare/compare_parts.hpp"

namespace edsc {
namespace {

constexpr std::uint16_t identity_object = 0x1018;
constexpr std::uint8_t revision_sub_index = 3;

using EntryNumber = std::pair<std::uint16_t, std::uint8_t>;

/// Iterates over two ascending lists in parallel: `one_side(before, after)` gets null for an element that is missing.
template <typename List, typename Key, typename Visit>
void walk(const List& before, const List& after, Key key, Visit visit) {
  auto a = before.begin();
  auto b = after.begin();
  while (a != before.end() || b != after.end()) {
    const bool take_a = b == after.end() || (a != before.end() && key(*a) <= key(*b));
    const bool take_b = a == before.end() || (b != after.end() && key(*b) <= key(*a));
    visit(take_a ? &*a : nullptr, take_b ? &*b : nullptr);
    if (take_a) ++a;
    if (take_b) ++b;
  }
}

class DeviceComparison {
 public:
  DeviceComparison(const NamedDevice& before, const NamedDevice& after)
      : before_{before.device},
        after_{after.device},
        old_names_{before.names},
        new_names_{after.names},
        sources_{compared_sources(before_, after_)} {
    for (const Pdo& pdo : before_.pdos) {
      const bool is_received = pdo.direction == PdoDirection::receive;
      for (const PdoEntry& entry : pdo.entries) {
        in_pdo_.emplace(entry.index, entry.sub_index);
        if (is_received) in_rpdo_.emplace(entry.index, entry.sub_index);
      }
    }
  }

  Changes compare() {
    compare_identity();
    compare_dummies();
    walk(
        before_.objects, after_.objects, [](const Object& object) { return object.index; },
        [&](const Object* a, const Object* b) { compare_objects(a, b); });
    compare_error_codes(before_, after_, sources_, changes_);
    compare_pdos(before_, after_, changes_);
    check_revision();
    return std::move(changes_);
  }

 private:
  Change& add_device_change(ChangeRule rule, std::string old_value, std::string new_value) {
    Change& change = changes_.add(rule, "device", "", {before_.source}, {after_.source});
    change.old_value = std::move(old_value);
    change.new_value = std::move(new_value);
    return change;
  }

  void compare_identity() {
    const auto compare = [&](ChangeRule rule, std::string_view what, const auto& old_value, const auto& new_value,
                             std::string_view format) {
      if (old_value == new_value) return;
      const auto text = [&](const auto& value) { return fmt::format(fmt::runtime(format), value); };
      add_device_change(rule, fmt::format("{} {}", what, text(old_value)), text(new_value));
    };
    compare("device-name", "vendor", before_.vendor_name, after_.vendor_name, "\"{}\"");
    compare("device-name", "product", before_.product_name, after_.product_name, "\"{}\"");
    compare("identity", "VendorNumber", before_.vendor_number, after_.vendor_number, "0x{:08X}");
    compare("identity", "ProductNumber", before_.product_number, after_.product_number, "0x{:08X}");
    const bool major = before_.revision_number >> 16 != after_.revision_number >> 16;
    compare(major ? ChangeRule{"revision-major"} : ChangeRule{"revision-minor"}, "RevisionNumber",
            before_.revision_number, after_.revision_number, "0x{:08X}");
    if (before_.node_id != after_.node_id) {
      const auto text = [](const auto& id) { return id ? fmt::format("{}", *id) : std::string{"none"}; };
      add_device_change("node-id", text(before_.node_id), text(after_.node_id));
    }
  }

  /// CiA 301, 7.5.2.21: the major revision identifies the CANopen behaviour. A configuration of a device (a DCF) is not
  /// another revision, and revisions of different products have no order.
  void check_revision() {
    if (before_.information.commissioning || after_.information.commissioning) return;
    if (identity_number(before_, 1) != identity_number(after_, 1)) return;
    if (identity_number(before_, 2) != identity_number(after_, 2)) return;
    const std::uint64_t old_revision = identity_number(before_, revision_sub_index);
    const std::uint64_t new_revision = identity_number(after_, revision_sub_index);
    const bool is_known = old_revision != 0 || new_revision != 0;
    if (!is_known || new_revision >> 16 > old_revision >> 16) return;
    const auto breaks_wire = [](const Change& change) { return change.breaks.master || change.breaks.pdo; };
    if (std::ranges::none_of(changes_.all(), breaks_wire)) return;
    const auto revision_position = [](const Device& device) {
      const Entry* const entry = device.find(identity_object, revision_sub_index);
      if (entry == nullptr) return Position{device.source};
      return entry->default_value ? entry->default_value->position : entry->position;
    };
    Change& change = changes_.add("revision-unchanged", entry_label(identity_object, revision_sub_index), "",
                                  revision_position(before_), revision_position(after_));
    change.old_value = fmt::format("{}", old_revision >> 16);
    if (new_revision >> 16 != old_revision >> 16) change.new_value = fmt::format("{}", new_revision >> 16);
  }

  /// From 1018h; if missing, from [DeviceInfo].
  static std::uint64_t identity_number(const Device& device, std::uint8_t sub_index) {
    const Entry* const entry = device.find(identity_object, sub_index);
    if (entry != nullptr && entry->default_value) return entry->default_value->bits;
    return sub_index == 1 ? device.vendor_number : sub_index == 2 ? device.product_number : device.revision_number;
  }

  void compare_dummies() {
    const auto compare = [&](const Device& one, const Device& other, ChangeRule rule) {
      for (const std::uint16_t dummy : one.dummies) {
        if (std::ranges::find(other.dummies, dummy) == other.dummies.end()) {
          const canopen::DataTypeRow* const type = canopen::find_data_type(dummy);
          add_device_change(rule, type != nullptr ? std::string{type->name} : index_label(dummy), "");
        }
      }
    };
    compare(before_, after_, "dummy-removed");
    compare(after_, before_, "dummy-added");
  }

  void compare_objects(const Object* a, const Object* b) {
    if (a == nullptr || b == nullptr) {
      const Object& there = a != nullptr ? *a : *b;
      changes_.add(a != nullptr ? ChangeRule{"object-removed"} : ChangeRule{"object-added"}, index_label(there.index),
                   there.name, a != nullptr ? a->position : Position{before_.source},
                   b != nullptr ? b->position : Position{after_.source});
      return;
    }
    compare_names(index_label(b->index), *a, *b);
    if (a->type != b->type) {
      Change& change = changes_.add("object-type", index_label(b->index), b->name, a->position, b->position);
      change.old_value = to_string(a->type);
      change.new_value = to_string(b->type);
    }
    const bool has_sub_indices = a->has_sub_indices() && b->has_sub_indices();
    walk(
        a->entries, b->entries, [](const Entry& entry) { return entry.sub_index; },
        [&](const Entry* old_entry, const Entry* new_entry) {
          compare_entry(*a, *b, old_entry, new_entry, has_sub_indices);
        });
  }

  void compare_entry(const Object& old_object, const Object& new_object, const Entry* a, const Entry* b,
                     bool has_sub_indices) {
    if (a == nullptr || b == nullptr) {
      const Entry& there = a != nullptr ? *a : *b;
      changes_.add(a != nullptr ? ChangeRule{"entry-removed"} : ChangeRule{"entry-added"},
                   entry_label(there.index, there.sub_index), there.name,
                   a != nullptr ? a->position : old_object.position, b != nullptr ? b->position : new_object.position);
      return;
    }
    if (has_sub_indices) compare_names(entry_label(b->index, b->sub_index), *a, *b);
    compare_entries(*a, *b, in_rpdo_.contains({a->index, a->sub_index}), changes_);
    compare_meanings(*a, *b, {in_pdo_.contains({a->index, a->sub_index}), sources_}, changes_);
  }

  /// Of objects or entries.
  template <typename Named>
  void compare_names(const std::string& label, const Named& a, const Named& b) {
    const std::string old_name = old_names_.of(a);
    const std::string new_name = new_names_.of(b);
    const bool compiles = old_name == new_name;
    if (compiles && a.name == b.name) return;
    Change& change =
        changes_.add(compiles ? ChangeRule{"name"} : ChangeRule{"identifier"}, label, b.name, a.position, b.position);
    change.old_value = compiles ? fmt::format("\"{}\"", a.name) : old_name;
    change.new_value = compiles ? fmt::format("\"{}\"", b.name) : new_name;
  }

  const Device& before_;
  const Device& after_;
  const CppNames& old_names_;
  const CppNames& new_names_;
  ComparedSources sources_;
  std::set<EntryNumber> in_pdo_;   ///< mapped to PDOs by default, before the change
  std::set<EntryNumber> in_rpdo_;  ///< those of RPDOs
  Changes changes_;
};

}  // namespace

Changes compare_devices(const NamedDevice& before, const NamedDevice& after) {
  return DeviceComparison{before, after}.compare();
}

}  // namespace edsc
