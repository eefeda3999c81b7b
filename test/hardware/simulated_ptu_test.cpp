#include "arfm_vo/hardware/simulated_ptu.h"

#include <gtest/gtest.h>

namespace arfm_vo {
namespace {

/// All that the unit sends within `wait_s` of the command.
std::string Converse(SimulatedPtu& ptu, double& now_s, const std::string& command,
                     double wait_s = 0.2) {
  ptu.Receive(command, now_s);
  now_s += wait_s;
  return ptu.Transmit(now_s);
}

TEST(SimulatedPtu, AnswersTheManualsExamples) {
  SimulatedPtu ptu;
  double now = 0;
  EXPECT_EQ(Converse(ptu, now, "PR "), "PR * The value is 185.1428\r\n");
  EXPECT_EQ(Converse(ptu, now, "ED "), "ED *\r\n");
  EXPECT_EQ(Converse(ptu, now, "PP3200 "), "! Maximum allowable Pan position is 3090\r\n");
  EXPECT_EQ(Converse(ptu, now, "PS3300 "), "! Pan speed cannot exceed 2902 positions/sec\r\n");
  EXPECT_EQ(Converse(ptu, now, "FT "), "*\r\n");
  EXPECT_EQ(Converse(ptu, now, "PR "), "* 185.1428\r\n");
  EXPECT_EQ(Converse(ptu, now, "PN "), "* -3090\r\n");
  EXPECT_EQ(Converse(ptu, now, "TX "), "* 604\r\n");
  EXPECT_EQ(Converse(ptu, now, "XX "), "! Illegal command entered\r\n");
}

TEST(SimulatedPtu, MovesUnderTrapezoidalAcceleration) {
  SimulatedPtuAxisOptions options;  // 1000 counts/s, 2000 counts/s^2, base 57 counts/s
  PtuAxisMotion motion(options);
  motion.target = 2000;
  // 943 counts/s of change take 0.4715 s and 249 counts each way, 1502 counts are left at speed.
  const double expected_s = 2 * 0.4715 + 1.502;
  double fastest = 0, before = 0, arrival = 0;
  for (double t = 0.01; t < 5; t += 0.01) {
    motion.Advance(t);
    fastest = std::max(fastest, (motion.Position() - before) / 0.01);
    EXPECT_GE(motion.Position(), before);
    before = motion.Position();
    if (motion.IsAtRest() && arrival == 0) arrival = t;
  }
  EXPECT_NEAR(fastest, 1000, 15);
  EXPECT_NEAR(arrival, expected_s, 0.05);
  EXPECT_EQ(motion.Position(), 2000);
}

TEST(SimulatedPtu, TurnsBackOnTheFly) {
  PtuAxisMotion motion((SimulatedPtuAxisOptions()));
  motion.target = 2000;
  motion.Advance(1);
  const double turning = motion.Position();
  motion.target = -100;
  double highest = 0;
  for (double t = 1; t < 6; t += 0.01) {
    motion.Advance(t);
    highest = std::max(highest, motion.Position());
  }
  EXPECT_NEAR(highest, turning + 1000.0 * 1000 / (2 * 2000), 30);  // braking distance
  EXPECT_EQ(motion.Position(), -100);
}

TEST(SimulatedPtu, AnInstantOneAnswersWhileTheClockStandsAndMovesAsItRuns) {
  SimulatedPtu ptu(SimulatedPtuOptions::Instant());
  ptu.Receive("ft ed pp100 pp ", 5);
  EXPECT_EQ(ptu.Transmit(5), "ft *\r\ned *\r\n*\r\n* 0\r\n");
  EXPECT_EQ(ptu.Position(PtuAxis::kPan, 5), 0);
  EXPECT_EQ(ptu.Position(PtuAxis::kPan, 6), 100);
}

TEST(SimulatedPtu, BytesTakeTheTimeOfTheLine) {
  SimulatedPtu ptu;
  double now = 0;
  Converse(ptu, now, "ED FT ");
  ptu.Receive("pp ", now);  // 3 bytes in, 2 ms, 5 bytes out at 1.04 ms each
  EXPECT_EQ(ptu.Transmit(now + 0.0050), "");
  EXPECT_EQ(ptu.Transmit(now + 0.0064), "*");
  EXPECT_EQ(ptu.Transmit(now + 0.0106), " 0\r\n");
}

}  // namespace
}  // namespace arfm_vo
