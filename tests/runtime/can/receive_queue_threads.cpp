/// Ten million frames from one thread to another, under ThreadSanitizer: each arrives once and unchanged or is counted
/// as an overrun. `receive_queue_threads [FRAMES]`
#include <atomic>
#include <canopen/can/receive_queue.hpp>
#include <cstdint>
#include <cstdio>
#include <cstdlib>
#include <cstring>
#include <thread>

namespace {

canopen::ReceiveQueue<64> queue;

/// The CAN-ID and both halves of the data follow from the number, so that a torn frame is noticed.
canopen::Frame frame_of(std::uint32_t number) {
  canopen::Frame frame{.id = number & 0x7FF, .size = 8};
  const std::uint32_t words[] = {number, ~number};
  std::memcpy(frame.data.data(), words, sizeof words);
  return frame;
}

std::uint32_t number_of(const canopen::Frame& frame) {
  std::uint32_t number = 0;
  std::memcpy(&number, frame.data.data(), sizeof number);
  return number;
}

/// Without a system call, as between two interrupts.
void pause(unsigned rounds) {
  static std::atomic<unsigned> round;
  for (round = 0; round < rounds;) ++round;
}

}  // namespace

int main(int argument_count, char** arguments) {
  const std::uint32_t frames =
      argument_count > 1 ? static_cast<std::uint32_t>(std::strtoul(arguments[1], nullptr, 10)) : 10'000'000;
  std::thread interrupt{[frames] {
    for (std::uint32_t i = 1; i <= frames; ++i) {
      queue.push(frame_of(i));
      if (i % 48 == 0) pause(100);  // bursts that the queue can hold, if the loop keeps up
    }
    while (!queue.push(frame_of(0))) std::this_thread::yield();  // the end; its refusals are counted as well
  }};
  std::uint64_t received = 0;
  std::uint64_t overruns = 0;
  std::uint32_t last = 0;
  unsigned idle = 0;
  bool wrong = false;
  for (;;) {
    overruns += queue.take_overruns();
    const auto frame = queue.pop();
    if (!frame) {
      if (++idle % 1'000 == 0) std::this_thread::yield();
      continue;
    }
    const std::uint32_t number = number_of(*frame);
    wrong = wrong || *frame != frame_of(number);
    if (number == 0) break;
    wrong = wrong || number <= last;
    last = number;
    ++received;
  }
  interrupt.join();
  overruns += queue.take_overruns();
  const bool lost = received + overruns < frames;  // more: refusals of the end
  std::printf("%u frames: %llu received, %llu overruns%s%s\n", frames, static_cast<unsigned long long>(received),
              static_cast<unsigned long long>(overruns), wrong ? ", a frame is torn or out of order" : "",
              lost ? ", frames are missing" : "");
  return wrong || lost ? 1 : 0;
}
