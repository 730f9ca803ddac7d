/// A value, or the SDO abort code that explains why it is missing.
#pragma once

#include <utility>

#include "canopen/base/abort_code.hpp"

namespace canopen {

///     if (const auto speed = drive.read<od::velocity_actual_value>()) use(*speed); else
///     log(to_text(speed.abort_code()));
template <class Type>
class [[nodiscard]] Result {
 public:
  constexpr Result(Type value)
      : value_{std::move(value)} {}  // NOLINT(google-explicit-constructor): a value is a result
  /// `code` must not be `ok`.
  constexpr Result(AbortCode code) : abort_code_{code} {}  // NOLINT(google-explicit-constructor): so is an abort code

  [[nodiscard]] constexpr bool has_value() const { return abort_code_ == ok; }
  constexpr explicit operator bool() const { return has_value(); }

  /// Returns the value, which must not be missing: the program ends with a trap, on a processor with its fault handler.
  constexpr const Type& operator*() const { return *required(); }
  constexpr const Type* operator->() const { return required(); }
  /// Returns the value, or `other` if it is missing.
  [[nodiscard]] constexpr Type value_or(Type other) const { return has_value() ? value_ : other; }
  /// Returns the value; a default-constructed one if it is missing.
  [[nodiscard]] constexpr const Type& value() const { return value_; }

  /// Returns the reason for a missing value; `ok` if there is a value.
  [[nodiscard]] constexpr AbortCode abort_code() const { return abort_code_; }

 private:
  [[nodiscard]] constexpr const Type* required() const {
    if (!has_value()) __builtin_trap();
    return &value_;
  }

  Type value_{};
  AbortCode abort_code_ = ok;
};

/// The result of a write: success, or an abort code.
template <>
class [[nodiscard]] Result<void> {
 public:
  constexpr Result() = default;
  constexpr Result(AbortCode code) : abort_code_{code} {}  // NOLINT(google-explicit-constructor): `ok` included

  constexpr explicit operator bool() const { return abort_code_ == ok; }
  [[nodiscard]] constexpr AbortCode abort_code() const { return abort_code_; }

 private:
  AbortCode abort_code_ = ok;
};

}  // namespace canopen
