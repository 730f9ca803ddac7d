/// A CANopen slave with faults of hardware and firmware, written after CiA 301 alone: it does not use the runtime's
/// node, SDO server or heartbeat, so that it is an independent partner for the tests of a master.
#pragma once

#include <canopen/can/frame.hpp>

#include <algorithm>
#include <array>
#include <cstdint>
#include <cstring>
#include <deque>
#include <functional>
#include <map>
#include <optional>
#include <string>
#include <utility>
#include <vector>

namespace faulty {

using Bytes = std::vector<std::uint8_t>;
/// Index in bits 8..23, sub-index in bits 0..7.
using Entry = std::uint32_t;
using Values = std::map<Entry, Bytes>;

enum class Fault : std::uint8_t {
  none,
  starts_twice,      ///< after a reset it sends its boot-up message, loses its values and sends another one
  answers_twice,     ///< each response is sent twice
  late_abort,        ///< an entry is confirmed, and 3 ms later its transfer is aborted
  heartbeat_fast,    ///< twice as many heartbeats
  heartbeat_slow,    ///< half of the heartbeats
  heartbeat_states,  ///< every other heartbeat has the state Stopped
  loses_power,       ///< in the middle of its configuration: it loses its values, and boots 50 ms later
  ignores_write,     ///< an entry is confirmed and not written
  rejects_write,     ///< an entry is rejected with 0609 0030h
  aborts_with_zero,  ///< an entry is rejected with code 0000 0000h
};

struct Settings {
  std::uint8_t node_id = 5;
  Values values{};  ///< after a reset
  Fault fault = Fault::none;
  Entry entry = 0;                ///< of the fault
  unsigned times = 1'000'000;     ///< the fault occurs, then no more
  std::uint32_t delay_us = 300;   ///< of each response
  std::uint32_t boot_us = 2'000;  ///< from a reset to the boot-up message
};

class Slave {
 public:
  using Time = std::uint64_t;  ///< us

  Slave(Settings settings, std::function<void(const canopen::Frame&)> send)
      : settings_{std::move(settings)}, send_{std::move(send)} {}

  void power_on(Time now) { restart(now, settings_.boot_us); }
  void power_off() {
    on_ = false;
    waiting_.clear();
    next_heartbeat_.reset();
  }

  [[nodiscard]] bool operational() const { return on_ && state_ == 0x05; }
  /// The number of commands to start it that it has received, and that found it with other values than `expected`.
  [[nodiscard]] unsigned starts() const { return starts_; }
  [[nodiscard]] unsigned wrong_starts() const { return wrong_starts_; }
  [[nodiscard]] unsigned requests() const { return requests_; }
  [[nodiscard]] const Values& values() const { return values_; }
  /// Loses its values without a boot-up message.
  void forget() { values_ = settings_.values; }
  void end_fault() { settings_.fault = Fault::none; }

  /// The configuration without which the slave must not be started.
  Values expected{};

  void on_frame(const canopen::Frame& frame, Time now) {
    if (!on_ || frame.extended || frame.remote) return;
    if (frame.id == 0 && frame.size == 2 && (frame.data[1] == 0 || frame.data[1] == settings_.node_id)) {
      command(frame.data[0], now);
    } else if (frame.id == 0x600u + settings_.node_id && frame.size == 8 && booted_ && state_ != 0x04) {
      ++requests_;
      request(frame.data, now);
    }
  }

  void on_time(Time now) {
    while (!waiting_.empty() && waiting_.front().due <= now) {
      const Waiting next = waiting_.front();
      waiting_.pop_front();
      if (next.restart) {
        restart(now, 0, true);
      } else if (next.boot_up) {
        booted_ = true;
        state_ = 0x7F;
        send(0x700, {0x00});
        begin_heartbeat(now);
      } else {
        send_(next.frame);
      }
    }
    if (!next_heartbeat_ || *next_heartbeat_ > now) return;
    const bool other = settings_.fault == Fault::heartbeat_states && (++heartbeats_ % 2) == 0;
    send(0x700, {other ? std::uint8_t{0x04} : state_});
    *next_heartbeat_ += heartbeat_period();
  }

  [[nodiscard]] std::optional<Time> next_deadline() const {
    std::optional<Time> next = next_heartbeat_;
    if (!waiting_.empty() && (!next || waiting_.front().due < *next)) next = waiting_.front().due;
    return next;
  }

 private:
  struct Waiting {
    Time due = 0;
    canopen::Frame frame{};
    bool boot_up = false;
    bool restart = false;
  };

  static constexpr Entry heartbeat_time = 0x101700;
  static constexpr std::uint32_t no_object = 0x0602'0000, invalid_value = 0x0609'0030;

  bool strikes(Fault fault) {
    if (settings_.fault != fault || settings_.times == 0) return false;
    --settings_.times;
    return true;
  }

  void send(std::uint32_t function, std::initializer_list<std::uint8_t> bytes) {
    canopen::Frame frame{};
    frame.id = function + settings_.node_id;
    for (const std::uint8_t byte : bytes) frame.data[frame.size++] = byte;
    send_(frame);
  }

  void add(Waiting what) {
    const auto later = [](Time due, const Waiting& one) { return due < one.due; };
    waiting_.insert(std::upper_bound(waiting_.begin(), waiting_.end(), what.due, later), what);
  }

  void restart(Time now, Time until_boot_up, bool is_second = false) {
    on_ = true;
    booted_ = false;
    state_ = 0;
    waiting_.clear();
    next_heartbeat_.reset();
    values_ = settings_.values;
    download_.reset();
    add({.due = now + until_boot_up, .frame = {}, .boot_up = true});
    if (!is_second && strikes(Fault::starts_twice)) {
      add({.due = now + until_boot_up + 30'000, .frame = {}, .boot_up = false, .restart = true});
    }
  }

  void command(std::uint8_t what, Time now) {
    switch (what) {
      case 0x01:
        if (!booted_) return;
        ++starts_;
        for (const auto& [entry, bytes] : expected) {
          const auto at = values_.find(entry);
          if (at == values_.end() || at->second != bytes) {
            ++wrong_starts_;
            break;
          }
        }
        state_ = 0x05;
        return;
      case 0x02: state_ = 0x04; return;
      case 0x80: state_ = 0x7F; return;
      case 0x81:
      case 0x82: return restart(now, settings_.boot_us);
      default: return;
    }
  }

  [[nodiscard]] Time heartbeat_period() const {
    const auto at = values_.find(heartbeat_time);
    Time period =
        at == values_.end() || at->second.size() < 2 ? 0 : static_cast<Time>(at->second[0] | at->second[1] << 8) * 1000;
    if (settings_.fault == Fault::heartbeat_fast) period /= 2;
    if (settings_.fault == Fault::heartbeat_slow) period *= 2;
    return period;
  }
  void begin_heartbeat(Time now) {
    next_heartbeat_.reset();
    if (const Time period = heartbeat_period(); period != 0) next_heartbeat_ = now + period;
  }

  using Data = std::array<std::uint8_t, 8>;

  void respond(const Data& data, Time now) {
    canopen::Frame frame{};
    frame.id = 0x580u + settings_.node_id;
    frame.size = 8;
    std::copy(data.begin(), data.end(), frame.data.begin());
    add({.due = now + settings_.delay_us, .frame = frame});
    if (strikes(Fault::answers_twice)) add({.due = now + settings_.delay_us + 400, .frame = frame});
  }

  static Data with_entry(std::uint8_t command, Entry entry) {
    return {command, static_cast<std::uint8_t>(entry >> 8), static_cast<std::uint8_t>(entry >> 16),
            static_cast<std::uint8_t>(entry)};
  }
  static Data abort_of(Entry entry, std::uint32_t code) {
    Data data = with_entry(0x80, entry);
    for (unsigned i = 0; i < 4; ++i) data[4 + i] = static_cast<std::uint8_t>(code >> 8 * i);
    return data;
  }

  void request(const Data& data, Time now) {
    const Entry entry = static_cast<Entry>(data[2]) << 16 | static_cast<Entry>(data[1]) << 8 | data[3];
    switch (data[0] >> 5) {
      case 0: return download_segment(data, now);
      case 1: return begin_download(data, entry, now);
      case 2: return begin_upload(entry, now);
      case 3: return upload_segment(data, now);
      case 4: download_.reset(); return;
      default: return respond(abort_of(entry, 0x0504'0001), now);
    }
  }

  void begin_upload(Entry entry, Time now) {
    const auto at = values_.find(entry);
    if (at == values_.end()) return respond(abort_of(entry, no_object), now);
    const Bytes& bytes = at->second;
    if (bytes.size() > 4) {
      upload_ = bytes;
      uploaded_ = 0;
      Data data = with_entry(0x41, entry);
      data[4] = static_cast<std::uint8_t>(bytes.size());
      return respond(data, now);
    }
    Data data = with_entry(static_cast<std::uint8_t>(0x43 | (4 - bytes.size()) << 2), entry);
    std::copy(bytes.begin(), bytes.end(), data.begin() + 4);
    respond(data, now);
  }

  void upload_segment(const Data& request, Time now) {
    const std::size_t size = std::min<std::size_t>(upload_.size() - uploaded_, 7);
    const bool last = uploaded_ + size == upload_.size();
    Data data{static_cast<std::uint8_t>((request[0] & 0x10) | (7 - size) << 1 | (last ? 1 : 0))};
    for (std::size_t i = 0; i < size; ++i) data[1 + i] = upload_[uploaded_ + i];
    uploaded_ += size;
    respond(data, now);
  }

  void begin_download(const Data& data, Entry entry, Time now) {
    if (!values_.contains(entry)) return respond(abort_of(entry, no_object), now);
    if (entry == settings_.entry) {
      if (strikes(Fault::rejects_write)) return respond(abort_of(entry, invalid_value), now);
      if (strikes(Fault::aborts_with_zero)) return respond(abort_of(entry, 0), now);
    }
    if ((data[0] & 2) == 0) {
      download_ = {entry, {}};
      return respond(with_entry(0x60, entry), now);
    }
    const std::size_t size = 4u - ((data[0] >> 2) & 3u);
    respond(with_entry(0x60, entry), now);
    written(entry, {data.begin() + 4, data.begin() + 4 + static_cast<std::ptrdiff_t>(size)}, now);
  }

  void download_segment(const Data& data, Time now) {
    if (!download_) return;
    const std::size_t size = 7u - ((data[0] >> 1) & 7u);
    download_->second.insert(download_->second.end(), data.begin() + 1,
                             data.begin() + 1 + static_cast<std::ptrdiff_t>(size));
    respond({static_cast<std::uint8_t>(0x20 | (data[0] & 0x10))}, now);
    if ((data[0] & 1) == 0) return;
    const auto whole = std::exchange(download_, std::nullopt);
    written(whole->first, whole->second, now);
  }

  void written(Entry entry, const Bytes& bytes, Time now) {
    const bool is_hit = entry == settings_.entry;
    if (!(is_hit && strikes(Fault::ignores_write))) values_[entry] = bytes;
    if (is_hit && strikes(Fault::late_abort)) {
      canopen::Frame frame{};
      frame.id = 0x580u + settings_.node_id;
      frame.size = 8;
      const Data data = abort_of(entry, invalid_value);
      std::copy(data.begin(), data.end(), frame.data.begin());
      add({.due = now + settings_.delay_us + 3'000, .frame = frame});
    }
    if (is_hit && strikes(Fault::loses_power)) return restart(now, 50'000);
    if (entry == heartbeat_time) begin_heartbeat(now);
  }

  Settings settings_;
  std::function<void(const canopen::Frame&)> send_;
  std::deque<Waiting> waiting_;
  std::optional<Time> next_heartbeat_;
  Values values_;
  std::optional<std::pair<Entry, Bytes>> download_;
  Bytes upload_;
  std::size_t uploaded_ = 0;
  unsigned heartbeats_ = 0, starts_ = 0, wrong_starts_ = 0, requests_ = 0;
  std::uint8_t state_ = 0;
  bool on_ = false;
  bool booted_ = false;
};

}  // namespace faulty
