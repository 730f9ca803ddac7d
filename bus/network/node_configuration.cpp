#include "network/node_configuration.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <map>
#include <tuple>
#include <utility>

#include "device/pdo/pdo_defaults.hpp"
#include "network/communication_objects.hpp"
#include "values/value_bytes.hpp"

namespace edsc {
namespace {

/// The values by index and sub-index, each once.
class NodeValues {
 public:
  explicit NodeValues(const NetworkNode& node) : node_{node} {}

  void set(ConfigurationValue value) {
    const Key key{value.entry.index, value.entry.sub_index};
    values_.insert_or_assign(key, std::move(value));
  }

  void set(std::uint16_t index, std::uint8_t sub_index, const Value& value) {
    const Entry* const entry = node_.device().find(index, sub_index);
    if (entry == nullptr) return;
    const std::string bytes = bytes_of(value, *entry->type);
    set({live_entry(&node_.device(), index, sub_index), {bytes.begin(), bytes.end()}, value.position});
  }

  /// The default value of a writable entry, unless it has a value.
  void add_default(const Entry& entry) {
    if (values_.contains({entry.index, entry.sub_index}) || !canopen::writable(entry.access)) return;
    if (!entry.default_value || entry.default_value->plus_node_id) return;
    set(entry.index, entry.sub_index, *entry.default_value);
  }

  void add_pdo(const Pdo& pdo) {
    if (pdo.communication != nullptr) add_defaults(*pdo.communication, last_communication_sub_index);
    if (pdo.mapping == nullptr || pdo.multiplexed) return;
    const auto count = static_cast<std::uint8_t>(pdo.entries.size());
    add_defaults(*pdo.mapping, count);
  }

  [[nodiscard]] bool has_one_of(const Object* object) const {
    if (object == nullptr) return false;
    const auto at = values_.lower_bound({object->index, std::uint8_t{0}});
    return at != values_.end() && at->first.first == object->index;
  }

  [[nodiscard]] std::vector<ConfigurationValue> take() {
    std::vector<ConfigurationValue> values;
    for (auto& [key, value] : values_) values.push_back(std::move(value));
    return values;
  }

 private:
  using Key = std::pair<std::uint16_t, std::uint8_t>;

  static constexpr std::uint8_t last_communication_sub_index = 6;

  void add_defaults(const Object& object, std::uint8_t last_sub_index) {
    for (const Entry& entry : object.entries) {
      const bool is_count = entry.sub_index == 0;
      if (entry.sub_index <= last_sub_index && (!is_count || canopen::writable(entry.access))) add_default(entry);
    }
  }

  const NetworkNode& node_;
  std::map<Key, ConfigurationValue> values_;
};

}  // namespace

std::set<const Pdo*> linked_pdos(const Network& network) {
  using Key = std::pair<std::uint32_t, bool>;
  std::map<Key, std::vector<CobIdUse>> uses;
  for (CobIdUse& use : cob_id_uses(network)) {
    if (use.service == FrameService::pdo && use.pdo != nullptr) uses[{use.can_id, use.extended}].push_back(use);
  }
  std::set<const Pdo*> linked;
  for (const auto& [key, users] : uses) {
    const bool is_sent = std::ranges::any_of(users, &CobIdUse::transmits);
    const bool is_received = !std::ranges::all_of(users, &CobIdUse::transmits);
    if (!is_sent || !is_received) continue;
    for (const CobIdUse& use : users) linked.insert(use.pdo);
  }
  return linked;
}

Configuration configuration_of(const Network& network, const NetworkNode& node, const std::set<const Pdo*>& linked,
                               Diagnostics& diagnostics) {
  const bool is_dcf = node.loaded->sheet.is_dcf;
  Diagnostics ignored;  // the ParameterValues of an EDS have no meaning
  Configuration configuration = configuration_of(node.loaded->sheet, node.device(), is_dcf ? diagnostics : ignored);
  NodeValues values{node};
  if (is_dcf) {
    for (ConfigurationValue& value : configuration.values) values.set(std::move(value));
  } else {
    configuration.left_out = 0;
  }
  for (const Setting& setting : node.settings) values.set(setting.index, setting.sub_index, setting.value);
  for (const Pdo& pdo : node.device().pdos) {
    if (linked.contains(&pdo) || values.has_one_of(pdo.communication) || values.has_one_of(pdo.mapping)) {
      values.add_pdo(pdo);
    }
  }
  if (const Entry* const sync = node.device().find(communication::cob_id_sync, 0);
      sync != nullptr && network.description.sync.producer) {
    values.add_default(*sync);
  }
  configuration.values = values.take();
  configuration.left_out +=
      std::erase_if(configuration.values, [](const ConfigurationValue& value) { return is_left_out(value.entry); });
  if (configuration.values.empty()) configuration.time.reset();
  return configuration;
}

Identity expected_identity(const NetworkNode& node) {
  Identity identity = identity_of(node.device());
  if (const WrittenNumber& serial_number = node.description->serial_number) {
    identity.serial_number = serial_number->value != 0 ? std::optional{serial_number->value} : std::nullopt;
  }
  return identity;
}

Position place_of_difference(const NetworkNode& node, const Identity& expected, const Identity& found) {
  const auto at = std::ranges::find_if(identity_numbers, [&](const IdentityNumber& number) {
    const auto& wanted = expected.*number.value;
    const auto& other = found.*number.value;
    return wanted && other && *wanted != *other;
  });
  if (at == std::ranges::end(identity_numbers)) return node.position;
  const WrittenNumber& serial_number = node.description->serial_number;
  if (at->value == &Identity::serial_number && serial_number) return serial_number->position;
  const bool has_entry = node.device().find(at->index, at->sub_index) != nullptr;
  return has_entry ? place_of_value(node.device(), at->index, at->sub_index) : node.position;
}

std::string label(const NetworkNode& node) { return fmt::format("node {} ({})", node.name, node.node_id); }

const std::string& file_of(const NetworkNode& node) {
  return node.description->dcf ? node.description->dcf->value : node.description->eds->value;
}

}  // namespace edsc
