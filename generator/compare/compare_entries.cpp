#include "compare/compare_parts.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <span>
#include <utility>

#include "device/cob_id_parameter.hpp"
#include "device/entry_text.hpp"
#include "values/value_bytes.hpp"
#include "values/value_text.hpp"

namespace edsc {
namespace {

using canopen::DataClass;
using canopen::DataTypeRow;
using canopen::Mappable;

/// Entries whose default value identifies a device.
struct SpecialDefault {
  std::uint16_t first, last;
  std::uint8_t first_sub_index, last_sub_index;
  ChangeRule change;
};

constexpr SpecialDefault special_defaults[] = {
    {0x1000, 0x1000, 0, 0, "identity"},  // device type
    {0x1018, 0x1018, 1, 2, "identity"},  // vendor-ID, product code
};

constexpr std::uint16_t producer_heartbeat_time = 0x1017;

const Position& place_of(const std::optional<Value>& value, const Entry& entry) {
  return value ? value->position : entry.position;
}

std::string mappable_text(const Entry& entry) {
  switch (entry.mappable()) {
    case Mappable::no: return "no";
    case Mappable::tpdo: return "TPDO";
    case Mappable::rpdo: return "RPDO";
    case Mappable::both: return "TPDO and RPDO";
  }
  return "";
}

bool is_number(const DataTypeRow& type) {
  return type.kind == DataClass::signed_integer || type.kind == DataClass::unsigned_integer ||
         type.kind == DataClass::real;
}

/// A limit as a number, or `missing`. The mantissa of a long double holds 64 bits.
long double limit_number(const std::optional<Value>& limit, const DataTypeRow& type, long double missing) {
  if (!limit) return missing;
  if (type.kind == DataClass::signed_integer) return static_cast<long double>(static_cast<std::int64_t>(limit->bits));
  if (type.kind == DataClass::unsigned_integer) return static_cast<long double>(limit->bits);
  return real_of(limit->bits, type);
}

long double lowest(const DataTypeRow& type) {
  if (type.kind == DataClass::real) return -std::numeric_limits<long double>::infinity();
  return type.kind == DataClass::signed_integer ? -std::ldexp(1.0L, type.bits - 1) : 0.0L;
}

long double highest(const DataTypeRow& type) {
  if (type.kind == DataClass::real) return std::numeric_limits<long double>::infinity();
  return std::ldexp(1.0L, type.kind == DataClass::signed_integer ? type.bits - 1 : type.bits) - 1.0L;
}

/// A string's type with the length that its DEFTYPE states.
std::string sized_type(const Entry& entry) {
  return entry.octets == 0 ? fmt::format("{} of any length", entry.type->name)
                           : fmt::format("{} of {} bytes", entry.type->name, entry.octets);
}

class EntryComparison {
 public:
  EntryComparison(const Entry& before, const Entry& after, bool in_rpdo, Changes& changes)
      : before_{before}, after_{after}, in_rpdo_{in_rpdo}, changes_{changes} {}

  void compare() {
    compare_access();
    compare_mapping();
    if (before_.type != after_.type) {
      add("data-type", before_.position, after_.position, std::string{before_.type->name},
          std::string{after_.type->name});
      return;  // values of different types are not compared
    }
    if (before_.octets != after_.octets) {
      add("data-type", before_.position, after_.position, sized_type(before_), sized_type(after_));
    }
    if (is_number(*before_.type)) {
      compare_limit("low", before_.low_limit, after_.low_limit, lowest(*before_.type), true);
      compare_limit("high", before_.high_limit, after_.high_limit, highest(*before_.type), false);
    }
    if (!is_pdo_parameter(before_.index)) compare_default();
  }

 private:
  Change& add(ChangeRule rule, const Position& old_position, const Position& new_position, std::string old_value,
              std::string new_value) {
    Change& change =
        changes_.add(rule, entry_label(after_.index, after_.sub_index), after_.name, old_position, new_position);
    change.old_value = std::move(old_value);
    change.new_value = std::move(new_value);
    return change;
  }

  void compare_access() {
    if (before_.access == after_.access) return;
    const canopen::AccessRow& old_row = canopen::row_of(before_.access);
    const canopen::AccessRow& new_row = canopen::row_of(after_.access);
    const bool loses = (old_row.readable && !new_row.readable) || (old_row.writable && !new_row.writable);
    const bool gains = (!old_row.readable && new_row.readable) || (!old_row.writable && new_row.writable);
    add(loses   ? ChangeRule{"access-reduced"}
        : gains ? ChangeRule{"access-extended"}
                : ChangeRule{"access-other"},
        before_.access_position, after_.access_position, std::string{old_row.name}, std::string{new_row.name});
  }

  void compare_mapping() {
    if (before_.mappable() == after_.mappable()) return;
    const auto loses = [&](Mappable direction) {
      return canopen::allows(before_.mappable(), direction) && !canopen::allows(after_.mappable(), direction);
    };
    const bool reduced = loses(Mappable::tpdo) || loses(Mappable::rpdo);
    add(reduced ? ChangeRule{"mapping-reduced"} : ChangeRule{"mapping-extended"}, before_.mapping_position,
        after_.mapping_position, mappable_text(before_), mappable_text(after_));
  }

  /// `unlimited` is the limit of the type.
  void compare_limit(std::string_view which, const std::optional<Value>& old_limit,
                     const std::optional<Value>& new_limit, long double unlimited, bool is_low) {
    if (same_value(old_limit, new_limit)) return;
    const bool follows_node_id = (old_limit && old_limit->plus_node_id) || (new_limit && new_limit->plus_node_id);
    const long double old_number = limit_number(old_limit, *before_.type, unlimited);
    const long double new_number = limit_number(new_limit, *before_.type, unlimited);
    if (old_number == new_number && !follows_node_id) return;
    const bool narrowed = follows_node_id || (is_low ? new_number > old_number : new_number < old_number);
    const bool written = canopen::writable(before_.access) || in_rpdo_;
    const ChangeRule rule = !written   ? ChangeRule{"limit-read-only"}
                            : narrowed ? ChangeRule{"limit-narrowed"}
                                       : ChangeRule{"limit-widened"};
    Change& change =
        add(rule, place_of(old_limit, before_), place_of(new_limit, after_),
            fmt::format("{} {}", which, meant_value_text(old_limit, before_)), meant_value_text(new_limit, after_));
    change.breaks.pdo = rule == ChangeRule{"limit-narrowed"} && in_rpdo_;
  }

  void compare_default() {
    if (same_value(before_.default_value, after_.default_value)) return;
    if (is_revision()) return compare_revision();
    if (const CobIdParameter* const parameter = find_cob_id_parameter(before_.index, before_.sub_index)) {
      return compare_cob_id(*parameter);
    }
    add(default_change(), place_of(before_.default_value, before_), place_of(after_.default_value, after_),
        meant_value_text(before_.default_value, before_), meant_value_text(after_.default_value, after_));
  }

  void compare_cob_id(const CobIdParameter& parameter) {
    const Position& old_place = place_of(before_.default_value, before_);
    const Position& new_place = place_of(after_.default_value, after_);
    for (CobIdChange& change :
         compare_cob_ids(before_.default_value, after_.default_value, *before_.type, parameter.service)) {
      Change& added = add(change.rule, old_place, new_place, std::move(change.old_value), std::move(change.new_value));
      if (change.rule == ChangeRule{"frame-format"}) added.breaks.pdo = false;
    }
  }

  [[nodiscard]] ChangeRule default_change() const {
    for (const SpecialDefault& row : special_defaults) {
      if (before_.index >= row.first && before_.index <= row.last && before_.sub_index >= row.first_sub_index &&
          before_.sub_index <= row.last_sub_index) {
        return row.change;
      }
    }
    if (before_.index == producer_heartbeat_time && before_.default_value && before_.default_value->bits != 0) {
      const std::uint64_t time = after_.default_value ? after_.default_value->bits : 0;
      if (time == 0 || time > before_.default_value->bits) return ChangeRule{"heartbeat-slowed"};
    }
    return ChangeRule{"default-value"};
  }

  [[nodiscard]] bool is_revision() const { return before_.index == 0x1018 && before_.sub_index == 3; }

  /// CiA 301, 7.5.2.21: the high word counts the changes of the CANopen behaviour.
  void compare_revision() {
    const auto major = [](const std::optional<Value>& value) { return value ? value->bits >> 16 : 0; };
    add(major(before_.default_value) != major(after_.default_value) ? ChangeRule{"revision-major"}
                                                                    : ChangeRule{"revision-minor"},
        place_of(before_.default_value, before_), place_of(after_.default_value, after_),
        written_value(before_.default_value, *before_.type), written_value(after_.default_value, *after_.type));
  }

  const Entry& before_;
  const Entry& after_;
  bool in_rpdo_;
  Changes& changes_;
};

}  // namespace

void compare_entries(const Entry& before, const Entry& after, bool in_rpdo, Changes& changes) {
  EntryComparison{before, after, in_rpdo, changes}.compare();
}

std::string meant_value_text(const std::optional<Value>& value, const Entry& entry) {
  std::string text = written_value(value, *entry.type);
  const bool has_meaning = entry.meaning && (quantity_of(entry) != nullptr || meaning_of_integer(entry) != nullptr);
  if (!value || value->plus_node_id || !has_meaning) return text;
  const std::string bytes = bytes_of(*value, *entry.type);
  const std::span octets{reinterpret_cast<const std::uint8_t*>(bytes.data()), bytes.size()};
  std::string meant = value_text(entry, octets);
  if (meant == value_text(*entry.type, octets) || meant.find(' ') == std::string::npos) return text;
  const bool is_name = entry.meaning->values || entry.meaning->has_fields();
  return is_name ? meant : fmt::format("{} ({})", text, meant);
}

bool same_value(const std::optional<Value>& a, const std::optional<Value>& b) {
  if (!a || !b) return a.has_value() == b.has_value();
  return a->bits == b->bits && a->plus_node_id == b->plus_node_id && a->bytes == b->bytes;
}

}  // namespace edsc
