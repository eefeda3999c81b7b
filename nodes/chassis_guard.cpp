#include "arfm_vo/hardware/guard/chassis_guard.h"

#include <arpa/inet.h>
#include <netinet/in.h>
#include <poll.h>
#include <sys/socket.h>

#include <csignal>
#include <iostream>

#include "arfm_vo/base/check.h"
#include "arfm_vo/configuration/program.h"
#include "arfm_vo/hardware/bus_lock.h"
#include "arfm_vo/hardware/chassis_link.h"
#include "arfm_vo/hardware/clock_offset.h"

namespace {

using namespace arfm_vo;

constexpr int kMaxWait_ms = 10, kMaxMessages = 500;
volatile std::sig_atomic_t is_ended = 0;

FileDescriptor OpenStopSocket(const std::string& host, uint16_t port) {
  sockaddr_in address{};
  address.sin_family = AF_INET;
  address.sin_port = htons(port);
  Require(::inet_pton(AF_INET, host.c_str(), &address.sin_addr) == 1,
          "stop-address '" + host + "' is no IPv4 address");
  FileDescriptor socket(::socket(AF_INET, SOCK_DGRAM | SOCK_NONBLOCK | SOCK_CLOEXEC, 0));
  if (::bind(socket.Get(), reinterpret_cast<const sockaddr*>(&address), sizeof(address)) != 0)
    ThrowSystemError("stop-port " + std::to_string(port) + " at " + host);
  return socket;
}

/// Answers packets, of whatever content; says whether there was one.
bool TakePackets(const FileDescriptor& socket) {
  constexpr char kAnswer[] = "stopped by chassis_guard";
  for (int i = 0; i < kMaxMessages; ++i) {
    sockaddr_storage from{};
    socklen_t size = sizeof(from);
    auto* const sender = reinterpret_cast<sockaddr*>(&from);
    if (::recvfrom(socket.Get(), nullptr, 0, 0, sender, &size) < 0) return i > 0;
    ::sendto(socket.Get(), kAnswer, sizeof(kAnswer) - 1, 0, sender, size);
  }
  return true;
}

void Run(const std::string& bus, const std::string& stop_address, uint16_t stop_port) {
  for (const int signal : {SIGTERM, SIGINT, SIGHUP}) std::signal(signal, [](int) { is_ended = 1; });
  const BusLock lock(bus);  // chassis_node connects to it, a second one when the first is gone
  const FileDescriptor stop_socket = OpenStopSocket(stop_address, stop_port);
  ChassisGuard guard(OpenCanBus(bus, ChassisLink::Filters()), [](GuardStop stop) {
    std::cerr << "chassis_guard: " << ToString(stop) << std::endl;
  });
  FileDescriptor node;
  while (!is_ended) {
    pollfd ends[] = {{stop_socket.Get(), POLLIN, 0},
                     {node.IsOpen() ? node.Get() : lock.Socket(), POLLIN, 0}};
    ::poll(ends, std::size(ends), kMaxWait_ms);
    if (TakePackets(stop_socket)) guard.Stop(GuardStop::kPacket);
    for (int i = 0; i < kMaxMessages; ++i) {
      const auto message = ReceiveMessage(node);
      if (!message) break;
      guard.Take(MonotonicNow(), *message);
    }
    if (!node.IsOpen()) {
      guard.Disconnect();
      node =
          FileDescriptor(::accept4(lock.Socket(), nullptr, nullptr, SOCK_NONBLOCK | SOCK_CLOEXEC));
    }
    for (const GuardMessage& message : guard.Tick(MonotonicNow())) SendMessage(node, message);
  }
}

}  // namespace

int main(int argc, char** argv) {
  std::string bus, stop_address = "127.0.0.1";
  uint16_t stop_port = 4700;
  Program program;
  program.name = "chassis_guard";
  program.description =
      "Stands between chassis_node (its can: guard:BUS) and the chassis' bus, which it alone "
      "writes\n"
      "to; needs no ROS. Sends zero where chassis_node is silent for 0.1 s or ends, where another\n"
      "driver commands the chassis, and after a UDP packet until the operator starts anew; brakes\n"
      "where the rover moves otherwise than commanded. BUS: can0, or udp:LOCAL:PEER.";
  program.inputs = {{"BUS", &bus}};
  program.Add("stop-port", stop_port, "PORT", "UDP, 4700 if not given: any packet stops the rover");
  program.Add("stop-address", stop_address, "ADDRESS", "where it comes in, 127.0.0.1 if not given");
  program.run = [&] { Run(bus, stop_address, stop_port); };
  std::vector<const char*> words;  // without those that roslaunch adds
  for (int i = 0; i < argc; ++i)
    if (std::string(argv[i]).rfind("__", 0) != 0) words.push_back(argv[i]);
  return RunProgram(static_cast<int>(words.size()), words.data(), program);
}
