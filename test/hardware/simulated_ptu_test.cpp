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

TEST(SimulatedPtu, AnInstantOneAnswersWhileTheClockStandsAndMovesAsItRuns) {
  SimulatedPtu ptu(SimulatedPtuOptions::Instant());
  ptu.Receive("ft ed pp100 pp ", 5);
  EXPECT_EQ(ptu.Transmit(5), "ft *\r\ned *\r\n*\r\n* 0\r\n");
  EXPECT_EQ(ptu.Position(PtuAxis::kPan, 5), 0);
  EXPECT_EQ(ptu.Position(PtuAxis::kPan, 6), 100);
}

}  // namespace
}  // namespace arfm_vo
