/// How the values of an entry are written. Prepared once for each entry: a log has many values of few entries.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <memory>
#include <optional>
#include <string>

#include "device/device.hpp"
#include "device/error_code_text.hpp"

namespace edsc {

/// A quantity whose physical values are finite decimals: `raw * factor + addend` is the value in units of 10^-decimals.
struct DecimalScale {
  std::int64_t factor = 0;  ///< 0: the quantity has no such scale
  std::int64_t addend = 0;
  unsigned decimals = 0;

  DecimalScale() = default;
  explicit DecimalScale(const Quantity& quantity);

  /// Appends `21.5`; returns false, and appends nothing, if the value does not fit.
  [[nodiscard]] bool append(std::string& text, std::int64_t raw) const;
};

/// A value of a word with fields, as text and as JSON: kept, because most frames repeat a value.
struct WordText {
  std::uint64_t number = 0;
  std::optional<std::int64_t> other;
  std::string text;
  std::string json;  ///< empty until it is needed

  [[nodiscard]] bool is_of(std::uint64_t wanted, std::optional<std::int64_t> wanted_other) const {
    return !text.empty() && number == wanted && other == wanted_other;
  }
};

/// Writes the same text as `value_text`, and names error codes. Copies share the texts that are kept; they belong to
/// one thread.
class ValueFormat {
 public:
  ValueFormat() = default;
  /// Device and entry must outlive the format.
  ValueFormat(const Device& device, const Entry& entry);

  /// `number`: of `entry.type->bits` bits, for BOOLEAN, integers, REAL and times. `other`: the value of the object on
  /// which fields depend; nothing if it is unknown.
  void append(std::string& text, std::uint64_t number, std::optional<std::int64_t> other) const;

  /// The texts of a value of a word with fields, until the next call; null for other entries.
  [[nodiscard]] WordText* word(std::uint64_t number, std::optional<std::int64_t> other) const;

  /// The meaning of an integer; null without one.
  [[nodiscard]] const Meaning* meaning() const { return meaning_; }
  /// Of a number; null without one.
  [[nodiscard]] const Quantity* quantity() const { return quantity_; }

 private:
  [[nodiscard]] bool append_named(std::string& text, std::uint64_t number) const;
  void append_quantity(std::string& text, std::uint64_t number) const;

  const Device* device_ = nullptr;
  const Entry* entry_ = nullptr;
  const Meaning* meaning_ = nullptr;
  const Quantity* quantity_ = nullptr;
  const Enumeration* values_ = nullptr;
  bool has_fields_ = false;
  bool is_hexadecimal_ = false;
  ErrorCodePlace error_code_ = ErrorCodePlace::none;
  DecimalScale scale_;
  static constexpr std::size_t max_words = 32;
  std::shared_ptr<std::array<WordText, max_words>> words_;
};

}  // namespace edsc
