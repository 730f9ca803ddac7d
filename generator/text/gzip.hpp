/// gzip files (RFC 1952): data sheets that devices keep compressed.
#pragma once

#include <cstddef>
#include <string>
#include <string_view>

namespace edsc {

[[nodiscard]] bool is_gzip(std::string_view bytes);

/// The same file for the same bytes: without name, time and operating system.
[[nodiscard]] std::string gzip(std::string_view bytes);

/// Unpacks a gzip file into `content`. Stops at more than `max_bytes`, and at more than 1 MiB that is over 200 times as
/// much as the bytes read so far: such a file is made to fill the memory. Returns the reason, empty on success.
[[nodiscard]] std::string gunzip(std::string_view bytes, std::size_t max_bytes, std::string& content);

}  // namespace edsc
