#include "device/meaning/resolve_meaning.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <map>
#include <memory>
#include <set>
#include <unordered_map>
#include <utility>
#include <vector>

#include "device/meaning/profile_scales.hpp"
#include "device/meaning/profiles.hpp"
#include "diagnostics/quote.hpp"
#include "eds/number.hpp"
#include "text/ascii.hpp"
#include "text/snake_case.hpp"
#include "values/little_endian.hpp"

namespace edsc {
namespace {

using canopen::DataClass;

/// The descriptions of an options file or profile, by index.
class DescriptionTable {
 public:
  explicit DescriptionTable(const MeaningDescriptions& descriptions) {
    for (const MeaningDescription& one : descriptions.entries) {
      if (one.first_index == one.last_index) {
        by_index_[one.first_index].push_back(&one);
      } else {
        ranges_.push_back(&one);
      }
    }
  }

  /// Appends those of an entry: those with its sub-index, then those of its object.
  void find(std::uint16_t index, std::uint8_t sub_index, bool is_counted,
            std::vector<const MeaningDescription*>& found) const {
    const auto at = by_index_.find(index);
    for (const bool exact : {true, false}) {
      const auto take = [&](const MeaningDescription* one) {
        if (one->sub_index.has_value() != exact || !one->applies_to(index, sub_index)) return;
        if (exact || is_counted) found.push_back(one);
      };
      if (at != by_index_.end()) std::ranges::for_each(at->second, take);
      std::ranges::for_each(ranges_, take);
    }
  }

 private:
  std::unordered_map<std::uint16_t, std::vector<const MeaningDescription*>> by_index_;
  std::vector<const MeaningDescription*> ranges_;
};

/// Whether an entry of this type can have the properties of a profile: all bits and values must fit.
class ProfileFit {
 public:
  explicit ProfileFit(const Entry& entry) : type_{*entry.type} {}

  [[nodiscard]] bool is_number() const {
    return type_.kind == DataClass::unsigned_integer || type_.kind == DataClass::signed_integer;
  }
  [[nodiscard]] bool fits(const Enumeration& values) const {
    return is_number() && std::ranges::all_of(values.values, [&](const NamedValue& one) { return fits(one.value); });
  }
  [[nodiscard]] bool fits(const std::vector<BitField>& fields) const {
    return is_number() &&
           std::ranges::all_of(fields, [&](const BitField& one) { return one.first_bit + one.bits <= type_.bits; });
  }
  [[nodiscard]] bool fits(const std::vector<MaskedGroup>& groups) const {
    return is_number() && std::ranges::all_of(groups, [&](const MaskedGroup& group) {
             return std::ranges::all_of(group.values, [&](const MaskedValue& one) {
               return type_.bits >= 64 || (one.mask >> type_.bits) == 0;
             });
           });
  }
  [[nodiscard]] bool fits(const std::vector<FieldCase>& cases) const {
    return std::ranges::all_of(cases, [&](const FieldCase& one) { return fits(one.fields); });
  }

 private:
  [[nodiscard]] bool fits(std::int64_t value) const {
    if (type_.bits >= 64) return true;
    if (type_.kind == DataClass::unsigned_integer)
      return value >= 0 && (static_cast<std::uint64_t>(value) >> type_.bits) == 0;
    const std::int64_t half = std::int64_t{1} << (type_.bits - 1);
    return value >= -half && value < half;
  }

  const canopen::DataTypeRow& type_;
};

/// The parts of a quantity as they are stated by the options or the EDS.
struct StatedQuantity {
  const Stated<std::string>* unit = nullptr;
  const Stated<Rational>* scale = nullptr;
  const Stated<Rational>* offset = nullptr;

  void take(const MeaningDescription& one) {
    if (unit == nullptr && one.unit) unit = &*one.unit;
    if (scale == nullptr && one.scale) scale = &*one.scale;
    if (offset == nullptr && one.offset) offset = &*one.offset;
  }
  [[nodiscard]] bool any() const { return unit != nullptr || scale != nullptr || offset != nullptr; }

  /// The quantity: `base` with the stated properties in place of its own.
  [[nodiscard]] Quantity over(const Quantity& base, MeaningSource source) const {
    Quantity result = base;
    result.source = source;
    if (offset != nullptr) result.offset = offset->value, result.position = offset->position;
    if (scale != nullptr) result.scale = scale->value, result.position = scale->position;
    if (unit != nullptr) {
      result.symbol = unit->value;
      result.unit = canopen::find_unit(unit->value);
      result.position = unit->position;
    }
    return result;
  }
};

/// Whether a decimal of the EDS is another number than that of the options. A decimal that is rounded is not: 0.33 for
/// 1/3.
bool contradicts(const Rational& in_options, const Rational& in_eds) {
  const std::string decimal = decimal_text(in_eds);
  const std::size_t point = decimal.find('.');
  if (point == std::string::npos) return in_options != in_eds;
  std::int64_t last_decimal = 1;
  for (std::size_t i = point + 1; i < decimal.size() && last_decimal < 1'000'000'000'000'000; ++i) last_decimal *= 10;
  const auto rounding = Rational::of(1, 2 * last_decimal);
  const auto low = difference(in_eds, *rounding), high = sum(in_eds, *rounding);
  return !low || !high ? in_options != in_eds : in_options < *low || *high < in_options;
}

class Resolver {
 public:
  Resolver(Device& device, const Options& options, Diagnostics& diagnostics)
      : device_{device}, options_{options}, diagnostics_{diagnostics}, of_options_{options.meaning} {}

  void resolve() {
    find_profiles();
    for (Object& object : device_.objects) {
      for (Entry& entry : object.entries) resolve(object, entry);
    }
    copy_same();
    name_cases();
    report_unused();
    take_error_codes();
  }

 private:
  struct AppliedProfile {
    const MeaningProfile* profile;
    DescriptionTable table;
  };
  /// What gives an entry its meaning, apart from the keys of the EDS.
  struct Given {
    std::vector<const MeaningDescription*> options, profile;
    std::uint16_t offset = 0;  ///< of the axis

    friend bool operator<(const Given& a, const Given& b) {
      return std::tie(a.options, a.profile, a.offset) < std::tie(b.options, b.profile, b.offset);
    }
  };

  void find_profiles() {
    constexpr std::uint16_t communication_profile = 301;
    const Entry* const type = device_.find(0x1000, 0);
    const auto number = type != nullptr && type->default_value ? type->default_value->bits & 0xFFFF : 0;
    const auto use = [&](std::uint64_t wanted) {
      const MeaningProfile* const profile = find_profile(static_cast<std::uint16_t>(wanted));
      if (profile != nullptr) profiles_.push_back({profile, DescriptionTable{profile->meanings}});
    };
    if (number != communication_profile) use(number);  // before that of all devices
    use(communication_profile);
  }

  void resolve(const Object& object, Entry& entry) {
    constexpr std::uint8_t structure_sub_index = 0xFF;
    const bool is_counted =
        !object.has_sub_indices() || (entry.sub_index != 0 && entry.sub_index != structure_sub_index);
    Given given;
    of_options_.find(entry.index, entry.sub_index, is_counted, given.options);
    for (const AppliedProfile& one : profiles_) {
      const auto [index, offset] = one.profile->place_of(entry.index);
      const std::size_t before = given.profile.size();
      one.table.find(index, entry.sub_index, is_counted, given.profile);
      if (given.profile.size() != before) given.offset = offset;
    }
    used_.insert(given.options.begin(), given.options.end());
    if (given.options.empty() && given.profile.empty()) return;
    const auto key = std::pair{entry.type, given};
    if (!entry.meaning) {
      if (const auto known = known_.find(key); known != known_.end()) {
        entry.meaning = known->second;
        return;
      }
    }
    const bool has_keys = entry.meaning != nullptr;
    Meaning meaning = has_keys ? *entry.meaning : Meaning{};
    take(given, entry, meaning);
    if (!meaning.quantity && !meaning.values && !meaning.has_fields() && !meaning.same_as && meaning.text.empty() &&
        meaning.place.empty()) {
      return;
    }
    entry.meaning = std::make_shared<const Meaning>(std::move(meaning));
    if (!has_keys) known_.emplace(key, entry.meaning);
  }

  void take(const Given& given, const Entry& entry, Meaning& meaning) {
    StatedQuantity stated;
    for (const MeaningDescription* one : given.options) {
      take_texts(*one, meaning);
      stated.take(*one);
      take_names(*one, meaning, 0, nullptr);
    }
    if (stated.any()) {
      report_contradiction(stated, entry, meaning);
      meaning.quantity = stated.over(meaning.quantity.value_or(Quantity{}), MeaningSource::options);
    }
    const ProfileFit fit{entry};
    StatedQuantity of_profile;
    for (const MeaningDescription* one : given.profile) {
      take_texts(*one, meaning);
      of_profile.take(*one);
      take_names(*one, meaning, given.offset, &fit);
    }
    if (!meaning.quantity && of_profile.any() && fit.is_number()) {
      meaning.quantity = of_profile.over(Quantity{}, MeaningSource::profile);
    }
  }

  static void take_texts(const MeaningDescription& one, Meaning& meaning) {
    if (meaning.text.empty()) meaning.text = one.text;
    if (!meaning.place.empty() || one.place.empty()) return;
    meaning.place = one.place;
    meaning.position = one.position;
    meaning.source = one.source;
  }

  /// Takes the properties that the meaning does not have yet. `fit` is null for those of the options, which a rule
  /// checks.
  static void take_names(const MeaningDescription& one, Meaning& meaning, std::uint16_t offset, const ProfileFit* fit) {
    const auto in_axis = [&](EntryKey key) {
      key.first = static_cast<std::uint16_t>(key.first + (key.first >= 0x6000 ? offset : 0));
      return key;
    };
    // A meaning has either names of values or of bits: those of the first source.
    const bool has_names = meaning.values || meaning.has_fields() || meaning.same_as;
    const bool has_bits = meaning.has_fields();
    if (!has_names && one.values && (fit == nullptr || fit->fits(*one.values))) meaning.values = one.values;
    if (meaning.values && !one.values && fit != nullptr) return;
    if (has_names && !has_bits) return;
    if (meaning.fields.empty() && (fit == nullptr || fit->fits(one.fields))) meaning.fields = one.fields;
    if (meaning.masked.empty() && (fit == nullptr || fit->fits(one.masked))) meaning.masked = one.masked;
    if (meaning.cases.empty() && (fit == nullptr || fit->fits(one.cases))) {
      meaning.cases = one.cases;
      if (one.depends_on) meaning.depends_on = in_axis(*one.depends_on);
    }
    if (!has_names && one.same_as) meaning.same_as = in_axis(*one.same_as);
  }

  void report_contradiction(const StatedQuantity& stated, const Entry& entry, const Meaning& meaning) {
    if (!meaning.quantity) return;
    const Quantity& keys = *meaning.quantity;
    const auto report = [&](const Position& position, std::string_view key, std::string_view in_options,
                            std::string_view in_eds) {
      if (!contradictions_.insert(position).second) return;
      diagnostics_.warning("meaning-contradicts-eds", position,
                           fmt::format("{} {} of {} differs from the EDS, {}; using the options", key,
                                       quote(in_options), entry_label(entry.index, entry.sub_index), quote(in_eds)),
                           {{entry.position, "in the EDS"}});
    };
    if (stated.unit != nullptr && !keys.symbol.empty() && keys.symbol != stated.unit->value &&
        (keys.unit == nullptr || keys.unit != canopen::find_unit(stated.unit->value))) {
      report(stated.unit->position, "unit", stated.unit->value, keys.symbol);
    }
    if (stated.scale != nullptr && !entry.factor.empty() && contradicts(stated.scale->value, keys.scale)) {
      report(stated.scale->position, "scale", fraction_text(stated.scale->value), entry.factor);
    }
    if (stated.offset != nullptr && keys.offset != Rational{0} && contradicts(stated.offset->value, keys.offset)) {
      report(stated.offset->position, "offset", fraction_text(stated.offset->value), fraction_text(keys.offset));
    }
  }

  /// Copies the names of the entry that "same_as" names.
  void copy_same() {
    for (Object& object : device_.objects) {
      for (Entry& entry : object.entries) {
        if (!entry.meaning || !entry.meaning->same_as) continue;
        const auto [index, sub_index] = *entry.meaning->same_as;
        const Entry* const other = device_.find(index, sub_index);
        Meaning meaning = *entry.meaning;
        if (other == nullptr || !other->meaning || other->meaning->same_as) {
          if (meaning.source == MeaningSource::options) {
            diagnostics_.error(
                "options", meaning.position,
                fmt::format("same_as names {}, which does not have a meaning", entry_label(index, sub_index)));
          }
          meaning.same_as.reset();
        } else {
          if (!meaning.values) meaning.values = other->meaning->values;
          if (meaning.fields.empty()) meaning.fields = other->meaning->fields;
          if (meaning.masked.empty()) meaning.masked = other->meaning->masked;
          if (meaning.cases.empty()) {
            meaning.cases = other->meaning->cases;
            meaning.depends_on = other->meaning->depends_on;
          }
        }
        entry.meaning = std::make_shared<const Meaning>(std::move(meaning));
      }
    }
  }

  /// A case without a name has that of the value of the other object.
  void name_cases() {
    std::map<std::shared_ptr<const Meaning>, std::shared_ptr<const Meaning>> renamed;
    for (Object& object : device_.objects) {
      for (Entry& entry : object.entries) {
        if (!entry.meaning || !entry.meaning->depends_on) continue;
        auto& result = renamed[entry.meaning];
        if (!result) result = std::make_shared<const Meaning>(with_named_cases(*entry.meaning));
        entry.meaning = result;
      }
    }
  }

  [[nodiscard]] Meaning with_named_cases(Meaning meaning) const {
    const Entry* const other = device_.find(meaning.depends_on->first, meaning.depends_on->second);
    if (other == nullptr || !other->meaning || !other->meaning->values) return meaning;
    for (FieldCase& one : meaning.cases) {
      const NamedValue* const named = other->meaning->values->find(one.values.front());
      if (one.name.empty() && named != nullptr) one.name = named->name;
    }
    return meaning;
  }

  void report_unused() {
    for (const MeaningDescription& one : options_.meaning.entries) {
      if (used_.contains(&one)) continue;
      diagnostics_.error("options", one.position,
                         fmt::format("meaning names {}, which is not in the EDS", one.address));
    }
  }

  /// Those of the options, then those of the profiles for other codes.
  void take_error_codes() {
    std::map<std::uint16_t, ErrorCodeName> codes;
    const auto take = [&](const MeaningDescriptions& descriptions) {
      for (const ErrorCodeName& one : descriptions.error_codes) codes.try_emplace(one.code, one);
    };
    take(options_.meaning);
    for (const AppliedProfile& one : profiles_) take(one.profile->meanings);
    for (auto& [code, name] : codes) device_.error_codes.push_back(std::move(name));
  }

  Device& device_;
  const Options& options_;
  Diagnostics& diagnostics_;
  DescriptionTable of_options_;
  std::vector<AppliedProfile> profiles_;
  std::map<std::pair<const canopen::DataTypeRow*, Given>, std::shared_ptr<const Meaning>> known_;
  std::set<const MeaningDescription*> used_;
  struct ByPlace {
    bool operator()(const Position& a, const Position& b) const {
      return std::tie(a.line, a.column) < std::tie(b.line, b.column);
    }
  };
  std::set<Position, ByPlace> contradictions_;
};

}  // namespace

std::optional<Quantity> quantity_of_keys(const EntryDescription& description, Diagnostics& diagnostics) {
  const std::string_view unit = without_quotes(trim(description.unit.text));
  const auto has_number = [](const Field& field) { return !trim(field.text).empty(); };
  if (unit.empty() && !has_number(description.factor) && !has_number(description.offset)) return std::nullopt;
  Quantity quantity;
  quantity.source = MeaningSource::eds;
  quantity.symbol = unit;
  quantity.unit = canopen::find_unit(unit);
  quantity.position = description.unit.present ? description.unit.position : description.position;
  const auto read = [&](const Field& field, std::string_view key, Rational& number, bool may_be_zero) {
    if (!has_number(field)) return true;
    const auto found = parse_rational(field.text);
    if (found && (may_be_zero || *found != Rational{0})) {
      number = *found;
      return true;
    }
    diagnostics.warning("meaning-scale", field.position,
                        fmt::format("{} {} is not a number{}; values have no unit", key, quote(trim(field.text)),
                                    may_be_zero ? "" : " other than 0"));
    return false;
  };
  const bool is_scale = read(description.factor, "Factor", quantity.scale, false);
  const bool is_offset = read(description.offset, "Offset", quantity.offset, true);
  return is_scale && is_offset ? std::optional{quantity} : std::nullopt;
}

std::optional<Enumeration> names_of_values(const EntryDescription& description, const canopen::DataTypeRow& type,
                                           Diagnostics& diagnostics) {
  const bool is_signed = type.kind == canopen::DataClass::signed_integer;
  if (!is_signed && type.kind != canopen::DataClass::unsigned_integer) return std::nullopt;
  Enumeration names;
  names.source = MeaningSource::eds;
  names.position = description.position;
  for (const ValueName& one : description.value_names) {
    const std::string_view digits = trim(one.value.text);
    const bool is_negative = digits.starts_with('-');
    const auto magnitude = parse_unsigned(is_negative ? digits.substr(1) : digits);
    NamedValue named;
    named.name = to_snake_case(one.name.text);
    if (!magnitude || named.name.empty() || (is_negative && !is_signed)) continue;
    named.value = static_cast<std::int64_t>(is_negative ? 0 - *magnitude : *magnitude);
    named.source = MeaningSource::eds;
    named.position = one.value.position;
    const std::uint64_t bits = static_cast<std::uint64_t>(named.value) & low_bits(type.bits);
    if ((is_signed ? sign_extended(bits, type.bits) : static_cast<std::int64_t>(bits)) != named.value) {
      diagnostics.warning(
          "meaning-value", named.position,
          fmt::format("{} = {} is not a value of {}; ignored", quote(named.name), named.value, type.name));
      continue;
    }
    const bool is_new = std::ranges::none_of(
        names.values, [&](const NamedValue& other) { return other.value == named.value || other.name == named.name; });
    if (is_new) names.values.push_back(std::move(named));
  }
  std::ranges::sort(names.values, {}, &NamedValue::value);
  return names.values.empty() ? std::nullopt : std::optional{std::move(names)};
}

void resolve_meaning(Device& device, const Options& options, Diagnostics& diagnostics) {
  Resolver{device, options, diagnostics}.resolve();
  resolve_profile_scales(device);
}

}  // namespace edsc
