#include "values/read_value.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <bit>
#include <cmath>
#include <string>

#include "diagnostics/quote.hpp"
#include "eds/ini.hpp"
#include "eds/number.hpp"
#include "text/ascii.hpp"
#include "values/value_bytes.hpp"

namespace edsc {
namespace {

using canopen::DataClass;
using canopen::DataType;
using canopen::DataTypeRow;

constexpr std::uint64_t last_node_id = 127;

/// `0.5f`.
std::string_view without_real_suffix(std::string_view digits) {
  const bool has_suffix = digits.size() > 1 && std::string_view{"fFlL"}.find(digits.back()) != std::string_view::npos;
  const char before = has_suffix ? digits[digits.size() - 2] : ' ';
  return is_digit(before) || before == '.' ? digits.substr(0, digits.size() - 1) : digits;
}

/// Parses the value of one field.
class ValueReader {
 public:
  ValueReader(const Field& field, const DataTypeRow& type, std::optional<std::uint8_t> node_id,
              std::optional<Limit> limit, Diagnostics& diagnostics)
      : field_{field}, type_{type}, node_id_{node_id}, limit_{limit}, diagnostics_{diagnostics} {}

  /// A decimal number outside the range of the type is not read as two's complement.
  ValueReader& exactly() {
    is_exact_ = true;
    return *this;
  }

  std::optional<Value> read() {
    if (!field_.present || trim(field_.text).empty()) return std::nullopt;
    switch (type_.kind) {
      case DataClass::string: return string();
      case DataClass::domain:
        warning("domain-value", "a DOMAIN cannot have a value in an EDS; ignored", "value");
        return std::nullopt;
      case DataClass::boolean:
      case DataClass::unsigned_integer:
      case DataClass::signed_integer:
      case DataClass::real:
      case DataClass::time: break;
    }
    const std::string_view written = strip_inline_comment(field_.text);
    const std::string_view text = without_quotes(written);
    if (text.size() != written.size()) {
      warning("number-spelling", "a number must be written without quotation marks", "quotes");
      spell(std::string{text}, "a number without quotation marks (CiA 306-1, 4.2)");
    }
    if (text.find('$') != std::string_view::npos) return formula(text);
    if (type_.kind == DataClass::real) return real(text);
    if (type_.kind == DataClass::boolean) return boolean(text);
    if (type_.kind == DataClass::time) {
      if (auto pair = days_and_milliseconds(text)) return pair;
    }
    return integer(text);
  }

 private:
  [[nodiscard]] Value value(std::uint64_t bits) const {
    const bool hexadecimal =
        field_.text.find("0x") != std::string_view::npos || field_.text.find("0X") != std::string_view::npos;
    return {.bits = bits, .hexadecimal = hexadecimal, .position = field_.position};
  }

  void error(ErrorRule rule, std::string message, std::string cause = {}) {
    diagnostics_.error(rule, field_.position, std::move(message), {}, std::move(cause));
  }
  void warning(WarningRule rule, std::string message, std::string cause = {}) {
    diagnostics_.warning(rule, field_.position, std::move(message), {}, std::move(cause));
  }

  /// Offers another spelling of the same number.
  void spell(std::string text, std::string reason) {
    diagnostics_.offer_value("number-spelling", field_.position, std::move(text), std::move(reason));
  }

  std::optional<Value> not_a_number() {
    error("number-format", fmt::format("{} is not a value of type {}", quote(field_.text), type_.name),
          std::string{trim(field_.text)});
    return std::nullopt;
  }

  /// The cause of findings of one text that is not in the range of one type, as a tool writes it in many places.
  [[nodiscard]] std::string same_text() const { return fmt::format("{} {}", type_.name, trim(field_.text)); }

  /// `$NODEID`, `$NODEID+0x180`, `0x180 + $NodeID`: CiA 306-1, 4.6.2.3.
  std::optional<Value> formula(std::string_view text) {
    if (type_.kind != DataClass::unsigned_integer && type_.kind != DataClass::signed_integer) return not_a_number();
    if (std::ranges::count(text, '+') > 1) return sum(text);
    const auto [variable, constant] = split_formula(text);
    const auto parsed = constant ? parse_unsigned(without_c_suffix(*constant)) : std::optional<std::uint64_t>{0};
    if (!is_node_id(variable) || !parsed) {
      error("node-id-formula", fmt::format("{} is not a valid $NODEID formula", quote(text)));
      return std::nullopt;
    }
    return formula(*parsed, constant && is_hexadecimal(*constant));
  }

  /// `0x180 + $NODEID + 0x40000000`: CiA 306 allows one constant.
  std::optional<Value> sum(std::string_view text) {
    std::uint64_t constant = 0;
    unsigned variables = 0;
    for (std::string_view rest = text; !rest.empty();) {
      const std::size_t plus = rest.find('+');
      const std::string_view term = trim(rest.substr(0, plus));
      rest = plus == std::string_view::npos ? std::string_view{} : rest.substr(plus + 1);
      const auto number = parse_unsigned(without_c_suffix(term));
      if (number && *number <= mask() - std::min(mask(), constant)) {
        constant += *number;
      } else if (!number && is_node_id(term)) {
        ++variables;
      } else {
        variables = 0;
        break;
      }
    }
    if (variables != 1 || text.ends_with('+')) {
      error("node-id-formula", fmt::format("{} is not a valid $NODEID formula", quote(text)));
      return std::nullopt;
    }
    warning("node-id-formula",
            fmt::format("reading {} as $NODEID+0x{:X}: a formula has one constant", quote(text), constant));
    return formula(constant, true);
  }

  /// The constant may be the two's complement of a negative number, as a value without $NODEID.
  std::optional<Value> formula(std::uint64_t constant, bool hexadecimal) {
    const bool is_signed = type_.kind == DataClass::signed_integer;
    const std::uint64_t highest = is_signed ? mask() >> 1U : mask();
    std::uint64_t last_fitting = last_node_id;
    if (constant > highest && constant <= mask() && hexadecimal) {
      constant |= ~mask();
    } else {
      last_fitting = constant > highest ? 0 : std::min(highest - constant, last_node_id);
    }
    if (node_id_) {
      if (*node_id_ > last_fitting) return out_of_range(true, fmt::format(" with node-ID {}", *node_id_));
      return value(constant + *node_id_);
    }
    if (last_fitting == 0) return out_of_range(true, " with any node-ID");
    // A limit is checked for a known node-ID only.
    if (last_fitting < last_node_id && !limit_) {
      return out_of_range(true, fmt::format(" with node-IDs above {}", last_fitting));
    }
    std::optional<Value> result = value(constant);
    result->plus_node_id = true;
    return result;
  }

  bool is_node_id(std::string_view variable) {
    if (equal_ignoring_case(variable, "$NODEID")) return true;
    if (!equal_ignoring_case(variable, "$NODE_ID") && !equal_ignoring_case(variable, "$MY_NODE_ID")) return false;
    warning("node-id-formula", fmt::format("reading {} as $NODEID", variable), std::string{variable});
    return true;
  }

  /// `above` or below all values of the type. `condition` is the end of the message.
  std::optional<Value> out_of_range(bool above, std::string_view condition = "") {
    if (limit_ == (above ? Limit::high : Limit::low)) {
      warning("number-range",
              fmt::format("{} is outside the range of {}{}; this limit has no effect and is ignored",
                          quote(field_.text), type_.name, condition),
              same_text());
      return std::nullopt;
    }
    error("number-range", fmt::format("{} does not fit into {}{}", quote(field_.text), type_.name, condition),
          same_text());
    return std::nullopt;
  }

  std::optional<Value> boolean(std::string_view text) {
    if (equal_ignoring_case(text, "true") || equal_ignoring_case(text, "false")) {
      warning("number-spelling", "a BOOLEAN must be written as 0 or 1", "BOOLEAN");
      return value(equal_ignoring_case(text, "true") ? 1 : 0);
    }
    const auto number = parse_unsigned(without_c_suffix(text));
    if (!number) return not_a_number();
    if (*number > 1) {
      warning("number-range", fmt::format("\"{}\" is not a BOOLEAN; reading it as 1", text), same_text());
    }
    return value(*number != 0 ? 1 : 0);
  }

  std::optional<Value> integer(std::string_view text) {
    const bool negative = text.starts_with('-');
    const std::string_view digits = negative ? trim(text.substr(1)) : text;
    const std::string_view plain = without_c_suffix(digits);
    const auto magnitude = parse_unsigned(plain);
    if (!magnitude) return unusual_integer(text);
    if (is_octal(plain)) {
      warning("number-spelling", fmt::format("a leading 0 makes {} an octal number: {}", quote(text), *magnitude),
              "octal");
    }
    if (plain.size() != digits.size()) warning("number-spelling", "a C suffix is not allowed in an EDS", "suffix");
    return negative ? negative_integer(*magnitude) : positive_integer(*magnitude, is_hexadecimal(plain));
  }

  std::optional<Value> negative_integer(std::uint64_t magnitude) {
    const std::uint64_t lowest = std::uint64_t{1} << (type_.bits - 1);
    const bool is_unsigned = type_.kind != DataClass::signed_integer;
    if (magnitude > lowest || ((limit_ || is_exact_) && is_unsigned && magnitude != 0)) return out_of_range(false);
    if (is_unsigned && magnitude != 0) {
      warning("number-range",
              fmt::format("negative value of the unsigned type {}; using its two's complement", type_.name),
              fmt::format("negative {}", type_.name));
      return value((~magnitude + 1) & mask());
    }
    return value(~magnitude + 1);
  }

  /// A signed value in hexadecimal may be its two's complement: 0xFFFF is -1 of an INTEGER16.
  std::optional<Value> positive_integer(std::uint64_t magnitude, bool hexadecimal) {
    if (magnitude > mask()) return out_of_range(true);
    if (type_.kind != DataClass::signed_integer) return value(magnitude);
    const std::uint64_t sign = std::uint64_t{1} << (type_.bits - 1);
    if (magnitude < sign) return value(magnitude);
    if (!hexadecimal && (limit_ || is_exact_)) return out_of_range(true);
    if (!hexadecimal) {
      warning(
          "number-range",
          fmt::format("{} exceeds the maximum of {}; reading it as two's complement", quote(field_.text), type_.name),
          fmt::format("decimal {}", type_.name));
    }
    return value(magnitude | ~mask());
  }

  /// `80h`, or `0.0` or `0089` for an integer: accepted if the value is exact.
  std::optional<Value> unusual_integer(std::string_view text) {
    if (const auto hexadecimal = parse_h_suffix(text)) {
      warning("number-spelling", fmt::format("a hexadecimal number must be written with 0x, not as {}", quote(text)),
              "suffix h");
      spell(fmt::format("0x{:0{}X}", *hexadecimal, (type_.bits + 3) / 4), "a hexadecimal number (CiA 306-1, 4.2)");
      return positive_integer(*hexadecimal, true);
    }
    const auto number = parse_real(text);
    if (!number || std::trunc(*number) != *number || std::abs(*number) > 9e15) return not_a_number();
    if (text.find_first_of(".eE") == std::string_view::npos) {
      warning("number-spelling",
              fmt::format("\"{}\" has a leading 0, but is not an octal number; reading it as decimal", text),
              "leading 0");
    } else {
      warning("number-spelling", fmt::format("a value of type {} must be written without a decimal point", type_.name),
              "point");
      spell(fmt::format("{:.0f}", *number), "an integer without decimal point (CiA 306-1, 4.2)");
    }
    const auto magnitude = static_cast<std::uint64_t>(std::abs(*number));
    return *number < 0 ? negative_integer(magnitude) : positive_integer(magnitude, false);
  }

  /// A hexadecimal number is the IEEE 754 pattern; otherwise a decimal number.
  std::optional<Value> real(std::string_view text) {
    if (is_hexadecimal(text)) {
      const auto bits = parse_unsigned(text);
      if (!bits) return not_a_number();
      if (*bits > mask()) return out_of_range(true);
      return value(*bits);
    }
    const std::string_view plain = without_real_suffix(text);
    const auto number = parse_real(plain);
    if (!number) return not_a_number();
    if (plain.size() != text.size()) warning("number-spelling", "a C suffix is not allowed in an EDS", "suffix");
    if (type_.bits == 64) return value(std::bit_cast<std::uint64_t>(*number));
    const auto single = static_cast<float>(*number);
    if (std::isinf(single) && !std::isinf(*number)) return out_of_range(*number > 0);
    if (single == 0 && *number != 0) {
      warning("number-range", fmt::format("{} is too close to 0 for {}; reading it as 0", quote(text), type_.name),
              same_text());
    }
    return value(std::bit_cast<std::uint32_t>(single));
  }

  /// TIME_OF_DAY as two numbers: days and milliseconds.
  std::optional<Value> days_and_milliseconds(std::string_view text) {
    const std::size_t blank = text.find_first_of(" \t");
    if (blank == std::string_view::npos) return std::nullopt;
    const auto days = parse_unsigned(text.substr(0, blank));
    const auto milliseconds = parse_unsigned(trim(text.substr(blank)));
    if (!days || !milliseconds || *days > 0xFFFF || *milliseconds > 0x0FFF'FFFF) return std::nullopt;
    return value((*days << 32) | *milliseconds);
  }

  std::optional<Value> string() {
    Value result = value(0);
    if (type_.type == DataType::octet_string) {
      if (!hex_bytes(field_.text, result.bytes)) {
        warning("octet-string", "an OCTET_STRING must be written as pairs of hexadecimal digits; using its characters");
        result.bytes = field_.text;
      }
    } else {
      const std::string_view text = field_.text;
      if (text.size() >= 2 && text.front() == '"' && text.back() == '"') {
        warning("string-quotes", "the quotation marks are part of the string; an EDS does not put them around it",
                "quotes");
      }
      result.bytes = text;
    }
    return result;
  }

  static bool hex_bytes(std::string_view text, std::string& bytes) {
    int high = -1;
    for (const char c : is_hexadecimal(text) ? text.substr(2) : text) {
      if (c == ' ' || c == '\t') continue;
      const int digit = c >= '0' && c <= '9'   ? c - '0'
                        : c >= 'a' && c <= 'f' ? c - 'a' + 10
                        : c >= 'A' && c <= 'F' ? c - 'A' + 10
                                               : -1;
      if (digit < 0) return false;
      if (high < 0) {
        high = digit;
      } else {
        bytes += static_cast<char>(high * 16 + digit);
        high = -1;
      }
    }
    if (high >= 0) bytes.clear();
    return high < 0;
  }

  [[nodiscard]] std::uint64_t mask() const { return low_bits(type_.bits); }

  const Field& field_;
  const DataTypeRow& type_;
  std::optional<std::uint8_t> node_id_;
  std::optional<Limit> limit_;
  bool is_exact_ = false;
  Diagnostics& diagnostics_;
};

}  // namespace

std::optional<Value> parse_value(const Field& field, const canopen::DataTypeRow& type,
                                 std::optional<std::uint8_t> node_id, Diagnostics& diagnostics) {
  return ValueReader{field, type, node_id, std::nullopt, diagnostics}.read();
}

std::optional<Value> parse_exact_value(const Field& field, const canopen::DataTypeRow& type, std::uint8_t node_id,
                                       Diagnostics& diagnostics) {
  return ValueReader{field, type, node_id, std::nullopt, diagnostics}.exactly().read();
}

std::optional<Value> parse_limit(const Field& field, Limit which, const canopen::DataTypeRow& type,
                                 std::optional<std::uint8_t> node_id, Diagnostics& diagnostics) {
  return ValueReader{field, type, node_id, which, diagnostics}.read();
}

bool is_less(const DataTypeRow& type, std::uint64_t a, std::uint64_t b) {
  if (type.kind == DataClass::signed_integer) return static_cast<std::int64_t>(a) < static_cast<std::int64_t>(b);
  return type.kind == DataClass::real ? real_of(a, type) < real_of(b, type) : a < b;
}

}  // namespace edsc
