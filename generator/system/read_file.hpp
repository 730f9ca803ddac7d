/// Reads the content of files. All of edsc opens input with these functions: a FIFO, a device or a folder that a
/// command line or another file names is an error, and does not make a command wait.
#pragma once

#include <canopen/host/descriptor.hpp>
#include <cstddef>
#include <cstdint>
#include <string>

namespace edsc {

/// What may be opened besides a file on a disk.
enum class InputKind : std::uint8_t {
  file,    ///< a pipe of this process, such as /dev/stdin, or what a shell makes of `<(gunzip x)`
  stream,  ///< also a FIFO, which is waited for, and a terminal: a log may come from a program that still runs
};

/// Opens a file for reading; `problem` is why it cannot be opened.
[[nodiscard]] canopen::Descriptor open_input(const std::string& path, InputKind kind, std::string& problem);

inline constexpr std::size_t max_file_bytes = std::size_t{1} << 30;

/// Reads a whole file into `bytes`; "-" is standard input. Returns the problem, or an empty text.
[[nodiscard]] std::string read_file(const std::string& path, std::string& bytes);

}  // namespace edsc
