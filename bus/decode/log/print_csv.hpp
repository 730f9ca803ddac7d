/// Messages as records of CSV (RFC 4180).
#pragma once

#include <string>

#include "decode/log/log_line.hpp"
#include "decode/log/print_message.hpp"
#include "decode/message.hpp"

namespace edsc {

/// The names of the columns, as a record.
void append_csv_header(std::string& out);

/// A record for each value of the message, with its text; or one without a value, with the text of the message.
void append_csv(std::string& out, const LogLine& line, const Message& message, const NodeLabels& labels);

}  // namespace edsc
