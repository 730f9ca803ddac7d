/// Units of physical values: a closed table of SI units and of those that are usual in drives and I/O devices.
#pragma once

#include <cstddef>
#include <cstdint>
#include <string_view>

#include "canopen/base/fraction.hpp"

namespace canopen {

/// Units of one dimension can be converted. Increments have dimensions of their own: their length or angle depends on
/// the device.
enum class Dimension : std::uint8_t {
  time,
  length,
  angle,
  rotational_speed,
  speed,
  rotational_acceleration,
  acceleration,
  rotational_jerk,
  jerk,
  increments,
  increment_rate,
  increment_acceleration,
  increment_jerk,
  increment_resolution,
  temperature,
  voltage,
  current,
  power,
  apparent_power,
  energy,
  force,
  torque,
  mass,
  moment_of_inertia,
  pressure,
  frequency,
  resistance,
  conductance,
  capacitance,
  inductance,
  charge,
  ratio,
  volume,
  volume_flow,
  mass_flow,
  information,
  data_rate,
};

/// A unit. value in the base unit of the dimension = value in this unit * factor + offset.
struct UnitRow {
  std::string_view name;     ///< of the type in canopen::unit: "degree_celsius"
  std::string_view literal;  ///< suffix of literals, after an underscore: "degC"
  std::string_view symbol;   ///< UTF-8: "°C"
  std::string_view ascii;    ///< "degC"
  Dimension dimension;
  Fraction factor;  ///< to the base unit
  Fraction offset;  ///< in the base unit
  /// False for units of the radian. Their factor, 1 / (2 pi), is rounded to 16 digits. Among themselves, they are
  /// exact.
  bool is_exact;
  std::string_view other_spellings;  ///< accepted; separated by `;`, may be empty
};

// clang-format off
// One row for each unit: name, literal, symbol, ASCII spelling, dimension, factor (numerator, denominator), offset
// (numerator, denominator), whether the factor is exact, and other accepted spellings. The base units of angles and
// rotational speeds are the revolution and the revolution per second, so that degrees and increments are exact.
#define CANOPEN_UNITS(Row) \
  Row(second,                           s,          "s",      "s",        time,                    1,          1,             0,     1,   true, "sec") \
  Row(millisecond,                      ms,         "ms",     "ms",       time,                    1,          1000,          0,     1,   true, "msec") \
  Row(microsecond,                      us,         "µs",     "us",       time,                    1,          1000000,       0,     1,   true, "μs;usec") \
  Row(nanosecond,                       ns,         "ns",     "ns",       time,                    1,          1000000000,    0,     1,   true, "") \
  Row(minute,                           min,        "min",    "min",      time,                    60,         1,             0,     1,   true, "") \
  Row(hour,                             h,          "h",      "h",        time,                    3600,       1,             0,     1,   true, "") \
  Row(day,                              d,          "d",      "d",        time,                    86400,      1,             0,     1,   true, "") \
  Row(metre,                            m,          "m",      "m",        length,                  1,          1,             0,     1,   true, "") \
  Row(kilometre,                        km,         "km",     "km",       length,                  1000,       1,             0,     1,   true, "") \
  Row(centimetre,                       cm,         "cm",     "cm",       length,                  1,          100,           0,     1,   true, "") \
  Row(millimetre,                       mm,         "mm",     "mm",       length,                  1,          1000,          0,     1,   true, "") \
  Row(micrometre,                       um,         "µm",     "um",       length,                  1,          1000000,       0,     1,   true, "μm") \
  Row(nanometre,                        nm,         "nm",     "nm",       length,                  1,          1000000000,    0,     1,   true, "") \
  Row(inch,                             inch,       "in",     "in",       length,                  127,        5000,          0,     1,   true, "inch") \
  Row(revolution,                       rev,        "rev",    "rev",      angle,                   1,          1,             0,     1,   true, "turn") \
  Row(degree,                           deg,        "°",      "deg",      angle,                   1,          360,           0,     1,   true, "º") \
  Row(radian,                           rad,        "rad",    "rad",      angle,                   78256779,   491701844,     0,     1,   false, "") \
  Row(milliradian,                      mrad,       "mrad",   "mrad",     angle,                   78256779,   491701844000,  0,     1,   false, "") \
  Row(revolution_per_second,            rev_per_s,  "rev/s",  "rev/s",    rotational_speed,        1,          1,             0,     1,   true, "rps;RPS;r/s;1/s;s-1") \
  Row(revolution_per_minute,            rpm,        "rpm",    "rpm",      rotational_speed,        1,          60,            0,     1,   true, "1/min;min-1;min^-1;min⁻¹;rev/min;r/min;RPM;U/min") \
  Row(degree_per_second,                deg_per_s,  "°/s",    "deg/s",    rotational_speed,        1,          360,           0,     1,   true, "") \
  Row(radian_per_second,                rad_per_s,  "rad/s",  "rad/s",    rotational_speed,        78256779,   491701844,     0,     1,   false, "") \
  Row(metre_per_second,                 m_per_s,    "m/s",    "m/s",      speed,                   1,          1,             0,     1,   true, "") \
  Row(metre_per_minute,                 m_per_min,  "m/min",  "m/min",    speed,                   1,          60,            0,     1,   true, "") \
  Row(kilometre_per_hour,               km_per_h,   "km/h",   "km/h",     speed,                   5,          18,            0,     1,   true, "") \
  Row(millimetre_per_second,            mm_per_s,   "mm/s",   "mm/s",     speed,                   1,          1000,          0,     1,   true, "") \
  Row(millimetre_per_minute,            mm_per_min, "mm/min", "mm/min",   speed,                   1,          60000,         0,     1,   true, "") \
  Row(micrometre_per_second,            um_per_s,   "µm/s",   "um/s",     speed,                   1,          1000000,       0,     1,   true, "μm/s") \
  Row(revolution_per_second_squared,    rev_per_s2, "rev/s²", "rev/s2",   rotational_acceleration, 1,          1,             0,     1,   true, "rev/s^2;r/s2;RPS^2") \
  Row(revolution_per_minute_per_second, rpm_per_s,  "rpm/s",  "rpm/s",    rotational_acceleration, 1,          60,            0,     1,   true, "") \
  Row(degree_per_second_squared,        deg_per_s2, "°/s²",   "deg/s2",   rotational_acceleration, 1,          360,           0,     1,   true, "deg/s^2") \
  Row(radian_per_second_squared,        rad_per_s2, "rad/s²", "rad/s2",   rotational_acceleration, 78256779,   491701844,     0,     1,   false, "rad/s^2") \
  Row(metre_per_second_squared,         m_per_s2,   "m/s²",   "m/s2",     acceleration,            1,          1,             0,     1,   true, "m/s^2") \
  Row(millimetre_per_second_squared,    mm_per_s2,  "mm/s²",  "mm/s2",    acceleration,            1,          1000,          0,     1,   true, "mm/s^2") \
  Row(revolution_per_second_cubed,      rev_per_s3, "rev/s³", "rev/s3",   rotational_jerk,         1,          1,             0,     1,   true, "rev/s^3") \
  Row(degree_per_second_cubed,          deg_per_s3, "°/s³",   "deg/s3",   rotational_jerk,         1,          360,           0,     1,   true, "deg/s^3") \
  Row(metre_per_second_cubed,           m_per_s3,   "m/s³",   "m/s3",     jerk,                    1,          1,             0,     1,   true, "m/s^3") \
  Row(millimetre_per_second_cubed,      mm_per_s3,  "mm/s³",  "mm/s3",    jerk,                    1,          1000,          0,     1,   true, "mm/s^3") \
  Row(increment,                        inc,        "inc",    "inc",      increments,              1,          1,             0,     1,   true, "increment;increments;Inc;pulse;pulses") \
  Row(increment_per_second,             inc_per_s,  "inc/s",  "inc/s",    increment_rate,          1,          1,             0,     1,   true, "") \
  Row(increment_per_millisecond,        inc_per_ms, "inc/ms", "inc/ms",   increment_rate,          1000,       1,             0,     1,   true, "") \
  Row(increment_per_second_squared,     inc_per_s2, "inc/s²", "inc/s2",   increment_acceleration,  1,          1,             0,     1,   true, "inc/s^2") \
  Row(increment_per_second_cubed,       inc_per_s3, "inc/s³", "inc/s3",   increment_jerk,          1,          1,             0,     1,   true, "inc/s^3") \
  Row(increment_per_revolution,         inc_per_rev, "inc/rev", "inc/rev", increment_resolution,    1,          1,             0,     1,   true, "PPR;ppr;pulses/rev;increments/rev") \
  Row(kelvin,                           K,          "K",      "K",        temperature,             1,          1,             0,     1,   true, "") \
  Row(degree_celsius,                   degC,       "°C",     "degC",     temperature,             1,          1,             27315, 100, true, "ºC;℃;deg C;Celsius") \
  Row(degree_fahrenheit,                degF,       "°F",     "degF",     temperature,             5,          9,             45967, 180, true, "ºF;℉;deg F;Fahrenheit") \
  Row(volt,                             V,          "V",      "V",        voltage,                 1,          1,             0,     1,   true, "") \
  Row(millivolt,                        mV,         "mV",     "mV",       voltage,                 1,          1000,          0,     1,   true, "") \
  Row(microvolt,                        uV,         "µV",     "uV",       voltage,                 1,          1000000,       0,     1,   true, "μV") \
  Row(kilovolt,                         kV,         "kV",     "kV",       voltage,                 1000,       1,             0,     1,   true, "") \
  Row(ampere,                           A,          "A",      "A",        current,                 1,          1,             0,     1,   true, "") \
  Row(milliampere,                      mA,         "mA",     "mA",       current,                 1,          1000,          0,     1,   true, "") \
  Row(microampere,                      uA,         "µA",     "uA",       current,                 1,          1000000,       0,     1,   true, "μA") \
  Row(kiloampere,                       kA,         "kA",     "kA",       current,                 1000,       1,             0,     1,   true, "") \
  Row(watt,                             W,          "W",      "W",        power,                   1,          1,             0,     1,   true, "") \
  Row(milliwatt,                        mW,         "mW",     "mW",       power,                   1,          1000,          0,     1,   true, "") \
  Row(kilowatt,                         kW,         "kW",     "kW",       power,                   1000,       1,             0,     1,   true, "") \
  Row(megawatt,                         MW,         "MW",     "MW",       power,                   1000000,    1,             0,     1,   true, "") \
  Row(volt_ampere,                      VA,         "VA",     "VA",       apparent_power,          1,          1,             0,     1,   true, "") \
  Row(kilovolt_ampere,                  kVA,        "kVA",    "kVA",      apparent_power,          1000,       1,             0,     1,   true, "") \
  Row(joule,                            J,          "J",      "J",        energy,                  1,          1,             0,     1,   true, "") \
  Row(kilojoule,                        kJ,         "kJ",     "kJ",       energy,                  1000,       1,             0,     1,   true, "") \
  Row(watt_second,                      Ws,         "Ws",     "Ws",       energy,                  1,          1,             0,     1,   true, "") \
  Row(watt_hour,                        Wh,         "Wh",     "Wh",       energy,                  3600,       1,             0,     1,   true, "") \
  Row(kilowatt_hour,                    kWh,        "kWh",    "kWh",      energy,                  3600000,    1,             0,     1,   true, "") \
  Row(megawatt_hour,                    MWh,        "MWh",    "MWh",      energy,                  3600000000, 1,             0,     1,   true, "") \
  Row(newton,                           N,          "N",      "N",        force,                   1,          1,             0,     1,   true, "") \
  Row(millinewton,                      mN,         "mN",     "mN",       force,                   1,          1000,          0,     1,   true, "") \
  Row(kilonewton,                       kN,         "kN",     "kN",       force,                   1000,       1,             0,     1,   true, "") \
  Row(newton_metre,                     Nm,         "Nm",     "Nm",       torque,                  1,          1,             0,     1,   true, "N·m;N m;N*m") \
  Row(millinewton_metre,                mNm,        "mNm",    "mNm",      torque,                  1,          1000,          0,     1,   true, "mN·m;mN m") \
  Row(centinewton_metre,                cNm,        "cNm",    "cNm",      torque,                  1,          100,           0,     1,   true, "") \
  Row(kilonewton_metre,                 kNm,        "kNm",    "kNm",      torque,                  1000,       1,             0,     1,   true, "") \
  Row(gram,                             g,          "g",      "g",        mass,                    1,          1000,          0,     1,   true, "") \
  Row(milligram,                        mg,         "mg",     "mg",       mass,                    1,          1000000,       0,     1,   true, "") \
  Row(kilogram,                         kg,         "kg",     "kg",       mass,                    1,          1,             0,     1,   true, "") \
  Row(tonne,                            t,          "t",      "t",        mass,                    1000,       1,             0,     1,   true, "") \
  Row(kilogram_square_metre,            kg_m2,      "kg·m²",  "kgm2",     moment_of_inertia,       1,          1,             0,     1,   true, "kg m²;kg m2;kg*m2;kg m^2") \
  Row(gram_square_centimetre,           g_cm2,      "g·cm²",  "gcm2",     moment_of_inertia,       1,          10000000,      0,     1,   true, "g cm²;g cm2;g*cm2;g cm^2") \
  Row(pascal,                           Pa,         "Pa",     "Pa",       pressure,                1,          1,             0,     1,   true, "") \
  Row(hectopascal,                      hPa,        "hPa",    "hPa",      pressure,                100,        1,             0,     1,   true, "") \
  Row(kilopascal,                       kPa,        "kPa",    "kPa",      pressure,                1000,       1,             0,     1,   true, "") \
  Row(megapascal,                       MPa,        "MPa",    "MPa",      pressure,                1000000,    1,             0,     1,   true, "") \
  Row(bar,                              bar,        "bar",    "bar",      pressure,                100000,     1,             0,     1,   true, "") \
  Row(millibar,                         mbar,       "mbar",   "mbar",     pressure,                100,        1,             0,     1,   true, "") \
  Row(hertz,                            Hz,         "Hz",     "Hz",       frequency,               1,          1,             0,     1,   true, "") \
  Row(millihertz,                       mHz,        "mHz",    "mHz",      frequency,               1,          1000,          0,     1,   true, "") \
  Row(kilohertz,                        kHz,        "kHz",    "kHz",      frequency,               1000,       1,             0,     1,   true, "") \
  Row(megahertz,                        MHz,        "MHz",    "MHz",      frequency,               1000000,    1,             0,     1,   true, "") \
  Row(ohm,                              ohm,        "Ω",      "ohm",      resistance,              1,          1,             0,     1,   true, "Ω;Ohm") \
  Row(milliohm,                         mohm,       "mΩ",     "mohm",     resistance,              1,          1000,          0,     1,   true, "mΩ") \
  Row(kiloohm,                          kohm,       "kΩ",     "kohm",     resistance,              1000,       1,             0,     1,   true, "kΩ;kOhm") \
  Row(megaohm,                          Mohm,       "MΩ",     "Mohm",     resistance,              1000000,    1,             0,     1,   true, "MΩ;MOhm") \
  Row(siemens,                          S,          "S",      "S",        conductance,             1,          1,             0,     1,   true, "") \
  Row(millisiemens,                     mS,         "mS",     "mS",       conductance,             1,          1000,          0,     1,   true, "") \
  Row(microsiemens,                     uS,         "µS",     "uS",       conductance,             1,          1000000,       0,     1,   true, "μS") \
  Row(farad,                            F,          "F",      "F",        capacitance,             1,          1,             0,     1,   true, "") \
  Row(millifarad,                       mF,         "mF",     "mF",       capacitance,             1,          1000,          0,     1,   true, "") \
  Row(microfarad,                       uF,         "µF",     "uF",       capacitance,             1,          1000000,       0,     1,   true, "μF") \
  Row(nanofarad,                        nF,         "nF",     "nF",       capacitance,             1,          1000000000,    0,     1,   true, "") \
  Row(picofarad,                        pF,         "pF",     "pF",       capacitance,             1,          1000000000000, 0,     1,   true, "") \
  Row(henry,                            H,          "H",      "H",        inductance,              1,          1,             0,     1,   true, "") \
  Row(millihenry,                       mH,         "mH",     "mH",       inductance,              1,          1000,          0,     1,   true, "") \
  Row(microhenry,                       uH,         "µH",     "uH",       inductance,              1,          1000000,       0,     1,   true, "μH") \
  Row(coulomb,                          C,          "C",      "C",        charge,                  1,          1,             0,     1,   true, "") \
  Row(ampere_hour,                      Ah,         "Ah",     "Ah",       charge,                  3600,       1,             0,     1,   true, "") \
  Row(milliampere_hour,                 mAh,        "mAh",    "mAh",      charge,                  18,         5,             0,     1,   true, "") \
  Row(one,                              one,        "1",      "one",      ratio,                   1,          1,             0,     1,   true, "") \
  Row(percent,                          percent,    "%",      "%",        ratio,                   1,          100,           0,     1,   true, "percent") \
  Row(permille,                         permille,   "‰",      "permille", ratio,                   1,          1000,          0,     1,   true, "per mille") \
  Row(part_per_million,                 ppm,        "ppm",    "ppm",      ratio,                   1,          1000000,       0,     1,   true, "") \
  Row(cubic_metre,                      m3,         "m³",     "m3",       volume,                  1,          1,             0,     1,   true, "m^3") \
  Row(litre,                            l,          "l",      "l",        volume,                  1,          1000,          0,     1,   true, "L") \
  Row(millilitre,                       ml,         "ml",     "ml",       volume,                  1,          1000000,       0,     1,   true, "mL") \
  Row(cubic_metre_per_hour,             m3_per_h,   "m³/h",   "m3/h",     volume_flow,             1,          3600,          0,     1,   true, "m^3/h") \
  Row(cubic_metre_per_second,           m3_per_s,   "m³/s",   "m3/s",     volume_flow,             1,          1,             0,     1,   true, "m^3/s") \
  Row(litre_per_second,                 l_per_s,    "l/s",    "l/s",      volume_flow,             1,          1000,          0,     1,   true, "") \
  Row(litre_per_minute,                 l_per_min,  "l/min",  "l/min",    volume_flow,             1,          60000,         0,     1,   true, "L/min") \
  Row(millilitre_per_minute,            ml_per_min, "ml/min", "ml/min",   volume_flow,             1,          60000000,      0,     1,   true, "mL/min") \
  Row(kilogram_per_second,              kg_per_s,   "kg/s",   "kg/s",     mass_flow,               1,          1,             0,     1,   true, "") \
  Row(kilogram_per_hour,                kg_per_h,   "kg/h",   "kg/h",     mass_flow,               1,          3600,          0,     1,   true, "") \
  Row(bit,                              bit,        "bit",    "bit",      information,             1,          1,             0,     1,   true, "") \
  Row(byte,                             byte,       "byte",   "byte",     information,             8,          1,             0,     1,   true, "") \
  Row(bit_per_second,                   bit_per_s,  "bit/s",  "bit/s",    data_rate,               1,          1,             0,     1,   true, "bps") \
  Row(kilobit_per_second,               kbit_per_s, "kbit/s", "kbit/s",   data_rate,               1000,       1,             0,     1,   true, "kbps") \
  Row(megabit_per_second,               Mbit_per_s, "Mbit/s", "Mbit/s",   data_rate,               1000000,    1,             0,     1,   true, "Mbps")
// clang-format on

#define CANOPEN_UNIT(name, literal, symbol, ascii, dimension, numerator, denominator, offset, under, is_exact, \
                     spellings)                                                                                \
  {#name,           #literal, symbol,   ascii, Dimension::dimension, {numerator, denominator},                 \
   {offset, under}, is_exact, spellings},
inline constexpr UnitRow unit_rows[] = {CANOPEN_UNITS(CANOPEN_UNIT)};
#undef CANOPEN_UNIT

namespace unit {

#define CANOPEN_UNIT(name, ...) name,
enum class Row : std::size_t { CANOPEN_UNITS(CANOPEN_UNIT) };
#undef CANOPEN_UNIT

#define CANOPEN_UNIT(name, ...)                                                           \
  struct name {                                                                           \
    static constexpr const UnitRow& row = unit_rows[static_cast<std::size_t>(Row::name)]; \
  };
CANOPEN_UNITS(CANOPEN_UNIT)
#undef CANOPEN_UNIT

}  // namespace unit

/// Whether a text is an element of a list that is separated by `;`.
[[nodiscard]] constexpr bool is_listed(std::string_view list, std::string_view text) {
  while (!list.empty()) {
    const std::size_t end = list.find(';');
    if (list.substr(0, end) == text) return true;
    list = end == std::string_view::npos ? std::string_view{} : list.substr(end + 1);
  }
  return false;
}

/// Returns the unit with this symbol, ASCII spelling or other spelling; nullptr: it is not in the table. The case of
/// letters counts: mW and MW.
[[nodiscard]] constexpr const UnitRow* find_unit(std::string_view text) {
  if (text.empty()) return nullptr;
  for (const UnitRow& row : unit_rows) {
    if (row.symbol == text || row.ascii == text) return &row;
    if (is_listed(row.other_spellings, text)) return &row;
  }
  return nullptr;
}

/// Whether values of one unit can be converted to the other without a rounded factor.
[[nodiscard]] constexpr bool is_exact_conversion(const UnitRow& from, const UnitRow& to) {
  return from.dimension == to.dimension && from.is_exact == to.is_exact;
}

/// Returns a value in another unit of the same dimension.
[[nodiscard]] constexpr Fraction convert(Fraction value, const UnitRow& from, const UnitRow& to) {
  return (value * from.factor + (from.offset - to.offset)) / to.factor;
}

}  // namespace canopen
