/// A terminal that one picture is drawn on again and again.
#pragma once

#include <termios.h>

#include <string>
#include <vector>

namespace edsc {

/// Takes the screen on standard output, and the keys of standard input where that is a terminal, too. Gives both back
/// as they were.
class Terminal {
 public:
  Terminal();
  ~Terminal();
  Terminal(const Terminal&) = delete;
  Terminal& operator=(const Terminal&) = delete;

  struct Size {
    std::size_t columns, rows;
  };

  /// As it is now; 80 x 24 where it does not say.
  [[nodiscard]] static Size size();

  /// Draws the lines over what was there. They fit, and hold no control characters but colours.
  void draw(const std::vector<std::string>& lines);

  /// The next key that was pressed; 0: none.
  [[nodiscard]] char key() const;

  /// Whether standard output is one.
  [[nodiscard]] static bool is_there();

 private:
  termios before_{};
  bool keys_ = false;
};

}  // namespace edsc
