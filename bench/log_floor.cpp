/// The lower limit for `edsc decode`: reads a log of `candump -L` from standard input and writes each line with its
/// bytes separated, without decoding CANopen.
#include <cstdio>
#include <cstring>
#include <string>
#include <string_view>

namespace {

constexpr std::size_t block = std::size_t{64} * 1024;

void write_line(std::string_view line, std::string& out) {
  const std::size_t hash = line.find('#');
  const std::size_t id = line.rfind(' ', hash) + 1;
  out += line.substr(0, hash);
  out += ' ';
  for (std::size_t at = hash + 1; at + 1 < line.size(); at += 2) {
    out += line.substr(at, 2);
    out += ' ';
  }
  constexpr std::size_t width = 30;
  if (line.size() - id < width) out.append(width - (line.size() - id), ' ');
  out += '\n';
}

}  // namespace

int main() {
  std::string in, out;
  std::string buffer(block, '\0');
  while (const std::size_t count = std::fread(buffer.data(), 1, buffer.size(), stdin)) {
    in.append(buffer, 0, count);
    std::size_t begin = 0;
    for (std::size_t end = in.find('\n'); end != std::string::npos; end = in.find('\n', begin)) {
      write_line(std::string_view{in}.substr(begin, end - begin), out);
      begin = end + 1;
    }
    in.erase(0, begin);
    std::fwrite(out.data(), 1, out.size(), stdout);
    out.clear();
  }
  return 0;
}
