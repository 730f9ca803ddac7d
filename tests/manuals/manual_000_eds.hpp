/// The EDS that the servo drive cpc TC1 sends from 1021h, for the tests of manual 000.
#pragma once

#include <cstdint>
#include <cstdio>
#include <map>
#include <sstream>
#include <string>
#include <utility>

#include "manual_bench.hpp"

namespace manual_000 {

/// A text that is uploaded in segments; empty if a response is not the one of CiA 301.
template <class Bench>
std::string upload_text(Bench& drive, std::uint16_t index) {
  const canopen::Frame initiated = bench::frame(drive.ask(manual::sdo("605", 0x40, index, 0, 0)));
  if (initiated.data[0] != 0x41) return "";
  std::size_t size = 0;
  for (unsigned i = 4; i-- > 0;) size = size << 8 | initiated.data.at(4 + i);
  std::string text;
  for (bool toggle = false, last = false; !last && text.size() <= size; toggle = !toggle) {
    const canopen::Frame segment =
        bench::frame(drive.ask(toggle ? "605 70 00 00 00 00 00 00 00" : "605 60 00 00 00 00 00 00 00"));
    if ((segment.data[0] & 0xF0) != (toggle ? 0x10 : 0x00)) return "";
    last = (segment.data[0] & 1) != 0;
    text.append(segment.data.begin() + 1, segment.data.end() - (segment.data[0] >> 1 & 7));
  }
  return text.size() == size ? text : "";
}

/// The values of its keys, by section.
class SentEds {
 public:
  template <class Bench>
  explicit SentEds(Bench& drive) : text{upload_text(drive, 0x1021)} {
    std::istringstream lines{text};
    std::string section;
    for (std::string line; std::getline(lines, line);) {
      if (line.empty() || line[0] == ';') continue;
      const std::size_t equals = line.find('=');
      if (line[0] == '[') {
        section = line.substr(1, line.find(']') - 1);
      } else if (equals != std::string::npos) {
        values_[section][line.substr(0, equals)] = line.substr(equals + 1);
      }
    }
  }

  /// The value of a key; "-" if the section or key is missing.
  [[nodiscard]] std::string value(const std::string& section, const std::string& key) const {
    const auto found = values_.find(section);
    if (found == values_.end()) return "-";
    const auto row = found->second.find(key);
    return row == found->second.end() ? "-" : row->second;
  }
  [[nodiscard]] bool has(const std::string& section) const { return values_.contains(section); }

  const std::string text;

 private:
  std::map<std::string, std::map<std::string, std::string>> values_;
};

/// The section of an object, "1018", or of an entry, "1018sub1".
inline std::string section_of(std::uint16_t index) {
  char name[8];
  std::snprintf(name, sizeof name, "%04X", static_cast<unsigned>(index));
  return name;
}
inline std::string section_of(std::uint16_t index, std::uint8_t sub_index) {
  char name[16];
  std::snprintf(name, sizeof name, "%04Xsub%X", static_cast<unsigned>(index), static_cast<unsigned>(sub_index));
  return name;
}

}  // namespace manual_000
