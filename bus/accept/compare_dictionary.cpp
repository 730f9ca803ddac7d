#include "accept/compare_dictionary.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <canopen/base/abort_code.hpp>
#include <canopen/od/access.hpp>
#include <iterator>
#include <optional>
#include <set>
#include <string_view>
#include <utility>

#include "accept/decisions.hpp"
#include "conform/cases/shared/entry_values.hpp"
#include "conform/cases/shared/product_values.hpp"
#include "device/entry_text.hpp"
#include "diagnostics/diagnostics.hpp"
#include "online/interruption.hpp"
#include "text/counted.hpp"
#include "values/append.hpp"
#include "values/little_endian.hpp"
#include "values/read_value.hpp"

namespace edsc::accept {
namespace {

using canopen::AbortCode;
using canopen::Access;
using conform::Bytes;

constexpr std::string_view missing_in_eds = "not described";

std::string size_text(std::size_t bytes) { return counted(bytes, "byte"); }

/// `UNSIGNED16, 2 bytes`
std::string type_text(const canopen::DataTypeRow& type) {
  if (type.bits == 0) return std::string{type.name};
  return fmt::format("{}, {}", type.name, size_text(bytes_for(type.bits)));
}

std::string access_name(const LiveEntry& entry) { return std::string{canopen::row_of(entry.entry->access).name}; }

bool has_type_length(const LiveEntry& entry, const SdoOutcome& outcome) {
  return entry.type->bits == 0 || !outcome.size_told || outcome.bytes.size() == bytes_for(entry.type->bits);
}

/// A value as the EDS has it, and what a formula is for this node: `$NODEID+0x620 (00000625h)`.
std::string written_text(std::string text, const LiveEntry& entry, canopen::NodeId node) {
  if (text.find('$') == std::string::npos || entry.type->bits == 0) return text;
  Diagnostics ignored;
  const auto number = parse_value({text, {}, true}, *entry.type, node.value(), ignored);
  if (!number) return text;
  return fmt::format("{} ({})", text, value_of(entry, bytes_of(number->bits, bytes_for(entry.type->bits))));
}

/// The value that the device sent, or the reason why it sent none.
std::string device_text(const Reading& reading) {
  const SdoOutcome& outcome = reading.outcome;
  if (!reading.was_read) return {};
  if (outcome.end == SdoEnd::refused) return abort_text(outcome.code);
  if (!outcome.done()) return failure_text(outcome);
  if (reading.entry.type == nullptr || !has_type_length(reading.entry, outcome)) {
    return fmt::format("{}: {}", size_text(outcome.bytes.size()), hex_bytes(outcome.bytes));
  }
  return value_of(reading.entry, outcome.bytes);
}

/// A pass over the readings of a device. A second pass, after another read, confirms the differences of the first one.
class Pass {
 public:
  Pass(const Device& sheet, const DataSheet& data, canopen::NodeId node, const Readings& readings)
      : sheet_{sheet}, data_{data}, node_{node}, readings_{readings} {}

  void run() {
    for (const auto& [key, reading] : readings_) {
      ComparedEntry row = row_of_entry(reading);
      if (reading.entry.entry == nullptr) {
        compare_additional(reading, row);
      } else if (reading.was_read) {
        compare_entry(reading, row);
      } else {
        row.remark = reading.why_not;
      }
      // An entry that neither the EDS nor the device has is none.
      if (row.in_eds || row.exists == Aspect::differs) entries.push_back(std::move(row));
    }
  }

  std::vector<ComparedEntry> entries;
  std::vector<Difference> differences;

 private:
  [[nodiscard]] const Object* object_of(const Reading& reading) const { return sheet_.find(reading.entry.index); }
  [[nodiscard]] Facts facts_of(Kind kind, const Reading& reading) const {
    return {sheet_, data_, node_, readings_, kind, reading, object_of(reading)};
  }

  /// The value of the EDS, as bytes; nothing without one.
  [[nodiscard]] std::optional<Bytes> eds_value(const LiveEntry& entry) const {
    const Object& object = *sheet_.find(entry.index);
    if (entry.sub_index == 0 && states_highest_sub_index(object)) {
      const auto written = written_count(data_, object);
      return written && entry.type->bits != 0 ? std::optional{bytes_of(*written, bytes_for(entry.type->bits))}
                                              : std::nullopt;
    }
    return conform::default_bytes(node_, *entry.entry);
  }

  [[nodiscard]] ComparedEntry row_of_entry(const Reading& reading) const {
    const LiveEntry& entry = reading.entry;
    ComparedEntry row;
    row.index = entry.index;
    row.sub_index = entry.sub_index;
    row.name = entry.name;
    row.device_value = device_text(reading);
    row.in_eds = entry.entry != nullptr;
    if (!row.in_eds) return row;
    row.type = entry.type->name;
    row.access = access_name(entry);
    if (const auto value = eds_value(entry)) {
      row.default_value = value_of(entry, *value);
    } else if (const auto written = written_value(data_, *object_of(reading), entry.sub_index)) {
      row.default_value = written_text(*written, entry, node_);  // edsc itself uses the value of CiA 301
    }
    return row;
  }

  void add(Kind kind, const Reading& reading, std::string in_eds, std::string in_device) {
    Difference difference;
    difference.index = reading.entry.index;
    difference.sub_index = reading.entry.sub_index;
    difference.kind = kind;
    difference.name = reading.entry.name;
    const Object* const object = object_of(reading);
    const bool of_object = kind == Kind::object_missing || kind == Kind::not_in_eds;
    if (of_object && object != nullptr) difference.name = object->name;
    difference.in_eds = std::move(in_eds);
    difference.in_device = std::move(in_device);
    difference.frames = reading.frames;
    decide(facts_of(kind, reading), difference);
    differences.push_back(std::move(difference));
  }

  /// An entry that the EDS does not have.
  void compare_additional(const Reading& reading, ComparedEntry& row) {
    if (!reading.exists()) return;
    row.exists = Aspect::differs;
    add(Kind::not_in_eds, reading, std::string{missing_in_eds}, device_text(reading));
  }

  void compare_entry(const Reading& reading, ComparedEntry& row) {
    const SdoOutcome& outcome = reading.outcome;
    if (reading.is_missing()) return compare_missing(reading, row);
    if (outcome.end == SdoEnd::no_answer) {
      row.remark = "no response";
      return add(Kind::no_response, reading, "a response", failure_text(outcome));
    }
    const bool has_value = reading.exists() && outcome.end != SdoEnd::refused;
    if (reading.exists()) row.exists = Aspect::same;
    if (!conform::is_readable(reading.entry)) {
      row.readable = has_value ? Aspect::differs : Aspect::same;
      if (has_value) add(Kind::access, reading, access_name(reading.entry), "readable: " + device_text(reading));
      return;
    }
    if (has_value) return compare_value(reading, row);
    compare_failure(reading, row);
  }

  /// 0602 0000h or 0609 0011h. A missing object is one difference.
  void compare_missing(const Reading& reading, ComparedEntry& row) {
    const LiveEntry& entry = reading.entry;
    if (entry.index == conform::error_history && entry.sub_index != 0) {
      row.remark = "the device has no error here now";
      return;
    }
    row.exists = Aspect::differs;
    const bool has_object = facts_of(Kind::sub_index_missing, reading).device_has(entry.index);
    if (has_object) return add(Kind::sub_index_missing, reading, "described", device_text(reading));
    if (missing_objects_.insert(entry.index).second) {
      add(Kind::object_missing, reading, "described", device_text(reading));
    }
  }

  /// An entry that exists, but whose value could not be read.
  void compare_failure(const Reading& reading, ComparedEntry& row) {
    const SdoOutcome& outcome = reading.outcome;
    const bool refused = outcome.end == SdoEnd::refused;
    if (refused && outcome.code == AbortCode::no_data && conform::may_have_no_value(reading.entry)) {
      row.readable = Aspect::same;
      row.remark = "the entry has no value now";
    } else if (refused && conform::depends_on_state(outcome.code)) {
      row.remark = "the value cannot be read in the present state";
    } else if (refused && outcome.code == AbortCode::write_only) {
      row.readable = Aspect::differs;
      add(Kind::access, reading, access_name(reading.entry), device_text(reading));
    } else {
      row.readable = Aspect::differs;
      add(Kind::unreadable, reading, access_name(reading.entry), device_text(reading));
    }
  }

  void compare_value(const Reading& reading, ComparedEntry& row) {
    const LiveEntry& entry = reading.entry;
    const SdoOutcome& outcome = reading.outcome;
    row.readable = Aspect::same;
    if (!outcome.done()) {
      row.remark = failure_text(outcome);  // more bytes than edsc reads
      if (entry.type->bits == 0) return;
    }
    if (entry.type->bits != 0 && outcome.size_told) {
      const bool fits = outcome.done() && has_type_length(entry, outcome);
      row.length = fits ? Aspect::same : Aspect::differs;
      if (!fits) return add(Kind::length, reading, type_text(*entry.type), device_text(reading));
    }
    compare_default(reading, row);
    if (conform::is_number(entry) && (entry.entry->low_limit || entry.entry->high_limit)) {
      const conform::LimitCheck check = conform::check_limits(node_, *entry.entry, outcome.bytes);
      row.limits = check.too_low || check.too_high ? Aspect::differs : Aspect::same;
      // The value of a constant differs already: its corrections include the limit.
      if (row.limits == Aspect::differs && row.value != Aspect::differs)
        add(Kind::limit, reading, limits_text(*entry.entry), device_text(reading));
    }
  }

  void compare_default(const Reading& reading, ComparedEntry& row) {
    const LiveEntry& entry = reading.entry;
    const std::uint64_t number = number_of(reading.outcome.bytes);
    if (const auto predefined = other_predefined_cob_id(data_, *entry.entry, node_)) {
      if (canopen::CobId{static_cast<std::uint32_t>(number)}.can_id() == *predefined) {
        row.value = Aspect::differs;
        return add(Kind::value, reading, row.default_value, device_text(reading));
      }
    }
    const auto expected = eds_value(entry);
    if (!expected) return;
    if (conform::trimmed(entry, reading.outcome.bytes) == conform::trimmed(entry, *expected)) {
      row.value = Aspect::same;
      return;
    }
    const bool is_count = entry.sub_index == 0 && states_highest_sub_index(*object_of(reading));
    const bool is_constant =
        conform::is_product_value(sheet_, entry) || (is_count && !canopen::writable(entry.entry->access));
    row.value = is_constant ? Aspect::differs : Aspect::may_differ;
    if (is_constant) add(Kind::value, reading, row.default_value, device_text(reading));
  }

  const Device& sheet_;
  const DataSheet& data_;
  canopen::NodeId node_;
  const Readings& readings_;
  std::set<std::uint16_t> missing_objects_;
};

bool is_same(const Difference& a, const Difference& b) {
  return a.index == b.index && a.sub_index == b.sub_index && a.kind == b.kind && a.in_device == b.in_device;
}

/// Reads the objects of the differences again, with the frames.
void confirm(DictionaryReader& reader, Readings& readings, const std::vector<Difference>& differences) {
  std::set<std::uint16_t> objects;
  for (const Difference& difference : differences) objects.insert(difference.index);
  for (auto& [key, reading] : readings) {
    if (reader.lost()) return;
    if (objects.contains(key.first) && reading.was_read) reader.read_again(reading);
  }
}

void compare(LiveBus& bus, const Device& sheet, const DataSheet& data, const ComparisonSettings& settings,
             Comparison& result) {
  DictionaryReader reader{bus, sheet, settings.node, settings.sdo};
  reader.on_record = [&result](const conform::SeenFrame& seen) { result.frames.push_back(seen); };
  {
    SdoAccess access{bus, settings.node, settings.sdo};
    const ReadIdentity read = read_identity(access);
    result.in_device = read.identity;
    if (read.unanswered == std::begin(identity_numbers)) {
      result.lost = fmt::format("node {} does not respond", settings.node.value());
      return;
    }
  }
  Readings readings = reader.read_all(settings.progress);
  Pass first{sheet, data, settings.node, readings};
  first.run();
  if (!reader.lost()) confirm(reader, readings, first.differences);
  Pass second{sheet, data, settings.node, readings};
  second.run();
  result.entries = std::move(second.entries);
  if (reader.lost()) {
    result.lost = fmt::format("node {} no longer responds", settings.node.value());
    return;
  }
  const auto in_second = [&](const Difference& one) {
    return std::ranges::any_of(second.differences, [&](const Difference& other) { return is_same(one, other); });
  };
  const auto in_first = [&](const Difference& one) {
    return std::ranges::any_of(first.differences, [&](const Difference& other) { return is_same(one, other); });
  };
  for (const Difference& one : first.differences) {
    if (in_second(one)) continue;
    result.unstable.push_back(fmt::format("{}: {}: {}; a second read differs", entry_label(one.index, one.sub_index),
                                          row_of(one.kind).text, one.in_device));
  }
  std::ranges::copy_if(second.differences, std::back_inserter(result.differences), in_first);
  result.clock = reader.clock();
}

}  // namespace

std::size_t Comparison::count(Mark mark) const {
  return static_cast<std::size_t>(std::ranges::count(differences, mark, &Difference::mark));
}

std::size_t Comparison::undeclared() const {
  return static_cast<std::size_t>(std::ranges::count(differences, false, &Difference::is_declared));
}

bool Comparison::differs(const IdentityNumber& number) const {
  const auto &stated = in_eds.*number.value, &found = in_device.*number.value;
  return stated && found && *stated != *found;
}

Comparison compare_dictionary(LiveBus& bus, const Device& sheet, const DataSheet& data,
                              const ComparisonSettings& settings) {
  Comparison result;
  result.in_eds = identity_of(sheet);
  try {
    compare(bus, sheet, data, settings, result);
  } catch (const BusLost& problem) {
    result.lost = fmt::format("the bus is lost: {}", problem.what());
  } catch (const Interrupted&) {
    result.interrupted = true;
  }
  return result;
}

}  // namespace edsc::accept
