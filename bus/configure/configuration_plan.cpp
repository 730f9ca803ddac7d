#include "configure/configuration_plan.hpp"

#include <algorithm>
#include <array>
#include <cctype>
#include <span>
#include <string>
#include <string_view>
#include <utility>

#include "device/index_range.hpp"

namespace edsc {
namespace {

/// Objects that are not written, in addition to `command_objects`: 1020h is written at the end, and the other objects
/// of a program download are commands too.
constexpr std::array not_written = {IndexRange{0x1020, 0x1020}, IndexRange{0x1F50, 0x1F5A}};

WriteValue write_value(const ConfigurationValue& value) {
  return {value.entry.index, value.entry.sub_index, value.bytes, sets_node_id_or_bit_rate(value.entry)};
}

std::size_t index_in(const std::vector<WriteValue>& values, const WriteValue& value) {
  return static_cast<std::size_t>(&value - values.data());
}

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
  const std::string words = words_of(entry.name + " " + entry.entry->parameter_name());
  std::string squashed = words;  // `CAN bit rate`, `CanBitRate` and `CAN_Bitrate` are equal
  std::erase(squashed, ' ');
  const bool named = contains_one_of(squashed, commissioning_names) || contains_one_of(words, commissioning_words);
  return named && !contains_one_of(words, other_words);
}

bool has_effect(const ConfigurationValue& value, const std::vector<ConfigurationValue>& values) {
  if (!contains(mapping_parameters, value.entry.index) || value.entry.sub_index == 0) return true;
  const auto count = std::ranges::find_if(values, [&](const ConfigurationValue& other) {
    return other.entry.index == value.entry.index && other.entry.sub_index == 0;
  });
  return count == values.end() || count->bytes.empty() || value.entry.sub_index <= count->bytes.front();
}

std::vector<ConfigurationValue> values_to_write(const std::vector<ConfigurationValue>& values,
                                                const std::vector<bool>& differs) {
  std::vector<WriteValue> writes;
  writes.reserve(values.size());
  for (const ConfigurationValue& value : values) writes.push_back(write_value(value));
  const std::vector<bool> wanted = with_dependent_values(writes, differs);
  std::vector<ConfigurationValue> chosen;
  for (std::size_t i = 0; i < values.size(); ++i) {
    if (wanted[i]) chosen.push_back(values[i]);
  }
  return chosen;
}

bool is_left_out(const LiveEntry& entry) {
  constexpr std::uint32_t no_write = 1;
  if (entry.entry != nullptr && (entry.entry->obj_flags & no_write) != 0) return true;
  return contains(command_objects, entry.index) || contains(not_written, entry.index);
}

std::vector<ConfigurationStep> plan_configuration(const std::vector<ConfigurationValue>& values, const Device* device) {
  std::vector<const ConfigurationValue*> written;
  std::vector<WriteValue> writes;
  for (const ConfigurationValue& value : values) {
    if (is_left_out(value.entry)) continue;
    written.push_back(&value);
    writes.push_back(write_value(value));
  }
  std::vector<ConfigurationStep> steps;
  for (WriteStep& write : order_writes(writes, device)) {
    const ConfigurationValue* const value = write.value != nullptr ? written[index_in(writes, *write.value)] : nullptr;
    const LiveEntry entry = value != nullptr ? value->entry : live_entry(device, write.index, write.sub_index);
    steps.push_back({write.kind, entry, value, std::move(write.bytes), write.off_set, write.off_cleared, write.group});
  }
  return steps;
}

}  // namespace edsc
