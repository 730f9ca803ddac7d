#include "device/meaning/profile_scales.hpp"

#include <algorithm>
#include <memory>
#include <span>
#include <string>
#include <string_view>
#include <utility>

namespace edsc {
namespace {

/// Codes of CiA 303-2, 4: SI units and others.
struct UnitCode {
  std::uint8_t code;
  std::string_view symbol;
};

constexpr UnitCode unit_codes[] = {
    {0x01, "m"}, {0x02, "kg"}, {0x04, "A"},  {0x05, "K"},   {0x20, "Hz"},  {0x21, "N"},   {0x22, "Pa"},
    {0x24, "W"}, {0x26, "V"},  {0x2D, "°C"}, {0x41, "deg"}, {0x10, "rad"}, {0xB4, "rev"}, {0xB5, "inc"},
};

/// The times of a denominator.
constexpr UnitCode time_codes[] = {{0x03, "s"}, {0x47, "min"}};

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
enum class ScaleKind : std::uint8_t { position, velocity, digits };

struct ScaledObjects {
  std::uint16_t profile;
  std::uint16_t first, last;
  ScaleKind kind;
};

constexpr ScaledObjects scaled_objects[] = {
    {402, 0x6062, 0x6062, ScaleKind::position}, {402, 0x6064, 0x6065, ScaleKind::position},
    {402, 0x6067, 0x6067, ScaleKind::position}, {402, 0x607A, 0x607D, ScaleKind::position},
    {402, 0x60BA, 0x60BD, ScaleKind::position}, {402, 0x60F4, 0x60F4, ScaleKind::position},
    {402, 0x606B, 0x606C, ScaleKind::velocity}, {402, 0x607F, 0x607F, ScaleKind::velocity},
    {402, 0x6081, 0x6082, ScaleKind::velocity}, {402, 0x6099, 0x6099, ScaleKind::velocity},
    {402, 0x60FF, 0x60FF, ScaleKind::velocity}, {404, 0x7121, 0x7121, ScaleKind::digits},
    {404, 0x7123, 0x7123, ScaleKind::digits},   {404, 0x7130, 0x7130, ScaleKind::digits},
    {404, 0x9121, 0x9121, ScaleKind::digits},   {404, 0x9123, 0x9123, ScaleKind::digits},
    {404, 0x9130, 0x9130, ScaleKind::digits},
};

class ScaleResolver {
 public:
  explicit ScaleResolver(Device& device) : device_{device} {
    profile_ = static_cast<std::uint16_t>(default_of(0x1000, 0).value_or(0) & 0xFFFF);
  }

  void resolve() {
    constexpr std::uint16_t drives = 402, axis_distance = 0x800, axes = 8;
    for (Object& object : device_.objects) {
      if (object.index < 0x6000) continue;
      const unsigned axis = profile_ == drives ? (object.index - 0x6000U) / axis_distance : 0;
      if (axis >= axes) continue;
      const auto offset = static_cast<std::uint16_t>(axis * axis_distance);
      const auto row = std::ranges::find_if(scaled_objects, [&](const ScaledObjects& one) {
        return one.profile == profile_ && object.index >= one.first + offset && object.index <= one.last + offset;
      });
      if (row == std::ranges::end(scaled_objects)) continue;
      for (Entry& entry : object.entries) {
        if (!object.has_sub_indices() || entry.sub_index != 0) apply(row->kind, offset, entry);
      }
    }
  }

 private:
  [[nodiscard]] std::optional<std::uint64_t> default_of(unsigned index, std::uint8_t sub_index) const {
    const Entry* const entry = device_.find(static_cast<std::uint16_t>(index), sub_index);
    const bool is_known = entry != nullptr && entry->default_value && !entry->default_value->plus_node_id;
    return is_known ? std::optional{entry->default_value->bits} : std::nullopt;
  }

  /// The unit of an object of this type; nothing if the device does not have it or does not state one.
  [[nodiscard]] std::optional<Quantity> si_unit(unsigned index, std::uint8_t sub_index) const {
    const auto number = default_of(index, sub_index);
    return number && *number != 0 ? quantity_of_si_unit(static_cast<std::uint32_t>(*number)) : std::nullopt;
  }

  /// Revolutions for each number: sub-index 2 of an object divided by its sub-index 1 (CiA 402-2).
  [[nodiscard]] std::optional<Quantity> revolutions(unsigned index) const {
    const auto numbers = default_of(index, 1), turns = default_of(index, 2);
    if (!numbers || !turns || *numbers == 0 || *turns == 0) return std::nullopt;
    const auto scale = Rational::of(static_cast<std::int64_t>(*turns), static_cast<std::int64_t>(*numbers));
    if (!scale) return std::nullopt;
    Quantity quantity;
    quantity.symbol = "rev";
    quantity.unit = canopen::find_unit(quantity.symbol);
    quantity.scale = *scale;
    return quantity;
  }

  [[nodiscard]] std::optional<Quantity> quantity_for(ScaleKind kind, std::uint16_t offset, const Entry& entry) const {
    constexpr unsigned si_unit_position = 0x60A8, si_unit_velocity = 0x60A9, feed_constant = 0x6092,
                       encoder_resolution = 0x608F, physical_unit = 0x6131, decimal_digits = 0x6132;
    if (kind == ScaleKind::velocity) return si_unit(si_unit_velocity + offset, 0);
    if (kind == ScaleKind::position) {
      if (const auto stated = si_unit(si_unit_position + offset, 0)) return stated;
      if (device_.find(static_cast<std::uint16_t>(feed_constant + offset)) != nullptr) {
        return revolutions(feed_constant + offset);
      }
      return revolutions(encoder_resolution + offset);
    }
    const auto digits = default_of(decimal_digits, entry.sub_index);
    const auto scale = digits && *digits < 100 ? scale_of_exponent(-static_cast<int>(*digits)) : std::nullopt;
    if (!scale) return std::nullopt;
    Quantity quantity = si_unit(physical_unit, entry.sub_index).value_or(Quantity{});
    const auto product_of_both = product(quantity.scale, *scale);
    if (!product_of_both) return std::nullopt;
    quantity.scale = *product_of_both;
    return quantity;
  }

  void apply(ScaleKind kind, std::uint16_t offset, Entry& entry) const {
    const bool is_integer = entry.type->kind == canopen::DataClass::signed_integer ||
                            entry.type->kind == canopen::DataClass::unsigned_integer;
    if (!is_integer || (entry.meaning && (entry.meaning->quantity || entry.meaning->values))) return;
    std::optional<Quantity> quantity = quantity_for(kind, offset, entry);
    if (!quantity || (quantity->symbol.empty() && quantity->is_raw())) return;
    quantity->source = MeaningSource::profile;
    Meaning meaning = entry.meaning ? *entry.meaning : Meaning{};
    if (!entry.meaning) meaning.source = MeaningSource::profile;
    meaning.quantity = std::move(quantity);
    entry.meaning = std::make_shared<const Meaning>(std::move(meaning));
  }

  Device& device_;
  std::uint16_t profile_ = 0;
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

void resolve_profile_scales(Device& device) { ScaleResolver{device}.resolve(); }

}  // namespace edsc
