#include "monitor/terminal.hpp"

#include <sys/ioctl.h>
#include <unistd.h>

#include <cstdio>

#include "system/standard_streams.hpp"

namespace edsc {
namespace {

constexpr const char* take_screen = "\x1B[?1049h\x1B[?25l";  // alternate screen, no cursor
constexpr const char* give_back = "\x1B[?25h\x1B[?1049l";
constexpr const char* home = "\x1B[H";
constexpr const char* clear_line = "\x1B[K";
constexpr const char* clear_below = "\x1B[J";

void print(const std::string& text) {
  std::fwrite(text.data(), 1, text.size(), stdout);
  std::fflush(stdout);
}

}  // namespace

Terminal::Terminal() : keys_{isatty(STDIN_FILENO) != 0 && tcgetattr(STDIN_FILENO, &before_) == 0} {
  if (keys_) {
    termios now = before_;
    now.c_lflag &= ~static_cast<tcflag_t>(ICANON | ECHO);
    now.c_cc[VMIN] = 0;
    now.c_cc[VTIME] = 0;
    now.c_cc[VSUSP] = _POSIX_VDISABLE;  // a suspended program would not restore the screen
    tcsetattr(STDIN_FILENO, TCSANOW, &now);
  }
  print(take_screen);
}

Terminal::~Terminal() {
  print(give_back);
  if (keys_) tcsetattr(STDIN_FILENO, TCSANOW, &before_);
}

Terminal::Size Terminal::size() {
  winsize window{};
  if (ioctl(STDOUT_FILENO, TIOCGWINSZ, &window) != 0 || window.ws_col == 0 || window.ws_row == 0) return {80, 24};
  return {window.ws_col, window.ws_row};
}

void Terminal::draw(const std::vector<std::string>& lines) {
  std::string picture = home;
  for (std::size_t i = 0; i < lines.size(); ++i) {
    picture += lines[i] + clear_line;
    if (i + 1 != lines.size()) picture += "\r\n";
  }
  print(picture + clear_below);
}

char Terminal::key() const {
  char key = 0;
  return keys_ && read(STDIN_FILENO, &key, 1) == 1 ? key : '\0';
}

bool Terminal::is_there() { return isatty(STDOUT_FILENO) != 0 && !is_dumb_terminal(); }

}  // namespace edsc
