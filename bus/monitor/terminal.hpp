/// A terminal for a screen that is redrawn repeatedly.
#pragma once

#include <termios.h>

#include <string>
#include <vector>

namespace edsc {

/// Takes over the screen on standard output, and the keys if standard input is a terminal too. Restores both at the
/// end.
class Terminal {
 public:
  Terminal();
  ~Terminal();
  Terminal(const Terminal&) = delete;
  Terminal& operator=(const Terminal&) = delete;

  struct Size {
    std::size_t columns, rows;
  };

  /// The current size; 80 x 24 if unknown.
  [[nodiscard]] static Size size();

  /// Draws the lines over the previous ones. They must fit, and contain no control characters except colours.
  void draw(const std::vector<std::string>& lines);

  /// The next pressed key; 0: none.
  [[nodiscard]] char key() const;

  /// Whether standard output is a terminal.
  [[nodiscard]] static bool is_there();

 private:
  termios before_{};
  bool keys_ = false;
};

}  // namespace edsc
