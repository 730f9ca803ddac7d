/// A trace: what a manual shows of a device on the bus, as a text that looks like a candump log.
///
///     # comment
///     manual  NNN, the place in the manual
///     device  NAME                                  eds/NAME.eds
///     node    N                                     node-ID, decimal
///     power on                                      the boot-up message is part of the trace
///     = 6041h:00 0x0231                             the application sets an object: a number, or "text"
///     + 5 ms                                        time passes (us, ms or s)
///     > 601  2B 01 18 03 F0 20 00 00                a frame to the device; `> 701 R 1` is a remote frame
///     < 581  60 01 18 03 -- -- -- --                the device sends exactly this next; `--` may be any byte
///     read 1801h:03 0x20F0                          the object's value is now this
#pragma once

#include <canopen/frame.hpp>
#include <canopen/node_id.hpp>
#include <canopen/time.hpp>
#include <cstdint>
#include <filesystem>
#include <string>
#include <vector>

namespace trace {

/// A frame of which some bytes may be anything.
struct Pattern {
  canopen::Frame frame;
  std::uint8_t any = 0;  ///< bit n: byte n may be anything

  [[nodiscard]] bool matches(const canopen::Frame& other) const;
};

/// A value as a trace writes it.
struct Value {
  bool is_text = false;
  std::string text;
  std::uint64_t number = 0;  ///< negative ones as two's complement
};

enum class Step : std::uint8_t { set, pass, send, expect, read };

struct Line {
  std::size_t number = 0;  ///< from 1
  Step step = Step::pass;
  Pattern pattern;             ///< send, expect
  canopen::Duration span{};    ///< pass
  std::uint16_t index = 0;     ///< set, read
  std::uint8_t sub_index = 0;  ///< set, read
  Value value;                 ///< set, read
};

struct Trace {
  std::string file;
  std::string device;
  canopen::NodeId node_id;
  bool power_on = false;
  std::vector<Line> lines;
};

/// Throws std::runtime_error with file and line where the text is not a trace.
[[nodiscard]] Trace read(const std::filesystem::path& file);

[[nodiscard]] std::string to_text(const canopen::Frame& frame);
[[nodiscard]] std::string to_text(const Pattern& pattern);

}  // namespace trace
