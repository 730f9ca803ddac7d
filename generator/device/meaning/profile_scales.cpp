#include "device/meaning/profile_scales.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <map>
#include <memory>
#include <set>
#include <span>
#include <string>
#include <string_view>
#include <tuple>
#include <utility>
#include <vector>

namespace edsc {
namespace {

/// Codes of CiA 303-2, clause 4.
struct UnitCode {
  std::uint8_t code;
  std::string_view symbol;
};

constexpr UnitCode unit_codes[] = {
    {0x01, "m"},   {0x02, "kg"}, {0x03, "s"},  {0x04, "A"},   {0x05, "K"},   {0x10, "rad"}, {0x20, "Hz"},
    {0x21, "N"},   {0x22, "Pa"}, {0x23, "J"},  {0x24, "W"},   {0x25, "C"},   {0x26, "V"},   {0x27, "F"},
    {0x28, "ohm"}, {0x29, "S"},  {0x2D, "°C"}, {0x41, "deg"}, {0x4E, "bar"}, {0xB4, "rev"}, {0xB5, "inc"},
};

/// The times of a denominator.
constexpr UnitCode time_codes[] = {{0x03, "s"}, {0x47, "min"}, {0x48, "h"}, {0x57, "s^2"}};

std::string_view symbol_of(std::span<const UnitCode> codes, std::uint8_t code) {
  const auto found = std::ranges::find(codes, code, &UnitCode::code);
  return found == codes.end() ? std::string_view{} : found->symbol;
}

/// 10 to the power of an exponent; nothing if it does not fit.
std::optional<Rational> scale_of_exponent(int exponent) {
  constexpr int max_exponent = 18;
  if (exponent < -max_exponent || exponent > max_exponent) return std::nullopt;
  std::int64_t power = 1;
  for (int i = 0; i < (exponent < 0 ? -exponent : exponent); ++i) power *= 10;
  return exponent < 0 ? Rational::of(1, power) : Rational{power};
}

/// What gives the objects of a range their unit.
enum class ScaleKind : std::uint8_t { position, velocity, acceleration, process_value };

struct ScaledObjects {
  std::uint16_t profile;
  std::uint16_t first, last;
  ScaleKind kind;
};

constexpr ScaledObjects scaled_objects[] = {
    {402, 0x6062, 0x6062, ScaleKind::position},      {402, 0x6064, 0x6065, ScaleKind::position},
    {402, 0x6067, 0x6067, ScaleKind::position},      {402, 0x607A, 0x607D, ScaleKind::position},
    {402, 0x60B0, 0x60B0, ScaleKind::position},      {402, 0x60BA, 0x60BD, ScaleKind::position},
    {402, 0x60F4, 0x60F4, ScaleKind::position},      {402, 0x606B, 0x606D, ScaleKind::velocity},
    {402, 0x606F, 0x606F, ScaleKind::velocity},      {402, 0x607F, 0x607F, ScaleKind::velocity},
    {402, 0x6081, 0x6082, ScaleKind::velocity},      {402, 0x6099, 0x6099, ScaleKind::velocity},
    {402, 0x60B1, 0x60B1, ScaleKind::velocity},      {402, 0x60FF, 0x60FF, ScaleKind::velocity},
    {402, 0x6083, 0x6085, ScaleKind::acceleration},  {402, 0x609A, 0x609A, ScaleKind::acceleration},
    {402, 0x60C5, 0x60C6, ScaleKind::acceleration},  {404, 0x7121, 0x7121, ScaleKind::process_value},
    {404, 0x7123, 0x7124, ScaleKind::process_value}, {404, 0x7130, 0x7130, ScaleKind::process_value},
    {404, 0x7133, 0x7135, ScaleKind::process_value}, {404, 0x9121, 0x9121, ScaleKind::process_value},
    {404, 0x9123, 0x9124, ScaleKind::process_value}, {404, 0x9130, 0x9130, ScaleKind::process_value},
    {404, 0x9133, 0x9135, ScaleKind::process_value},
};

struct ScalePlace {
  ScaleKind kind;
  std::uint16_t offset;  ///< of the axis
};

/// What states the unit of an integer of the profile; nothing for other entries.
std::optional<ScalePlace> scale_place(const Device& device, const Entry& entry) {
  constexpr std::uint16_t first_of_profiles = 0x6000, drives = 402, axis_distance = 0x800, axes = 8;
  if (entry.index < first_of_profiles) return std::nullopt;
  const bool is_integer = entry.type->kind == canopen::DataClass::signed_integer ||
                          entry.type->kind == canopen::DataClass::unsigned_integer;
  const Entry* const type = device.find(0x1000, 0);
  const Object* const object = device.find(entry.index);
  if (!is_integer || type == nullptr || !type->default_value || object == nullptr) return std::nullopt;
  if (object->has_sub_indices() && (entry.sub_index == 0 || entry.sub_index == 0xFF)) return std::nullopt;
  const auto profile = static_cast<std::uint16_t>(type->default_value->bits & 0xFFFF);
  const unsigned axis = profile == drives ? (entry.index - unsigned{first_of_profiles}) / axis_distance : 0;
  if (axis >= axes) return std::nullopt;
  const auto offset = static_cast<std::uint16_t>(axis * axis_distance);
  const auto row = std::ranges::find_if(scaled_objects, [&](const ScaledObjects& one) {
    return one.profile == profile && entry.index >= one.first + offset && entry.index <= one.last + offset;
  });
  if (row == std::ranges::end(scaled_objects)) return std::nullopt;
  return ScalePlace{row->kind, offset};
}

std::optional<Rational> product_of(const std::optional<Rational>& a, const std::optional<Rational>& b) {
  return a && b ? product(*a, *b) : std::nullopt;
}

/// The formulas of CiA 402-2 (IEC 61800-7-201), "Factor group", and of CiA 404.
class ScaleFormula {
 public:
  ScaleFormula(const Device& device, const NumberOfEntry& number_of, std::uint16_t offset)
      : device_{device}, number_of_{number_of}, offset_{offset} {}

  std::optional<Quantity> quantity(ScaleKind kind, std::uint8_t channel) {
    switch (kind) {
      case ScaleKind::position: return position();
      case ScaleKind::velocity: return velocity();
      case ScaleKind::acceleration: return stated_unit(si_unit_acceleration).quantity;
      case ScaleKind::process_value: break;
    }
    return process_value(channel);
  }

  /// Entries other than constants whose numbers the quantity is of.
  std::vector<EntryKey> variable_entries() {
    std::ranges::sort(variable_);
    return std::move(variable_);
  }

 private:
  static constexpr std::uint16_t position_encoder_resolution = 0x608F, velocity_encoder_resolution = 0x6090,
                                 gear_ratio = 0x6091, feed_constant = 0x6092, position_factor = 0x6093,
                                 velocity_encoder_factor = 0x6094, velocity_factor = 0x6096, si_unit_position = 0x60A8,
                                 si_unit_velocity = 0x60A9, si_unit_acceleration = 0x60AA, physical_unit = 0x6131,
                                 decimal_digits = 0x6132;

  [[nodiscard]] bool has(std::uint16_t index) const {
    return device_.find(static_cast<std::uint16_t>(index + offset_)) != nullptr;
  }

  std::optional<std::uint64_t> number(std::uint16_t index, std::uint8_t sub_index) {
    const Entry* const entry = device_.find(static_cast<std::uint16_t>(index + offset_), sub_index);
    if (entry == nullptr) return std::nullopt;
    if (entry->access != canopen::Access::constant) variable_.emplace_back(entry->index, entry->sub_index);
    return number_of_(*entry);
  }

  /// Nothing for a device without the object, and for 0, which is not a unit.
  struct StatedUnit {
    bool is_stated = false;
    std::optional<Quantity> quantity = {};  ///< nothing if it is unknown
  };

  StatedUnit stated_unit(std::uint16_t index, std::uint8_t sub_index = 0) {
    if (device_.find(static_cast<std::uint16_t>(index + offset_), sub_index) == nullptr) return {};
    const auto code = number(index, sub_index);
    if (!code) return {true};
    return {*code != 0, quantity_of_si_unit(static_cast<std::uint32_t>(*code))};
  }

  /// Sub-index `upper` of an object divided by the other one of its sub-indices 1 and 2.
  std::optional<Rational> ratio(std::uint16_t index, std::uint8_t upper) {
    const auto first = number(index, 1), second = number(index, 2);
    if (!first || !second || *first == 0 || *second == 0) return std::nullopt;
    const auto a = static_cast<std::int64_t>(*first), b = static_cast<std::int64_t>(*second);
    return upper == 1 ? Rational::of(a, b) : Rational::of(b, a);
  }

  /// The same for objects that a drive can omit.
  std::optional<Rational> ratio_or_one(std::uint16_t index, std::uint8_t upper) {
    return has(index) ? ratio(index, upper) : Rational{1};
  }

  /// Revolutions for each increment or unit. 1 is the value of a drive that does not use the object.
  std::optional<Rational> revolutions(std::uint16_t index) {
    const auto turns = ratio(index, 2);
    return turns == Rational{1} ? std::nullopt : turns;
  }

  static std::optional<Quantity> in_unit(std::string_view symbol, const std::optional<Rational>& scale) {
    if (!scale) return std::nullopt;
    Quantity quantity;
    quantity.symbol = symbol;
    quantity.unit = canopen::find_unit(symbol);
    quantity.scale = *scale;
    return quantity;
  }

  /// Revolutions are those of the driving shaft, after the gear.
  std::optional<Quantity> position() {
    if (const auto unit = stated_unit(si_unit_position); unit.is_stated) return unit.quantity;
    if (has(feed_constant)) return in_unit("rev", revolutions(feed_constant));
    const auto of_shaft = product_of(revolutions(position_encoder_resolution), ratio_or_one(gear_ratio, 2));
    return in_unit("rev", product_of(of_shaft, ratio_or_one(position_factor, 1)));
  }

  /// 6096h has other meanings in other versions of the profile.
  std::optional<Quantity> velocity() {
    if (const auto unit = stated_unit(si_unit_velocity); unit.is_stated) return unit.quantity;
    const bool has_factor = has(velocity_encoder_factor);
    if (has(velocity_factor) && !has_factor) return std::nullopt;
    if (has(feed_constant) && !has_factor) return std::nullopt;
    const bool has_own_resolution = has(velocity_encoder_resolution);
    if (!has_factor && !has_own_resolution) return std::nullopt;
    const auto of_motor = revolutions(has_own_resolution ? velocity_encoder_resolution : position_encoder_resolution);
    const auto of_shaft = product_of(of_motor, ratio_or_one(gear_ratio, 2));
    return in_unit("rev/s", product_of(of_shaft, ratio_or_one(velocity_encoder_factor, 1)));
  }

  std::optional<Quantity> process_value(std::uint8_t channel) {
    const auto digits = number(decimal_digits, channel);
    const auto scale = digits && *digits < 100 ? scale_of_exponent(-static_cast<int>(*digits)) : std::nullopt;
    Quantity quantity = stated_unit(physical_unit, channel).quantity.value_or(Quantity{});
    const auto both = product_of(quantity.scale, scale);
    if (!both) return std::nullopt;
    quantity.scale = *both;
    return quantity;
  }

  const Device& device_;
  const NumberOfEntry& number_of_;
  std::uint16_t offset_;
  std::vector<EntryKey> variable_;
};

/// Whether the options, the EDS or a table of the profile say what the numbers are.
bool has_own_meaning(const Entry& entry) {
  if (!entry.meaning) return false;
  const Meaning& meaning = *entry.meaning;
  return meaning.values || meaning.has_fields() || (meaning.quantity && meaning.quantity->stated_by.empty());
}

std::optional<std::uint64_t> default_number(const Entry& entry) {
  const bool is_known = entry.default_value && !entry.default_value->plus_node_id;
  return is_known ? std::optional{entry.default_value->bits} : std::nullopt;
}

/// `by the default values of 608Fh, 6091h`
std::string text_of_sources(const std::vector<EntryKey>& entries) {
  std::string text;
  std::set<std::uint16_t> named;
  for (const EntryKey& key : entries) {
    if (!named.insert(key.first).second) continue;
    text += fmt::format("{} {:04X}h", text.empty() ? "by the default values of" : ",", key.first);
  }
  return text;
}

/// Gives entries their quantity. Entries with one meaning share it afterwards, too, if it has one scale.
class ProfileScaleResolver {
 public:
  explicit ProfileScaleResolver(const Device& device) : device_{device} {}

  void resolve(Entry& entry) {
    if (!has_profile_scale(device_, entry)) return;
    std::optional<Quantity> quantity = profile_scale(device_, entry, default_number);
    if (!quantity && (!entry.meaning || !entry.meaning->quantity)) return;
    auto& meaning =
        known_[{entry.meaning, quantity ? quantity->symbol : std::string{}, quantity ? quantity->scale : Rational{0},
                quantity ? quantity->stated_by : std::vector<EntryKey>{}}];
    if (!meaning) meaning = with_quantity(entry, std::move(quantity));
    entry.meaning = meaning;
  }

 private:
  using MeaningPointer = std::shared_ptr<const Meaning>;
  using Key = std::tuple<MeaningPointer, std::string, Rational, std::vector<EntryKey>>;

  static MeaningPointer with_quantity(const Entry& entry, std::optional<Quantity> quantity) {
    Meaning meaning = entry.meaning ? *entry.meaning : Meaning{};
    if (!entry.meaning) meaning.source = MeaningSource::profile;
    meaning.quantity = std::move(quantity);
    const bool is_left = meaning.quantity || !meaning.text.empty() || !meaning.place.empty();
    return is_left ? std::make_shared<const Meaning>(std::move(meaning)) : nullptr;
  }

  const Device& device_;
  std::map<Key, MeaningPointer> known_;
};

}  // namespace

std::optional<Quantity> quantity_of_si_unit(std::uint32_t number) {
  const auto exponent = static_cast<std::int8_t>(number >> 24);
  const auto numerator = static_cast<std::uint8_t>(number >> 16), denominator = static_cast<std::uint8_t>(number >> 8);
  std::string symbol{symbol_of(unit_codes, numerator)};
  if (symbol.empty()) return std::nullopt;
  if (denominator != 0) {
    const std::string_view time = symbol_of(time_codes, denominator);
    if (time.empty()) return std::nullopt;
    symbol.append("/").append(time);
  }
  const canopen::UnitRow* const unit = canopen::find_unit(symbol);
  const auto scale = scale_of_exponent(exponent);
  if (unit == nullptr || !scale) return std::nullopt;
  Quantity quantity;
  quantity.unit = unit;
  quantity.symbol = unit->symbol;
  quantity.scale = *scale;
  return quantity;
}

bool has_profile_scale(const Device& device, const Entry& entry) {
  return !has_own_meaning(entry) && scale_place(device, entry).has_value();
}

std::optional<Quantity> profile_scale(const Device& device, const Entry& entry, const NumberOfEntry& number_of) {
  const auto place = scale_place(device, entry);
  if (!place) return std::nullopt;
  ScaleFormula formula{device, number_of, place->offset};
  std::optional<Quantity> quantity = formula.quantity(place->kind, entry.sub_index);
  if (!quantity || (quantity->symbol.empty() && quantity->is_raw())) return std::nullopt;
  quantity->source = MeaningSource::profile;
  quantity->stated_by = formula.variable_entries();
  quantity->text = text_of_sources(quantity->stated_by);
  return quantity;
}

void resolve_profile_scales(Device& device) {
  ProfileScaleResolver resolver{device};
  for (Object& object : device.objects) {
    for (Entry& entry : object.entries) resolver.resolve(entry);
  }
}

}  // namespace edsc
