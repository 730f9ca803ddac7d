/// A file or standard input, read as its bytes arrive.
#pragma once

#include <cstddef>
#include <string>

#include "system/waiting_signals.hpp"

namespace edsc {

class InputFile {
 public:
  /// Opens a file; "-" is standard input.
  explicit InputFile(const std::string& path);
  InputFile(const InputFile&) = delete;
  InputFile& operator=(const InputFile&) = delete;
  ~InputFile();

  /// Why the file cannot be opened, as an error number; 0 if it is open.
  [[nodiscard]] int error() const { return error_; }

  /// Waits for input and reads at most `most` bytes. Returns their number; 0 at the end of the file and at a signal of
  /// `interrupts`; the negated error number if reading fails.
  [[nodiscard]] std::ptrdiff_t read_some(char* to, std::size_t most, const WaitingSignals& interrupts) const;

 private:
  int descriptor_;
  int error_;
};

}  // namespace edsc
