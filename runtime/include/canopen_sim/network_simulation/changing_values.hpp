/// Values that change in intervals, in the place of the application of a simulated node. Host side.
#pragma once

#include <algorithm>
#include <array>
#include <cstddef>
#include <cstdint>
#include <random>
#include <span>
#include <vector>

#include "canopen/base/bytes.hpp"
#include "canopen_sim/network_simulation/network_plan.hpp"

namespace canopen::network_simulation {

/// Times are those of VirtualBus::elapsed().
class ChangingValues {
 public:
  static constexpr std::uint64_t never = UINT64_MAX;

  ChangingValues(std::span<const PlannedChange> changes, std::uint32_t seed) : random_{seed} {
    for (const PlannedChange& change : changes) {
      rows_.push_back({&change, never, 0, std::vector<std::uint64_t>(change.objects.size())});
    }
  }

  /// Begins at an interval after `now`.
  void start(std::uint64_t now) {
    for (Row& row : rows_) row.due = now + interval(*row.change);
  }
  void stop() {
    for (Row& row : rows_) row.due = never;
  }

  [[nodiscard]] std::uint64_t due() const {
    std::uint64_t first = never;
    for (const Row& row : rows_) first = std::min(first, row.due);
    return first;
  }

  void serve(SimulatedNode& node, std::uint64_t now) {
    for (Row& row : rows_) {
      if (row.due > now) continue;
      row.due += interval(*row.change);
      if (change(row, node)) ++row.count;
    }
  }

  /// Calls `visit(PlannedChange, number of changes)`.
  template <class Visit>
  void for_each(Visit&& visit) const {
    for (const Row& row : rows_) visit(*row.change, row.count);
  }

 private:
  struct Row {
    const PlannedChange* change;
    std::uint64_t due;
    std::uint64_t count;
    std::vector<std::uint64_t> last;  ///< offset to `low` of each object
  };

  [[nodiscard]] std::uint64_t interval(const PlannedChange& change) {
    return change.interval + (change.varies ? random_() % (change.interval / 8 + 1) : 0);
  }

  /// Whether an object has a new value. One that the node rejects keeps its value.
  bool change(Row& row, SimulatedNode& node) {
    bool is_changed = false;
    for (std::size_t i = 0; i < row.last.size(); ++i) {
      const PlannedObject& object = row.change->objects[i];
      std::uint64_t offset = random_();
      if (object.range != UINT64_MAX) offset %= object.range + 1;
      if (offset == row.last[i]) offset = offset == object.range ? 0 : offset + 1;
      row.last[i] = offset;
      std::array<std::uint8_t, 8> bytes{};
      for (std::size_t byte = 0; byte < bytes.size(); ++byte) {
        bytes[byte] = static_cast<std::uint8_t>((object.low + offset) >> (8 * byte));
      }
      is_changed |= node.set(object.index, object.sub_index, std::span{bytes}.first(object.bytes)) == ok;
    }
    return is_changed;
  }

  std::vector<Row> rows_;
  std::mt19937_64 random_;
};

}  // namespace canopen::network_simulation
