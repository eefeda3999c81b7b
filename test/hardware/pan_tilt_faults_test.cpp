// What goes wrong in the middle of a command to the head.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "arfm_vo/hardware/pan_tilt.h"
#include "hardware/simulated_line.h"

namespace arfm_vo {
namespace {

class PanTiltFaultTest : public testing::Test {
 protected:
  void Make(const PanTiltOptions& options = {}) {
    head_ = std::make_unique<PanTilt>(
        options, [this] { return std::make_unique<SimulatedLine>(bench_); },
        [this] { return bench_.now_s; });
  }
  bool Reach(PanTiltState state, double limit_s) {
    for (const double end = bench_.now_s + limit_s; bench_.now_s < end; bench_.now_s += 0.1) {
      head_->Step();
      if (head_->state() == state) return true;
    }
    return false;
  }

  SimulatedBench bench_;
  std::unique_ptr<PanTilt> head_;
};

TEST_F(PanTiltFaultTest, ALineThatGoesWithACommandClosesTheUnitAndIsNamed) {
  Make();
  ASSERT_TRUE(Reach(PanTiltState::kReady, 60));
  bench_.is_plugged = false;
  EXPECT_THAT(*head_->MoveTo({0.2, 0.1}), testing::HasSubstr("line is gone"));
  EXPECT_EQ(head_->state(), PanTiltState::kClosed);
  EXPECT_FALSE(head_->properties(PtuAxis::kPan));
  EXPECT_FALSE(head_->counts());
}

TEST_F(PanTiltFaultTest, ALineThatGoesWithHomingClosesTheUnit) {
  Make();
  ASSERT_TRUE(Reach(PanTiltState::kReady, 60));
  bench_.is_plugged = false;
  EXPECT_THAT(*head_->Home(), testing::HasSubstr("line is gone"));
  EXPECT_EQ(head_->state(), PanTiltState::kClosed);
}

TEST_F(PanTiltFaultTest, HomingThatDoesNotEndClosesTheUnit) {
  PanTiltOptions options;
  options.home_timeout_s = 1;
  Make(options);
  ASSERT_TRUE(Reach(PanTiltState::kReady, 60));
  ASSERT_EQ(head_->Home(), std::nullopt);
  EXPECT_THAT(*head_->MoveTo({0.1, {}}), testing::HasSubstr("homing"));
  bench_.disturb = [](const std::string&) { return std::string(); };
  EXPECT_TRUE(Reach(PanTiltState::kClosed, 30));
  EXPECT_THAT(head_->problem(), testing::HasSubstr("homing"));
}

TEST_F(PanTiltFaultTest, ASpeedThatTheUnitDoesNotHaveIsSaidWithItsLimits) {
  PanTiltOptions options;
  options.pan_speed_rad_s = 50;
  Make(options);
  ASSERT_TRUE(Reach(PanTiltState::kReady, 60));
  EXPECT_THAT(head_->problem(),
              testing::AllOf(testing::HasSubstr("pan speed"), testing::HasSubstr("is outside")));
}

TEST_F(PanTiltFaultTest, ASpeedWithinTheLimitsIsSet) {
  PanTiltOptions options;
  options.pan_speed_rad_s = 0.2;
  Make(options);
  ASSERT_TRUE(Reach(PanTiltState::kReady, 60));
  EXPECT_EQ(head_->problem(), "");
  const auto pan = head_->properties(PtuAxis::kPan);
  EXPECT_NEAR(pan->speed * pan->resolution_rad, 0.2, pan->resolution_rad);
}

}  // namespace
}  // namespace arfm_vo
