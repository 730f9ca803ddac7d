#include "format/dcf/write_order.hpp"

#include <algorithm>
#include <canopen/can/cob_id.hpp>
#include <map>
#include <set>

#include "device/index_range.hpp"

namespace edsc {
namespace {

using canopen::CobId;

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

const GuardedCobId* guard_of(const WriteValue& value) {
  const auto* guard = std::ranges::find_if(guarded_cob_ids, [&](const GuardedCobId& row) {
    return value.index >= row.objects.first && value.index <= row.objects.last &&
           value.sub_index >= row.first_sub_index && value.sub_index <= row.last_sub_index;
  });
  return guard == std::end(guarded_cob_ids) ? nullptr : guard;
}

/// Ascending, application after communication.
std::uint64_t order_of(const WriteValue& value) {
  std::uint64_t place = value.index * 2U + 1U;
  for (const MovedObject& row : moved_objects) {
    if (row.index == value.index) place = row.before * 2U;
  }
  const bool communication = value.index < 0x2000;
  return (communication ? 0 : std::uint64_t{1} << 40) | place << 20 | std::uint64_t{value.index} << 8 | value.sub_index;
}

class WriteOrder {
 public:
  WriteOrder(const std::vector<WriteValue>& values, const Device* device) : device_{device} {
    for (const WriteValue& value : values) {
      const std::uint16_t index = value.index;
      if (value.is_last) {
        last_.push_back(&value);
      } else if (is_pdo_communication(index)) {
        pdos_[index].push_back(&value);
      } else if (is_pdo_mapping(index)) {
        pdos_[static_cast<std::uint16_t>(index - mapping_after_communication)].push_back(&value);
      } else {
        ordinary_.push_back(&value);
      }
    }
    std::ranges::stable_sort(ordinary_, {}, [](const WriteValue* value) { return order_of(*value); });
  }

  std::vector<WriteStep> steps() {
    plan_ordinary();
    for (const auto& [communication, values] : pdos_) plan_pdo(communication, values);
    for (const WriteValue* value : last_) add(StepKind::write, *value);
    return std::move(steps_);
  }

 private:
  using Values = std::vector<const WriteValue*>;

  void add(StepKind kind, const WriteValue& value) { add(kind, value.index, value.sub_index, &value); }

  /// A COB-ID or a counter that need not be configured.
  void add(StepKind kind, std::uint16_t index, std::uint8_t sub_index, const WriteValue* value,
           std::uint32_t off_set = 0, std::uint32_t off_cleared = 0) {
    WriteStep step{kind, index, sub_index, value, {}, off_set, off_cleared, group_};
    if (value != nullptr) step.bytes = value->bytes;
    steps_.push_back(std::move(step));
  }

  [[nodiscard]] bool is_writable(std::uint16_t index, std::uint8_t sub_index) const {
    if (device_ == nullptr) return true;
    const Entry* entry = device_->find(index, sub_index);
    return entry != nullptr && canopen::writable(entry->access);
  }

  static const WriteValue* find(const Values& values, std::uint16_t index, std::uint8_t sub_index) {
    const auto found = std::ranges::find_if(
        values, [&](const WriteValue* value) { return value->index == index && value->sub_index == sub_index; });
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
      if (guard_of(*ordinary_[i]) == nullptr) {
        add(StepKind::write, *ordinary_[i]);
        if (ordinary_[i]->index == sync_overflow && restores_period) {
          add(StepKind::restore, sync_period, 0, nullptr);
        }
        continue;
      }
      std::size_t end = i + 1;
      while (end < ordinary_.size() && ordinary_[end]->index == ordinary_[i]->index) ++end;
      plan_guarded(
          {ordinary_.begin() + static_cast<std::ptrdiff_t>(i), ordinary_.begin() + static_cast<std::ptrdiff_t>(end)});
      i = end - 1;
    }
  }

  /// The values of one object with COB-IDs that are disabled first.
  void plan_guarded(const Values& values) {
    group_ = ++groups_;
    for (const WriteValue* value : values) {
      const GuardedCobId* guard = guard_of(*value);
      if (guard == nullptr) continue;
      add(StepKind::switch_off, value->index, value->sub_index, value, guard->off_set, guard->off_cleared);
    }
    for (const WriteValue* value : values) {
      if (guard_of(*value) == nullptr) add(StepKind::write, *value);
    }
    for (const WriteValue* value : values) {
      if (guard_of(*value) != nullptr) add(StepKind::switch_on, *value);
    }
    group_ = 0;
  }

  void plan_pdo(std::uint16_t communication, const Values& values) {
    group_ = ++groups_;
    const auto mapping = static_cast<std::uint16_t>(communication + mapping_after_communication);
    const WriteValue* cob_id = find(values, communication, 1);
    const bool switches = cob_id != nullptr || is_writable(communication, 1);
    if (switches) add(StepKind::switch_off, communication, 1, cob_id, CobId::invalid_bit, 0);
    plan_mapping(mapping, values);
    for (const WriteValue* value : values) {
      if (value->index == communication && value != cob_id) add(StepKind::write, *value);
    }
    if (switches) add(StepKind::switch_on, communication, 1, cob_id);
    group_ = 0;
  }

  /// Plans the used entries of a mapping; those after them have no effect.
  void plan_mapping(std::uint16_t mapping, const Values& values) {
    const WriteValue* count = find(values, mapping, 0);
    Values entries;
    for (const WriteValue* value : values) {
      const bool counts = count == nullptr || count->bytes.empty() || value->sub_index <= count->bytes.front();
      if (value->index == mapping && value != count && counts) entries.push_back(value);
    }
    if (count == nullptr && entries.empty()) return;
    const bool counted = count != nullptr || is_writable(mapping, 0);
    if (counted) add(StepKind::clear, mapping, 0, nullptr);
    for (const WriteValue* value : entries) add(StepKind::write, *value);
    if (!counted) return;
    add(count == nullptr ? StepKind::restore : StepKind::write, mapping, 0, count);
    if (count == nullptr) steps_.back().bytes = {entries.back()->sub_index};
  }

  const Device* device_;
  Values ordinary_, last_;
  std::map<std::uint16_t, Values> pdos_;  ///< by the index of the communication parameter
  std::vector<WriteStep> steps_;
  unsigned group_ = 0;
  unsigned groups_ = 0;
};

}  // namespace

std::vector<bool> with_dependent_values(const std::vector<WriteValue>& values, const std::vector<bool>& differs) {
  std::set<std::uint16_t> whole;  // objects of which each value is written
  for (std::size_t i = 0; i < values.size(); ++i) {
    if (!differs[i]) continue;
    const std::uint16_t index = values[i].index;
    if (is_pdo_mapping(index)) whole.insert(index);
    if (index == sync_overflow) whole.insert(sync_period);
  }
  std::vector<bool> wanted = differs;
  for (std::size_t i = 0; i < values.size(); ++i) {
    if (whole.contains(values[i].index)) wanted[i] = true;
  }
  return wanted;
}

std::vector<WriteStep> order_writes(const std::vector<WriteValue>& values, const Device* device) {
  return WriteOrder{values, device}.steps();
}

}  // namespace edsc
