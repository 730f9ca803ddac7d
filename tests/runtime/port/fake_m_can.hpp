/// A CAN controller FDCAN in memory. Its registers behave as the manuals of STM32G4 and STM32H7 describe them, as far
/// as a driver without interrupts uses them. The test fails if a driver does something that is not allowed.
#pragma once

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <canopen/can/arbitration.hpp>
#include <canopen/can/frame.hpp>
#include <cstdint>
#include <cstring>
#include <initializer_list>
#include <optional>
#include <vector>

namespace fake {

enum class Chip : std::uint8_t { g4, h7 };

class MCan {
 public:
  using Word = volatile std::uint32_t;
  static constexpr std::size_t ram_words = 2560;

  /// The state after a reset; the message RAM contains arbitrary data.
  explicit MCan(Chip chip, std::uint16_t controller = 0) : chip_{chip}, first_g4_word_{controller * 212u} {
    for (Word& word : ram) word = 0xDEAD'BEEF;
  }
  MCan(const MCan&) = delete;
  MCan& operator=(const MCan&) = delete;

  // --- for the test ------------------------------------------------------------------------------------------------

  bool powered = true;
  int init_takes = 3;  ///< reads of CCCR until a change of INIT can be read back
  int wire_takes = 4;  ///< reads of TXBRP until the frame on the wire has ended
  Word ram[ram_words];
  std::vector<canopen::Frame> sent;

  /// Receives a frame of another node. Returns false if it has not been stored.
  bool arrive(const canopen::Frame& frame) {
    if (!on_the_bus()) return false;
    const std::uint32_t id = frame.extended ? frame.id : frame.id & 0x7FF;
    if (!(frame.extended ? takes_extended(id) : takes_standard(id))) return false;
    if (fill_ == place_.received) {
      lost_ = true;
      return false;
    }
    Word* const element = ram + place_.receive + put_ * place_.element;
    element[0] = (frame.extended ? 1u << 30 | id : id << 18) | (frame.remote ? 1u << 29 : 0) | 1u << 31;
    element[1] = 0x8000'BEEFu | std::uint32_t{frame.size} << 16;  // ANMF and a time stamp around the DLC
    std::uint32_t words[2];
    std::memcpy(words, frame.data.data(), sizeof words);
    if (!frame.remote) {
      element[2] = words[0];
      element[3] = words[1];
    }
    put_ = (put_ + 1) % place_.received;
    ++fill_;
    return true;
  }

  /// Begins to send the request that wins the arbitration.
  bool begin_frame() {
    if (on_wire_ || halted_ || !on_the_bus() || (cccr_ & monitor) != 0) return on_wire_.has_value();
    for (std::uint32_t i = 0; i < place_.transmitted; ++i) {
      if ((requests_ >> i & 1) != 0 && (!on_wire_ || arbitration(i) < arbitration(*on_wire_))) on_wire_ = i;
    }
    wire_left_ = wire_takes;
    return on_wire_.has_value();
  }

  /// Ends the frame on the wire. Without acknowledgement it is sent again unless it has been cancelled.
  void end_frame(bool acknowledged = true) {
    ASSERT_TRUE(on_wire_);
    const std::uint32_t bit = 1u << *on_wire_;
    if (acknowledged) {
      sent.push_back(frame_in(*on_wire_));
      occurred_ |= bit;
    }
    if (acknowledged || (cancelled_ & bit) != 0) requests_ &= ~bit;
    cancelled_ &= ~bit;
    on_wire_.reset();
  }

  /// Sends all requested frames.
  void send_all() {
    while (begin_frame()) end_frame();
  }

  /// Sets PSR as the error counters would.
  void error_state(bool warning, bool passive) { change_state((warning ? 1u << 6 : 0) | (passive ? 1u << 5 : 0)); }
  void go_bus_off() {
    change_state(off | 1u << 6 | 1u << 5);
    on_wire_.reset();
    cccr_ |= initialize;
    asked_ |= initialize;
  }
  /// 129 times 11 recessive bits. Returns false if INIT keeps the controller off the bus.
  bool pass_recovery() {
    if ((cccr_ & initialize) != 0) return false;
    change_state(0);
    return true;
  }

  [[nodiscard]] std::uint32_t nominal_bit_timing() const { return values_[NBTP]; }
  [[nodiscard]] bool on_the_bus() const { return (cccr_ & initialize) == 0 && (state_ & off) == 0; }
  [[nodiscard]] std::uint32_t requests() const { return requests_; }
  [[nodiscard]] bool classic() const { return (cccr_ & 0x0000'0344) == 0; }  // no FDOE, BRSE, DAR, ASM
  /// Whether line 0 is active for a change of error passive or bus-off.
  [[nodiscard]] bool interrupts_for_status() const {
    return (interrupt_ & values_[IE]) != 0 && values_[ILE] == 1 && values_[ILS] == 0;
  }
  /// Whether the interrupt of line 0 is enabled for received frames, for every Tx buffer that has been sent, and for
  /// error passive and bus-off.
  [[nodiscard]] bool interrupts() const {
    const std::uint32_t enabled = 1u << 0 | (chip_ == Chip::g4 ? 1u << 7 : 1u << 9) | passive_bit() | off_bit();
    return values_[IE] == enabled && values_[ILE] == 1 && values_[ILS] == 0 &&
           values_[TXBTIE] == (1u << place_.transmitted) - 1;
  }
  [[nodiscard]] std::uint32_t acknowledged() const { return values_[IR]; }
  [[nodiscard]] std::uint32_t value(unsigned which) const { return values_[which]; }

 private:
  enum Name : std::uint8_t {
    // clang-format off
    CCCR, NBTP, ECR, PSR, IR, IE, ILS, ILE, RXGFC, GFC, SIDFC, XIDFC, XIDAM, RXF0C, RXF0S, RXF0A, RXBC, RXF1C, RXESC, TXBC, TXFQS,
    TXESC, TXBRP, TXBAR, TXBCR, TXBTO, TXBTIE, TXEFC, names
    // clang-format on
  };
  static constexpr std::uint32_t initialize = 1, change_enable = 2, monitor = 1 << 5, off = 1 << 7;

  struct Register {
    MCan& can;
    Name name;
    operator std::uint32_t() const { return can.read(name); }
    void operator=(std::uint32_t value) { can.write(name, value); }
  };

  struct Common {
    Register cccr, nbtp, ecr, psr, ir, ie, ils, ile;
  };

 public:
  // --- for the driver ----------------------------------------------------------------------------------------------

  Common common{{*this, Name::CCCR}, {*this, Name::NBTP}, {*this, Name::ECR}, {*this, Name::PSR},
                {*this, Name::IR},   {*this, Name::IE},   {*this, Name::ILS}, {*this, Name::ILE}};
  Register rxgfc{*this, Name::RXGFC}, gfc{*this, Name::GFC}, sidfc{*this, Name::SIDFC}, xidfc{*this, Name::XIDFC},
      xidam{*this, Name::XIDAM}, rxf0c{*this, Name::RXF0C}, rxf0s{*this, Name::RXF0S}, rxf0a{*this, Name::RXF0A},
      rxbc{*this, Name::RXBC}, rxf1c{*this, Name::RXF1C}, rxesc{*this, Name::RXESC}, txbc{*this, Name::TXBC},
      txfqs{*this, Name::TXFQS}, txesc{*this, Name::TXESC}, txbrp{*this, Name::TXBRP}, txbar{*this, Name::TXBAR},
      txbcr{*this, Name::TXBCR}, txbto{*this, Name::TXBTO}, txbtie{*this, Name::TXBTIE}, txefc{*this, Name::TXEFC};

 private:
  /// The sections of the message RAM, in words.
  struct Place {
    std::uint32_t standard, standards, extended, extendeds, receive, received, transmit, transmitted, element;
  };

  /// IR.EP, IR.BO: each change of these states.
  [[nodiscard]] std::uint32_t passive_bit() const { return chip_ == Chip::g4 ? 1u << 17 : 1u << 23; }
  [[nodiscard]] std::uint32_t off_bit() const { return chip_ == Chip::g4 ? 1u << 19 : 1u << 25; }
  void change_state(std::uint32_t state) {
    const std::uint32_t changed = state ^ state_;
    if ((changed & 1u << 5) != 0) interrupt_ |= passive_bit();
    if ((changed & off) != 0) interrupt_ |= off_bit();
    state_ = state;
  }

  [[nodiscard]] bool protected_register(Name name) const {
    static constexpr Name open[] = {CCCR, IR, IE, ILS, ILE, RXF0A, TXBAR, TXBCR, TXBTIE};
    return std::find(std::begin(open), std::end(open), name) == std::end(open);
  }

  std::uint32_t read(Name name) {
    switch (name) {
      case CCCR: return read_cccr();
      case PSR: return 0x0000'0707 | state_;
      case IR: return interrupt_;
      case RXF0S:
        return fill_ | get_ << 8 | put_ << 16 | (fill_ == place_.received ? 1u << 24 : 0) | (lost_ ? 1u << 25 : 0);
      case TXFQS: {
        std::uint32_t free = 0;
        while (free < place_.transmitted && (requests_ >> free & 1) != 0) ++free;
        return free == place_.transmitted ? 1u << 21 : free << 16;
      }
      case TXBRP:
        if (on_wire_ && --wire_left_ <= 0) end_frame();
        return requests_;
      case TXBTO: return occurred_;
      default: return values_[name];
    }
  }

  void write(Name name, std::uint32_t value) {
    if (protected_register(name)) {
      EXPECT_EQ(cccr_ & 3, 3u) << "register " << int{name} << " is protected by CCE and INIT";
      if ((cccr_ & 3) != 3) return;
    }
    values_[name] = value;
    switch (name) {
      case CCCR: return write_cccr(value);
      case IR:
        interrupt_ &= ~value;
        if ((value & (chip_ == Chip::g4 ? 1u << 2 : 1u << 3)) != 0) lost_ = false;
        return;
      case RXF0A:
        ASSERT_GT(fill_, 0u);
        ASSERT_EQ(value, get_);
        get_ = (get_ + 1) % place_.received;
        --fill_;
        return;
      case TXBAR:
        if (value == 0) return;
        ASSERT_EQ(cccr_ & (initialize | monitor), 0u) << "no request is taken now";
        requests_ |= value;
        occurred_ &= ~value;
        return;
      case TXBCR:
        cancelled_ |= value & requests_;
        requests_ &= on_wire_ ? ~value | 1u << *on_wire_ : ~value;
        if (!on_wire_) cancelled_ = 0;
        return;
      default: return;
    }
  }

  /// INIT crosses clock domains: a written value can be read back only some time later.
  std::uint32_t read_cccr() {
    if (powered && ((cccr_ ^ asked_) & initialize) != 0 && --init_left_ <= 0) change_init();
    return cccr_;
  }
  void change_init() {
    if ((asked_ & initialize) != 0) {
      EXPECT_FALSE(on_wire_) << "INIT has destroyed a frame";
      cccr_ |= initialize;
    } else {
      cccr_ &= ~(initialize | change_enable);
      divide();
    }
  }
  void write_cccr(std::uint32_t value) {
    const bool changed = ((value ^ asked_) & initialize) != 0;
    EXPECT_FALSE(changed && ((cccr_ ^ asked_) & initialize) != 0) << "the last change of INIT is still under way";
    const bool stopped = (cccr_ & initialize) != 0;
    const bool changing = (cccr_ & change_enable) != 0;
    asked_ = value;
    if (changed) init_left_ = init_takes;
    const std::uint32_t modes = value & ~3u;
    if (stopped && changing) {
      cccr_ = modes | (cccr_ & 3);
    } else {
      EXPECT_EQ(modes & ~cccr_, 0u) << "modes are protected by CCE and INIT";
      cccr_ &= modes | 3;
    }
    if ((value & change_enable) == 0 || !stopped || changing) return;
    cccr_ |= change_enable;
    if (requests_ != 0) halted_ = true;  // the Tx handler was scanning them
    EXPECT_FALSE(halted_) << "CCE is set while there are requests: the controller never sends again";
    requests_ = occurred_ = cancelled_ = 0;
    fill_ = get_ = put_ = 0;
    lost_ = false;
  }

  /// Divides the message RAM as the registers specify, when the controller goes on the bus.
  void divide() {
    if (chip_ == Chip::g4) {
      const std::uint32_t first = first_g4_word_;
      place_ = {
          first, values_[RXGFC] >> 16 & 0x1F, first + 28, values_[RXGFC] >> 24 & 0xF, first + 44, 3, first + 158, 3,
          18};
      unmatched_ = values_[RXGFC];
      EXPECT_EQ(values_[TXBC], 1u << 24);
    } else {
      const auto start = [this](Name name) { return (values_[name] & 0xFFFC) / 4; };
      const auto size = [this](Name name) { return values_[name] >> 16 & 0x7F; };
      place_ = {start(SIDFC),
                size(SIDFC),
                start(XIDFC),
                size(XIDFC),
                start(RXF0C),
                size(RXF0C),
                start(TXBC),
                values_[TXBC] >> 24 & 0x3F,
                4};
      unmatched_ = values_[GFC];
      EXPECT_EQ(values_[TXBC] >> 30, 1u);         // a queue
      EXPECT_EQ(values_[TXBC] >> 16 & 0x3F, 0u);  // no dedicated buffers
      EXPECT_EQ(values_[RXESC] | values_[TXESC], 0u);
      EXPECT_LE(place_.transmit + place_.transmitted * place_.element, ram_words);
      EXPECT_LE(place_.standards, 128u);
      EXPECT_LE(place_.extendeds, 64u);
      EXPECT_LE(place_.received, 64u);
      EXPECT_LE(place_.transmitted, 32u);
    }
  }

  [[nodiscard]] bool takes_standard(std::uint32_t id) const {
    for (std::uint32_t i = 0; i < place_.standards; ++i) {
      const std::uint32_t word = ram[place_.standard + i];
      const std::uint32_t type = word >> 30, action = word >> 27 & 7, first = word >> 16 & 0x7FF, second = word & 0x7FF;
      if (action != 0 && matches(type, first, second, id)) return action == 1;
    }
    return (unmatched_ >> 4 & 3) == 0;
  }
  [[nodiscard]] bool takes_extended(std::uint32_t id) const {
    for (std::uint32_t i = 0; i < place_.extendeds; ++i) {
      const std::uint32_t low = ram[place_.extended + 2 * i], high = ram[place_.extended + 2 * i + 1];
      if (low >> 29 != 0 && matches(high >> 30, low & 0x1FFF'FFFF, high & 0x1FFF'FFFF, id & values_[XIDAM])) {
        return low >> 29 == 1;
      }
    }
    return (unmatched_ >> 2 & 3) == 0;
  }
  [[nodiscard]] static bool matches(std::uint32_t type, std::uint32_t first, std::uint32_t second, std::uint32_t id) {
    switch (type) {
      case 0: return id >= first && id <= second;
      case 1: return id == first || id == second;
      case 2: return (id & second) == (first & second);
      default: return false;
    }
  }

  [[nodiscard]] canopen::Frame frame_in(std::uint32_t buffer) const {
    const Word* const element = ram + place_.transmit + buffer * place_.element;
    canopen::Frame frame;
    frame.extended = (element[0] >> 30 & 1) != 0;
    frame.remote = (element[0] >> 29 & 1) != 0;
    frame.id = frame.extended ? element[0] & 0x1FFF'FFFF : element[0] >> 18 & 0x7FF;
    EXPECT_EQ(element[1] & 0xFFF0'FFFF, 0u);  // no FD format, no Tx event
    frame.size = static_cast<std::uint8_t>(element[1] >> 16);
    const std::uint32_t words[2] = {element[2], element[3]};
    std::memcpy(frame.data.data(), words, sizeof words);
    return frame;
  }
  [[nodiscard]] std::uint64_t arbitration(std::uint32_t buffer) const {
    return canopen::arbitration_value(frame_in(buffer));
  }

  Chip chip_;
  std::uint32_t first_g4_word_;
  std::array<std::uint32_t, names> values_ = [] {
    std::array<std::uint32_t, names> reset{};
    reset[NBTP] = 0x0600'0A03;
    reset[XIDAM] = 0x1FFF'FFFF;
    return reset;
  }();
  Place place_{};
  std::uint32_t unmatched_ = 0;
  std::uint32_t cccr_ = initialize;
  std::uint32_t asked_ = initialize;
  int init_left_ = 0;
  std::uint32_t state_ = 0;
  std::uint32_t interrupt_ = 0;  ///< IR
  std::uint32_t fill_ = 0, get_ = 0, put_ = 0;
  bool lost_ = false;
  std::uint32_t requests_ = 0, occurred_ = 0, cancelled_ = 0;
  std::optional<std::uint32_t> on_wire_;
  int wire_left_ = 0;
  bool halted_ = false;
};

}  // namespace fake
