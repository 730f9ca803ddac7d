/// The list of services of a node: which of them are called, in which order, and until when.
#include <gtest/gtest.h>

#include <canopen/node/service_set.hpp>

#include <array>
#include <chrono>
#include <span>
#include <string>
#include <type_traits>

namespace {

using canopen::AbortCode;
using canopen::Frame;
using canopen::NmtState;
using canopen::ServiceDefaults;
using canopen::ServiceError;
using canopen::ServiceSet;
using canopen::TimePoint;
using namespace std::chrono_literals;

struct Host {
  std::string* calls;
  bool has_room = true;

  TimePoint now{};
};

constexpr TimePoint at(std::uint32_t microseconds) { return TimePoint{canopen::Duration{microseconds}}; }

/// A service with the objects of one index and the frames of one CAN-ID, both `Number`.
template <char Name, std::uint16_t Number>
class Witness : public ServiceDefaults<Witness<Name, Number>> {
 public:
  void on_start(Host host) { call(host, "start"); }
  void reset_application(Host host) { call(host, "application"); }
  void reset_communication(Host host) { call(host, "communication"); }
  void on_state(Host host, NmtState, NmtState) { call(host, "state"); }
  bool on_frame(Host host, const Frame&, std::uint32_t cob_id) {
    call(host, "frame");
    return cob_id == Number;
  }
  bool on_remote_frame(Host host, const Frame& frame) {
    call(host, "remote");
    return frame.id == Number;
  }
  void on_sync(Host host, canopen::Sync) { call(host, "sync"); }
  void on_time(Host host) { call(host, "time"); }
  bool serve(Host host) {
    call(host, "serve");
    return host.has_room;
  }
  std::optional<TimePoint> deadline(Host) const { return at(Number); }
  canopen::ServiceErrors errors() const { return Name == 'a' ? set_of(ServiceError::overrun) : 0; }
  static constexpr bool checks(std::uint16_t index, std::uint8_t) { return index == Number; }
  AbortCode check_write(Host host, std::uint16_t, std::uint8_t, std::span<std::uint8_t>) {
    call(host, "check");
    return AbortCode::invalid_value;
  }
  void after_write(Host host, std::uint16_t, std::uint8_t) { call(host, "written"); }
  void after_operational_write(Host host, std::uint16_t, std::uint8_t, bool) { call(host, "operational"); }
  template <canopen::DictionaryObject O>
  bool on_new_value(Host host) {
    call(host, "value");
    return O::index == Number;
  }
  AbortCode before_read(Host host, std::uint16_t index, std::uint8_t) {
    call(host, "read");
    return index == Number ? AbortCode::no_data : canopen::ok;
  }
  static constexpr bool has_command(std::uint16_t index) { return index == Number; }
  AbortCode command(Host host, std::uint16_t, std::uint8_t, std::span<std::uint8_t>) {
    call(host, "command");
    return canopen::ok;
  }

 private:
  static void call(Host host, const char* what) { *host.calls += std::string{Name} + ' ' + what + ", "; }
};

using First = Witness<'a', 0x181>;
using Second = Witness<'b', 0x182>;

struct Missing : ServiceDefaults<Missing> {
  static constexpr bool exists = false;
  static void on_start(Host host) { *host.calls += "missing"; }
  std::uint32_t state = 0;
};

/// LSS-like: called without node-ID.
struct Early : ServiceDefaults<Early> {
  static constexpr bool runs_without_node_id = true;
  static bool on_frame(Host host, const Frame&, std::uint32_t) {
    *host.calls += "early frame, ";
    return true;
  }
  static void on_time(Host host) { *host.calls += "early time, "; }
  static bool serve(Host host) {
    *host.calls += "early serve, ";
    return true;
  }
};

struct Fixed : ServiceDefaults<Fixed> {
  static constexpr bool has_fixed_can_id = true;
  static bool on_frame(Host host, const Frame&, std::uint32_t) {
    *host.calls += "fixed frame, ";
    return true;
  }
};

using Set = ServiceSet<First, Missing, Early, Fixed, Second>;
static_assert(std::is_empty_v<Set>, "empty and missing services take no RAM");
static_assert(Set::has_any_without_node_id);
static_assert(!ServiceSet<First, Second>::has_any_without_node_id);

struct ServiceList : testing::Test {
  std::string take() { return std::exchange(calls, {}); }

  std::string calls;
  Host host{&calls};
  Set services;
  Frame frame{};
  std::array<std::uint8_t, 1> bytes{};
};

TEST_F(ServiceList, IsCalledInOrderWithoutMissingServices) {
  services.on_start(host);
  EXPECT_EQ(take(), "a start, b start, ");
  services.reset_application(host);
  services.reset_communication(host);
  EXPECT_EQ(take(), "a application, b application, a communication, b communication, ");
  services.on_state(host, NmtState::stopped, NmtState::operational);
  EXPECT_EQ(take(), "a state, b state, ");
  services.on_sync(host, canopen::Sync{0, true});
  EXPECT_EQ(take(), "a sync, b sync, ");
  services.after_write(host, 0x1000, 0);
  services.after_operational_write(host, 0x1000, 0, true);
  EXPECT_EQ(take(), "a written, b written, a operational, b operational, ");
}

TEST_F(ServiceList, PassesAFrameUntilAServiceTakesIt) {
  EXPECT_TRUE(services.on_frame(host, frame, 0x181));
  EXPECT_EQ(take(), "a frame, ");
  EXPECT_TRUE(services.on_frame(host, frame, 0x182));
  EXPECT_EQ(take(), "a frame, b frame, ");
  EXPECT_FALSE(services.on_frame(host, frame, 0x183));
  EXPECT_EQ(take(), "a frame, b frame, ");
  frame.id = 0x182;
  EXPECT_TRUE(services.on_remote_frame(host, frame));
  EXPECT_EQ(take(), "a remote, b remote, ");
}

TEST_F(ServiceList, PassesFixedCanIdsOnlyToTheServicesThatHaveThem) {
  EXPECT_TRUE(services.on_fixed_frame(host, frame, 0x605));
  EXPECT_EQ(take(), "fixed frame, ");
  EXPECT_FALSE(services.on_frequent_frame(host, frame, 0x605));
  EXPECT_EQ(take(), "");
}

TEST_F(ServiceList, CallsOnlySomeServicesWithoutNodeId) {
  services.on_frame_without_node_id(host, frame);
  services.on_time_without_node_id(host);
  EXPECT_TRUE(services.serve_without_node_id(host));
  EXPECT_EQ(take(), "early frame, early time, early serve, ");
  EXPECT_EQ(services.deadline(host, false), std::nullopt);
  services.on_time(host);
  EXPECT_EQ(take(), "a time, b time, ");
}

TEST_F(ServiceList, SendsUntilTheBusHasNoRoom) {
  EXPECT_TRUE(services.serve(host));
  EXPECT_EQ(take(), "a serve, early serve, b serve, ");
  host.has_room = false;
  EXPECT_FALSE(services.serve(host));
  EXPECT_EQ(take(), "a serve, ");
}

TEST_F(ServiceList, HasTheEarliestDeadlineAndAllErrors) {
  EXPECT_EQ(services.deadline(host, true), at(0x181));
  EXPECT_EQ(services.errors(), set_of(ServiceError::overrun));
}

TEST_F(ServiceList, AsksTheServiceOfAnObject) {
  EXPECT_EQ(services.check_write(host, 0x182, 0, bytes), AbortCode::invalid_value);
  EXPECT_EQ(take(), "b check, ");
  EXPECT_EQ(services.check_write(host, 0x183, 0, bytes), canopen::ok);
  EXPECT_EQ(take(), "");
  EXPECT_EQ(services.command(host, 0x182, 1, bytes), canopen::ok);
  EXPECT_EQ(take(), "b command, ");
  EXPECT_EQ(services.command(host, 0x183, 1, bytes), AbortCode::not_stored);
  EXPECT_EQ(services.before_read(host, 0x181, 0), AbortCode::no_data);
  EXPECT_EQ(take(), "a read, ");
}

TEST_F(ServiceList, ReportsANewValueToAllServices) {
  using Object = canopen::Object<0x181, 0, std::uint8_t, canopen::Access::rw>;
  EXPECT_TRUE(services.on_new_value<Object>(host));
  EXPECT_EQ(take(), "a value, b value, ");
}

}  // namespace
