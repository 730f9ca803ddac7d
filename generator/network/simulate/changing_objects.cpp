#include "network/simulate/changing_objects.hpp"

#include <algorithm>
#include <optional>
#include <set>
#include <tuple>
#include <utility>

#include "device/pdo/pdo_defaults.hpp"
#include "network/communication_objects.hpp"

namespace edsc {
namespace {

using canopen::DataClass;

/// Both limits included; as signed or unsigned numbers.
struct ValueRange {
  std::uint64_t low = 0;
  std::uint64_t high = 0;
};

/// All values of a type. Of REAL those from 1 to 2, whose patterns are consecutive.
std::optional<ValueRange> values_of_type(const canopen::DataTypeRow& type) {
  switch (type.kind) {
    case DataClass::boolean: return ValueRange{0, 1};
    case DataClass::unsigned_integer: return ValueRange{0, UINT64_MAX >> (64 - type.bits)};
    case DataClass::signed_integer: {
      const std::uint64_t high = UINT64_MAX >> (65 - type.bits);
      return ValueRange{~high, high};
    }
    case DataClass::real:
      if (type.bits == 32) return ValueRange{0x3F80'0000, 0x3FFF'FFFF};
      return ValueRange{0x3FF0'0000'0000'0000, 0x3FFF'FFFF'FFFF'FFFF};
    case DataClass::string:
    case DataClass::time:
    case DataClass::domain: return std::nullopt;
  }
  return std::nullopt;
}

bool is_less(std::uint64_t a, std::uint64_t b, DataClass kind) {
  if (kind == DataClass::signed_integer) return static_cast<std::int64_t>(a) < static_cast<std::int64_t>(b);
  return a < b;
}

void limit(ValueRange& range, const Entry& entry, DataClass kind) {
  if (kind == DataClass::real || entry.type == nullptr || entry.type->kind != kind) return;
  if (entry.low_limit && is_less(range.low, entry.low_limit->bits, kind)) range.low = entry.low_limit->bits;
  if (entry.high_limit && is_less(entry.high_limit->bits, range.high, kind)) range.high = entry.high_limit->bits;
}

class ChangingPdoCollector {
 public:
  ChangingPdoCollector(const NetworkNode& node, const std::vector<CobIdUse>& uses, const NetworkTiming& timing)
      : node_{node}, uses_{uses}, timing_{timing} {}

  std::vector<ChangingPdo> collect() {
    for (const CobIdUse& use : uses_) {
      if (use.node == &node_ && use.pdo != nullptr && use.transmits && !use.pdo->multiplexed) add(use);
    }
    std::ranges::stable_sort(pdos_, [](const Row& a, const Row& b) {
      return std::tuple{!a.pdo.is_event_driven, b.pdo.interval} < std::tuple{!b.pdo.is_event_driven, a.pdo.interval};
    });
    std::vector<ChangingPdo> changing;
    for (Row& row : pdos_) {
      add_objects(row);
      if (!row.pdo.objects.empty()) changing.push_back(std::move(row.pdo));
    }
    return changing;
  }

 private:
  struct Row {
    const CobIdUse* use;
    ChangingPdo pdo;
  };

  void add(const CobIdUse& use) {
    const auto at = std::ranges::find_if(timing_.messages, [&](const TimedMessage& one) {
      return one.service == FrameService::pdo && one.message.can_id == use.can_id &&
             one.message.extended == use.extended;
    });
    if (at == timing_.messages.end()) return;
    ChangingPdo pdo;
    pdo.message = static_cast<std::size_t>(at - timing_.messages.begin());
    pdo.interval = at->message.period;
    pdo.is_event_driven = !at->is_synchronous;
    pdo.has_event_timer = communication_default(*use.pdo, event_timer_sub_index).value_or(0) != 0 &&
                          communication_default(*use.pdo, inhibit_time_sub_index).value_or(0) == 0;
    pdo.has_receiver = std::ranges::any_of(uses_, [&](const CobIdUse& one) { return receives(one, use); });
    pdos_.push_back({&use, std::move(pdo)});
  }

  static bool receives(const CobIdUse& use, const CobIdUse& sender) {
    return use.pdo != nullptr && !use.transmits && use.can_id == sender.can_id && use.extended == sender.extended;
  }

  void add_objects(Row& row) {
    for (const PdoEntry& mapped : row.use->pdo->entries) {
      if (mapped.object != nullptr && mapped.object->type != nullptr) add_object(row, *mapped.object, mapped.offset);
    }
  }

  void add_object(Row& row, const Entry& entry, unsigned first_bit) {
    auto range = values_of_type(*entry.type);
    if (!range || !used_.emplace(entry.index, entry.sub_index).second) return;
    limit(*range, entry, entry.type->kind);
    for (const CobIdUse& use : uses_) {
      if (!receives(use, *row.use)) continue;
      if (const Entry* const received = entry_at(*use.pdo, first_bit)) limit(*range, *received, entry.type->kind);
    }
    if (!is_less(range->low, range->high, entry.type->kind)) return;
    row.pdo.objects.push_back({entry.index, entry.sub_index, static_cast<std::uint8_t>((entry.type->bits + 7) / 8),
                               range->low, range->high - range->low});
  }

  static const Entry* entry_at(const Pdo& pdo, unsigned first_bit) {
    const auto at = std::ranges::find(pdo.entries, first_bit, &PdoEntry::offset);
    return at == pdo.entries.end() ? nullptr : at->object;
  }

  const NetworkNode& node_;
  const std::vector<CobIdUse>& uses_;
  const NetworkTiming& timing_;
  std::vector<Row> pdos_;
  std::set<std::pair<std::uint16_t, std::uint8_t>> used_;
};

}  // namespace

std::vector<ChangingPdo> changing_pdos(const NetworkNode& node, const std::vector<CobIdUse>& uses,
                                       const NetworkTiming& timing) {
  return ChangingPdoCollector{node, uses, timing}.collect();
}

}  // namespace edsc
