/// A model of an NMT slave, written only from CiA 301 (version 4.2.0, 7.2.8.2.1 and 7.3.2). Numbers in comments are
/// clauses of CiA 301.
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>

namespace model {

class NmtSlave {
 public:
  enum class State : std::uint8_t { stopped = 4, operational = 5, pre_operational = 127 };

  explicit NmtSlave(std::uint8_t node_id) : node_id_{node_id} {}

  /// The effect of a command besides the change of the state.
  enum class Reset { none, communication, application };

  /// A frame on CAN-ID 000h (7.2.8.3.1.1): the command and the node-ID; 0 is all nodes. Unknown commands and shorter
  /// frames are not an NMT service. The standard does not specify longer frames; manual 003 (5.4.1) shows commands of
  /// eight bytes, of which the first two are used.
  Reset take(std::span<const std::uint8_t> data) {
    if (data.size() < 2) return Reset::none;
    if (data[1] != 0 && data[1] != node_id_) return Reset::none;
    switch (data[0]) {
      case 1: state_ = State::operational; return Reset::none;
      case 2: state_ = State::stopped; return Reset::none;
      case 128: state_ = State::pre_operational; return Reset::none;
      case 129: state_ = State::pre_operational; return Reset::application;
      case 130: state_ = State::pre_operational; return Reset::communication;
      default: return Reset::none;
    }
  }

  [[nodiscard]] State state() const { return state_; }

  // Table 38 (7.3.2.2.5): which communication objects exist in which state.
  [[nodiscard]] bool pdo() const { return state_ == State::operational; }
  [[nodiscard]] bool sdo() const { return state_ != State::stopped; }
  [[nodiscard]] bool sync() const { return state_ != State::stopped; }
  [[nodiscard]] bool emcy() const { return state_ != State::stopped; }

 private:
  std::uint8_t node_id_;
  State state_ = State::pre_operational;  // after the boot-up message (7.3.2.2.1)
};

}  // namespace model
