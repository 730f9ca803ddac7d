#include "system/write_all.hpp"

#include <fcntl.h>
#include <gtest/gtest.h>
#include <unistd.h>

#include <array>
#include <cerrno>
#include <csignal>
#include <string>
#include <thread>

namespace edsc {
namespace {

struct Pipe {
  Pipe() { EXPECT_EQ(pipe2(ends.data(), O_CLOEXEC), 0) << errno; }
  std::array<int, 2> ends{-1, -1};
};

std::string read_to_end(int descriptor) {
  std::string all;
  std::array<char, 4096> some;
  for (ssize_t count = 0; (count = ::read(descriptor, some.data(), some.size())) > 0;) {
    all.append(some.data(), static_cast<std::size_t>(count));
  }
  return all;
}

TEST(WriteAll, WaitsForTheReaderOfAFullPipe) {
  const Pipe pipe;
  ASSERT_EQ(::fcntl(pipe.ends[1], F_SETFL, O_NONBLOCK), 0);
  const std::string text(std::size_t{1} << 20U, 'x');  // a pipe holds 64 KiB
  std::string got;
  std::thread reader{[&] { got = read_to_end(pipe.ends[0]); }};
  EXPECT_EQ(write_all(pipe.ends[1], text), 0);
  ::close(pipe.ends[1]);
  reader.join();
  ::close(pipe.ends[0]);
  EXPECT_TRUE(got == text) << got.size();
}

TEST(WriteAll, ReturnsTheErrorNumber) {
  const Pipe pipe;
  EXPECT_EQ(write_all(pipe.ends[0], "x"), EBADF);
  const auto before = std::signal(SIGPIPE, SIG_IGN);
  ::close(pipe.ends[0]);
  EXPECT_EQ(write_all(pipe.ends[1], "x"), EPIPE);
  std::signal(SIGPIPE, before);
  ::close(pipe.ends[1]);
}

}  // namespace
}  // namespace edsc
