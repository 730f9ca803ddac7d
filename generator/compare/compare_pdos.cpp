#include "compare/compare_parts.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <optional>
#include <utility>

#include "device/cob_id_parameter.hpp"
#include "device/pdo/pdo_defaults.hpp"
#include "values/value_text.hpp"

namespace edsc {
namespace {

constexpr std::uint8_t cob_id_sub_index = 1;
constexpr std::uint8_t first_timing_sub_index =
    3;  ///< inhibit time; then compatibility entry, event timer, SYNC start value

const Entry* parameter(const Pdo& pdo, std::uint8_t sub_index) {
  return pdo.communication != nullptr ? pdo.communication->find(sub_index) : nullptr;
}

std::optional<Value> default_of(const Entry* entry) { return entry != nullptr ? entry->default_value : std::nullopt; }

/// The properties of an entry that matter to a PDO partner.
struct LayoutEntry : MappingValue {
  const canopen::DataTypeRow* type;

  friend bool operator==(const LayoutEntry&, const LayoutEntry&) = default;
};

std::vector<LayoutEntry> layout_of(const Pdo& pdo) {
  std::vector<LayoutEntry> layout;
  for (const PdoEntry& entry : pdo.entries) {
    const MappingValue& mapping = entry;
    layout.push_back({mapping, entry.object != nullptr ? entry.object->type : entry.dummy});
  }
  return layout;
}

std::string entry_text(const LayoutEntry& entry) {
  return fmt::format("{}/{}{}{}", entry_label(entry.index, entry.sub_index), entry.bits,
                     entry.type != nullptr ? " " : "", entry.type != nullptr ? entry.type->name : "");
}

std::string layout_text(const std::vector<LayoutEntry>& layout) {
  std::string text;
  for (const LayoutEntry& entry : layout) text += (text.empty() ? "" : ", ") + entry_text(entry);
  return "[" + text + "]";
}

Position mapping_position(const Pdo& pdo, std::size_t entry) {
  if (entry < pdo.entries.size()) return pdo.entries[entry].place;
  return pdo.mapping != nullptr ? pdo.mapping->position : pdo.position;
}

class PdoComparison {
 public:
  PdoComparison(const Pdo& before, const Pdo& after, Changes& changes)
      : before_{before}, after_{after}, changes_{changes}, is_used_{on_by_default(before) || on_by_default(after)} {}

  void compare() {
    compare_state();
    compare_cob_id();
    compare_parameter(transmission_type_sub_index,
                      is_used_ ? ChangeRule{"pdo-transmission"} : ChangeRule{"default-value"});
    compare_timing();
    compare_layout();
  }

 private:
  Change& add(ChangeRule rule, const Position& old_position, const Position& new_position) {
    return changes_.add(rule, pdo_label(after_), after_.communication != nullptr ? after_.communication->name : "",
                        old_position, new_position);
  }

  void compare_state() {
    if (on_by_default(before_) == on_by_default(after_)) return;
    report(cob_id_sub_index, on_by_default(before_) ? ChangeRule{"pdo-disabled"} : ChangeRule{"pdo-enabled"});
  }

  /// CAN-ID and flags, except for the valid bit of the PDO.
  void compare_cob_id() {
    const Entry* const old_entry = parameter(before_, cob_id_sub_index);
    const Entry* const new_entry = parameter(after_, cob_id_sub_index);
    const auto old_id = default_of(old_entry);
    const auto new_id = default_of(new_entry);
    if (same_value(old_id, new_id)) return;
    const canopen::DataTypeRow& type = old_entry != nullptr ? *old_entry->type : *new_entry->type;
    const CobIdService service = after_.direction == PdoDirection::receive ? CobIdService::rpdo : CobIdService::tpdo;
    for (CobIdChange& found : compare_cob_ids(old_id, new_id, type, service)) {
      const ChangeRule rule =
          found.rule == ChangeRule{"pdo-cob-id"} && !is_used_ ? ChangeRule{"default-value"} : found.rule;
      Change& change =
          add(rule, old_id ? old_id->position : before_.position, new_id ? new_id->position : after_.position);
      if (rule == ChangeRule{"default-value"} && new_entry != nullptr) change.name = new_entry->name;
      change.old_value = std::move(found.old_value);
      change.new_value = std::move(found.new_value);
    }
  }

  void compare_timing() {
    const auto count = [](const Pdo& pdo) {
      return pdo.communication != nullptr && !pdo.communication->entries.empty()
                 ? pdo.communication->entries.back().sub_index
                 : std::uint8_t{0};
    };
    const unsigned last = std::max(count(before_), count(after_));
    for (unsigned sub_index = first_timing_sub_index; sub_index <= last; ++sub_index) {
      compare_parameter(static_cast<std::uint8_t>(sub_index), "pdo-timing");
    }
  }

  void compare_parameter(std::uint8_t sub_index, ChangeRule rule) {
    const auto old_value = default_of(parameter(before_, sub_index));
    const auto new_value = default_of(parameter(after_, sub_index));
    if (!same_value(old_value, new_value)) report(sub_index, rule);
  }

  void report(std::uint8_t sub_index, ChangeRule rule) {
    const auto text = [&](const Pdo& pdo) {
      const Entry* const entry = parameter(pdo, sub_index);
      return entry != nullptr ? written_value(entry->default_value, *entry->type) : std::string{"none"};
    };
    const auto place = [&](const Pdo& pdo) {
      const auto value = default_of(parameter(pdo, sub_index));
      return value ? value->position : pdo.position;
    };
    const bool has_own_name = rule == ChangeRule{"pdo-timing"} || rule == ChangeRule{"default-value"};
    const Entry* const entry = parameter(after_, sub_index);
    Change& change = add(rule, place(before_), place(after_));
    if (has_own_name && entry != nullptr) change.name = entry->name;
    change.old_value = text(before_);
    change.new_value = text(after_);
  }

  void compare_layout() {
    const auto old_layout = layout_of(before_);
    const auto new_layout = layout_of(after_);
    if (old_layout == new_layout) return;
    const auto [old_end, new_end] = std::ranges::mismatch(old_layout, new_layout);
    // A receiver ignores bytes after its mapping; a device requires all bytes of its RPDO.
    const bool ignores_more = after_.direction == PdoDirection::transmit || old_layout.empty();
    const bool extended = old_end == old_layout.end() && ignores_more;
    const auto first = static_cast<std::size_t>(old_end - old_layout.begin());
    Change& change = add(extended ? ChangeRule{"pdo-layout-extended"} : ChangeRule{"pdo-layout"},
                         mapping_position(before_, first), mapping_position(after_, first));
    change.breaks.pdo = change.breaks.pdo && is_used_;
    change.old_value = layout_text(old_layout);
    change.new_value = layout_text(new_layout);
  }

  const Pdo& before_;
  const Pdo& after_;
  Changes& changes_;
  bool is_used_;  ///< enabled by default, before or after
};

const Pdo* find(const Device& device, const Pdo& wanted) {
  const auto at = std::ranges::find_if(
      device.pdos, [&](const Pdo& pdo) { return pdo.direction == wanted.direction && pdo.number == wanted.number; });
  return at != device.pdos.end() ? &*at : nullptr;
}

}  // namespace

void compare_pdos(const Device& before, const Device& after, Changes& changes) {
  for (const Pdo& pdo : before.pdos) {
    if (const Pdo* const same = find(after, pdo)) {
      PdoComparison{pdo, *same, changes}.compare();
    } else {
      changes.add("pdo-removed", pdo_label(pdo), "", pdo.position, {after.source}).breaks.pdo = on_by_default(pdo);
    }
  }
  for (const Pdo& pdo : after.pdos) {
    if (find(before, pdo) == nullptr) changes.add("pdo-added", pdo_label(pdo), "", {before.source}, pdo.position);
  }
}

bool is_pdo_parameter(std::uint16_t index) { return index >= 0x1400 && index <= 0x1BFF; }

}  // namespace edsc
