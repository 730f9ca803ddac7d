/// gzip files (RFC 1952): data sheets that devices keep compressed.
#pragma once

#include <cstddef>
#include <string>
#include <string_view>

namespace edsc {

[[nodiscard]] bool is_gzip(std::string_view bytes);

/// The same file for the same bytes: without name, time and operating system.
[[nodiscard]] std::string gzip(std::string_view bytes);

/// Puts what a gzip file holds into `content`, `most` bytes at most. Gives the reason when that fails, else an empty
/// string.
[[nodiscard]] std::string gunzip(std::string_view bytes, std::size_t most, std::string& content);

}  // namespace edsc
