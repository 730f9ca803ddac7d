/// Compressed data: gzip files (RFC 1952), as EDS files that devices store, and zlib streams.
#pragma once

#include <cstddef>
#include <string>
#include <string_view>

namespace edsc {

[[nodiscard]] bool is_gzip(std::string_view bytes);

/// Returns the same file for the same bytes: without name, time and operating system.
[[nodiscard]] std::string gzip(std::string_view bytes);

/// Unpacks a gzip file into `content`. Stops above `max_bytes`, and above 1 MiB if that is more than 200 times the
/// bytes read so far, as such a file is made to exhaust memory. Returns the reason; empty on success.
[[nodiscard]] std::string gunzip(std::string_view bytes, std::size_t max_bytes, std::string& content);

/// The same for a zlib stream (RFC 1950), as in the containers of BLF logs.
[[nodiscard]] std::string unpack_zlib(std::string_view bytes, std::size_t max_bytes, std::string& content);

}  // namespace edsc
