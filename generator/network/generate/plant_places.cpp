#include "network/generate/plant_places.hpp"

#include <algorithm>
#include <map>
#include <utility>

#include "diagnostics/place.hpp"
#include "format/dcf/concise_dcf.hpp"
#include "format/dcf/configured_values.hpp"
#include "network/communication_objects.hpp"
#include "system/path.hpp"

namespace edsc {
namespace {

using Key = std::pair<std::uint16_t, std::uint8_t>;

/// A number that is compared with the node, and the list of the master that may state it (CiA 302-2).
struct ComparedNumber {
  std::uint16_t list;
  std::uint16_t index;
  std::uint8_t sub_index;
};

constexpr ComparedNumber compared_numbers[] = {
    {0x1F84, 0x1000, 0},
    {0x1F85, communication::identity, 1},
    {0x1F86, communication::identity, 2},
    {0x1F87, communication::identity, 3},
    {0x1F88, communication::identity, 4},
};

class PlantPlaces {
 public:
  PlantPlaces(const Network& network, const NetworkNode& node) : network_{network}, node_{node} {}

  std::vector<PlantPlaceRow> make(const std::string& concise_dcf) {
    add({}, node_.position);
    for (const ComparedNumber& number : compared_numbers)
      add({number.index, number.sub_index}, place_of_number(number));
    const std::map<Key, Position> values = places_of_values();
    const auto entries = read_concise_dcf(concise_dcf);
    if (!entries) return std::move(rows_);
    for (const ConciseEntry& entry : *entries) {
      const auto at = values.find({entry.index, entry.sub_index});
      add({entry.index, entry.sub_index},
          at != values.end() ? at->second : place_of_value(node_.device(), entry.index, entry.sub_index));
    }
    return std::move(rows_);
  }

 private:
  [[nodiscard]] Position place_of_number(const ComparedNumber& number) const {
    const NetworkNode* const master = network_.master();
    if (master != nullptr && master->has_file() &&
        value_of(master->device(), number.list, node_.node_id).value_or(0) != 0)
      return place_of_value(master->device(), number.list, node_.node_id);
    const bool is_serial_number = number.list == 0x1F88;
    const WrittenNumber& serial_number = node_.description->serial_number;
    if (is_serial_number && serial_number) return serial_number->position;
    return place_of_value(node_.device(), number.index, number.sub_index);
  }

  /// Of the ParameterValues of a DCF and of the settings of the network file, which replace them.
  [[nodiscard]] std::map<Key, Position> places_of_values() const {
    std::map<Key, Position> places;
    Diagnostics ignored;
    for (const ConfiguredValue& value : configured_values(node_.loaded->sheet, node_.device(), ignored)) {
      places[{value.entry->index, value.entry->sub_index}] = value.position;
    }
    for (const Setting& setting : node_.settings) places[{setting.index, setting.sub_index}] = setting.value.position;
    return places;
  }

  void add(Key key, const Position& position) {
    const std::string file = file_text(position.file);
    if (!file.empty()) rows_.push_back({key.first, key.second, file, place_of(position).line});
  }

  /// As the network file names it, so that the header does not depend on the folder of the build.
  [[nodiscard]] std::string file_text(const SourceFile* file) const {
    if (file == nullptr) return {};
    if (file == network_.source.get()) return std::string{file_name_of(file->name())};
    for (const NetworkNode& one : network_.nodes) {
      if (!one.has_file() || one.loaded->source.get() != file) continue;
      return one.description->dcf ? one.description->dcf->value : one.description->eds->value;
    }
    return {};
  }

  const Network& network_;
  const NetworkNode& node_;
  std::vector<PlantPlaceRow> rows_;
};

}  // namespace

std::vector<PlantPlaceRow> plant_places(const Network& network, const NetworkNode& node,
                                        const std::string& concise_dcf) {
  return PlantPlaces{network, node}.make(concise_dcf);
}

}  // namespace edsc
