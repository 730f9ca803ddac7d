#include "accept/dictionary_reader.hpp"

#include <algorithm>
#include <canopen/base/abort_code.hpp>
#include <canopen/sdo/sdo_transfer.hpp>

#include "conform/cases/shared/entry_values.hpp"
#include "device/index_range.hpp"
#include "device/objects/standard_objects.hpp"
#include "values/little_endian.hpp"

namespace edsc::accept {
namespace {

using canopen::AbortCode;

/// The maximum number of frames of one transfer. The size and the abort are in the first frames.
constexpr std::size_t max_frames = 40;
/// Enough to show that an entry exists.
constexpr std::size_t first_bytes = 8;

bool is_missing_code(AbortCode code) { return code == AbortCode::no_object || code == AbortCode::no_sub_index; }

/// The highest sub-index that the device states. Sub-index 0 of the error history counts errors, and sub-index 0 of a
/// mapping parameter mapped objects, or states a multiplex PDO.
std::uint8_t stated_highest(const Readings& readings, const Object& object) {
  const auto found = readings.find({object.index, 0});
  if (found == readings.end() || !found->second.outcome.done()) return 0;
  const std::uint64_t stated = number_of(found->second.outcome.bytes);
  const std::uint64_t max = contains(mapping_parameters, object.index) ? 64 : 254;
  return object.index == conform::error_history || stated > max ? 0 : static_cast<std::uint8_t>(stated);
}

}  // namespace

bool Reading::exists() const {
  if (!was_read) return false;
  if (outcome.end == SdoEnd::refused) return !is_missing_code(outcome.code);
  return outcome.done() || (outcome.end == SdoEnd::broken && outcome.max_bytes != 0);
}

bool Reading::is_missing() const { return was_read && outcome.end == SdoEnd::refused && is_missing_code(outcome.code); }

DictionaryReader::DictionaryReader(LiveBus& bus, const Device& sheet, canopen::NodeId node, SdoSettings settings)
    : CaseFrames{bus}, sheet_{sheet}, node_{node}, sdo_{bus, node, settings} {}

/// Reads only the beginning of a DOMAIN, of an entry that the EDS does not have, and of a string that it does not
/// declare readable.
SdoOutcome DictionaryReader::upload(const LiveEntry& entry) {
  const bool has_length = entry.type != nullptr && entry.type->bits != 0;
  if (has_length || (conform::is_readable(entry) && !conform::is_domain(entry))) return edsc::upload(sdo_, entry);
  return sdo_.upload(entry.index, entry.sub_index, SdoTransfer::segmented, {}, first_bytes);
}

void DictionaryReader::read(Reading& reading) {
  clear_frames();
  reading.was_read = true;
  reading.outcome = upload(reading.entry);
  silent_ = reading.outcome.end == SdoEnd::no_answer ? silent_ + 1 : 0;
}

void DictionaryReader::read_again(Reading& reading) {
  read(reading);
  const canopen::SdoChannel sdo = canopen::default_sdo(node_);
  reading.frames.clear();
  for (const conform::SeenFrame& seen : frames()) {
    const bool of_transfer = with_id(sdo.request.can_id())(seen.frame) || with_id(sdo.response.can_id())(seen.frame);
    if (of_transfer && reading.frames.size() < max_frames) reading.frames.push_back(seen);
  }
}

void DictionaryReader::read_missing(Readings& readings, std::uint16_t index, std::uint8_t sub_index) {
  if (lost() || readings.contains({index, sub_index})) return;
  Reading reading;
  reading.entry = live_entry(nullptr, index, sub_index);
  read(reading);
  readings.emplace(EntryKey{index, sub_index}, std::move(reading));
}

void DictionaryReader::read_object(Readings& readings, const Object& object) {
  for (const Entry& entry : object.entries) {
    if (lost()) return;
    Reading reading;
    reading.entry = live_entry(sheet_, object, entry);
    if (entry.stated_type != nullptr) reading.entry.type = entry.stated_type;  // the file is compared as it is
    if ((conform::flags_of(sheet_, reading.entry) & conform::refuse_read_flag) != 0) {
      reading.why_not = "ObjFlags exclude it from reads";
    } else {
      read(reading);
    }
    readings.emplace(EntryKey{entry.index, entry.sub_index}, std::move(reading));
  }
  if (!object.has_sub_indices()) return;
  read_missing(readings, object.index, 0);
  for (unsigned sub_index = 1; sub_index <= stated_highest(readings, object); ++sub_index) {
    read_missing(readings, object.index, static_cast<std::uint8_t>(sub_index));
  }
}

Readings DictionaryReader::read_all(const Progress& progress) {
  Readings readings;
  for (std::size_t i = 0; i != sheet_.objects.size() && !lost(); ++i) {
    progress(i, sheet_.objects.size());
    read_object(readings, sheet_.objects[i]);
  }
  for (const std::uint16_t index : required_objects) {
    read_missing(readings, index, 0);
    const StandardObject& standard = *find_standard_object(index);
    for (const StandardEntry& row : standard.entries) {
      if (row.required) read_missing(readings, index, row.first);
    }
  }
  return readings;
}

}  // namespace edsc::accept
