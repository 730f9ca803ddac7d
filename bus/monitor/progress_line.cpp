#include "monitor/progress_line.hpp"
#include "system/standard_streams.hpp"
#include "text/printable.hpp"

#include <fmt/format.h>

#include <cstdio>

namespace edsc {
namespace {

constexpr std::chrono::milliseconds before_the_first{300};
constexpr std::chrono::milliseconds between{100};

}  // namespace

ProgressLine::ProgressLine()
    : terminal_{is_terminal(stderr) && !is_dumb_terminal()}, next_{Clock::now() + before_the_first} {}

ProgressLine::~ProgressLine() { hide(); }

bool ProgressLine::due() const { return terminal_ && Clock::now() >= next_; }

void ProgressLine::show(const std::string& text) {
  if (!due()) return;
  print_to_stderr("\r{}\x1B[K", text);
  shown_ = true;
  next_ = Clock::now() + between;
}

void ProgressLine::show_at_once(const std::string& text) {
  next_ = Clock::now();
  show(text);
}

void ProgressLine::hide() {
  if (!shown_) return;
  print_to_stderr("\r\x1B[K");
  shown_ = false;
}

}  // namespace edsc
