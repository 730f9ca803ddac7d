/// The CAN controller FDCAN of STM32, Bosch's M_CAN: as in STM32G4, G0, H5, L5 and U5, whose chip divides the message
/// RAM, and as in STM32H7, where the driver divides it. Classic CAN frames. Without operating system; polled,
/// or with interrupts in an InterruptPort.
///
///     canopen::FdcanG4 bus{*reinterpret_cast<canopen::FdcanG4Registers*>(0x4000'6400),
///                          reinterpret_cast<volatile std::uint32_t*>(0x4000'A400)};
///     const bool up = bus.start(170'000'000, 500'000);  // its kernel clock; clock and pins must be enabled
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

namespace fdcan {

using Register = volatile std::uint32_t;

/// Registers that both kinds of chip have, up to 07Ch.
struct CommonRegisters {
  Register reserved_000[6];
  Register cccr;  ///< CC control, 018h
  Register nbtp;  ///< nominal bit timing
  Register reserved_020[8];
  Register ecr;  ///< error counters, 040h
  Register psr;  ///< protocol status
  Register reserved_048[2];
  Register ir;  ///< interrupts, 050h
  Register ie;
  Register ils;  ///< interrupt line select
  Register ile;  ///< interrupt line enable
  Register reserved_060[8];
};

/// Layout of a controller's filters, Rx FIFO 0 and Tx queue, in words of the message RAM.
struct MessageRam {
  std::uint16_t standard_filters;  ///< one word each
  std::uint16_t extended_filters;  ///< two words each
  std::uint16_t received;          ///< elements of Rx FIFO 0
  std::uint16_t transmitted;       ///< elements of the Tx queue
  std::uint16_t element;           ///< words per element
  std::uint16_t transmit;          ///< first word of the Tx queue
  std::uint16_t size;              ///< total size in words

  [[nodiscard]] constexpr std::uint16_t extended() const { return standard_filters; }
  [[nodiscard]] constexpr std::uint16_t receive() const {
    return static_cast<std::uint16_t>(standard_filters + 2 * extended_filters);
  }
};

/// GFC, RXGFC: frames that do not match a filter are rejected, ANFS and ANFE. Remote frames are filtered.
inline constexpr std::uint32_t reject_others = 2 << 4 | 2 << 2;

}  // namespace fdcan

/// The register block (reference manual RM0440, chapter "FD controller area network").
struct FdcanG4Registers {
  fdcan::CommonRegisters common;
  fdcan::Register rxgfc;  ///< global filter configuration, 080h
  fdcan::Register xidam;  ///< extended ID AND mask
  fdcan::Register hpms;
  fdcan::Register reserved_08c;
  fdcan::Register rxf0s;  ///< Rx FIFO 0 status, 090h
  fdcan::Register rxf0a;  ///< Rx FIFO 0 acknowledge
  fdcan::Register reserved_098[10];
  fdcan::Register txbc;   ///< Tx buffer configuration, 0C0h
  fdcan::Register txfqs;  ///< Tx FIFO/queue status
  fdcan::Register txbrp;  ///< Tx buffer request pending
  fdcan::Register txbar;  ///< Tx buffer add request
  fdcan::Register txbcr;  ///< Tx buffer cancellation request
  fdcan::Register txbto;  ///< Tx buffer transmission occurred, 0D4h
  fdcan::Register reserved_0d8;
  fdcan::Register txbtie;  ///< Tx buffer transmission interrupt enable
};

/// The register block (reference manual RM0433, chapter "FD controller area network").
struct FdcanH7Registers {
  fdcan::CommonRegisters common;
  fdcan::Register gfc;    ///< global filter configuration, 080h
  fdcan::Register sidfc;  ///< standard ID filter configuration
  fdcan::Register xidfc;  ///< extended ID filter configuration
  fdcan::Register reserved_08c;
  fdcan::Register xidam;  ///< extended ID AND mask, 090h
  fdcan::Register reserved_094[3];
  fdcan::Register rxf0c;  ///< Rx FIFO 0 configuration, 0A0h
  fdcan::Register rxf0s;  ///< Rx FIFO 0 status
  fdcan::Register rxf0a;  ///< Rx FIFO 0 acknowledge
  fdcan::Register rxbc;   ///< Rx buffer configuration
  fdcan::Register rxf1c;  ///< Rx FIFO 1 configuration, 0B0h
  fdcan::Register reserved_0b4[2];
  fdcan::Register rxesc;  ///< Rx element size configuration
  fdcan::Register txbc;   ///< Tx buffer configuration, 0C0h
  fdcan::Register txfqs;  ///< Tx FIFO/queue status
  fdcan::Register txesc;  ///< Tx element size configuration
  fdcan::Register txbrp;  ///< Tx buffer request pending
  fdcan::Register txbar;  ///< Tx buffer add request, 0D0h
  fdcan::Register txbcr;  ///< Tx buffer cancellation request
  fdcan::Register txbto;  ///< Tx buffer transmission occurred
  fdcan::Register reserved_0dc;
  fdcan::Register txbtie;  ///< Tx buffer transmission interrupt enable, 0E0h
  fdcan::Register reserved_0e4[3];
  fdcan::Register txefc;  ///< Tx event FIFO configuration, 0F0h
};

/// Differences between the kinds of chip: registers, message RAM and its layout.
struct FdcanOfG4 {
  using Registers = FdcanG4Registers;
  static constexpr fdcan::MessageRam message_ram{28, 8, 3, 3, 18, 158, 212};
  static constexpr std::uint32_t lost = 1 << 2;               ///< IR.RF0L
  static constexpr std::uint32_t sent = 1 << 7;               ///< IR.TC
  static constexpr std::uint32_t status = 1 << 17 | 1 << 19;  ///< IR.EP, IR.BO

  /// Only the number of filters can be configured.
  static void divide(auto& registers, std::uint32_t /*first_word*/) {
    registers.rxgfc = std::uint32_t{message_ram.extended_filters} << 24 |
                      std::uint32_t{message_ram.standard_filters} << 16 | fdcan::reject_others;
    registers.txbc = 1 << 24;  // TFQM: a queue
  }
};

struct FdcanOfH7 {
  using Registers = FdcanH7Registers;
  static constexpr fdcan::MessageRam message_ram{64, 16, 64, 16, 4, 352, 416};
  static constexpr std::uint32_t lost = 1 << 3;               ///< IR.RF0L
  static constexpr std::uint32_t sent = 1 << 9;               ///< IR.TC
  static constexpr std::uint32_t status = 1 << 23 | 1 << 25;  ///< IR.EP, IR.BO

  /// Start addresses are in bytes, because their two lowest bits are not part of the fields. Unused parts are empty.
  static void divide(auto& registers, std::uint32_t first_word) {
    const auto place = [first_word](std::uint32_t elements, std::uint32_t word) {
      return elements << 16 | (first_word + word) * 4;
    };
    registers.gfc = fdcan::reject_others;
    registers.sidfc = place(message_ram.standard_filters, 0);
    registers.xidfc = place(message_ram.extended_filters, message_ram.extended());
    registers.rxf0c = place(message_ram.received, message_ram.receive());
    registers.rxf1c = 0;
    registers.rxbc = 0;
    registers.rxesc = 0;  // elements of 8 bytes of data
    registers.txesc = 0;
    registers.txefc = 0;
    registers.txbc = 1u << 30 | std::uint32_t{message_ram.transmitted} << 24 | (first_word + message_ram.transmit) * 4;
  }
};

/// `Registers` is another type only in tests.
template <class Chip, class Registers = typename Chip::Registers>
class Fdcan {
 public:
  static constexpr BitTimingRange range{512, 256, 128, 128};
  static constexpr fdcan::MessageRam layout = Chip::message_ram;
  /// Maximum number of identifiers for `accept`: two per filter; the last filter is for all frames.
  static constexpr std::size_t max_standard = 2 * (layout.standard_filters - 1);
  static constexpr std::size_t max_extended = 2 * (layout.extended_filters - 1);

  /// `message_ram` is that of the chip; the part of this controller begins with `first_word`: 0 for the first
  /// controller, `layout.size` for the second one.
  constexpr Fdcan(Registers& registers, volatile std::uint32_t* message_ram, std::uint16_t first_word = 0)
      : registers_{registers}, ram_{message_ram}, first_word_{first_word} {}

  /// Goes on the bus, or changes the bit rate, with the frames selected by `accept`, or all frames. `clock` is the
  /// kernel clock of the controller in Hz, `bit_rate` is in bit/s. Frames waiting for transmission are kept; those that
  /// have not been read yet are lost. Returns false if the rate cannot be derived from the clock, or the controller
  /// does not have a clock.
  [[nodiscard]] bool start(std::uint32_t clock, std::uint32_t bit_rate, BusMode mode = BusMode::normal) {
    const std::optional<BitTiming> timing = canopen::bit_timing(clock, bit_rate, range);
    if (!timing || !stop()) return false;
    const std::uint32_t modes = mode == BusMode::silent ? silent : 0;  // FDOE, DAR 0: classic CAN, retransmission on
    registers_.common.cccr = initialize | change_enable;
    if (!wait_until([this] { return (registers_.common.cccr & change_enable) != 0; })) return false;
    registers_.common.nbtp = (timing->resynchronization - 1u) << 25 | (timing->prescaler - 1u) << 16 |
                             (timing->before_sample - 1u) << 8 | (timing->after_sample - 1u);
    registers_.common.ie = interrupts_;
    registers_.xidam = all_extended;
    Chip::divide(registers_, first_word_);
    registers_.common.cccr = initialize | change_enable | modes;
    if (!filtered_) accept_all();
    registers_.common.cccr = modes;
    if (!wait_until([this] { return (registers_.common.cccr & initialize) == 0; })) return false;
    running_ = true;
    if (mode == BusMode::normal) {
      registers_.txbar = kept_;
      kept_ = 0;
    }
    return true;
  }

  /// Leaves the bus when the frame on the wire has ended. Frames waiting for transmission are kept until the next start
  /// in normal mode. Returns false if the controller does not have a clock.
  ///
  /// CCE clears the requests, which must not happen while the controller scans them for the next frame to send: it
  /// would then never send again. They are therefore cancelled first, and requested again at the end.
  bool stop() {
    const std::uint32_t requested = registers_.txbrp;
    running_ = false;
    if (requested != 0 && (registers_.common.cccr & initialize) == 0) {
      registers_.txbcr = requested;
      const bool ended = wait_until([this] { return registers_.txbrp == 0; });
      kept_ |= requested & ~registers_.txbto;
      if (!ended) return false;
    } else {
      kept_ |= requested;  // in bus-off no transmission is in progress
    }
    registers_.common.cccr = registers_.common.cccr | initialize;
    return wait_until([this] { return (registers_.common.cccr & initialize) != 0; });
  }

  /// Accepts every frame.
  void accept_all() {
    filtered_ = true;
    standard(layout.standard_filters - 1u) = into_fifo << 27 | all_standard;  // from 000h to 7FFh
    set_extended(layout.extended_filters - 1u, into_fifo << 29, all_extended);
    for (std::uint32_t i = 0; i + 1 < layout.standard_filters; ++i) standard(i) = 0;
    for (std::uint32_t i = 0; i + 1 < layout.extended_filters; ++i) set_extended(i, 0, 0);
  }

  /// Accepts only frames with these identifiers; the filters do not distinguish data and remote frames. All frames if
  /// there are more than the filters can hold. No frame is lost: the last filters accept all frames until the
  /// others have been set.
  void accept(std::span<const AcceptedFrame> frames) {
    accept_all();
    if (frames.empty()) return;
    std::size_t standards = 0;
    std::size_t extendeds = 0;
    for (const AcceptedFrame& frame : frames) {
      if (frame.extended ? extendeds == max_extended : standards == max_standard) return accept_all();
      if (frame.extended) {
        add_extended(extendeds++, frame.id);
      } else {
        add_standard(standards++, frame.id);
      }
    }
    standard(layout.standard_filters - 1u) = 0;
    set_extended(layout.extended_filters - 1u, 0, 0);
  }

  /// Writes a frame to the queue, from which the controller sends the frame with the lowest identifier first. Of two
  /// frames with the same identifier, the second waits until the first has been sent, because the queue does not keep
  /// the order of requests. Returns false if there is no room, the controller is not on the bus, or it is silent.
  [[nodiscard]] bool send(const Frame& frame) {
    if (!running_ || (registers_.common.cccr & (initialize | silent)) != 0) return false;
    const std::uint32_t id = frame.extended ? frame.id | extended : frame.id << 18;
    const std::uint32_t word = id | (frame.remote ? remote : 0);
    const std::uint32_t requested = registers_.txbrp;
    for (std::uint32_t i = 0; i < layout.transmitted; ++i) {
      if ((requested >> i & 1) != 0 && ram_[transmit_element(i)] == word) return false;
    }
    const std::uint32_t queue = registers_.txfqs;
    if ((queue & queue_full) != 0) return false;
    const std::uint32_t put = queue >> 16 & 0x1F;
    const FrameWords words = words_of(frame);
    volatile std::uint32_t* const element = ram_ + transmit_element(put);
    element[0] = word;
    element[1] = std::uint32_t{frame.size} << 16;
    element[2] = words.first;
    element[3] = words.second;
    registers_.txbar = 1u << put;
    return true;
  }

  /// Returns the next frame of Rx FIFO 0, if any.
  [[nodiscard]] std::optional<Frame> receive() {
    const std::uint32_t fifo = registers_.rxf0s;
    if ((fifo & message_lost) != 0) {
      report_.note_overrun();
      registers_.common.ir = Chip::lost;
    }
    if ((fifo & 0x7F) == 0) return std::nullopt;
    const std::uint32_t get = fifo >> 8 & 0x3F;
    const volatile std::uint32_t* const element = ram_ + first_word_ + layout.receive() + get * layout.element;
    const std::uint32_t word = element[0];
    const bool is_extended = (word & extended) != 0;
    const bool is_remote = (word & remote) != 0;
    const FrameWords words = is_remote ? FrameWords{} : FrameWords{element[2], element[3]};
    const Frame frame = make_frame(is_extended ? word & all_extended : word >> 18 & all_standard,
                                   size_of_code(element[1] >> 16), words, is_extended, is_remote);
    registers_.rxf0a = get;
    return frame;
  }

  /// Interrupts of line 0 for a received frame, for one that has been sent, and for each change of error passive and
  /// bus-off. In bus-off, the loop that they wake calls `status_change`, which starts the recovery.
  void enable_interrupts() {
    interrupts_ = frame_received | Chip::sent | Chip::status;
    registers_.txbtie = (1u << layout.transmitted) - 1;
    registers_.common.ils = 0;
    registers_.common.ie = interrupts_;
    registers_.common.ile = 1;
  }

  static constexpr bool has_status_interrupt = true;

  /// In the interrupt, before `receive` until there is no frame. Returns whether it is one for the status.
  bool acknowledge_interrupts() {
    const bool status = (registers_.common.ir & Chip::status) != 0;
    registers_.common.ir = frame_received | Chip::sent | Chip::status;
    return status;
  }

  /// Returns the status of the controller if it has changed since the last call. Call it in every cycle of the loop: it
  /// starts the recovery of a controller in bus-off, which takes 129 times 11 recessive bits.
  [[nodiscard]] std::optional<BusStatus> status_change() {
    const std::uint32_t status = registers_.common.psr;
    if ((status & bus_off) != 0 && running_ && (registers_.common.cccr & initialize) != 0) {
      registers_.common.cccr = registers_.common.cccr & ~initialize;
    }
    return report_.change((status & bus_off) != 0   ? BusState::off
                          : (status & passive) != 0 ? BusState::passive
                                                    : BusState::active);
  }

 private:
  static constexpr std::uint32_t initialize = 1 << 0;      // CCCR.INIT
  static constexpr std::uint32_t change_enable = 1 << 1;   // CCCR.CCE
  static constexpr std::uint32_t silent = 1 << 5;          // CCCR.MON
  static constexpr std::uint32_t passive = 1 << 5;         // PSR.EP
  static constexpr std::uint32_t bus_off = 1 << 7;         // PSR.BO
  static constexpr std::uint32_t frame_received = 1 << 0;  // IE.RF0N, IR.RF0N
  static constexpr std::uint32_t message_lost = 1 << 25;   // RXF0S.RF0L
  static constexpr std::uint32_t queue_full = 1 << 21;     // TXFQS.TFQF
  static constexpr std::uint32_t extended = 1 << 30;       // R0.XTD, T0.XTD
  static constexpr std::uint32_t remote = 1 << 29;         // R0.RTR, T0.RTR
  static constexpr std::uint32_t all_standard = 0x7FF;
  static constexpr std::uint32_t all_extended = 0x1FFF'FFFF;
  static constexpr std::uint32_t into_fifo = 1;           // SFEC, EFEC: store in Rx FIFO 0
  static constexpr std::uint32_t two_of_them = 1u << 30;  // SFT, EFT: two identifiers, not a range

  [[nodiscard]] std::uint32_t transmit_element(std::uint32_t index) const {
    return first_word_ + layout.transmit + index * layout.element;
  }
  [[nodiscard]] volatile std::uint32_t& standard(std::uint32_t filter) { return ram_[first_word_ + filter]; }

  void set_extended(std::uint32_t filter, std::uint32_t first, std::uint32_t second) {
    volatile std::uint32_t* const words = ram_ + first_word_ + layout.extended() + 2 * filter;
    words[0] = first;
    words[1] = second;
  }

  /// Adds the identifier with this number; an odd one replaces the copy of the identifier before it.
  void add_standard(std::size_t number, std::uint32_t id) {
    volatile std::uint32_t& word = standard(static_cast<std::uint32_t>(number / 2));
    const std::uint32_t first = number % 2 == 0 ? two_of_them | into_fifo << 27 | id << 16 : word & ~all_standard;
    word = first | id;
  }
  void add_extended(std::size_t number, std::uint32_t id) {
    const auto filter = static_cast<std::uint32_t>(number / 2);
    const std::uint32_t first = ram_[first_word_ + layout.extended() + 2 * filter];
    set_extended(filter, number % 2 == 0 ? into_fifo << 29 | id : first, two_of_them | id);
  }

  Registers& registers_;
  volatile std::uint32_t* ram_;
  std::uint32_t kept_ = 0;        ///< requests that wait for the next start
  std::uint32_t interrupts_ = 0;  ///< IE, after `enable_interrupts`
  std::uint16_t first_word_;
  StatusReport report_;
  bool filtered_ = false;  ///< by `accept` or `accept_all`
  bool running_ = false;
};

using FdcanG4 = Fdcan<FdcanOfG4>;
using FdcanH7 = Fdcan<FdcanOfH7>;

}  // namespace canopen
