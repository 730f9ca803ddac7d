#include "configure/configuration_plan.hpp"

#include <algorithm>
#include <array>
#include <canopen/can/cob_id.hpp>
#include <cctype>
#include <map>
#include <optional>
#include <set>
#include <span>
#include <string>
#include <string_view>

#include "device/index_range.hpp"

namespace edsc {
namespace {

using canopen::CobId;

/// Objects that are not written, in addition to `command_objects`: 1020h is written at the end, and the other objects
/// of a program download are commands too.
constexpr std::array not_written = {IndexRange{0x1020, 0x1020}, IndexRange{0x1F50, 0x1F5A}};

constexpr std::uint32_t produces_sync = 0x4000'0000;
constexpr std::uint32_t consumes_or_produces_time = 0xC000'0000;

/// COB-IDs whose CAN-ID may change only while they are disabled (CiA 301, 7.5.2).
struct GuardedCobId {
  IndexRange objects;
  std::uint8_t first_sub_index, last_sub_index;
  std::uint32_t off_set, off_cleared;
};

constexpr GuardedCobId guarded_cob_ids[] = {
    {{0x1005, 0x1005}, 0, 0, 0, produces_sync},
    {{0x1012, 0x1012}, 0, 0, 0, consumes_or_produces_time},
    {{0x1014, 0x1014}, 0, 0, CobId::invalid_bit, 0},
    {{0x1201, 0x12FF}, 1, 2, CobId::invalid_bit, 0},
};

/// Objects that are not in the order of their index: the SYNC overflow before the period, the SYNC producer after it.
struct MovedObject {
  std::uint16_t index, before;
};
constexpr MovedObject moved_objects[] = {{0x1019, 0x1005}, {0x1005, 0x1008}};

constexpr std::uint16_t sync_period = 0x1006;
constexpr std::uint16_t sync_overflow = 0x1019;
constexpr std::uint16_t mapping_after_communication = 0x0200;

bool is_pdo_communication(std::uint16_t index) { return (index & 0xFE00) == 0x1400 || (index & 0xFE00) == 0x1800; }
bool is_pdo_mapping(std::uint16_t index) { return contains(mapping_parameters, index); }

const GuardedCobId* guard_of(const LiveEntry& entry) {
  const auto* guard = std::ranges::find_if(guarded_cob_ids, [&](const GuardedCobId& row) {
    return entry.index >= row.objects.first && entry.index <= row.objects.last &&
           entry.sub_index >= row.first_sub_index && entry.sub_index <= row.last_sub_index;
  });
  return guard == std::end(guarded_cob_ids) ? nullptr : guard;
}

/// Ascending, application after communication.
std::uint64_t order_of(const LiveEntry& entry) {
  std::uint64_t place = entry.index * 2U + 1U;
  for (const MovedObject& row : moved_objects) {
    if (row.index == entry.index) place = row.before * 2U;
  }
  const bool communication = entry.index < 0x2000;
  return (communication ? 0 : std::uint64_t{1} << 40) | place << 20 | std::uint64_t{entry.index} << 8 | entry.sub_index;
}

class Planner {
 public:
  Planner(const std::vector<ConfigurationValue>& values, const Device* device) : device_{device} {
    for (const ConfigurationValue& value : values) {
      const std::uint16_t index = value.entry.index;
      if (is_left_out(value.entry)) continue;
      if (sets_node_id_or_bit_rate(value.entry)) {
        commissioning_.push_back(&value);
      } else if (is_pdo_communication(index)) {
        pdos_[index].push_back(&value);
      } else if (is_pdo_mapping(index)) {
        pdos_[static_cast<std::uint16_t>(index - mapping_after_communication)].push_back(&value);
      } else {
        ordinary_.push_back(&value);
      }
    }
    std::ranges::stable_sort(ordinary_, {}, [](const ConfigurationValue* value) { return order_of(value->entry); });
  }

  std::vector<ConfigurationStep> plan() {
    plan_ordinary();
    for (const auto& [communication, values] : pdos_) plan_pdo(communication, values);
    for (const ConfigurationValue* value : commissioning_) add(StepKind::write, *value);
    return std::move(steps_);
  }

 private:
  using Values = std::vector<const ConfigurationValue*>;

  void add(StepKind kind, const ConfigurationValue& value) {
    add(kind, value.entry.index, value.entry.sub_index, &value);
  }

  /// A COB-ID or a counter that the DCF need not configure.
  void add(StepKind kind, std::uint16_t index, std::uint8_t sub_index, const ConfigurationValue* value,
           std::uint32_t off_set = 0, std::uint32_t off_cleared = 0) {
    ConfigurationStep step{kind, live_entry(device_, index, sub_index), value, {}, off_set, off_cleared, group_};
    if (value != nullptr) {
      step.entry = value->entry;
      step.bytes = value->bytes;
    }
    steps_.push_back(std::move(step));
  }

  [[nodiscard]] bool is_writable(std::uint16_t index, std::uint8_t sub_index) const {
    if (device_ == nullptr) return true;
    const Entry* entry = device_->find(index, sub_index);
    return entry != nullptr && canopen::writable(entry->access);
  }

  static const ConfigurationValue* find(const Values& values, std::uint16_t index, std::uint8_t sub_index) {
    const auto found = std::ranges::find_if(values, [&](const ConfigurationValue* value) {
      return value->entry.index == index && value->entry.sub_index == sub_index;
    });
    return found == values.end() ? nullptr : *found;
  }

  void plan_ordinary() {
    const bool overflow = find(ordinary_, sync_overflow, 0) != nullptr;
    const bool period = find(ordinary_, sync_period, 0) != nullptr;
    const bool restores_period = !period && device_ != nullptr && is_writable(sync_period, 0);
    if (overflow && (period || restores_period)) {
      add(StepKind::clear, sync_period, 0, nullptr);  // 1019h can change only while the period is 0
    }
    for (std::size_t i = 0; i < ordinary_.size(); ++i) {
      if (guard_of(ordinary_[i]->entry) == nullptr) {
        add(StepKind::write, *ordinary_[i]);
        if (ordinary_[i]->entry.index == sync_overflow && restores_period) {
          add(StepKind::restore, sync_period, 0, nullptr);
        }
        continue;
      }
      std::size_t end = i + 1;
      while (end < ordinary_.size() && ordinary_[end]->entry.index == ordinary_[i]->entry.index) ++end;
      plan_guarded(
          {ordinary_.begin() + static_cast<std::ptrdiff_t>(i), ordinary_.begin() + static_cast<std::ptrdiff_t>(end)});
      i = end - 1;
    }
  }

  /// The values of one object with COB-IDs that are disabled first.
  void plan_guarded(const Values& values) {
    group_ = ++groups_;
    for (const ConfigurationValue* value : values) {
      const GuardedCobId* guard = guard_of(value->entry);
      if (guard == nullptr) continue;
      add(StepKind::switch_off, value->entry.index, value->entry.sub_index, value, guard->off_set, guard->off_cleared);
    }
    for (const ConfigurationValue* value : values) {
      if (guard_of(value->entry) == nullptr) add(StepKind::write, *value);
    }
    for (const ConfigurationValue* value : values) {
      if (guard_of(value->entry) != nullptr) add(StepKind::switch_on, *value);
    }
    group_ = 0;
  }

  void plan_pdo(std::uint16_t communication, const Values& values) {
    group_ = ++groups_;
    const auto mapping = static_cast<std::uint16_t>(communication + mapping_after_communication);
    const ConfigurationValue* cob_id = find(values, communication, 1);
    const bool switches = cob_id != nullptr || is_writable(communication, 1);
    if (switches) add(StepKind::switch_off, communication, 1, cob_id, CobId::invalid_bit, 0);
    plan_mapping(mapping, values);
    for (const ConfigurationValue* value : values) {
      if (value->entry.index == communication && value != cob_id) add(StepKind::write, *value);
    }
    if (switches) add(StepKind::switch_on, communication, 1, cob_id);
    group_ = 0;
  }

  /// Plans the used entries of a mapping; those after them have no effect.
  void plan_mapping(std::uint16_t mapping, const Values& values) {
    const ConfigurationValue* count = find(values, mapping, 0);
    Values entries;
    for (const ConfigurationValue* value : values) {
      const bool counts = count == nullptr || count->bytes.empty() || value->entry.sub_index <= count->bytes.front();
      if (value->entry.index == mapping && value != count && counts) entries.push_back(value);
    }
    if (count == nullptr && entries.empty()) return;
    const bool counted = count != nullptr || is_writable(mapping, 0);
    if (counted) add(StepKind::clear, mapping, 0, nullptr);
    for (const ConfigurationValue* value : entries) add(StepKind::write, *value);
    if (!counted) return;
    add(count == nullptr ? StepKind::restore : StepKind::write, mapping, 0, count);
    if (count == nullptr) steps_.back().bytes = {entries.back()->entry.sub_index};
  }

  const Device* device_;
  Values ordinary_, commissioning_;
  std::map<std::uint16_t, Values> pdos_;  ///< by the index of the communication parameter
  std::vector<ConfigurationStep> steps_;
  unsigned group_ = 0;
  unsigned groups_ = 0;
};

/// The words of a name in lower case, between blanks: ` can bit rate ` for `CAN bit rate`, `CanBitRate` and
/// `CAN_Bit-Rate`.
std::string words_of(std::string_view name) {
  std::string words = " ";
  bool after_lower = false;
  for (const char c : name) {
    const auto letter = static_cast<unsigned char>(c);
    const bool upper = std::isupper(letter) != 0;
    const bool ends = std::isalnum(letter) == 0 || (upper && after_lower);
    if (ends && words.back() != ' ') words += ' ';
    if (std::isalnum(letter) != 0) words += static_cast<char>(std::tolower(letter));
    after_lower = std::islower(letter) != 0;
  }
  return words.back() == ' ' ? words : words + ' ';
}

constexpr std::array commissioning_names = {"nodeid", "nodeaddress", "nodenumber", "canaddress", "baud", "bitrate"};
constexpr std::array commissioning_words = {" can speed "};
/// Other nodes, and other interfaces than CAN.
constexpr std::array other_words = {" remote ", " consumer ", " producer ", " client ", " server ",
                                    " master ", " rs232 ",    " rs422 ",    " rs485 ",  " usb ",
                                    " uart ",   " serial ",   " modbus "};

bool contains_one_of(std::string_view text, std::span<const char* const> parts) {
  return std::ranges::any_of(parts, [&](std::string_view part) { return text.find(part) != std::string_view::npos; });
}

constexpr std::uint16_t node_id_of_cia301_v3 = 0x100B;
constexpr std::uint16_t first_of_manufacturer = 0x2000;

}  // namespace

bool sets_node_id_or_bit_rate(const LiveEntry& entry) {
  if (entry.index == node_id_of_cia301_v3) return true;
  if (entry.index < first_of_manufacturer || entry.entry == nullptr) return false;
  const std::string words = words_of(entry.name);
  std::string squashed = words;  // `CAN bit rate`, `CanBitRate` and `CAN_Bitrate` are equal
  std::erase(squashed, ' ');
  const bool named = contains_one_of(squashed, commissioning_names) || contains_one_of(words, commissioning_words);
  return named && !contains_one_of(words, other_words);
}

bool has_effect(const ConfigurationValue& value, const std::vector<ConfigurationValue>& values) {
  if (!is_pdo_mapping(value.entry.index) || value.entry.sub_index == 0) return true;
  const auto count = std::ranges::find_if(values, [&](const ConfigurationValue& other) {
    return other.entry.index == value.entry.index && other.entry.sub_index == 0;
  });
  return count == values.end() || count->bytes.empty() || value.entry.sub_index <= count->bytes.front();
}

std::vector<ConfigurationValue> values_to_write(const std::vector<ConfigurationValue>& values,
                                                const std::vector<bool>& differs) {
  std::set<std::uint16_t> whole;  // objects of which each value is written
  for (std::size_t i = 0; i < values.size(); ++i) {
    if (!differs[i]) continue;
    const std::uint16_t index = values[i].entry.index;
    if (is_pdo_mapping(index)) whole.insert(index);
    if (index == sync_overflow) whole.insert(sync_period);
  }
  std::vector<ConfigurationValue> wanted;
  for (std::size_t i = 0; i < values.size(); ++i) {
    if (differs[i] || whole.contains(values[i].entry.index)) wanted.push_back(values[i]);
  }
  return wanted;
}

bool is_left_out(const LiveEntry& entry) {
  constexpr std::uint32_t no_write = 1;
  if (entry.entry != nullptr && (entry.entry->obj_flags & no_write) != 0) return true;
  return contains(command_objects, entry.index) || contains(not_written, entry.index);
}

std::vector<ConfigurationStep> plan_configuration(const std::vector<ConfigurationValue>& values, const Device* device) {
  return Planner{values, device}.plan();
}

}  // namespace edsc
