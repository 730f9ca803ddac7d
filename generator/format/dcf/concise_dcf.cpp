#include "format/dcf/concise_dcf.hpp"

#include <algorithm>
#include <utility>

#include "device/index_range.hpp"
#include "device/pdo/fixed_mapping.hpp"
#include "format/dcf/configured_values.hpp"
#include "format/dcf/write_order.hpp"
#include "values/read_value.hpp"
#include "values/value_bytes.hpp"

namespace edsc {

namespace {

constexpr std::uint16_t verify_configuration = 0x1020;  // the device clears it when another value is written

/// Whether a ParameterValue only states the mapping that the device has: one that cannot be changed and has no
/// DefaultValue, such as that of a compact form.
bool is_of_device(const DataSheet& sheet, const Device& device, const Entry& entry) {
  if (!is_of_fixed_mapping(device, entry)) return false;
  const ValueFields fields = sheet.values_of(*sheet.find(entry.index), entry.sub_index, true);
  return fields.default_value == nullptr || fields.default_value->empty();
}

/// The values to write, with those that belong to a different one.
std::vector<WriteValue> values_to_write(const DataSheet& sheet, const Device& device, Diagnostics& diagnostics) {
  std::vector<WriteValue> values;
  std::vector<bool> differs;
  for (const ConfiguredValue& value : configured_values(sheet, device, diagnostics)) {
    const Entry& entry = *value.entry;
    if (contains(command_objects, entry.index) || is_of_device(sheet, device, entry)) continue;
    values.push_back(
        {entry.index, entry.sub_index, {value.data.begin(), value.data.end()}, entry.index == verify_configuration});
    differs.push_back(value.differs);
  }
  const std::vector<bool> wanted = with_dependent_values(values, differs);
  std::vector<WriteValue> chosen;
  for (std::size_t i = 0; i < values.size(); ++i) {
    if (wanted[i]) chosen.push_back(std::move(values[i]));
  }
  return chosen;
}

/// Writes the steps for a device that has the default values of its EDS.
class ConciseStream {
 public:
  ConciseStream(const DataSheet& sheet, const Device& device) : sheet_{sheet}, device_{device} {}

  [[nodiscard]] std::string write(const std::vector<WriteStep>& steps) {
    for (const WriteStep& step : steps) write(step);
    std::string stream;
    append_bytes(stream, count_, 4);
    return stream + entries_;
  }

 private:
  void write(const WriteStep& step) {
    const auto before = default_of(step.index, step.sub_index);
    switch (step.kind) {
      case StepKind::write: return add(step, step.bytes);
      case StepKind::switch_off: {
        const std::uint64_t cob_id = before.value_or(step.value != nullptr ? number_of(step.bytes) : 0);
        return add(step, (cob_id | step.off_set) & ~std::uint64_t{step.off_cleared});
      }
      case StepKind::switch_on:
        if (step.value != nullptr) return add(step, step.bytes);
        if (before) add(step, *before);
        return;
      case StepKind::clear: return add(step, 0);
      case StepKind::restore: {
        const std::uint64_t least = number_of(step.bytes);
        return add(step, std::max(before.value_or(0), least));
      }
    }
  }

  /// DefaultValue for this node; of a DCF the device has the ParameterValue in its place.
  [[nodiscard]] std::optional<std::uint64_t> default_of(std::uint16_t index, std::uint8_t sub_index) const {
    const Object* const object = device_.find(index);
    const Entry* const entry = device_.find(index, sub_index);
    const ObjectDescription* const description = sheet_.find(index);
    if (entry == nullptr || description == nullptr) return std::nullopt;
    const ValueFields fields = sheet_.values_of(*description, sub_index, object->has_sub_indices());
    if (fields.default_value == nullptr) return std::nullopt;
    Diagnostics ignored;
    const auto value = parse_value(*fields.default_value, *entry->type, device_.node_id, ignored);
    return value ? std::optional{value->bits} : std::nullopt;
  }

  /// A number in the length of the entry.
  void add(const WriteStep& step, std::uint64_t number) {
    const Entry* const entry = device_.find(step.index, step.sub_index);
    if (entry == nullptr) return;
    std::vector<std::uint8_t> bytes(entry->type->bits / 8U);
    for (std::uint8_t& byte : bytes) {
      byte = static_cast<std::uint8_t>(number);
      number >>= 8;
    }
    add(step, bytes);
  }

  void add(const WriteStep& step, const std::vector<std::uint8_t>& bytes) {
    ++count_;
    append_bytes(entries_, step.index, 2);
    append_bytes(entries_, step.sub_index, 1);
    append_bytes(entries_, bytes.size(), 4);
    entries_.append(bytes.begin(), bytes.end());
  }

  const DataSheet& sheet_;
  const Device& device_;
  std::uint32_t count_ = 0;
  std::string entries_;
};

}  // namespace

std::string concise_dcf(const DataSheet& sheet, const Device& device, Diagnostics& diagnostics) {
  const std::vector<WriteValue> values = values_to_write(sheet, device, diagnostics);
  return ConciseStream{sheet, device}.write(order_writes(values, &device));
}

std::optional<std::vector<ConciseEntry>> read_concise_dcf(std::string_view stream) {
  const auto number = [&stream](unsigned count) {
    std::uint64_t value = 0;
    for (unsigned i = count; i-- > 0;) value = value << 8 | static_cast<std::uint8_t>(stream[i]);
    stream.remove_prefix(count);
    return value;
  };
  constexpr std::size_t head = 7;
  if (stream.size() < 4) return std::nullopt;
  std::vector<ConciseEntry> entries;
  for (std::uint64_t left = number(4); left > 0; --left) {
    if (stream.size() < head) return std::nullopt;
    ConciseEntry entry;
    entry.index = static_cast<std::uint16_t>(number(2));
    entry.sub_index = static_cast<std::uint8_t>(number(1));
    const std::uint64_t size = number(4);
    if (stream.size() < size) return std::nullopt;
    entry.data = stream.substr(0, size);
    stream.remove_prefix(size);
    entries.push_back(entry);
  }
  if (!stream.empty()) return std::nullopt;
  return entries;
}

}  // namespace edsc
