#include "system/gzip.hpp"

#define ZLIB_CONST  // the input of zlib is const
#include <fmt/format.h>
#include <zlib.h>

#include <new>

namespace edsc {
namespace {

constexpr int window_bits = 15;
constexpr int gzip_header = 16, zlib_header = 0;  ///< added to the window bits
constexpr int memory_level = 9;
constexpr int unknown_system = 255;
constexpr std::size_t max_at_once = std::size_t{1} << 16;

/// EDS files with 30,000 equal objects have a ratio of 35; files made to exhaust memory, of 1000.
constexpr std::size_t max_ratio = 200;
constexpr std::size_t any_ratio_bytes = std::size_t{1} << 20;  ///< up to this size

const Bytef* input_of(std::string_view bytes) { return reinterpret_cast<const Bytef*>(bytes.data()); }
Bytef* output_of(std::string& bytes, std::size_t at) { return reinterpret_cast<Bytef*>(&bytes[at]); }

std::string unpack(std::string_view bytes, std::size_t max_bytes, std::string& content, int header_bits,
                   std::string_view incomplete) {
  z_stream stream{};
  if (inflateInit2(&stream, window_bits + header_bits) != Z_OK) throw std::bad_alloc{};
  stream.next_in = input_of(bytes);
  stream.avail_in = static_cast<uInt>(bytes.size());
  content.clear();
  int result = Z_OK;
  const auto is_bomb = [&] {
    return content.size() > any_ratio_bytes && content.size() / max_ratio > static_cast<std::size_t>(stream.total_in);
  };
  while (result == Z_OK && content.size() <= max_bytes && !is_bomb()) {
    const std::size_t size = content.size();
    content.resize(size + max_at_once);
    stream.next_out = output_of(content, size);
    stream.avail_out = static_cast<uInt>(max_at_once);
    result = inflate(&stream, Z_NO_FLUSH);
    content.resize(size + max_at_once - stream.avail_out);
  }
  const bool whole = result == Z_STREAM_END && stream.avail_in == 0;
  const std::string place = fmt::format("stopped at byte {} of {}", stream.total_in, bytes.size());
  inflateEnd(&stream);
  if (content.size() > max_bytes) return fmt::format("unpacks to more than {} bytes; {}", max_bytes, place);
  if (is_bomb()) return fmt::format("unpacks to more than {} times its size; {}", max_ratio, place);
  return whole ? "" : std::string{incomplete};
}

}  // namespace

bool is_gzip(std::string_view bytes) { return bytes.starts_with("\x1F\x8B"); }

std::string gzip(std::string_view bytes) {
  z_stream stream{};
  if (deflateInit2(&stream, Z_BEST_COMPRESSION, Z_DEFLATED, window_bits + gzip_header, memory_level,
                   Z_DEFAULT_STRATEGY) != Z_OK) {
    throw std::bad_alloc{};
  }
  gz_header header{};
  header.os = unknown_system;
  deflateSetHeader(&stream, &header);
  std::string file(deflateBound(&stream, static_cast<uLong>(bytes.size())), '\0');
  stream.next_in = input_of(bytes);
  stream.avail_in = static_cast<uInt>(bytes.size());
  stream.next_out = output_of(file, 0);
  stream.avail_out = static_cast<uInt>(file.size());
  deflate(&stream, Z_FINISH);
  file.resize(stream.total_out);
  deflateEnd(&stream);
  return file;
}

std::string gunzip(std::string_view bytes, std::size_t max_bytes, std::string& content) {
  return unpack(bytes, max_bytes, content, gzip_header, "not a complete gzip file");
}

std::string unpack_zlib(std::string_view bytes, std::size_t max_bytes, std::string& content) {
  return unpack(bytes, max_bytes, content, zlib_header, "not a complete zlib stream");
}

}  // namespace edsc
