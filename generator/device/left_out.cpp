#include "device/left_out.hpp"

#include <fmt/format.h>

#include <optional>
#include <string_view>
#include <utility>

#include "device/types/type_table.hpp"
#include "diagnostics/quote.hpp"

namespace edsc {
namespace {

class Comparison {
 public:
  Comparison(const DataSheet& sheet, const Device& device) : sheet_{sheet}, device_{device} {}

  std::vector<LeftOut> run() {
    for (const ObjectDescription& description : sheet_.objects) {
      if (description.index >= first_communication_index) compare(description);
    }
    for (const Pdo& pdo : device_.pdos) {
      if (!pdo.broken) continue;
      add(pdo.position, pdo.dynamic ? "the default mapping of " + pdo_label(pdo) : pdo_label(pdo));
    }
    return std::move(left_out_);
  }

 private:
  void compare(const ObjectDescription& description) {
    const Object* object = device_.find(description.index);
    if (object == nullptr) {
      return add(description.position,
                 fmt::format("{} {}", index_label(description.index), quote(description.parameter_name.text)));
    }
    if (!object->has_sub_indices()) compare_values(description, object->entries.front());
    for (const SubObjectDescription& sub : description.sub_objects) {
      const Entry* entry = object->has_sub_indices() ? object->find(sub.sub_index) : nullptr;
      if (entry != nullptr) {
        compare_values(sub, *entry);
      } else {
        add(sub.position,
            fmt::format("{} {}", entry_label(description.index, sub.sub_index), quote(sub.parameter_name.text)));
      }
    }
  }

  void compare_values(const EntryDescription& description, const Entry& entry) {
    const bool is_configured = sheet_.is_dcf && !description.parameter_value.empty();
    compare_value(is_configured ? "ParameterValue" : "DefaultValue",
                  is_configured ? description.parameter_value : description.default_value, entry.default_value, entry);
    compare_value("LowLimit", description.low_limit, entry.low_limit, entry);
    compare_value("HighLimit", description.high_limit, entry.high_limit, entry);
  }

  void compare_value(std::string_view key, const Field& field, const std::optional<Value>& value, const Entry& entry) {
    if (field.empty() || value) return;
    add(field.position,
        fmt::format("the {} of {} {}", key, entry_label(entry.index, entry.sub_index), quote(entry.name)));
  }

  void add(const Position& position, std::string what) { left_out_.push_back({position, std::move(what)}); }

  const DataSheet& sheet_;
  const Device& device_;
  std::vector<LeftOut> left_out_;
};

}  // namespace

std::vector<LeftOut> find_left_out(const DataSheet& sheet, const Device& device) {
  return Comparison{sheet, device}.run();
}

}  // namespace edsc
