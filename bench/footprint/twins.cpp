/// The same work with the typed values of a generated header and by hand, with masks and numbers, as pairs of
/// functions: `typed_X` and `hand_X`. bench/footprint/measure.py compares their bytes and instructions.
#include "twins.hpp"

using twins::Values;
using namespace canopen::literals;
namespace od = twins::od;

void first();
void second();
void other();

namespace {

using canopen::from_raw;
using canopen::to_raw;
using mode = od::modes_of_operation::value;

od::statusword::type status_of(const Values& values) { return from_raw<od::statusword::type>(values.status); }
od::controlword::type control_of(const Values& values) { return from_raw<od::controlword::type>(values.control); }
od::door::type door_of(const Values& values) { return from_raw<od::door::type>(values.door); }
od::modes_of_operation::type mode_of(const Values& values) {
  return from_raw<od::modes_of_operation::type>(values.mode);
}
od::temperature::type temperature_of(const Values& values) {
  return from_raw<od::temperature::type>(values.temperature);
}
od::target_position::type position_of(const Values& values) {
  return from_raw<od::target_position::type>(values.position);
}

using Pdo = canopen::PdoLayout<od::statusword, od::temperature, od::modes_of_operation_display>;
using PdoByHand = canopen::PdoLayout<twins::Numbers<0x6041, std::uint16_t>, twins::Numbers<0x2001, std::int16_t>,
                                     twins::Numbers<0x6061, std::int8_t>>;

}  // namespace

extern "C" {

void typed_flag(Values& values) {
  if (status_of(values).fault()) first();
}
void hand_flag(Values& values) {
  if ((values.status & 0x0008) != 0) first();
}

void typed_two_flags(Values& values) {
  if (status_of(values).all(od::statusword::type{}.ready_to_switch_on(true).operation_enabled(true))) first();
}
void hand_two_flags(Values& values) {
  if ((values.status & 0x0005) == 0x0005) first();
}

int typed_field(Values& values) { return door_of(values).zone(); }
int hand_field(Values& values) { return (values.door >> 4) & 0xF; }

void typed_modify(Values& values) { values.control = to_raw(control_of(values).quick_stop(true).halt(false)); }
void hand_modify(Values& values) { values.control = static_cast<std::uint16_t>((values.control | 0x0004) & ~0x0100); }

void typed_set_field(Values& values) { values.door = to_raw(door_of(values).zone(9)); }
void hand_set_field(Values& values) { values.door = static_cast<std::uint8_t>((values.door & ~0xF0) | 0x90); }

void typed_enumeration(Values& values) {
  switch (mode_of(values)) {
    case mode::profile_position: return first();
    case mode::homing: return second();
    default: return other();
  }
}
void hand_enumeration(Values& values) {
  switch (values.mode) {
    case 1: return first();
    case 6: return second();
    default: return other();
  }
}

void typed_set_enumeration(Values& values) { values.mode = to_raw(mode::homing); }
void hand_set_enumeration(Values& values) { values.mode = 6; }

void typed_compare(Values& values) {
  if (temperature_of(values) > 80_degC) first();
}
void hand_compare(Values& values) {
  if (values.temperature > 800) first();
}

void typed_compare_in_kelvin(Values& values) {
  if (temperature_of(values) < 300_K) first();
}
void hand_compare_in_kelvin(Values& values) {
  if (values.temperature <= 268) first();
}

void typed_set_constant(Values& values) { values.temperature = to_raw(od::temperature::type{21.5_degC}); }
void hand_set_constant(Values& values) { values.temperature = 215; }

void typed_add(Values& values) {
  values.temperature = to_raw(od::temperature::type::clamped(temperature_of(values) + 0.5_K));
}
void hand_add(Values& values) {
  const int sum = values.temperature + 5;
  values.temperature = static_cast<std::int16_t>(sum > 32'767 ? 32'767 : sum < -32'768 ? -32'768 : sum);
}

int typed_convert(Values& values) { return temperature_of(values).count<canopen::unit::kelvin>(); }
int hand_convert(Values& values) {
  const int tenths = values.temperature + 2'736;
  return (tenths >= 0 ? tenths : tenths - 9) / 10;
}

int typed_convert_wide(Values& values) { return static_cast<int>(position_of(values).count<canopen::unit::degree>()); }
int hand_convert_wide(Values& values) {
  const std::int64_t scaled = std::int64_t{values.position} * 9 + 125;
  return static_cast<int>((scaled >= 0 ? scaled : scaled - 249) / 250);
}

void typed_pack(Values& values, canopen::Frame& frame) {
  Pdo::pack_into(frame, status_of(values), temperature_of(values), mode_of(values));
}
void hand_pack(Values& values, canopen::Frame& frame) {
  PdoByHand::pack_into(frame, values.status, values.temperature, values.mode);
}

void typed_unpack(Values& values, const canopen::Frame& frame) {
  values.status = to_raw(Pdo::get<0>(frame));
  values.temperature = to_raw(Pdo::get<1>(frame));
  values.mode = to_raw(Pdo::get<2>(frame));
}
void hand_unpack(Values& values, const canopen::Frame& frame) {
  values.status = PdoByHand::get<0>(frame);
  values.temperature = PdoByHand::get<1>(frame);
  values.mode = PdoByHand::get<2>(frame);
}

}  // extern "C"
