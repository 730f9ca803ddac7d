/// Records which objects the applications of the runnable nodes use: the hook of canopen/od/access_probe.hpp.
///
/// A program with edsc_record_accesses() writes the objects to EDSC_ACCESS_FILE when all of its tests have run, in rows
/// of device, index and sub-index. Accesses by a test itself do not count: a bench has an InApplication while its
/// application runs.
#pragma once

namespace bench {

/// While one exists, accesses are those of an application.
class InApplication {
 public:
  InApplication() { ++depth; }
  ~InApplication() { --depth; }
  InApplication(const InApplication&) = delete;
  InApplication& operator=(const InApplication&) = delete;

  static inline int depth = 0;
};

}  // namespace bench

#ifdef CANOPEN_ACCESS_PROBE

#include <gtest/gtest.h>

#include <cstdint>
#include <cstdio>
#include <fstream>
#include <map>
#include <set>
#include <string>
#include <string_view>
#include <utility>

namespace bench {

using Accesses = std::map<std::string, std::set<std::pair<unsigned, unsigned>>>;
inline Accesses accesses;  ///< index and sub-index, by the name of the device

/// Writes the file. A part of the tests does not show what all of them use.
class AccessFile : public testing::Environment {
 public:
  void TearDown() override {
    if (GTEST_FLAG_GET(filter) != "*") return;
    std::ofstream file{EDSC_ACCESS_FILE};
    for (const auto& [device, objects] : accesses) {
      for (const auto& [index, sub_index] : objects) {
        char object[16];
        std::snprintf(object, sizeof object, "%04X\t%02X", index, sub_index);
        file << device << '\t' << object << '\n';
      }
    }
  }
};
inline testing::Environment* const access_file = testing::AddGlobalTestEnvironment(new AccessFile);

/// The namespace of a device, such as `cpd`.
template <class Device>
[[nodiscard]] std::string device_name() {
  constexpr std::string_view key = "Device = ";
  std::string_view text = __PRETTY_FUNCTION__;
  text.remove_prefix(text.find(key) + key.size());
  return std::string{text.substr(0, text.find("::"))};
}

}  // namespace bench

namespace canopen {

template <class Device>
struct AccessProbe {
  static void uses(std::uint16_t index, std::uint8_t sub_index) {
    if (bench::InApplication::depth == 0) return;
    static std::set<std::pair<unsigned, unsigned>>& objects = bench::accesses[bench::device_name<Device>()];
    objects.emplace(index, sub_index);
  }
};

}  // namespace canopen

#endif
