/// Durations as users write them: `10ms`, `3s`, `1m`, `1h`.
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <string_view>

namespace edsc {

/// What a duration looks like, for messages.
inline constexpr const char* duration_form = "a duration, such as 10ms, 3s, 1m or 1h";

/// Parses a decimal number, with or without a fraction, and a unit: us, ms, s, m or h. Returns microseconds; nothing if
/// the text is anything else, has a fraction of a microsecond, or is more than max_duration_us.
[[nodiscard]] std::optional<std::uint64_t> parse_duration(std::string_view text);

/// More than a hundred years: sums of durations do not overflow.
inline constexpr std::uint64_t max_duration_us = 1'000'000ULL * 3600 * 1'000'000;

/// In the largest unit that needs no fraction: `90s`, `1m`, `500ms`.
[[nodiscard]] std::string duration_text(std::uint64_t microseconds);

}  // namespace edsc
