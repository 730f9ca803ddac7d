#include "render/render.hpp"

#include <algorithm>
#include <kainjow/mustache.hpp>
#include <stdexcept>

namespace edsc {
namespace {

using kainjow::mustache::data;
using nlohmann::ordered_json;

/// A JSON value as mustache sees it: numbers are text.
data to_mustache(const ordered_json& value) {
  switch (value.type()) {
    case ordered_json::value_t::object: {
      data object{data::type::object};
      for (const auto& [key, member] : value.items()) object.set(key, to_mustache(member));
      return object;
    }
    case ordered_json::value_t::array: {
      data list{data::type::list};
      for (const ordered_json& item : value) list.push_back(to_mustache(item));
      return list;
    }
    case ordered_json::value_t::boolean: return data{value.get<bool>()};
    case ordered_json::value_t::string: return data{value.get_ref<const std::string&>()};
    case ordered_json::value_t::number_integer:
    case ordered_json::value_t::number_unsigned:
    case ordered_json::value_t::number_float: return data{value.dump()};
    case ordered_json::value_t::null:
    case ordered_json::value_t::binary:
    case ordered_json::value_t::discarded: break;
  }
  return data{false};
}

/// Whether a line holds one section tag and nothing else.
bool is_section_line(std::string_view line) {
  const std::size_t begin = line.find_first_not_of(' ');
  if (begin == std::string_view::npos || !line.substr(begin).starts_with("{{")) return false;
  if (!line.ends_with("}}") || line.find("}}") != line.size() - 2) return false;
  return line.size() > begin + 2 && std::string_view{"#/^!"}.find(line[begin + 2]) != std::string_view::npos;
}

/// Lines that hold only a section tag leave nothing behind, not even an empty line, also where the section is empty.
std::string without_section_lines(std::string_view text) {
  std::string out;
  while (!text.empty()) {
    const std::size_t end = std::min(text.find('\n'), text.size());
    const std::string_view line = text.substr(0, end);
    if (is_section_line(line)) {
      out += line.substr(line.find('{'));
    } else {
      out += line;
      if (end < text.size()) out += '\n';
    }
    text.remove_prefix(std::min(end + 1, text.size()));
  }
  return out;
}

}  // namespace

std::string render(std::string_view text, const ordered_json& view) {
  kainjow::mustache::mustache filler{without_section_lines(text)};
  if (!filler.is_valid()) throw std::runtime_error{filler.error_message()};
  filler.set_custom_escape([](const std::string& plain) { return plain; });
  std::string out = filler.render(to_mustache(view));
  if (!filler.is_valid()) throw std::runtime_error{filler.error_message()};
  return out;
}

}  // namespace edsc
