#include "arfm_vo/hardware/pan_tilt.h"

#include <gmock/gmock.h>

#include <cmath>

#include "arfm_vo/base/random.h"
#include "hardware/line_noise.h"
#include "hardware/simulated_line.h"

namespace arfm_vo {
namespace {

using testing::HasSubstr;

constexpr double kCount = 185.1428 / 3600 * M_PI / 180;  // rad

class PanTiltTest : public testing::Test {
 protected:
  void Make(const PanTiltOptions& options = {}) {
    head_ = std::make_unique<PanTilt>(
        options, [this] { return std::make_unique<SimulatedLine>(bench_); },
        [this] { return bench_.now_s; });
  }
  /// Steps at 10 Hz until the state is reached; false after `limit_s`.
  bool StepUntil(const std::function<bool()>& is_reached, double limit_s) {
    for (const double end = bench_.now_s + limit_s; bench_.now_s < end; bench_.now_s += 0.1) {
      head_->Step();
      if (is_reached()) return true;
    }
    return false;
  }
  bool Reach(PanTiltState state, double limit_s) {
    return StepUntil([&] { return head_->state() == state; }, limit_s);
  }
  bool BecomeReady() { return Reach(PanTiltState::kReady, 60); }
  void MakeReady(const PanTiltOptions& options = {}) {
    Make(options);
    ASSERT_TRUE(BecomeReady());
  }
  double TrueRad(PtuAxis axis) { return bench_.ptu.Position(axis, bench_.now_s) * kCount; }

  SimulatedBench bench_;
  std::unique_ptr<PanTilt> head_;
};

TEST_F(PanTiltTest, ReadsLimitsResolutionAndSpeedFromTheUnit) {
  MakeReady();
  const auto pan = head_->properties(PtuAxis::kPan), tilt = head_->properties(PtuAxis::kTilt);
  ASSERT_TRUE(pan && tilt);
  EXPECT_NEAR(pan->resolution_rad, kCount, 1e-12);
  EXPECT_NEAR(pan->MaxRad() * 180 / M_PI, 158.91, 0.01);
  EXPECT_EQ(tilt->min_position, -907);
  EXPECT_EQ(tilt->max_position, 604);
  EXPECT_EQ(pan->speed, 1000);
  EXPECT_EQ(pan->max_speed, 2902);
  EXPECT_THAT(bench_.sent, HasSubstr("ft ed ci "));
  EXPECT_THAT(bench_.sent, testing::Not(HasSubstr("ds"))) << "writes to the EEPROM";
}

TEST_F(PanTiltTest, HomesAtTheStartWhereAsked) {
  PanTiltOptions options;
  options.home_at_start = true;
  Make(options);
  head_->Step();
  EXPECT_EQ(head_->state(), PanTiltState::kHoming);
  EXPECT_THAT(*head_->MoveTo({0.1, 0.0}), HasSubstr("homing"));
  ASSERT_TRUE(BecomeReady());
  EXPECT_GT(bench_.now_s, 8);
  EXPECT_FALSE(head_->HasLostPosition());  // limits that homing finds are no faults
}

TEST_F(PanTiltTest, GoesToAGoalAndSettles) {
  MakeReady();
  ASSERT_TRUE(StepUntil([this] { return head_->IsSettled(); }, 2));
  EXPECT_EQ(head_->MoveTo({0.7, -0.3}), std::nullopt);
  head_->Step();
  EXPECT_FALSE(head_->IsSettled());
  ASSERT_TRUE(StepUntil([this] { return head_->IsSettled(); }, 5));
  EXPECT_NEAR(TrueRad(PtuAxis::kPan), 0.7, kCount);
  EXPECT_NEAR(TrueRad(PtuAxis::kTilt), -0.3, kCount);
  const PanTiltReadings readings = head_->Step();
  EXPECT_NEAR(readings.pan->position_rad, 0.7, kCount);
  EXPECT_NEAR(readings.tilt->position_rad, -0.3, kCount);
}

TEST_F(PanTiltTest, StampsAnAxisInTheMiddleOfItsRoundTrip) {
  MakeReady();
  ASSERT_EQ(head_->MoveTo({1.5, -0.5}), std::nullopt);
  for (int i = 0; i < 20; ++i, bench_.now_s += 0.02) {
    SimulatedPtu truth = bench_.ptu;  // moves on by itself
    const PanTiltReadings readings = head_->Step();
    ASSERT_TRUE(readings.pan && readings.tilt);
    EXPECT_GT(readings.tilt->time_s, readings.pan->time_s + 0.01);  // asked one after the other
    // At 1000 counts/s, 1 ms is a count; the unit reads its count 3 ms before the middle.
    EXPECT_NEAR(readings.pan->position_rad,
                truth.Position(PtuAxis::kPan, readings.pan->time_s) * kCount, 6 * kCount);
    EXPECT_NEAR(readings.tilt->position_rad,
                truth.Position(PtuAxis::kTilt, readings.tilt->time_s) * kCount, 6 * kCount);
  }
}

TEST_F(PanTiltTest, RefusesGoalsOutsideTheLimitsBothAxesOrNone) {
  MakeReady();
  bench_.sent.clear();
  EXPECT_THAT(*head_->MoveTo({0.5, 1.0}), HasSubstr("tilt 57.30 deg is outside the limits "
                                                    "-46.65 .. 31.06 deg"));
  EXPECT_THAT(*head_->MoveTo({-3.0, {}}), HasSubstr("pan"));
  EXPECT_THAT(*head_->MoveTo({NAN, 0.0}), HasSubstr("outside"));
  EXPECT_EQ(bench_.sent, "");
}

TEST_F(PanTiltTest, SaysWhyWhileThereIsNoUnit) {
  bench_.is_plugged = false;
  Make();
  head_->Step();
  EXPECT_EQ(head_->state(), PanTiltState::kClosed);
  EXPECT_THAT(*head_->MoveTo({0.1, {}}), HasSubstr("line is gone"));
  EXPECT_TRUE(head_->Home());
}

TEST_F(PanTiltTest, SurvivesAnUnpluggedLineWithGrowingWaits) {
  MakeReady();
  bench_.is_plugged = false;
  head_->Step();
  EXPECT_EQ(head_->state(), PanTiltState::kClosed);
  EXPECT_THAT(head_->problem(), HasSubstr("gone"));
  EXPECT_FALSE(Reach(PanTiltState::kReady, 20));
  bench_.is_plugged = true;
  ASSERT_TRUE(Reach(PanTiltState::kReady, 6));
  EXPECT_EQ(head_->num_reopened(), 1);
  EXPECT_EQ(head_->problem(), "");
  EXPECT_TRUE(head_->Step().pan);
}

TEST_F(PanTiltTest, AUnitThatIsSilentIsOpenedAnew) {
  MakeReady();
  bench_.disturb = [](const std::string&) { return std::string(); };
  EXPECT_TRUE(Reach(PanTiltState::kClosed, 30));
  bench_.disturb = [](const std::string& bytes) { return bytes; };
  EXPECT_TRUE(BecomeReady());
}

TEST_F(PanTiltTest, AnUnexpectedLimitMeansTheCountIsLostUntilHomed) {
  MakeReady();
  EXPECT_FALSE(head_->HasLostPosition());
  bench_.ptu.HitLimit(PtuAxis::kPan, 40, bench_.now_s);
  bench_.now_s += 0.05;
  head_->Step();
  EXPECT_TRUE(head_->HasLostPosition());
  EXPECT_EQ(head_->Home(), std::nullopt);
  ASSERT_TRUE(BecomeReady());
  EXPECT_FALSE(head_->HasLostPosition());
}

TEST_F(PanTiltTest, ALateReplyIsNotTakenForTheNextQuestions) {
  MakeReady();
  ASSERT_EQ(head_->MoveTo({1.0, -0.5}), std::nullopt);
  ASSERT_TRUE(StepUntil([this] { return head_->IsSettled(); }, 5));
  // Everything comes 0.3 s late for a while: later than the driver waits.
  std::string held;
  double release_s = bench_.now_s + 0.3;
  bench_.disturb = [&](const std::string& bytes) {
    held += bytes;
    if (bench_.now_s < release_s) return std::string();
    release_s = bench_.now_s + 0.3;
    return std::exchange(held, {});
  };
  for (int i = 0; i < 10; ++i, bench_.now_s += 0.1) {
    const PanTiltReadings readings = head_->Step();
    EXPECT_NEAR(readings.pan.value_or(PtuReading{1}).position_rad, 1, kCount);
    EXPECT_NEAR(readings.tilt.value_or(PtuReading{-0.5}).position_rad, -0.5, kCount);
    if (head_->state() != PanTiltState::kReady) break;
  }
  bench_.disturb = [](const std::string& bytes) { return bytes; };
  ASSERT_TRUE(BecomeReady());
  EXPECT_NEAR(head_->Step().pan->position_rad, 1.0, kCount);
}

TEST_F(PanTiltTest, TenThousandRandomRepliesGiveNoWrongPositionAndNoHang) {
  MakeReady();
  LineNoise noise(46);
  RandomEngine engine(7);
  int num_read = 0;
  bool is_noisy = false;
  bench_.disturb = [&](const std::string& bytes) { return is_noisy ? noise(bytes) : bytes; };
  while (noise.num_replies < 10000) {
    if (RandomBelow(20, engine) == 0)
      head_->MoveTo({RandomUnit(engine) * 4 - 2, RandomUnit(engine) - 0.5});
    // The noise comes in spells, as from a bad plug.
    is_noisy = RandomBelow(4, engine) != 0;
    const double start_s = bench_.now_s;
    SimulatedPtu truth = bench_.ptu;  // moves on by itself
    const PanTiltReadings readings = head_->Step();
    ASSERT_LT(bench_.now_s - start_s, 30);  // of simulated time: attempts are bounded
    for (const auto& [axis, reading] :
         {std::pair(PtuAxis::kPan, readings.pan), {PtuAxis::kTilt, readings.tilt}}) {
      if (!reading) continue;
      ++num_read;
      // The unit's count some time during the round trip; a garbled last digit may pass for a step.
      SimulatedPtu axis_truth = truth;
      const double early = axis_truth.Position(axis, reading->time_s - 0.01) * kCount;
      const double late = axis_truth.Position(axis, reading->time_s + 0.01) * kCount;
      EXPECT_GE(reading->position_rad, std::min(early, late) - 3 * kCount);
      EXPECT_LE(reading->position_rad, std::max(early, late) + 3 * kCount);
    }
    bench_.now_s += 0.1;
  }
  EXPECT_GT(num_read, 300);
  bench_.disturb = [](const std::string& bytes) { return bytes; };
  ASSERT_TRUE(StepUntil([this] { return head_->Step().pan.has_value(); }, 30));
  std::printf("%d replies, %d positions taken, %d times reopened, %.0f s simulated\n",
              noise.num_replies, num_read, head_->num_reopened(), bench_.now_s);
  EXPECT_THAT(bench_.sent, testing::Not(HasSubstr("ds"))) << "writes to the EEPROM";
}

TEST_F(PanTiltTest, ALineThatGoesWithACommandOrHomingClosesTheUnitAndIsNamed) {
  for (const bool is_homing : {false, true}) {
    bench_.is_plugged = true;
    MakeReady();
    bench_.is_plugged = false;
    EXPECT_THAT(*(is_homing ? head_->Home() : head_->MoveTo({0.2, 0.1})),
                HasSubstr("line is gone"));
    EXPECT_EQ(head_->state(), PanTiltState::kClosed);
    EXPECT_FALSE(head_->properties(PtuAxis::kPan));
    EXPECT_FALSE(head_->counts());
  }
}

TEST_F(PanTiltTest, HomingThatDoesNotEndClosesTheUnit) {
  PanTiltOptions options;
  options.home_timeout_s = 1;
  MakeReady(options);
  ASSERT_EQ(head_->Home(), std::nullopt);
  EXPECT_THAT(*head_->MoveTo({0.1, {}}), HasSubstr("homing"));
  bench_.disturb = [](const std::string&) { return std::string(); };
  EXPECT_TRUE(Reach(PanTiltState::kClosed, 30));
  EXPECT_THAT(head_->problem(), HasSubstr("homing"));
}

TEST_F(PanTiltTest, ASpeedWithinTheLimitsIsSetAndAnotherSaidWithThem) {
  PanTiltOptions options;
  options.pan_speed_rad_s = 0.2;
  MakeReady(options);
  EXPECT_EQ(head_->problem(), "");
  const auto pan = head_->properties(PtuAxis::kPan);
  EXPECT_NEAR(pan->speed * pan->resolution_rad, 0.2, pan->resolution_rad);
  options.pan_speed_rad_s = 50;
  MakeReady(options);
  EXPECT_THAT(head_->problem(), testing::AllOf(HasSubstr("pan speed"), HasSubstr("is outside")));
}

TEST(PanTiltOptions, BadValuesAreNamed) {
  PanTiltOptions options;
  options.reply_timeout_s = 0;
  EXPECT_THROW(options.Check(), std::invalid_argument);
  options = {};
  options.reopen.max_s = 0.1;
  EXPECT_THROW(options.Check(), std::invalid_argument);
}

}  // namespace
}  // namespace arfm_vo
