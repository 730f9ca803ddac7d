#include <fmt/format.h>

#include <cerrno>
#include <cstdio>
#include <cstring>

#include "commands/commands.hpp"
#include "decode/log/log_decoder.hpp"
#include "decode/log/print_csv.hpp"
#include "shared/define_command.hpp"
#include "shared/exit_code.hpp"
#include "shared/log_options.hpp"
#include "system/standard_streams.hpp"

namespace edsc {
namespace {

constexpr const char* examples = R"(Examples:
  edsc decode --node 5=drive.eds can0.log            decode each frame of a log
  candump -L can0 | edsc decode --node axis1.dcf -   the same on a live bus; the DCF states the node-ID
  tcpdump -i can0 -U -w - | edsc decode --node axis1.dcf -
  edsc decode --node 5=drive.eds can0.log --filter node=5,service=sdo --summary
  edsc decode --node 5=drive.eds can0.log --format json | jq -c 'select(.problem)'
  edsc decode --node 5=drive.eds trip.asc --format csv > trip.csv)";

struct Settings : LogSettings {
  std::vector<std::string> filters;
  std::string format = "text";
  bool summary = false;
};

/// Ends the command without a message if the reader of standard output has closed it.
void write_out(std::string& text) {
  const int error_number = write_unbuffered(stdout, text);
  if (error_number == EPIPE) throw Exit{exit_fine};
  if (error_number != 0) fail(fmt::format("cannot write to standard output: {}", std::strerror(error_number)));
  text.clear();
}

struct FormatRow {
  const char* name;
  LogOutput output;
};

constexpr FormatRow formats[] = {{"text", LogOutput::text}, {"json", LogOutput::json}, {"csv", LogOutput::csv}};

LogDecoderSettings decoder_settings(const Settings& settings, const NodeLabels& labels) {
  LogDecoderSettings result{settings.log_name(), settings.interface, LogOutput::text, settings.color.on(stdout), {}};
  for (const FormatRow& row : formats) {
    if (settings.format == row.name) result.output = row.output;
  }
  if (settings.summary && result.output == LogOutput::csv) fail("--summary: CSV has no place for a summary");
  for (const std::string& filter : settings.filters) {
    const std::string problem = result.filter.add(filter, labels);
    if (!problem.empty()) fail("--filter: " + problem);
  }
  return result;
}

int decode(const Settings& settings) {
  constexpr std::size_t output_bytes = std::size_t{64} * 1024;
  const GivenNodes nodes = load_given_nodes(settings, settings.color);
  LogDecoder decoder{nodes.known(), nodes.labels, decoder_settings(settings, nodes.labels)};
  report_closed_pipes();
  std::string out, complaints;
  const auto flush = [&] {
    write_out(out);
    write_to_stderr(complaints);
    complaints.clear();
  };
  if (settings.format == "csv") append_csv_header(out);
  const auto use = [&](LogLine& line) {
    decoder.decode(line, out, complaints);
    if (out.size() >= output_bytes || !complaints.empty()) flush();
  };
  const auto fail_if_unreadable = read_log(settings, use, flush);
  decoder.finish(complaints);
  if (settings.summary) out += settings.format == "json" ? decoder.summary().json() : decoder.summary().text();
  flush();
  fail_if_unreadable();
  return decoder.skipped_lines() ? exit_input_has_errors : exit_fine;
}

}  // namespace

void add_decode_options(Command command, int& exit_code) {
  Settings& settings = define_command(command, examples, decode, exit_code);
  add_log_options(command, settings).show_default();
  std::vector<std::string> names;
  for (const FormatRow& row : formats) names.emplace_back(row.name);
  add_choice(command, "--format", settings.format, names, "json: an object on each line; csv: a record for each value");
  command.add_option("--filter", settings.filters, "node=5,service=sdo,id=185h,problem=yes; all frames are evaluated")
      .one_value_each();
  command.add_flag("--summary", settings.summary);
}

}  // namespace edsc
