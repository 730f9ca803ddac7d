/// Messages and signals of a DBC file, as far as names need them.
#pragma once

#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

#include "diagnostics/diagnostics.hpp"
#include "text/source_file.hpp"

namespace edsc {

struct DbcFileSignal {
  std::string name;  ///< the long one, if the file states it
  /// The lowest bit in the numbering of a PDO mapping.
  unsigned first_bit = 0;
  unsigned bits = 0;
  bool has_pdo_layout = true;  ///< false: it is multiplexed, or big-endian in more than one byte
  Position position;
};

struct DbcFileMessage {
  std::string name;
  std::uint32_t can_id = 0;
  bool extended = false;
  Position position;
  std::vector<DbcFileSignal> signals;
};

/// Reads messages (BO_), signals (SG_) and the long names of signals; everything else is skipped, also text in quotes
/// that has several lines. A line that begins as a message or signal and is none is reported, and a file without a
/// message.
[[nodiscard]] std::vector<DbcFileMessage> read_dbc(const SourceFile& source, Diagnostics& diagnostics);

}  // namespace edsc
