#include "arfm_vo/hardware/serial_port.h"

#include <gtest/gtest.h>
#include <unistd.h>

#include <filesystem>
#include <fstream>
#include <system_error>

#include "arfm_vo/hardware/clock_offset.h"
#include "arfm_vo/hardware/pan_tilt.h"
#include "arfm_vo/hardware/simulated_ptu_port.h"
#include "base/refusal.h"

namespace arfm_vo {
namespace {

std::string Link() {
  return (std::filesystem::temp_directory_path() / ("arfm_vo_pty_" + std::to_string(::getpid())))
      .string();
}

/// Reads until as many bytes have come as are wanted; all that came where they do not in 2 s.
template <class End>
std::string ReadAll(End& end, size_t size) {
  std::string bytes;
  for (const double limit = MonotonicNow() + 2; bytes.size() < size && MonotonicNow() < limit;)
    bytes += end.Read(0.1);
  return bytes;
}

TEST(SerialPort, CarriesAllBytesBothWays) {
  PseudoTerminal device(Link());
  SerialPort port(Link(), 9600);
  std::string all;
  for (int c = 0; c < 256; ++c) all += static_cast<char>(c);
  port.Write(all, 1);
  EXPECT_EQ(ReadAll(device, 256), all);
  device.Write(all);
  EXPECT_EQ(ReadAll(port, 256), all);
}

TEST(PseudoTerminal, RemovesNothingButItsOwnLinkAndThoseLeftBehind) {
  std::ofstream(Link()) << "a file of somebody else";
  EXPECT_THROW(PseudoTerminal{Link()}, std::system_error);
  EXPECT_TRUE(std::filesystem::is_regular_file(Link()));
  std::filesystem::remove(Link());
  std::filesystem::create_symlink("/dev/ttyS0", Link());
  EXPECT_THROW(PseudoTerminal{Link()}, std::system_error);
  EXPECT_EQ(std::filesystem::read_symlink(Link()), "/dev/ttyS0");
  std::filesystem::remove(Link());
  {
    const PseudoTerminal living(Link());
    EXPECT_THROW(PseudoTerminal{Link()}, std::system_error) << "took the link of one that lives";
  }
  std::filesystem::create_symlink("/dev/pts/100000", Link());
  auto device = std::make_unique<PseudoTerminal>(Link());
  std::filesystem::remove(Link());
  std::filesystem::create_symlink("/dev/ttyS0", Link());
  device.reset();
  EXPECT_TRUE(std::filesystem::is_symlink(Link())) << "it was another link by then";
  std::filesystem::remove(Link());
}

TEST(SerialPort, ReadReturnsByItsTimeout) {
  PseudoTerminal device(Link());
  SerialPort port(Link(), 9600);
  const double start = MonotonicNow();
  EXPECT_EQ(port.Read(0.02), "");
  EXPECT_GE(MonotonicNow() - start, 0.019);
}

TEST(SerialPort, AnUnpluggedLineThrows) {
  auto device = std::make_unique<PseudoTerminal>(Link());
  SerialPort port(Link(), 9600);
  device.reset();
  EXPECT_THROW(ReadAll(port, 1), std::system_error);
  EXPECT_THROW(port.Write("pp ", 0.1), std::system_error);
}

TEST(SerialPort, SaysWhatDoesNotOpen) {
  EXPECT_THAT(RefusalOf<std::system_error>([] { SerialPort("/nowhere/ttyUSB0", 9600); }),
              testing::HasSubstr("'/nowhere/ttyUSB0' (is it plugged in?"));
  EXPECT_THROW(SerialPort("/dev/null", 9600), std::system_error);  // no serial line
  PseudoTerminal device(Link());
  EXPECT_THROW(SerialPort(Link(), 12345), std::invalid_argument);
}

}  // namespace
}  // namespace arfm_vo
