/// CRC-32 of bytes, as in gzip files.
#pragma once

#include <cstdint>
#include <string_view>

namespace edsc {

[[nodiscard]] std::uint32_t checksum(std::string_view bytes);

}  // namespace edsc
