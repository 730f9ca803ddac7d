/// Frames between an interrupt and the loop of a Cortex-M, through a canopen::ReceiveQueue. SysTick interrupts at any
/// instruction of the loop. Each frame must arrive once, in order and unchanged, or be counted as an overrun.
///
/// Prints a line for each run over semihosting: `NAME sent S received R overruns O refused F empty E fault WORD`, and
/// the addresses of the instructions of `pop` that were interrupted. For interrupt_queue_test.py.
#include <array>
#include <canopen/can/receive_queue.hpp>
#include <cstddef>
#include <cstdint>
#include <cstring>
#include <optional>

#include "faulty_queues.hpp"
#include "registers.hpp"
#include "semihosting.hpp"

namespace {

constexpr std::size_t capacity = 16;
constexpr std::uint32_t ticks_between_interrupts = 1'999;  // a prime number: no fixed phase to the loop

/// A pseudo-random sequence (xorshift32), one for each context.
class Random {
 public:
  explicit constexpr Random(std::uint32_t seed) : state_{seed} {}
  /// Returns a number below 2^bits.
  std::uint32_t next(unsigned bits) {
    state_ ^= state_ << 13;
    state_ ^= state_ >> 17;
    state_ ^= state_ << 5;
    return state_ >> (32 - bits);
  }

 private:
  std::uint32_t state_;
};

/// All parts of the frame follow from the number, so that a torn frame is noticed.
canopen::Frame frame_of(std::uint32_t number) {
  return canopen::make_frame(number & 0x7FF, 8, {number, ~number}, (number & 1) != 0, (number & 2) != 0);
}

bool is_frame_of(const canopen::Frame& frame, std::uint32_t number) {
  return canopen::words_of(frame).second == ~number && frame.id == (number & 0x7FF) && frame.size == 8 &&
         frame.extended == ((number & 1) != 0) && frame.remote == ((number & 2) != 0);
}

template <class Queue>
[[gnu::noinline]] std::optional<canopen::Frame> pop(Queue& queue) {
  return queue.pop();
}

/// One direction through a queue. The numbers of each context are read by the other one only after the last interrupt.
template <class Queue>
struct Run {
  Queue queue;
  std::uint32_t frames = 0;  ///< to send
  volatile bool done = false;

  std::uint32_t sent = 0;  ///< of the sender
  std::uint32_t refused = 0;

  std::uint32_t received = 0;  ///< of the receiver
  std::uint32_t last = 0;
  std::uint32_t empty = 0;
  const char* volatile fault = nullptr;

  void send() {
    if (sent == frames) return;
    ++sent;
    if (!queue.push(frame_of(sent))) ++refused;
  }

  /// Returns false if there is no frame.
  bool receive() {
    const std::optional<canopen::Frame> frame = pop(queue);
    if (!frame) {
      ++empty;
      return false;
    }
    ++received;
    const std::uint32_t number = canopen::words_of(*frame).first;
    if (!is_frame_of(*frame, number)) fault = "torn";
    if (number <= last || number > frames) fault = "order";
    last = number;
    return true;
  }

  void end(const char* name) {
    const std::uint32_t overruns = queue.take_overruns();
    if (fault == nullptr && (overruns != refused || received + overruns != sent)) fault = "count";
    semihosting::print(name);
    semihosting::print(" sent ", sent);
    semihosting::print(" received ", received);
    semihosting::print(" overruns ", overruns);
    semihosting::print(" refused ", refused);
    semihosting::print(" empty ", empty);
    semihosting::print(" fault ");
    semihosting::print(fault == nullptr ? "none\n" : fault);
    if (fault != nullptr) semihosting::print("\n");
  }
};

// ---- the interrupt ----

constexpr std::uintptr_t systick = 0xE000'E010;

void (*on_tick)() = nullptr;
std::array<std::uint8_t, 128> interrupted{};  ///< one for each half-word of `pop`
std::uintptr_t watched = 0;

extern "C" [[gnu::used]] void tick(const std::uint32_t* stacked) {
  constexpr std::size_t program_counter = 6;
  const std::uint32_t place = (stacked[program_counter] - watched) / 2;
  if (place < interrupted.size()) interrupted[place] = 1;
  on_tick();
}

void start_interrupts(void (*handler)()) {
  on_tick = handler;
  board::word_at(systick + 4) = ticks_between_interrupts;
  board::word_at(systick + 8) = 0;
  board::word_at(systick) = 7;  // enabled, with interrupt, clock of the core
}
void stop_interrupts() { board::word_at(systick) = 0; }

// ---- the runs ----

/// A few instructions to hundreds: the queue runs full and empty.
void work(Random& random) {
  const std::uint32_t rounds = random.next(5) == 0 ? random.next(9) : random.next(3);
  for (std::uint32_t i = 0; i < rounds; ++i) asm volatile("");
}

/// The interrupt sends in bursts, of which some exceed the queue, and the loop receives.
template <class Queue>
void interrupt_sends(const char* name, std::uint32_t frames) {
  static Run<Queue> run;
  static Random burst{0x2545'F491};
  Random loop{0x9E37'79B9};
  run.frames = frames;
  start_interrupts([] {
    const std::uint32_t size = burst.next(6) == 0 ? 20 + burst.next(4) : burst.next(4);
    for (std::uint32_t i = 0; i < size; ++i) run.send();
    if (run.sent == run.frames) run.done = true;
  });
  while (run.fault == nullptr) {
    const bool done = run.done;
    if (!run.receive() && done) break;
    if (loop.next(4) == 0) work(loop);
  }
  stop_interrupts();
  run.end(name);
}

/// The loop sends, and the interrupt receives in bursts.
template <class Queue>
void interrupt_receives(const char* name, std::uint32_t frames) {
  static Run<Queue> run;
  static Random burst{0x2545'F491};
  Random loop{0x9E37'79B9};
  run.frames = frames;
  start_interrupts([] {
    for (std::uint32_t left = 1 + burst.next(5); left != 0 && run.receive(); --left) {
    }
  });
  while (run.fault == nullptr && run.sent != frames) {
    run.send();
    if (loop.next(2) == 0) work(loop);
  }
  stop_interrupts();
  while (run.fault == nullptr && run.receive()) {
  }
  run.end(name);
}

}  // namespace

/// Passes the stack, where the core has put the interrupted address.
extern "C" [[gnu::naked]] void SysTick_Handler() { asm volatile("mov r0, sp\n ldr r1, =tick\n bx r1\n .ltorg"); }

int main() {
  using Queue = canopen::ReceiveQueue<capacity>;
  watched = reinterpret_cast<std::uintptr_t>(&pop<Queue>) & ~std::uintptr_t{1};
  interrupt_sends<Queue>("receive_queue", EDSC_TEST_FRAMES);
  watched = 0;
  for (std::size_t i = 0; i < interrupted.size(); ++i) {
    if (interrupted[i] != 0) semihosting::print("interrupted ", i * 2);
    if (interrupted[i] != 0) semihosting::print("\n");
  }
  interrupt_receives<Queue>("receive_queue_to_interrupt", EDSC_TEST_FRAMES);
  interrupt_sends<faulty::FreesFirst<capacity>>("frees_first", EDSC_TEST_FRAMES);
  interrupt_receives<faulty::PublishesFirst<capacity>>("publishes_first", EDSC_TEST_FRAMES);
  interrupt_sends<faulty::SharesCount<capacity>>("shares_count", EDSC_TEST_FRAMES);
  semihosting::exit();
}
