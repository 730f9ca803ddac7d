/// A network file with two small EDS files -> nodes, signals, findings, response times and, with every 32nd length,
/// the generated files. Their names are different ones on a file system that does not tell upper from lower case.
#include "network/network.hpp"

#include <algorithm>
#include <set>

#include "document/network_drawings.hpp"
#include "fuzz.hpp"
#include "network/checks/check_network.hpp"
#include "network/cob_id_use.hpp"
#include "network/generate/generate_network.hpp"
#include "network/timing/timing.hpp"
#include "text/ascii.hpp"

namespace edsc::fuzz {
namespace {

/// Beside the EDS files that the seeds name.
constexpr const char* path = EDSC_SOURCE_DIR "/tests/fuzz/network_seeds/fuzz.json";

void check_names(const std::vector<OutputFile>& files) {
  std::set<std::string> names;
  for (const OutputFile& file : files) {
    std::string name = file.path;
    require(printable(name) == name, "the name of a file does not have hidden characters");
    require(!name.starts_with('/') && name.find("..") == std::string::npos, "a file is in the folder");
    std::ranges::transform(name, name.begin(), to_lower);
    require(names.insert(name).second, "each file has a name of its own");
  }
}

}  // namespace
}  // namespace edsc::fuzz

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  using namespace edsc;
  Diagnostics diagnostics;
  const auto loaded = load_network(std::make_unique<SourceFile>(fuzz::path, fuzz::text_of(data, size)), diagnostics);
  check_network(loaded->network, diagnostics);
  if (diagnostics.errors() == 0) {
    static_cast<void>(network_timing(loaded->network, cob_id_uses(loaded->network)));
    static_cast<void>(network_drawings(loaded->network));
    if (size % 32 == 0) fuzz::check_names(generate_network(loaded->network, diagnostics).files);
  }
  fuzz::print(diagnostics);
  return 0;
}
