#include "device/types/shifted_types.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cstdlib>
#include <map>
#include <set>
#include <utility>

#include "device/objects/standard_objects.hpp"
#include "eds/number.hpp"

namespace edsc {
namespace {

/// Entries with an equal difference that are evidence, and the share of all entries that they must be.
constexpr std::size_t min_entries = 6;
constexpr std::size_t min_percent = 90;
/// Data types with an equal difference: a file may have one wrong type in many objects.
constexpr std::size_t min_types = 2;

class Comparison {
 public:
  explicit Comparison(const DataSheet& sheet) {
    for (const ObjectDescription& object : sheet.objects) {
      const StandardObject* const standard = find_standard_object(object.index);
      if (standard == nullptr) continue;
      const bool has_sub_objects = !object.sub_objects.empty();
      if (has_sub_objects == (standard->type == ObjectType::var)) continue;
      if (!has_sub_objects) add(object, object.index, 0);
      for (const SubObjectDescription& sub : object.sub_objects) add(sub, object.index, sub.sub_index);
    }
  }

  [[nodiscard]] std::optional<ShiftedTypes> result() const {
    const auto most = std::ranges::max_element(groups_, {}, [](const auto& one) { return one.second.count; });
    if (most == groups_.end() || most->first == 0) return std::nullopt;
    const Group& group = most->second;
    const bool is_systematic =
        group.count >= min_entries && group.count * 100 >= all_ * min_percent && group.types.size() >= min_types;
    if (!is_systematic) return std::nullopt;
    return ShiftedTypes{most->first, group.count, group.first};
  }

 private:
  struct Group {
    std::size_t count = 0;
    std::set<canopen::DataType> types;
    Position first;
  };

  void add(const EntryDescription& description, std::uint16_t index, std::uint8_t sub_index) {
    const auto code = number_of(description.data_type);
    const StandardEntry* const standard = find_standard_entry(index, sub_index);
    if (!code || *code > 0xFFFF || standard == nullptr || standard->may_differ) return;
    Group& group = groups_[static_cast<int>(*code) - static_cast<int>(standard->type)];
    if (group.count == 0) group.first = description.data_type.position;
    ++group.count;
    group.types.insert(standard->type);
    ++all_;
  }

  std::map<int, Group> groups_;  ///< by the difference of the codes
  std::size_t all_ = 0;
};

}  // namespace

std::optional<ShiftedTypes> find_shifted_types(const DataSheet& sheet) { return Comparison{sheet}.result(); }

void report_shifted_types(const DataSheet& sheet, Diagnostics& diagnostics) {
  const auto shifted = find_shifted_types(sheet);
  if (!shifted) return;
  diagnostics.error(
      "shifted-data-types", shifted->first,
      fmt::format("the data types of this file are {} too {}: those of {} entries of CiA 301 show it",
                  std::abs(shifted->difference), shifted->difference > 0 ? "high" : "low", shifted->count));
  const auto offer = [&](const EntryDescription& entry) {
    const auto code = number_of(entry.data_type);
    if (!code || *code > 0xFFFF || static_cast<int>(*code) <= shifted->difference) return;
    diagnostics.offer_value("shifted-data-types", entry.data_type.position,
                            fmt::format("0x{:04X}", static_cast<int>(*code) - shifted->difference),
                            fmt::format("all data types of the file are {} too {}", std::abs(shifted->difference),
                                        shifted->difference > 0 ? "high" : "low"));
  };
  for (const ObjectDescription& object : sheet.objects) {
    offer(object);
    for (const SubObjectDescription& sub : object.sub_objects) offer(sub);
  }
}

}  // namespace edsc
