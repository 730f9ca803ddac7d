/// A file or standard input, read as its bytes arrive.
#pragma once

#include <canopen/host/descriptor.hpp>
#include <cstddef>
#include <string>

#include "system/waiting_signals.hpp"

namespace edsc {

class InputFile {
 public:
  /// Opens a file or a stream, see InputKind; "-" is standard input.
  explicit InputFile(const std::string& path);
  InputFile(const InputFile&) = delete;
  InputFile& operator=(const InputFile&) = delete;
  ~InputFile() = default;

  /// Why the file cannot be opened; empty if it is open.
  [[nodiscard]] const std::string& error() const { return error_; }

  /// Waits for input and reads at most `most` bytes. Returns their number; 0 at the end of the file and at a signal of
  /// `interrupts`; the negated error number if reading fails.
  [[nodiscard]] std::ptrdiff_t read_some(char* to, std::size_t most, const WaitingSignals& interrupts) const;

 private:
  std::string error_;
  canopen::Descriptor file_;
  int descriptor_;
};

}  // namespace edsc
