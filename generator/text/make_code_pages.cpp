/// Prints the tables of `text/code_page_tables.hpp` as C++, made with iconv of the machine that builds edsc:
///
///     make_code_pages > code_page_tables.cpp
///
/// A part of the build: it includes nothing of edsc.
#include <iconv.h>

#include <array>
#include <cstdint>
#include <cstdio>
#include <cstdlib>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

namespace {

constexpr unsigned undefined = 0xFFFD;

class Converter {
 public:
  explicit Converter(const char* encoding) : handle_{iconv_open("UCS-4LE", encoding)} {
    if (handle_ == reinterpret_cast<iconv_t>(-1)) {  // NOLINT(performance-no-int-to-ptr): what POSIX specifies
      std::fprintf(stderr, "make_code_pages: iconv of this machine does not have %s\n", encoding);
      std::exit(1);
    }
  }
  ~Converter() { iconv_close(handle_); }
  Converter(const Converter&) = delete;
  Converter& operator=(const Converter&) = delete;

  /// The code point, if the bytes are exactly one character.
  std::optional<std::uint32_t> operator()(std::string bytes) {
    iconv(handle_, nullptr, nullptr, nullptr, nullptr);
    std::array<unsigned char, 16> out{};
    char* from = bytes.data();
    std::size_t from_left = bytes.size();
    char* to = reinterpret_cast<char*>(out.data());
    std::size_t to_left = out.size();
    if (iconv(handle_, &from, &from_left, &to, &to_left) != 0 || from_left != 0) return std::nullopt;
    iconv(handle_, nullptr, nullptr, &to, &to_left);  // a character that waits for a combining one
    if (out.size() - to_left != 4) return std::nullopt;
    return std::uint32_t{out[0]} | std::uint32_t{out[1]} << 8U | std::uint32_t{out[2]} << 16U |
           std::uint32_t{out[3]} << 24U;
  }

 private:
  iconv_t handle_;
};

char byte(unsigned value) { return static_cast<char>(static_cast<unsigned char>(value)); }

void print_cells(const std::vector<unsigned>& cells) {
  for (std::size_t i = 0; i < cells.size(); ++i) std::printf("%s%u,", i % 24 == 0 ? "\n" : "", cells[i]);
}

struct WideCell {
  unsigned code;
  unsigned code_point;
};

constexpr unsigned first_trail = 0x40;
constexpr unsigned trails = 0xFF - first_trail;
constexpr unsigned leads = 0x7F;

/// Bytes 80h to FFh, and of an encoding with two bytes what follows a lead byte from 80h on.
void print_page(const char* name, const char* encoding, bool has_two_bytes) {
  Converter convert{encoding};
  std::vector<unsigned> singles;
  for (unsigned i = 0x80; i <= 0xFF; ++i) singles.push_back(convert({byte(i)}).value_or(undefined));
  std::vector<unsigned> pairs;
  std::vector<WideCell> wide;
  for (unsigned lead = 0x80; has_two_bytes && lead < 0x80 + leads; ++lead) {
    for (unsigned trail = first_trail; trail < first_trail + trails; ++trail) {
      const auto found = convert({byte(lead), byte(trail)});
      if (found && *found > 0xFFFF) wide.push_back({lead << 8U | trail, *found});
      pairs.push_back(!found || *found > 0xFFFF ? undefined : *found);
    }
  }
  std::printf("static constexpr std::uint16_t %s_singles[] = {", name);
  print_cells(singles);
  std::printf("};\n");
  if (!has_two_bytes) {
    std::printf("const CodePageTable %s_table{%s_singles, {}, {}};\n", name, name);
    return;
  }
  std::printf("static constexpr std::uint16_t %s_pairs[] = {", name);
  print_cells(pairs);
  std::printf("};\nstatic constexpr std::array<WideCharacter, %zu> %s_wide = {{", wide.size(), name);
  for (const WideCell& cell : wide) std::printf("{%u,%u},", cell.code, cell.code_point);
  std::printf("}};\nconst CodePageTable %s_table{%s_singles, %s_pairs, %s_wide};\n", name, name, name, name);
}

/// The codes of four bytes in GB18030, by their number from 81308130h on.
void print_four_bytes() {
  struct Run {
    unsigned first;
    unsigned code_point;
    unsigned length;
  };
  Converter convert{"GB18030"};
  std::vector<Run> runs;
  unsigned number = 0;
  for (unsigned a = 0x81; a <= 0xFE; ++a) {
    for (unsigned b = 0x30; b <= 0x39; ++b) {
      for (unsigned c = 0x81; c <= 0xFE; ++c) {
        for (unsigned d = 0x30; d <= 0x39; ++d, ++number) {
          const auto found = convert({byte(a), byte(b), byte(c), byte(d)});
          if (!found) continue;
          const bool continues = !runs.empty() && runs.back().first + runs.back().length == number &&
                                 runs.back().code_point + runs.back().length == *found;
          if (continues) {
            ++runs.back().length;
          } else {
            runs.push_back({number, *found, 1});
          }
        }
      }
    }
  }
  std::printf("static constexpr FourByteRun runs[] = {\n");
  for (const Run& run : runs) std::printf("{%u,%u,%u},\n", run.first, run.code_point, run.length);
  std::printf("};\nconst std::span<const FourByteRun> gb18030_four_bytes{runs};\n");
}

}  // namespace

int main() {
  std::printf("// Made by make_code_pages.cpp.\n#include \"text/code_page_tables.hpp\"\n\n#include <array>\n");
  std::printf("namespace edsc {\n");
  print_page("cp1252", "CP1252", false);
  print_page("cp437", "CP437", false);
  print_page("cp850", "CP850", false);
  print_page("cp1250", "CP1250", false);
  print_page("cp1251", "CP1251", false);
  print_page("shift_jis", "CP932", true);  // as Windows has it: 5Ch is a backslash
  print_page("gb18030", "GB18030", true);
  print_page("big5", "BIG5", true);
  print_page("cp949", "CP949", true);
  print_four_bytes();
  std::printf("}  // namespace edsc\n");
  return std::fflush(stdout) == 0 ? 0 : 1;
}
