#include "decode/value_format.hpp"

#include "device/entry_text.hpp"
#include "device/meaning/physical.hpp"
#include "device/meaning/value_parts.hpp"
#include "values/append.hpp"
#include "values/little_endian.hpp"
#include "values/value_text.hpp"

namespace edsc {
namespace {

using canopen::DataClass;
using canopen::DataTypeRow;

/// Nothing for an UNSIGNED64 above the range of int64.
std::optional<std::int64_t> integer_of(const DataTypeRow& type, std::uint64_t number) {
  if (type.kind == DataClass::signed_integer) return sign_extended(number, type.bits);
  if (number >> 63 != 0) return std::nullopt;
  return static_cast<std::int64_t>(number);
}

bool is_integer(const DataTypeRow& type) {
  return type.kind == DataClass::unsigned_integer || type.kind == DataClass::signed_integer;
}

}  // namespace

DecimalScale::DecimalScale(const Quantity& quantity) {
  constexpr unsigned max_decimals = 12;
  std::int64_t unit = 1;
  for (unsigned count = 0; count <= max_decimals; ++count, unit *= 10) {
    if (unit % quantity.scale.denominator() != 0 || unit % quantity.offset.denominator() != 0) continue;
    const std::int64_t scale = unit / quantity.scale.denominator(), offset = unit / quantity.offset.denominator();
    std::int64_t one = 0, other = 0;
    if (__builtin_mul_overflow(quantity.scale.numerator(), scale, &one) ||
        __builtin_mul_overflow(quantity.offset.numerator(), offset, &other)) {
      return;
    }
    factor = one;
    addend = other;
    decimals = count;
    return;
  }
}

bool DecimalScale::append(std::string& text, std::int64_t raw) const {
  std::int64_t value = 0;
  if (factor == 0 || __builtin_mul_overflow(raw, factor, &value) || __builtin_add_overflow(value, addend, &value)) {
    return false;
  }
  std::uint64_t size = value < 0 ? 0 - static_cast<std::uint64_t>(value) : static_cast<std::uint64_t>(value);
  unsigned digits = decimals;
  for (; digits > 0 && size % 10 == 0; --digits) size /= 10;
  if (value < 0) text += '-';
  if (digits == 0) {
    append_decimal(text, size);
    return true;
  }
  std::uint64_t unit = 1;
  for (unsigned i = 0; i < digits; ++i) unit *= 10;
  append_decimal(text, size / unit);
  text += '.';
  const fmt::format_int fraction{size % unit};
  text.append(digits - fraction.size(), '0');
  text.append(fraction.data(), fraction.size());
  return true;
}

ValueFormat::ValueFormat(const Device& device, const Entry& entry)
    : device_{&device},
      entry_{&entry},
      meaning_{meaning_of_integer(entry)},
      quantity_{quantity_of(entry)},
      error_code_{error_code_place(device, entry)} {
  const bool is_communication = entry.index >= 0x1000 && entry.index < 0x2000;
  if (meaning_ != nullptr) {
    values_ = meaning_->values ? &*meaning_->values : nullptr;
    has_fields_ = meaning_->has_fields();
  }
  if (has_fields_ && error_code_ == ErrorCodePlace::none) {
    words_ = std::make_shared<std::array<WordText, max_words>>();
  }
  is_hexadecimal_ = is_communication && entry.type->type == canopen::DataType::unsigned32 && values_ == nullptr &&
                    !has_fields_ && quantity_ == nullptr;
  if (quantity_ != nullptr && is_integer(*entry.type) && !quantity_->is_raw()) scale_ = DecimalScale{*quantity_};
}

void ValueFormat::append_quantity(std::string& text, std::uint64_t number) const {
  const DataTypeRow& type = *entry_->type;
  const auto raw = scale_.factor != 0 ? integer_of(type, number) : std::nullopt;
  if (raw && scale_.append(text, *raw)) return append_unit(text, quantity_->symbol);
  append_physical(text, *quantity_, type, number, type.bits);
}

bool ValueFormat::append_named(std::string& text, std::uint64_t number) const {
  if (values_ == nullptr) return false;
  const DataTypeRow& type = *entry_->type;
  const bool is_signed = type.kind == DataClass::signed_integer;
  const std::int64_t value = is_signed ? sign_extended(number, type.bits) : static_cast<std::int64_t>(number);
  const NamedValue* const named = values_->find(value);
  if (named == nullptr) return false;
  append_decimal(text, named->value);
  text += ' ';
  text += named->name;
  return true;
}

WordText* ValueFormat::word(std::uint64_t number, std::optional<std::int64_t> other) const {
  if (!words_) return nullptr;
  constexpr std::uint64_t spread = 0x9E37'79B9'7F4A'7C15;  // 2^64 divided by the golden ratio
  WordText& kept = (*words_)[(number * spread >> 59) % max_words];
  if (kept.is_of(number, other)) return &kept;
  kept.number = number;
  kept.other = other;
  kept.text.clear();
  kept.json.clear();
  if (append_named(kept.text, number)) return &kept;
  append_hex_number(kept.text, number, (entry_->type->bits + 3U) / 4);
  kept.text += ' ';
  const std::size_t before = kept.text.size();
  append_parts(kept.text, *meaning_, number, other);
  if (kept.text.size() == before) kept.text.pop_back();
  return &kept;
}

void ValueFormat::append(std::string& text, std::uint64_t number, std::optional<std::int64_t> other) const {
  const DataTypeRow& type = *entry_->type;
  if (error_code_ != ErrorCodePlace::none) {
    return append_error_value(text, *device_, *entry_, static_cast<std::uint32_t>(number));
  }
  if (const WordText* const kept = word(number, other)) {
    text += kept->text;
    return;
  }
  if (append_named(text, number)) return;
  if (quantity_ != nullptr) return append_quantity(text, number);
  if (is_hexadecimal_) return append_hex_number(text, number, 8);
  append_number(text, type, number, type.bits);
}

}  // namespace edsc
