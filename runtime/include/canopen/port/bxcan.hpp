/// The CAN controller bxCAN of STM32F0, F1, F2, F3, F4, F7 and L4. Without operating system; polled, or
/// with interrupts in an InterruptPort.
///
///     canopen::BxCan<> bus{*reinterpret_cast<canopen::BxCanRegisters*>(0x4000'6400)};
///     const bool up = bus.start(42'000'000, 500'000);  // the clock of APB1; clock and pins must be enabled
///     if (const auto frame = bus.receive()) node.on_frame(*frame, now);
///     if (const auto status = bus.status_change()) node.on_bus_status(*status, now);
#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>

#include "canopen/can/bus_status.hpp"
#include "canopen/can/frame.hpp"
#include "canopen/node/accepted_frames.hpp"
#include "canopen/port/bit_timing.hpp"
#include "canopen/port/can_controller.hpp"

namespace canopen {

/// The register block (reference manual RM0090, chapter "Controller area network").
struct BxCanRegisters {
  using Register = volatile std::uint32_t;
  struct Mailbox {
    Register id;      ///< TIxR, RIxR
    Register length;  ///< TDTxR, RDTxR
    Register low;     ///< data bytes 0 to 3
    Register high;    ///< data bytes 4 to 7
  };
  struct FilterBank {
    Register id;
    Register mask;
  };

  Register master_control;   // MCR, 000h
  Register master_status;    // MSR
  Register transmit_status;  // TSR
  Register receive_fifo[2];  // RF0R, RF1R
  Register interrupts;       // IER
  Register error_status;     // ESR
  Register bit_timing;       // BTR, 01Ch
  Register reserved_020[88];
  Mailbox transmit[3];  // 180h
  Mailbox receive[2];   // 1B0h
  Register reserved_1d0[12];
  Register filter_master;  // FMR, 200h
  Register filter_list;    // FM1R: 1: two identifiers, 0: identifier and mask
  Register reserved_208;
  Register filter_wide;  // FS1R: 1: one filter of 32 bits
  Register reserved_210;
  Register filter_fifo;  // FFA1R
  Register reserved_218;
  Register filter_active;  // FA1R, 21Ch
  Register reserved_220[8];
  FilterBank filters[28];  // 240h
};
static_assert(sizeof(BxCanRegisters) == 0x320);

/// The first controller of a chip: the filter banks of a second one are in the registers of the first. `Registers` is
/// another type only in tests.
template <class Registers = BxCanRegisters>
class BxCan {
 public:
  static constexpr BitTimingRange range{1024, 16, 8, 4};
  static constexpr std::size_t filter_banks = 14;  ///< that every chip has for its first controller

  explicit constexpr BxCan(Registers& registers) : registers_{registers} {}

  /// Goes on the bus, or changes the bit rate, with the frames selected by `accept`, or all frames. `clock` is that of
  /// the controller in Hz, `bit_rate` is in bit/s. Waiting frames are kept. Returns false if the rate cannot be derived
  /// from the clock, or the controller does not start, for instance without clock or with CAN_RX held low.
  [[nodiscard]] bool start(std::uint32_t clock, std::uint32_t bit_rate, BusMode mode = BusMode::normal) {
    const std::optional<BitTiming> timing = canopen::bit_timing(clock, bit_rate, range);
    if (!timing || !stop()) return false;
    registers_.bit_timing = (timing->resynchronization - 1u) << 24 | (timing->after_sample - 1u) << 20 |
                            (timing->before_sample - 1u) << 16 | (timing->prescaler - 1u) |
                            (mode == BusMode::silent ? silent : 0);
    if (!filtered_) accept_all();
    registers_.master_control = registers_.master_control & ~initialize;
    return wait_until([this] { return (registers_.master_status & (initialize | asleep)) == 0; });
  }

  /// Leaves the bus when the frame on the wire has ended. Waiting frames are kept until the next start. Returns false
  /// if the controller does not have a clock.
  bool stop() {
    registers_.master_control = initialize | recover_from_bus_off;  // awake, and mailboxes by identifier: TXFP is 0
    return wait_until([this] { return (registers_.master_status & (initialize | asleep)) == initialize; });
  }

  /// Accepts every frame.
  void accept_all() {
    filtered_ = true;
    registers_.filter_master = registers_.filter_master | 1;
    registers_.filter_active = 0;
    registers_.filter_list = 0;
    registers_.filter_wide = 1;
    registers_.filter_fifo = 0;
    registers_.filters[0].id = 0;
    registers_.filters[0].mask = 0;
    registers_.filter_active = 1;
    registers_.filter_master = registers_.filter_master & ~1u;
  }

  /// Accepts only these frames, two per filter bank; all frames if there are more than the banks can hold.
  void accept(std::span<const AcceptedFrame> frames) {
    if (frames.empty() || frames.size() > 2 * filter_banks) return accept_all();
    const std::size_t banks = (frames.size() + 1) / 2;
    const std::uint32_t used = (1u << banks) - 1;
    filtered_ = true;
    registers_.filter_master = registers_.filter_master | 1;
    registers_.filter_active = 0;
    registers_.filter_list = used;
    registers_.filter_wide = used;
    registers_.filter_fifo = 0;
    for (std::size_t bank = 0; bank < banks; ++bank) {
      const std::size_t second = 2 * bank + 1 < frames.size() ? 2 * bank + 1 : 2 * bank;
      registers_.filters[bank].id = word_of(frames[2 * bank].id, frames[2 * bank].extended, frames[2 * bank].remote);
      registers_.filters[bank].mask = word_of(frames[second].id, frames[second].extended, frames[second].remote);
    }
    registers_.filter_active = used;
    registers_.filter_master = registers_.filter_master & ~1u;
  }

  /// Writes a frame to a free mailbox. The controller sends the one with the lowest identifier first. Of two frames
  /// with the same identifier, the second waits until the first has been sent, because equal ones are sent in mailbox
  /// order. Returns false if there is no room, the controller is not on the bus, or it is silent.
  [[nodiscard]] bool send(const Frame& frame) {
    if ((registers_.master_status & initialize) != 0 || (registers_.bit_timing & silent) != 0) return false;
    const std::uint32_t empty = registers_.transmit_status >> 26 & 7;
    const std::uint32_t id = word_of(frame.id, frame.extended, frame.remote);
    std::size_t free = mailboxes;
    for (std::size_t i = 0; i < mailboxes; ++i) {
      if ((empty >> i & 1) != 0) {
        if (free == mailboxes) free = i;
      } else if ((registers_.transmit[i].id & ~request) == id) {
        return false;
      }
    }
    if (free == mailboxes) return false;
    const FrameWords words = words_of(frame);
    auto& box = registers_.transmit[free];
    box.length = frame.size;
    box.low = words.first;
    box.high = words.second;
    box.id = id | request;
    return true;
  }

  /// Returns the next frame of receive FIFO 0, if any. While the last frame is being released, FMP still counts it, and
  /// the mailbox still shows it.
  [[nodiscard]] std::optional<Frame> receive() {
    const std::uint32_t fifo = registers_.receive_fifo[0];
    if ((fifo & overrun) != 0) {
      report_.note_overrun();
      registers_.receive_fifo[0] = overrun;
    }
    if ((fifo & pending) == 0 || (fifo & release) != 0) return std::nullopt;
    const auto& box = registers_.receive[0];
    const std::uint32_t id = box.id;
    const bool is_extended = (id & extended) != 0;
    const Frame frame = make_frame(is_extended ? id >> 3 : id >> 21, size_of_code(box.length), {box.low, box.high},
                                   is_extended, (id & remote) != 0);
    registers_.receive_fifo[0] = release;
    return frame;
  }

  /// Interrupts for a received frame, for a mailbox that has become free, and for error passive and bus-off. The
  /// controller does not interrupt when these end: ask `status_change` now and then until it reports `active`.
  void enable_interrupts() {
    registers_.interrupts = frame_received | mailbox_free | error_line | error_passive | bus_off;
  }
  static constexpr bool has_status_interrupt = true;

  /// In the interrupt, before `receive` until there is no frame: that ends the one for a frame. Returns whether it is
  /// one for the status.
  bool acknowledge_interrupts() {
    registers_.transmit_status = 1 << 0 | 1 << 8 | 1 << 16;  // RQCP0 to RQCP2
    if ((registers_.master_status & error_interrupt) == 0) return false;
    registers_.master_status = error_interrupt;
    return true;
  }

  /// Returns the status of the controller if it has changed since the last call.
  [[nodiscard]] std::optional<BusStatus> status_change() {
    const std::uint32_t errors = registers_.error_status;
    return report_.change((errors & 4) != 0 ? BusState::off : (errors & 2) != 0 ? BusState::passive : BusState::active);
  }

 private:
  static constexpr std::size_t mailboxes = 3;
  static constexpr std::uint32_t initialize = 1 << 0;            // MCR.INRQ, MSR.INAK
  static constexpr std::uint32_t asleep = 1 << 1;                // MSR.SLAK
  static constexpr std::uint32_t recover_from_bus_off = 1 << 6;  // MCR.ABOM
  static constexpr std::uint32_t silent = 1u << 31;              // BTR.SILM
  static constexpr std::uint32_t request = 1;                    // TIxR.TXRQ
  static constexpr std::uint32_t remote = 1 << 1;                // TIxR.RTR
  static constexpr std::uint32_t extended = 1 << 2;              // TIxR.IDE
  static constexpr std::uint32_t pending = 3;                    // RFxR.FMP
  static constexpr std::uint32_t overrun = 1 << 4;               // RFxR.FOVR
  static constexpr std::uint32_t release = 1 << 5;               // RFxR.RFOM
  static constexpr std::uint32_t mailbox_free = 1 << 0;          // IER.TMEIE
  static constexpr std::uint32_t frame_received = 1 << 1;        // IER.FMPIE0
  static constexpr std::uint32_t error_passive = 1 << 9;         // IER.EPVIE
  static constexpr std::uint32_t bus_off = 1 << 10;              // IER.BOFIE
  static constexpr std::uint32_t error_line = 1 << 15;           // IER.ERRIE
  static constexpr std::uint32_t error_interrupt = 1 << 2;       // MSR.ERRI

  /// Returns the identifier in the format of mailboxes and filters.
  [[nodiscard]] static constexpr std::uint32_t word_of(std::uint32_t id, bool is_extended, bool is_remote) {
    return (is_extended ? id << 3 | extended : id << 21) | (is_remote ? remote : 0);
  }

  Registers& registers_;
  StatusReport report_;
  bool filtered_ = false;  ///< by `accept` or `accept_all`
};

}  // namespace canopen
