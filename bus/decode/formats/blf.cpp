/// BLF, the binary logs of Vector's tools. Vector does not publish the format; this is what open readers know of it: a
/// file header, then objects, of which containers hold more objects, mostly compressed by zlib. All numbers are
/// little-endian. Times are in 10 us or 1 ns after the start, which the file header has as a date.
#include <fmt/format.h>

#include <algorithm>
#include <chrono>
#include <cstring>
#include <memory>
#include <string>
#include <string_view>
#include <utility>

#include "decode/formats/log_formats.hpp"
#include "decode/formats/words.hpp"
#include "system/gzip.hpp"

namespace edsc {
namespace {

constexpr std::string_view file_mark = "LOGG", object_mark = "LOBJ";
constexpr std::size_t min_file_header = 72, base_header = 16, container_header = 16;
/// A larger object is the sign of a damaged file.
constexpr std::size_t max_object = std::size_t{1} << 24;

enum class ObjectType : std::uint32_t {
  can_message = 1,
  can_error = 2,
  container = 10,
  can_error_extended = 73,
  can_message_2 = 86,
  can_fd_message = 100,
  can_fd_message_64 = 101,
};

/// A number of these bytes at an offset; 0 beyond the end.
std::uint64_t blf_number(std::string_view bytes, std::size_t at, std::size_t size) {
  std::uint64_t number = 0;
  for (std::size_t i = size; i-- > 0;) {
    number = number << 8U | (at + i < bytes.size() ? static_cast<std::uint8_t>(bytes[at + i]) : 0U);
  }
  return number;
}

/// The SYSTEMTIME at the offset, as microseconds since 1970; 0 if it is not a date.
std::int64_t blf_start(std::string_view header, std::size_t at) {
  const auto field = [&](std::size_t i) { return static_cast<unsigned>(blf_number(header, at + 2 * i, 2)); };
  const std::chrono::year_month_day date{std::chrono::year{static_cast<int>(field(0))}, std::chrono::month{field(1)},
                                         std::chrono::day{field(3)}};
  if (!date.ok() || field(0) < 1970) return 0;
  const auto time = std::chrono::sys_days{date} + std::chrono::hours{field(4)} + std::chrono::minutes{field(5)} +
                    std::chrono::seconds{field(6)} + std::chrono::milliseconds{field(7)};
  return std::chrono::duration_cast<std::chrono::microseconds>(time.time_since_epoch()).count();
}

class BlfSource final : public LogSource {
 public:
  explicit BlfSource(LogInput& input) : input_{input} {}

  /// Returns a problem, or nothing.
  [[nodiscard]] std::string open() {
    std::string header(min_file_header, '\0');
    if (!read_all(header)) return "the file header is not complete";
    const std::uint64_t size = blf_number(header, 4, 4);
    if (!header.starts_with(file_mark) || size < min_file_header || size > max_object) return "not a BLF file";
    start_us_ = blf_start(header, 40);
    header.resize(size - min_file_header);
    return read_all(header) ? "" : "the file header is not complete";
  }

  [[nodiscard]] bool next(LogLine& line) override {
    while (!at_end_) {
      line = {};
      line.byte = input_.position();
      std::string_view object;
      if (!next_object(object)) return end_with(line);
      if (!parse(object, line)) continue;
      line.number = ++objects_;
      return true;
    }
    return false;
  }

 private:
  [[nodiscard]] bool read_all(std::string& bytes) {
    std::size_t at = 0;
    while (at < bytes.size()) {
      const std::size_t count = input_.read(bytes.data() + at, bytes.size() - at);
      if (count == 0) return false;
      at += count;
    }
    return true;
  }

  bool end_with(LogLine& line) {
    at_end_ = true;
    if (input_.error() != 0 || problem_.empty()) return false;
    line.number = ++objects_;
    line.kind = LogLineKind::unreadable;
    line.problem = problem_;
    return true;
  }

  [[nodiscard]] bool fail(std::string problem) {
    if (input_.error() == 0) problem_ = std::move(problem);
    return false;
  }

  /// The next object of the containers read so far, which may continue in the next container.
  [[nodiscard]] bool next_object(std::string_view& object) {
    while (true) {
      const std::string_view rest = std::string_view{content_}.substr(used_);
      // Between objects are up to 3 bytes of padding.
      const std::size_t begin = rest.substr(0, base_header).find(object_mark);
      if (begin != std::string_view::npos && rest.size() >= begin + base_header) {
        const std::uint64_t size = blf_number(rest, begin + 8, 4);
        if (size < base_header || size > max_object) return fail("an object has an impossible length");
        if (rest.size() >= begin + size) {
          object = rest.substr(begin, size);
          used_ += begin + size;
          return true;
        }
      } else if (begin == std::string_view::npos && rest.size() >= base_header) {
        return fail("no object where one is expected");
      }
      if (!read_object_of_file()) return false;
    }
  }

  /// Appends the contents of the next object of the file: of a container its objects, else the object itself.
  [[nodiscard]] bool read_object_of_file() {
    std::string object(1, '\0');
    // Up to 3 bytes of padding, which need not follow the last object.
    for (int padding = 0; object.front() != object_mark.front(); ++padding) {
      if (!read_all(object)) return content_.size() - used_ < base_header ? false : fail("the log ends in an object");
      if (padding > 3) return fail("no object where one is expected");
    }
    object.resize(base_header);
    std::string rest(base_header - 1, '\0');
    if (!read_all(rest)) return fail("the log ends in an object");
    object.replace(1, rest.size(), rest);
    if (!object.starts_with(object_mark)) return fail("no object where one is expected");
    const std::uint64_t size = blf_number(object, 8, 4);
    if (size < base_header || size > max_object) return fail("an object has an impossible length");
    std::string body(size - base_header, '\0');
    if (!read_all(body)) return fail("the log ends in an object");
    content_.erase(0, std::exchange(used_, 0));
    if (static_cast<ObjectType>(blf_number(object, 12, 4)) == ObjectType::container) return append_container(body);
    content_ += object + body;
    return true;
  }

  [[nodiscard]] bool append_container(std::string_view body) {
    constexpr std::uint64_t not_compressed = 0, zlib = 2;
    if (body.size() < container_header) return fail("a container without a header");
    const std::uint64_t method = blf_number(body, 0, 2), size = blf_number(body, 8, 4);
    const std::string_view data = body.substr(container_header);
    if (method == not_compressed) {
      content_ += data;
      return true;
    }
    if (method != zlib) return fail(fmt::format("compression method {} is not known", method));
    if (size > max_object) return fail("a container has an impossible length");
    std::string unpacked;
    if (const std::string problem = unpack_zlib(data, size, unpacked); !problem.empty()) return fail(problem);
    content_ += unpacked;
    return true;
  }

  /// Returns false for an object that is not a frame.
  [[nodiscard]] bool parse(std::string_view object, LogLine& line) {
    constexpr std::uint32_t ten_microseconds = 1;
    const std::size_t header = blf_number(object, 4, 2);
    const auto type = static_cast<ObjectType>(blf_number(object, 12, 4));
    if (header < base_header + 16 || header > object.size()) return false;
    const std::uint64_t ticks = blf_number(object, 24, 8);
    const bool is_coarse = blf_number(object, 16, 4) == ten_microseconds;
    constexpr auto longest = static_cast<std::uint64_t>(max_log_time_us / 2);
    const std::uint64_t elapsed_us = is_coarse ? std::min(ticks, longest / 10) * 10 : ticks / 1000;
    const std::string_view body = object.substr(header);
    if (!parse_body(type, body, line)) return false;
    line.has_time = true;
    line.microseconds = start_us_ + static_cast<std::int64_t>(std::min(elapsed_us, longest));
    time_.clear();
    append_seconds(time_, line.microseconds);
    line.time = time_;
    const std::size_t channel_bytes = type == ObjectType::can_fd_message_64 ? 1 : 2;
    channel_ = fmt::format("{}", blf_number(body, 0, channel_bytes));
    line.interface = channel_;
    return true;
  }

  /// Returns false for an object that is not a frame.
  [[nodiscard]] static bool parse_body(ObjectType type, std::string_view body, LogLine& line) {
    constexpr std::uint64_t remote = 0x80, fd = 1, remote_64 = 0x10, fd_64 = 0x1000;
    switch (type) {
      case ObjectType::can_message:
      case ObjectType::can_message_2:
        parse_frame(body, {4, 3, 8}, (blf_number(body, 2, 1) & remote) != 0, line);
        return true;
      case ObjectType::can_fd_message:
        parse_frame(body, {4, 3, 20}, (blf_number(body, 2, 1) & remote) != 0, line);
        if ((blf_number(body, 13, 1) & fd) != 0) line.kind = LogLineKind::can_fd;
        return true;
      case ObjectType::can_fd_message_64:
        parse_frame(body, {4, 1, 40}, (blf_number(body, 12, 4) & remote_64) != 0, line);
        if ((blf_number(body, 12, 4) & fd_64) != 0) line.kind = LogLineKind::can_fd;
        return true;
      case ObjectType::can_error:
      case ObjectType::can_error_extended:
        line.kind = LogLineKind::error_frame;
        line.frame.extended = true;  // the CAN-ID of an error frame has error flags; they are not known here
        return true;
      case ObjectType::container: break;
    }
    return false;
  }

  struct Places {
    std::size_t id, length, data;
  };

  static void parse_frame(std::string_view body, Places at, bool is_remote, LogLine& line) {
    constexpr std::uint32_t extended_flag = 0x8000'0000;
    line.kind = LogLineKind::frame;
    const auto id = static_cast<std::uint32_t>(blf_number(body, at.id, 4));
    line.frame.extended = (id & extended_flag) != 0;
    line.frame.id = id & 0x1FFF'FFFFU;
    line.frame.remote = is_remote;
    line.frame.size = static_cast<std::uint8_t>(std::min<std::uint64_t>(blf_number(body, at.length, 1), 8));
    if (!line.frame.extended && line.frame.id > 0x7FF) {
      line = broken(line, "the CAN-ID has more than 11 bits");
    } else if (!is_remote && body.size() < at.data + line.frame.size) {
      line = broken(line, "fewer bytes than the length states");
    } else if (!is_remote) {
      std::memcpy(line.frame.data.data(), body.data() + at.data, line.frame.size);
    }
  }

  LogInput& input_;
  std::int64_t start_us_ = 0;
  std::string content_;  ///< objects of containers
  std::size_t used_ = 0;
  std::size_t objects_ = 0;
  bool at_end_ = false;
  std::string problem_, time_, channel_;
};

bool is_blf(std::string_view beginning) { return beginning.starts_with(file_mark); }

std::unique_ptr<LogSource> open_blf(LogInput& input, std::string& problem) {
  auto source = std::make_unique<BlfSource>(input);
  problem = source->open();
  return problem.empty() ? std::move(source) : nullptr;
}

}  // namespace

const LogFormat blf_format{"blf", "binary log of Vector", is_blf, open_blf};

}  // namespace edsc
