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

ProgressLine::ProgressLine() : terminal_{is_terminal(stderr)}, next_{Clock::now() + before_the_first} {}

ProgressLine::~ProgressLine() { hide(); }

bool ProgressLine::due() const { return terminal_ && Clock::now() >= next_; }

void ProgressLine::show(const std::string& text) {
  if (!due()) return;
  print_visibly(stderr, "\r{}\x1B[K", text);
  std::fflush(stderr);
  shown_ = true;
  next_ = Clock::now() + between;
}

void ProgressLine::hide() {
  if (!shown_) return;
  print_visibly(stderr, "\r\x1B[K");
  std::fflush(stderr);
  shown_ = false;
}

}  // namespace edsc
