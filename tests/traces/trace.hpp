/// A trace: frames of devices as a manual shows them, in a text that looks like a candump log.
///
///     # comment
///     manual  NNN, the place in the manual
///     device  NAME                                  eds/NAME.eds
///     application NAME                              the same with its application, examples/nodes/NAME
///     node    N                                     its node-ID, decimal, 255 for none yet; further pairs add further
///                                                   nodes
///     power on                                      as the first line: the boot-up messages are part of the trace
///     power off                                     later: all nodes lose what they have not stored; only time
///                                                   passes until `power on`
///     = 6041h:00 0x0231                             the application sets an object: a number, or "text"; successive
///                                                   lines set their objects at the same time
///     emergency 0x8611 0x20 09 00 00 00 00          the application has an error: its code, the bits of 1001h, and the
///                                                   manufacturer-specific bytes, zeros if they are missing
///     emergency over 0x20                           the error and these bits have disappeared
///     ! limit negative on                           a line of input of the application
///     ~ 481                                         from here on, any number of frames with this CAN-ID may be sent at
///                                                   any time; those that a line expects must be sent
///     + 5 ms                                        time passes (us, ms or s)
///     > 601  2B 01 18 03 F0 20 00 00                a frame to the bus
///     > 284  R                                      a remote frame, DLC 0; `R 8` is one with DLC 8
///     < 581  60 01 18 03 -- -- -- --                a node sends exactly this next; `--` may be any byte
///     read 1801h:03 0x20F0                          the object's value is now this
///
/// With several nodes, `=`, `!`, `read` and `emergency` name one: `= node 2 6000h:01 0x34`. Frames do not name a node:
/// each one goes to all nodes except its sender.
#pragma once

#include <canopen/base/clock.hpp>
#include <canopen/can/frame.hpp>
#include <canopen/can/node_id.hpp>
#include <canopen/emcy/emcy_producer.hpp>
#include <canopen/emcy/error_register.hpp>
#include <cstdint>
#include <filesystem>
#include <istream>
#include <string>
#include <vector>

namespace trace {

/// A frame in which some bytes may have any value.
struct Pattern {
  canopen::Frame frame;
  std::uint8_t any = 0;  ///< bit n: byte n may have any value

  [[nodiscard]] bool matches(const canopen::Frame& other) const;
};

/// A value as in a trace.
struct Value {
  bool is_text = false;
  std::string text;
  std::uint64_t number = 0;  ///< negative numbers in two's complement

  /// The bytes in an entry of this size, lowest first; the characters of a text.
  [[nodiscard]] std::vector<std::uint8_t> bytes(std::size_t size) const;
};

enum class Step : std::uint8_t {
  set,
  input,
  emergency,
  emergency_over,
  power_off,
  power_on,
  pass,
  send,
  expect,
  disregard,
  read
};

/// An error of the application.
struct Emergency {
  std::uint16_t code = 0;
  canopen::ErrorRegister bits{};
  canopen::EmergencyInfo info{};
};

struct Line {
  std::size_t number = 0;  ///< from 1
  Step step = Step::pass;
  Pattern pattern;             ///< send, expect; disregard: only the CAN-ID
  canopen::Duration span{};    ///< pass
  std::size_t node = 0;        ///< set, input, read, emergency: position in Trace::nodes
  std::uint16_t index = 0;     ///< set, read
  std::uint8_t sub_index = 0;  ///< set, read
  Value value;                 ///< set, read
  std::string input;           ///< of the application
  Emergency emergency;         ///< emergency; emergency_over: only the bits
};

struct NodeOfTrace {
  std::string device;
  bool has_application = false;
  canopen::NodeId node_id;
};

struct Trace {
  std::string file;
  std::vector<NodeOfTrace> nodes;
  bool power_on = false;  ///< the trace begins with the boot-up messages
  std::vector<Line> lines;
};

/// Throws std::runtime_error with file and line if the text is not a trace.
[[nodiscard]] Trace read(const std::filesystem::path& file);

/// The same for a text that is not in a file; messages contain `name`.
[[nodiscard]] Trace read(std::istream& text, const std::string& name);

[[nodiscard]] std::string to_text(const canopen::Frame& frame);
[[nodiscard]] std::string to_text(const Pattern& pattern);
[[nodiscard]] std::string to_text(const std::vector<std::uint8_t>& bytes);

}  // namespace trace
