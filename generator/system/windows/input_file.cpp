#include "system/input_file.hpp"

#include <unistd.h>

#include "system/read_file.hpp"
#include "system/windows/cancelled_read.hpp"

namespace edsc {

InputFile::InputFile(const std::string& path)
    : file_{path == "-" ? canopen::Descriptor{} : open_input(path, InputKind::stream, error_)},
      descriptor_{path == "-" ? STDIN_FILENO : file_.number()} {}

std::ptrdiff_t InputFile::read_some(char* to, std::size_t most, const WaitingSignals& /*interrupts*/) const {
  return read_or_cancel(descriptor_, to, most);
}

}  // namespace edsc
