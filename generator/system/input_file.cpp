#include "system/input_file.hpp"

#include <poll.h>
#include <unistd.h>

#include <cerrno>

#include "system/read_file.hpp"

namespace edsc {
namespace {

/// Returns false at a signal of `interrupts`.
bool wait_for(int descriptor, const WaitingSignals& interrupts) {
  pollfd input{descriptor, POLLIN, 0};
  while (ppoll(&input, 1, nullptr, interrupts.while_waiting()) < 0 && errno == EINTR) {
    if (WaitingSignals::noted()) return false;
  }
  return true;
}

}  // namespace

InputFile::InputFile(const std::string& path)
    : file_{path == "-" ? canopen::Descriptor{} : open_input(path, InputKind::stream, error_)},
      descriptor_{path == "-" ? STDIN_FILENO : file_.number()} {}

std::ptrdiff_t InputFile::read_some(char* to, std::size_t most, const WaitingSignals& interrupts) const {
  if (!wait_for(descriptor_, interrupts)) return 0;
  ssize_t count = 0;
  do {
    count = ::read(descriptor_, to, most);
  } while (count < 0 && errno == EINTR);
  return count < 0 ? -errno : count;
}

}  // namespace edsc
