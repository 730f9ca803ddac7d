#include "system/input_file.hpp"

#include <fcntl.h>
#include <poll.h>
#include <unistd.h>

#include <cerrno>

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
    : descriptor_{path == "-" ? STDIN_FILENO : ::open(path.c_str(), O_RDONLY | O_CLOEXEC)},
      error_{descriptor_ < 0 ? errno : 0} {}

InputFile::~InputFile() {
  if (descriptor_ > STDIN_FILENO) ::close(descriptor_);
}

std::ptrdiff_t InputFile::read_some(char* to, std::size_t most, const WaitingSignals& interrupts) const {
  if (!wait_for(descriptor_, interrupts)) return 0;
  ssize_t count = 0;
  do {
    count = ::read(descriptor_, to, most);
  } while (count < 0 && errno == EINTR);
  return count < 0 ? -errno : count;
}

}  // namespace edsc
