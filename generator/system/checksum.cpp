#include "system/checksum.hpp"

#define ZLIB_CONST  // as in gzip.cpp, which may be compiled in one unit with this file
#include <zlib.h>

namespace edsc {

std::uint32_t checksum(std::string_view bytes) {
  return static_cast<std::uint32_t>(::crc32_z(0, reinterpret_cast<const Bytef*>(bytes.data()), bytes.size()));
}

}  // namespace edsc
