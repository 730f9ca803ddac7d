#include <gtest/gtest.h>

#include <filesystem>
#include <string>
#include <vector>

#include "document/network_drawings.hpp"
#include "network/checks/check_network.hpp"
#include "network/generate/generate_network.hpp"
#include "network/network.hpp"

namespace edsc {
namespace {

namespace fs = std::filesystem;

const fs::path source_dir = EDSC_SOURCE_DIR;

std::vector<fs::path> network_files_in(const fs::path& folder) {
  std::vector<fs::path> files;
  for (const fs::directory_entry& entry : fs::directory_iterator{folder}) {
    if (entry.path().extension() == ".json") files.push_back(entry.path());
  }
  return files;
}

/// As `edsc network generate` does.
void generate(const fs::path& path) {
  SCOPED_TRACE(path.string());
  Diagnostics diagnostics;
  const auto loaded = load_network(path.string(), diagnostics);
  check_network(loaded->network, diagnostics);
  ASSERT_EQ(diagnostics.errors(), 0);
  EXPECT_FALSE(loaded->unreadable);
  const GeneratedNetwork generated = generate_network(loaded->network, diagnostics);
  EXPECT_EQ(diagnostics.errors(), 0);
  EXPECT_GT(generated.files.size(), loaded->network.nodes.size());
  EXPECT_FALSE(network_drawings(loaded->network).empty());
}

TEST(GenerateNetworks, GeneratesTheExamples) {
  const std::vector<fs::path> files = network_files_in(source_dir / "examples/networks");
  EXPECT_GE(files.size(), 3);
  for (const fs::path& path : files) generate(path);
}

TEST(GenerateNetworks, GeneratesTheNetworksOfTheTests) {
  for (const fs::path& path : network_files_in(source_dir / "tests/networks")) generate(path);
}

/// As docs/networks.md does, beside the EDS files of its nodes.
TEST(GenerateNetworks, GeneratesTheLine) {
  const fs::path folder = fs::path{testing::TempDir()} / "edsc-generate-line";
  fs::remove_all(folder);
  fs::create_directories(folder);
  for (const fs::directory_entry& entry : fs::directory_iterator{source_dir / "eds"}) {
    if (entry.is_regular_file()) fs::copy_file(entry.path(), folder / entry.path().filename());
  }
  fs::copy_file(source_dir / "examples/line/line.json", folder / "line.json");
  generate(folder / "line.json");
  fs::remove_all(folder);
}

}  // namespace
}  // namespace edsc
