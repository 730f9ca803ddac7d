/// The same work with typed values and by hand, with masks and numbers, as pairs of functions: `typed_X` and `hand_X`.
/// bench/footprint/measure.py compares their bytes and instructions.
#include "twins.hpp"

using twins::Values;
using namespace canopen::literals;

void first();
void second();
void other();

namespace {

using canopen::from_raw;
using canopen::to_raw;

twins::word word_of(const Values& values) { return from_raw<twins::word>(values.word); }
twins::mode mode_of(const Values& values) { return from_raw<twins::mode>(values.mode); }
twins::temperature temperature_of(const Values& values) { return from_raw<twins::temperature>(values.temperature); }
twins::position position_of(const Values& values) { return from_raw<twins::position>(values.position); }

using Pdo = canopen::PdoLayout<twins::Typed<0x6041, twins::word>, twins::Typed<0x2001, twins::temperature>,
                               twins::Typed<0x6061, twins::mode>>;
using PdoByHand = canopen::PdoLayout<twins::Numbers<0x6041, std::uint16_t>, twins::Numbers<0x2001, std::int16_t>,
                                     twins::Numbers<0x6061, std::int8_t>>;

}  // namespace

extern "C" {

void typed_flag(Values& values) {
  if (word_of(values).fault()) first();
}
void hand_flag(Values& values) {
  if ((values.word & 0x0008) != 0) first();
}

void typed_two_flags(Values& values) {
  if (word_of(values).all(twins::word{}.ready(true).enabled(true))) first();
}
void hand_two_flags(Values& values) {
  if ((values.word & 0x0005) == 0x0005) first();
}

int typed_field(Values& values) { return word_of(values).zone(); }
int hand_field(Values& values) { return (values.word >> 4) & 0xF; }

void typed_modify(Values& values) { values.word = to_raw(word_of(values).enabled(true).halt(false)); }
void hand_modify(Values& values) { values.word = static_cast<std::uint16_t>((values.word | 0x0004) & ~0x0100); }

void typed_set_field(Values& values) { values.word = to_raw(word_of(values).zone(9)); }
void hand_set_field(Values& values) { values.word = static_cast<std::uint16_t>((values.word & ~0x00F0) | 0x0090); }

void typed_enumeration(Values& values) {
  switch (mode_of(values)) {
    case twins::mode::profile_position: return first();
    case twins::mode::homing: return second();
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

void typed_set_enumeration(Values& values) { values.mode = to_raw(twins::mode::homing); }
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

void typed_set_constant(Values& values) { values.temperature = to_raw(twins::temperature{21.5_degC}); }
void hand_set_constant(Values& values) { values.temperature = 215; }

void typed_add(Values& values) {
  values.temperature = to_raw(twins::temperature::clamped(temperature_of(values) + 0.5_K));
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
  Pdo::pack_into(frame, word_of(values), temperature_of(values), mode_of(values));
}
void hand_pack(Values& values, canopen::Frame& frame) {
  PdoByHand::pack_into(frame, values.word, values.temperature, values.mode);
}

void typed_unpack(Values& values, const canopen::Frame& frame) {
  values.word = to_raw(Pdo::get<0>(frame));
  values.temperature = to_raw(Pdo::get<1>(frame));
  values.mode = to_raw(Pdo::get<2>(frame));
}
void hand_unpack(Values& values, const canopen::Frame& frame) {
  values.word = PdoByHand::get<0>(frame);
  values.temperature = PdoByHand::get<1>(frame);
  values.mode = PdoByHand::get<2>(frame);
}

}  // extern "C"
