#include "backend/template_parts.hpp"

#include <string>
#include <string_view>

#include "backend/render.hpp"

namespace edsc {

std::string with_parts(std::string_view name) {
  constexpr std::string_view begin = "{{>";
  constexpr std::string_view end = "}}\n";
  std::string text{report_template(name)};
  for (std::size_t at = 0; (at = text.find(begin, at)) != std::string::npos;) {
    const std::size_t close = text.find(end, at);
    std::string part = text.substr(at + begin.size(), close - at - begin.size());
    if (part.find('.') == std::string::npos) part += name.substr(name.find('.'));
    text.replace(at, close + end.size() - at, with_parts(part));
  }
  return text;
}

}  // namespace edsc
