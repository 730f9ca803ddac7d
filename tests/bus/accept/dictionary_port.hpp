/// An SDO server with a table of entries as the port of a LiveBus, in simulated time: expedited and segmented uploads
/// as in CiA 301, 7.2.4.3. It does not share code with the comparison.
#pragma once

#include <algorithm>
#include <cstdint>
#include <deque>
#include <map>
#include <optional>
#include <set>
#include <utility>
#include <vector>

#include "online/live_bus.hpp"

namespace edsc::accept {

class DictionaryPort final : public BusPort {
 public:
  using Bytes = std::vector<std::uint8_t>;
  using Key = std::pair<unsigned, unsigned>;

  static constexpr std::uint8_t node_id = 5;

  std::map<Key, Bytes> values;
  std::map<Key, std::uint32_t> aborts;  ///< instead of a value
  std::set<Key> silent;                 ///< without a response
  std::map<Key, Bytes> first_values;    ///< of the first read alone
  unsigned downloads = 0;               ///< requests that would write

  bool send(const canopen::Frame& frame) override {
    if (frame.id == 0x600U + node_id && frame.size == 8) serve(frame.data);
    return true;
  }
  std::optional<canopen::Frame> receive(canopen::Duration timeout) override {
    if (responses_.empty()) {
      now_ = now_ + timeout;
      return std::nullopt;
    }
    now_ = now_ + canopen::Duration{100};
    const canopen::Frame frame = responses_.front();
    responses_.pop_front();
    return frame;
  }
  canopen::TimePoint now() const override { return now_; }
  canopen::TimePoint received_at() const override { return now_; }

 private:
  using Data = std::array<std::uint8_t, 8>;

  void respond(const Data& data) {
    canopen::Frame frame;
    frame.id = 0x580U + node_id;
    frame.size = 8;
    frame.data = data;
    responses_.push_back(frame);
  }

  void abort(const Data& request, std::uint32_t code) {
    Data data{0x80, request[1], request[2], request[3]};
    for (unsigned i = 0; i != 4; ++i) data.at(4 + i) = static_cast<std::uint8_t>(code >> (8 * i));
    respond(data);
  }

  void serve(const Data& request) {
    switch (request[0] >> 5) {
      case 2: return begin_upload(request);
      case 3: return segment(request);
      case 4: return rest_.clear();
      default: ++downloads;
    }
  }

  [[nodiscard]] bool has_object(unsigned index) const {
    return std::ranges::any_of(values, [&](const auto& row) { return row.first.first == index; }) ||
           std::ranges::any_of(aborts, [&](const auto& row) { return row.first.first == index; });
  }

  void begin_upload(const Data& request) {
    const Key key{request[1] | request[2] << 8, request[3]};
    if (silent.contains(key)) return;
    if (const auto found = aborts.find(key); found != aborts.end()) return abort(request, found->second);
    const auto value = values.find(key);
    if (value == values.end()) return abort(request, has_object(key.first) ? 0x0609'0011 : 0x0602'0000);
    Bytes bytes = value->second;
    if (const auto first = first_values.extract(key)) bytes = first.mapped();
    Data data{0x41, request[1], request[2], request[3]};
    if (!bytes.empty() && bytes.size() <= 4) {
      data[0] = static_cast<std::uint8_t>(0x43 | (4 - bytes.size()) << 2);
      std::ranges::copy(bytes, data.begin() + 4);
    } else {
      data[4] = static_cast<std::uint8_t>(bytes.size());
      rest_ = bytes;
    }
    respond(data);
  }

  void segment(const Data& request) {
    const std::size_t size = std::min<std::size_t>(7, rest_.size());
    Data data{static_cast<std::uint8_t>((request[0] & 0x10) | (7 - size) << 1 | (size == rest_.size() ? 1 : 0))};
    std::copy_n(rest_.begin(), size, data.begin() + 1);
    rest_.erase(rest_.begin(), rest_.begin() + static_cast<std::ptrdiff_t>(size));
    respond(data);
  }

  canopen::TimePoint now_{};
  std::deque<canopen::Frame> responses_;
  Bytes rest_;
};

}  // namespace edsc::accept
