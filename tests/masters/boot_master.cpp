/// The master of foreign_slaves_test.py: `boot_master BUS NODE[:heartbeat=MS][:product=CODE]...` until SIGTERM. It
/// boots the nodes and configures each one with a number in 2000h and a longer value in 2001h, which it reads back.
#include <atomic>
#include <canopen/host/host_bus.hpp>
#include <canopen/host/master.hpp>
#include <csignal>
#include <cstdio>
#include <cstdlib>
#include <exception>
#include <sstream>
#include <string>
#include <vector>

namespace {

using canopen::NodeId;

std::atomic<bool> stop{false};

void log(const std::string& line) {
  std::printf("%s\n", line.c_str());
  std::fflush(stdout);
}

canopen::NmtSlave slave_of(const std::string& argument) {
  using namespace canopen::slave_assignment;
  std::istringstream words{argument};
  std::string word;
  std::getline(words, word, ':');
  canopen::NmtSlave slave{NodeId{static_cast<std::uint8_t>(std::stoul(word))}, listed | boot | mandatory};
  while (std::getline(words, word, ':')) {
    const std::size_t at = word.find('=');
    const auto value = static_cast<std::uint32_t>(std::stoul(word.substr(at + 1), nullptr, 0));
    if (word.starts_with("heartbeat=")) slave.heartbeat_time = static_cast<std::uint16_t>(value);
    if (word.starts_with("product=")) slave.product_code = value;
  }
  return slave;
}

const std::vector<std::uint8_t> number{0x34, 0x12};

std::vector<std::uint8_t> longer(NodeId node_id) {
  std::vector<std::uint8_t> value(20);
  for (std::size_t i = 0; i < value.size(); ++i) value[i] = static_cast<std::uint8_t>('a' + (node_id.value() + i) % 26);
  return value;
}

canopen::Result<void> configure(canopen::Master<canopen::HostBus>& master, NodeId node_id) {
  if (const auto done = master.download(node_id, 0x2000, 0, number); !done) return done;
  if (const auto done = master.download(node_id, 0x2001, 0, longer(node_id)); !done) return done;
  const auto number_back = master.upload(node_id, 0x2000, 0);
  if (!number_back) return number_back.abort_code();
  const auto longer_back = master.upload(node_id, 0x2001, 0);
  if (!longer_back) return longer_back.abort_code();
  const bool same = *number_back == number && *longer_back == longer(node_id);
  return same ? canopen::ok : canopen::AbortCode::invalid_value;
}

}  // namespace

int main(int argc, char** argv) {
  if (argc < 3) return 2;
  std::signal(SIGTERM, [](int) { stop = true; });
  try {
    canopen::HostBus bus{argv[1]};
    std::vector<canopen::NmtSlave> slaves;
    for (int i = 2; i < argc; ++i) slaves.push_back(slave_of(argv[i]));
    canopen::Master master{
        bus, slaves, {}, {.timeout = std::chrono::seconds{2}, .block_transfer = true, .block_threshold = 8}};
    master.on_configure = [&](NodeId node_id) { return configure(master, node_id); };
    master.on_booted = [](NodeId node_id, const canopen::BootResult& result) { log(boot_text(node_id, result)); };
    master.on_event = [](canopen::NmtMasterEvent event, NodeId node_id, canopen::NmtState state) {
      log(event_text(event, node_id, state));
    };
    master.on_network_started = [] { log("network started"); };
    master.start();
    while (!stop) master.poll(std::chrono::milliseconds{50});
  } catch (const std::exception& problem) {
    std::fprintf(stderr, "%s: %s\n", argv[0], problem.what());
    return 1;
  }
  return 0;
}
