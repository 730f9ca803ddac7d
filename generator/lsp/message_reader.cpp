#include "lsp/message_reader.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <utility>

#include "eds/ini.hpp"
#include "text/number_text.hpp"

namespace edsc::lsp {
namespace {

constexpr std::string_view length_field = "Content-Length:";

std::string_view without_blanks(std::string_view text) {
  const std::size_t first = text.find_first_not_of(" \t\r");
  if (first == std::string_view::npos) return {};
  return text.substr(first, text.find_last_not_of(" \t\r") - first + 1);
}

/// The length that a header states.
std::optional<std::size_t> length_in(std::string_view header) {
  while (!header.empty()) {
    const std::size_t end = header.find('\n');
    const std::string_view line = header.substr(0, end);
    header.remove_prefix(end == std::string_view::npos ? header.size() : end + 1);
    if (starts_with_ignoring_case(line, length_field)) {
      return parse_whole<std::size_t>(without_blanks(line.substr(length_field.size())));
    }
  }
  return std::nullopt;
}

}  // namespace

void MessageReader::skip_header(std::size_t bytes, std::string_view fault) {
  begin_ += bytes;
  if (fault_.empty()) fault_ = fault;
}

bool MessageReader::read_header() {
  const std::string_view rest = std::string_view{pending_}.substr(begin_);
  const std::size_t with_cr = rest.find("\r\n\r\n");
  const std::size_t without_cr = rest.find("\n\n");
  const std::size_t end = std::min(with_cr, without_cr);
  if (end == std::string_view::npos || end > max_header_bytes) {
    if (rest.size() <= max_header_bytes) return false;
    const std::size_t next = rest.find(length_field, 1);
    skip_header(next == std::string_view::npos ? rest.size() - length_field.size() : next,
                "text that is not a header was skipped");
    return next != std::string_view::npos;
  }
  const std::size_t size = end + (with_cr < without_cr ? 4 : 2);
  const auto length = length_in(rest.substr(0, end));
  if (!length) {
    skip_header(size, "a header without a valid Content-Length was skipped");
  } else if (*length > max_message_bytes) {
    skip_header(size, fmt::format("a message of {} bytes was skipped", *length));
    skipped_ = *length;
  } else {
    begin_ += size;
    length_ = length;
  }
  return true;
}

std::optional<std::string> MessageReader::next() {
  while (true) {
    const std::size_t skipped = std::min(skipped_, pending_.size() - begin_);
    begin_ += skipped;
    skipped_ -= skipped;
    if (skipped_ == 0 && length_ && pending_.size() - begin_ >= *length_) {
      std::string message = pending_.substr(begin_, *length_);
      begin_ += *length_;
      length_.reset();
      return message;
    }
    if (skipped_ > 0 || length_ || !read_header()) break;
  }
  pending_.erase(0, begin_);
  begin_ = 0;
  return std::nullopt;
}

std::string MessageReader::take_fault() { return std::exchange(fault_, {}); }

std::string framed(std::string_view message) {
  return fmt::format("Content-Length: {}\r\n\r\n{}", message.size(), message);
}

}  // namespace edsc::lsp
