#include "audit/node_settings.hpp"

#include <canopen/nmt/nmt.hpp>

namespace edsc::audit {
namespace {

constexpr std::int64_t per_millisecond = 1000;  ///< microseconds

void read_tpdos(const NodeModel& model, NodeSettings& settings) {
  for (const PdoLayout& pdo : model.pdos()) {
    if (pdo.direction != PdoDirection::transmit) continue;
    const std::uint16_t index = parameters_of(PdoDirection::transmit, pdo.number).communication;
    if (settings.tpdos.size() < pdo.number) settings.tpdos.resize(pdo.number);
    TpdoSettings& tpdo = settings.tpdos[pdo.number - 1U];
    tpdo.is_sent = pdo.cob_id.valid() && pdo.bits > 0;
    tpdo.transmission_type = static_cast<std::uint8_t>(model.parameter(index, 2).value_or(255));
    tpdo.inhibit_us = std::int64_t{model.parameter(index, 3).value_or(0)} * model.inhibit_time_unit();
    tpdo.event_us = model.parameter(index, 5).value_or(0) * per_millisecond;
  }
}

void read_consumed(const NodeModel& model, NodeSettings& settings) {
  const Object* const object = model.device().find(0x1016);
  if (object == nullptr) return;
  for (const Entry& entry : object->entries) {
    if (entry.sub_index == 0) continue;
    const std::uint32_t value = model.parameter(0x1016, entry.sub_index).value_or(0);
    const std::int64_t us = (value & 0xFFFF) * per_millisecond;
    const std::uint32_t producer = value >> 16 & 0xFF;
    if (producer == 0 || producer > 127 || us == 0) continue;
    settings.consumed.push_back({entry.sub_index, static_cast<std::uint8_t>(producer), us});
  }
}

}  // namespace

NodeSettings settings_of(const NodeModel& model) {
  constexpr std::uint32_t produces = 1U << 30;
  NodeSettings settings;
  settings.heartbeat_us = model.parameter(0x1017, 0).value_or(0) * per_millisecond;
  read_consumed(model, settings);
  settings.sync_id = model.sync().value();
  settings.is_sync_producer = (model.parameter(0x1005, 0).value_or(0) & produces) != 0;
  settings.sync_period_us = model.parameter(0x1006, 0).value_or(0);
  settings.sync_window_us = model.parameter(0x1007, 0).value_or(0);
  if (const auto overflow = model.parameter(0x1019, 0)) settings.sync_overflow = static_cast<std::uint8_t>(*overflow);
  settings.emcy_id = model.emcy().value();
  settings.emcy_inhibit_us = std::int64_t{model.parameter(0x1015, 0).value_or(0)} * usual_inhibit_time_unit;
  const auto start_up = model.parameter(0x1F80, 0);
  settings.starts_itself = start_up && (*start_up & canopen::nmt_start_up::no_self_start) == 0;
  settings.is_nmt_master = start_up && (*start_up & canopen::nmt_start_up::master) != 0;
  read_tpdos(model, settings);
  return settings;
}

}  // namespace edsc::audit
