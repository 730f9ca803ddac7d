#include "simulate/simulation_program.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <atomic>
#include <filesystem>
#include <mutex>
#include <optional>
#include <sstream>
#include <system_error>
#include <thread>
#include <utility>

#include "simulate/compiled_object.hpp"
#include "system/environment.hpp"
#include "system/path.hpp"
#include "system/run_program.hpp"

namespace edsc {
namespace {

namespace fs = std::filesystem;

constexpr const char* runtime_header = "canopen_sim/network_simulation/network_simulation.hpp";

/// The words of `$CXX`, such as `ccache g++`.
std::vector<std::string> compiler() {
  std::istringstream text{environment_variable("CXX").value_or("")};
  std::vector<std::string> words;
  for (std::string word; text >> word;) words.push_back(word);
  if (words.empty()) words.emplace_back("c++");
  return words;
}

/// Runs the compiler. Returns an error message; empty on success.
std::string compile(const std::vector<std::string>& arguments) {
  std::vector<std::string> words = compiler();
  const std::string name = words.front();
  words.insert(words.end(), arguments.begin(), arguments.end());
  const auto outcome = run_program(std::move(words));
  if (!outcome || outcome->exit_code == 127) {
    return fmt::format("cannot start the C++ compiler {}; install one, or set CXX", name);
  }
  if (outcome->exit_code == 0) return {};
  return fmt::format("{} has failed:\n{}", name, outcome->errors);
}

std::string object_file(const std::string& source) { return from_native(to_native(source).replace_extension(".o")); }

/// Compiles one source after the other, with another thread for each further processor.
class Compilation {
 public:
  Compilation(const SimulationBuild& build, const std::function<void(std::size_t)>& progress)
      : build_{build}, progress_{progress} {}

  /// Returns the first error message; empty on success.
  std::string run() {
    const std::size_t count = std::clamp<std::size_t>(std::thread::hardware_concurrency(), 1,
                                                      std::max<std::size_t>(build_.sources.size(), 1));
    std::vector<std::jthread> others;
    for (std::size_t i = 1; i < count; ++i) others.emplace_back([this] { work(); });
    work();
    others.clear();
    return error_;
  }

 private:
  void work() {
    for (std::size_t i = 0; (i = next_++) < build_.sources.size();) {
      std::string error = compile_if_needed(join_path(build_.folder, build_.sources[i]));
      const std::scoped_lock lock{mutex_};
      if (error.empty()) {
        progress_(++done_);
      } else {
        next_ = build_.sources.size();
        if (error_.empty()) error_ = std::move(error);
      }
    }
  }

  std::string compile_if_needed(const std::string& source) const {
    const CompiledObject object{object_file(source)};
    const std::vector<std::string> arguments{
        "-std=c++20",
        "-O1",  // compiles a fifth faster, and the simulation takes less than half a second
        "-I" + build_.folder,
        "-I" + build_.include_folder,
        "-MD",
        "-MF",
        object.dependency_file(),
        "-c",
        source,
        "-o",
        object.path()};
    std::vector<std::string> command = compiler();
    command.insert(command.end(), arguments.begin(), arguments.end());
    if (object.is_up_to_date(command)) return {};
    object.begin();
    std::string error = compile(arguments);
    if (error.empty()) object.complete(command);
    return error;
  }

  const SimulationBuild& build_;
  const std::function<void(std::size_t)>& progress_;
  std::atomic<std::size_t> next_ = 0;
  std::mutex mutex_;
  std::size_t done_ = 0;
  std::string error_;
};

}  // namespace

std::string runtime_include_folder() {
  std::error_code error;
  for (fs::path folder = program_file().parent_path(); folder.has_relative_path(); folder = folder.parent_path()) {
    for (const char* const include : {"include/edsc", "runtime/include"}) {
      if (fs::exists(folder / include / runtime_header, error)) return from_native(folder / include);
    }
  }
  return {};
}

std::string build_simulation(const SimulationBuild& build, const std::function<void(std::size_t)>& progress) {
  std::string error = Compilation{build, progress}.run();
  const std::string program = from_native(fs::absolute(to_native(join_path(build.folder, "simulate"))));
  if (error.empty()) {
    std::vector<std::string> arguments{"-o", program};
    for (const std::string& source : build.sources) {
      arguments.push_back(object_file(join_path(build.folder, source)));
    }
    error = compile(arguments);
  }
  if (!error.empty()) throw SimulationError{error};
  return program;
}

SimulationResult run_simulation(const SimulationRun& run, const std::function<void(std::uint64_t)>& progress) {
  std::vector<std::string> words{run.program, std::to_string(run.duration_us), std::to_string(run.seed)};
  for (const SimulationFault& fault : run.faults) {
    const auto* const row = std::ranges::find(fault_rows, fault.kind, &FaultRow::kind);
    words.insert(words.end(), {std::string{row->name}, std::to_string(fault.node), std::to_string(fault.time_us)});
  }
  SimulationReader reader{run.nodes, run.messages};
  const auto outcome = run_program(std::move(words), [&](std::string_view piece) { reader.read(piece, progress); });
  if (!outcome) throw SimulationError{fmt::format("cannot start {}", run.program)};
  if (!reader.malformed().empty()) {
    throw SimulationError{fmt::format("unexpected line \"{}\" of the simulation", reader.malformed())};
  }
  if (outcome->exit_code != 0 || !reader.is_complete()) {
    throw SimulationError{fmt::format("the simulation has failed with exit code {}", outcome->exit_code)};
  }
  return std::move(reader.result());
}

}  // namespace edsc
