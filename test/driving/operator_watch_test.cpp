#include "arfm_vo/driving/operator_watch.h"

#include <gtest/gtest.h>

#include <cmath>

namespace arfm_vo {
namespace {

constexpr double kLinkStep_s = 0.02;

/// A rover "sojourner" whose challenges reach a person over a link; numbers count from 1000.
class OperatorWatchTest : public ::testing::Test {
 protected:
  static OperatorWatchOptions Options() {
    OperatorWatchOptions options;
    options.rover = "sojourner";
    return options;
  }

  /// Goes on by `duration_s`; each challenge is answered after `round_trip_s`, none where it is
  /// infinite, and every `nth` answer only gets through.
  void Run(double duration_s, double round_trip_s, int nth = 1) {
    for (const double end_s = now_s_ + duration_s; now_s_ < end_s - 1e-9;) {
      now_s_ += kLinkStep_s;
      const auto challenge = watch_.Advance(now_s_, number_++);
      if (challenge && challenge->sequence % nth == 0 && std::isfinite(round_trip_s))
        answers_.push_back({now_s_ + round_trip_s, *challenge});
      while (!answers_.empty() && answers_.front().first <= now_s_ + 1e-9) {
        watch_.ObserveAnswer(now_s_, answers_.front().second);
        answers_.pop_front();
      }
    }
  }

  OperatorWatch watch_{Options()};
  double now_s_ = 50;
  uint64_t number_ = 1000;
  std::deque<std::pair<double, Challenge>> answers_;
};

TEST_F(OperatorWatchTest, NobodyIsThereBeforeTheFirstAnswer) {
  EXPECT_TRUE(watch_.IsMissing());
  Run(1, INFINITY);
  EXPECT_TRUE(watch_.IsMissing());
  EXPECT_FALSE(watch_.RoundTrip());
}

TEST_F(OperatorWatchTest, AnAnswerInTimeCountsAndItsRoundTripIsMeasured) {
  Run(1, 0.3);
  EXPECT_FALSE(watch_.IsMissing());
  EXPECT_NEAR(watch_.RoundTrip().value(), 0.3, kLinkStep_s);
  EXPECT_EQ(watch_.DescribeRefused(), "");
}

TEST_F(OperatorWatchTest, ALinkThatIsCutIsNoticedWithinASecondOfTheLastChallengeThatGotThrough) {
  for (const double round_trip_s : {0.02, 0.46}) {
    Run(2, round_trip_s);
    ASSERT_FALSE(watch_.IsMissing());
    answers_.clear();
    Run(0.9 - round_trip_s - 0.16, INFINITY);
    EXPECT_FALSE(watch_.IsMissing()) << round_trip_s;
    Run(round_trip_s + 0.18, INFINITY);
    EXPECT_TRUE(watch_.IsMissing()) << round_trip_s;
  }
}

TEST_F(OperatorWatchTest, TwoLostAnswersOfThreeAtTheLongestRoundTripStopNothing) {
  Run(2, 0.48, 3);
  for (int i = 0; i < 250; ++i) {
    Run(kLinkStep_s, 0.48, 3);
    ASSERT_FALSE(watch_.IsMissing()) << now_s_;
  }
}

TEST_F(OperatorWatchTest, AnswersOfASlowLinkAreAllTooOld) {
  Run(20, 8);
  EXPECT_TRUE(watch_.IsMissing());
  EXPECT_EQ(watch_.Answers().num_taken, 0);
  EXPECT_GT(watch_.Answers().num_late, 100);
  Run(2, 0.56);
  EXPECT_TRUE(watch_.IsMissing()) << "later than max_round_trip_s";
  now_s_ += 1;
  const Challenge challenge = watch_.Advance(now_s_, 7).value();
  EXPECT_FALSE(watch_.ObserveAnswer(now_s_ + 0.51, challenge)) << "before the next tick";
}

TEST_F(OperatorWatchTest, ARepeatedAnswerDoesNotCountAgain) {
  const Challenge challenge = watch_.Advance(now_s_, 7).value();
  EXPECT_TRUE(watch_.ObserveAnswer(now_s_ + 0.1, challenge));
  EXPECT_FALSE(watch_.ObserveAnswer(now_s_ + 0.2, challenge));
  EXPECT_NEAR(watch_.RoundTrip().value(), 0.1, 1e-9);
  Run(0.3, INFINITY);
  EXPECT_FALSE(watch_.ObserveAnswer(now_s_, challenge)) << "with later ones in flight";
  EXPECT_EQ(watch_.Answers().num_repeated, 2);
}

TEST_F(OperatorWatchTest, AForeignAnswerDoesNotCount) {
  const Challenge challenge = watch_.Advance(now_s_, 7).value();
  Challenge foreign = challenge;
  foreign.rover = "spirit";
  EXPECT_FALSE(watch_.ObserveAnswer(now_s_, foreign));
  foreign = challenge;
  foreign.number = 8;
  EXPECT_FALSE(watch_.ObserveAnswer(now_s_, foreign));
  foreign = challenge;
  ++foreign.sequence;
  EXPECT_FALSE(watch_.ObserveAnswer(now_s_, foreign)) << "not sent yet";
  EXPECT_EQ(watch_.DescribeRefused(), "(answers refused: 0 late, 0 repeated, 3 foreign)");
  EXPECT_TRUE(watch_.IsMissing());
  EXPECT_TRUE(watch_.ObserveAnswer(now_s_, challenge)) << "the right one is not used up";
}

TEST_F(OperatorWatchTest, AnswersToAnEarlierProcessAreWorthless) {
  Run(2, 0.1);
  const auto old = answers_;
  ASSERT_FALSE(old.empty());
  watch_ = OperatorWatch(Options());
  number_ = 5000;
  Run(3, INFINITY);
  for (const auto& [due_s, challenge] : old)
    EXPECT_FALSE(watch_.ObserveAnswer(now_s_, challenge)) << challenge.sequence;
  EXPECT_TRUE(watch_.IsMissing());
}

TEST_F(OperatorWatchTest, AnswersOutOfOrderCountFromTheNewestChallenge) {
  const Challenge first = watch_.Advance(now_s_, 7).value();
  const Challenge second = watch_.Advance(now_s_ + 0.1, 8).value();
  EXPECT_TRUE(watch_.ObserveAnswer(now_s_ + 0.2, second));
  EXPECT_TRUE(watch_.ObserveAnswer(now_s_ + 0.21, first));
  watch_.Advance(now_s_ + 0.99, 9);
  EXPECT_FALSE(watch_.IsMissing());
  watch_.Advance(now_s_ + 1.01, 9);
  EXPECT_TRUE(watch_.IsMissing());
}

TEST_F(OperatorWatchTest, WhereNobodyIsRequiredNobodyIsMissing) {
  OperatorWatchOptions options = Options();
  options.is_required = false;
  EXPECT_FALSE(OperatorWatch(options).IsMissing());
}

TEST(OperatorWatchOptions, WrongValuesAreNamed) {
  OperatorWatchOptions options;
  options.timeout_s = 1;
  EXPECT_THROW(options.Check(), std::invalid_argument);
  options = {};
  for (const double wrong_s : {0.05, 0.95, static_cast<double>(NAN)}) {
    options.max_round_trip_s = wrong_s;
    EXPECT_THROW(OperatorWatch{options}, std::invalid_argument) << wrong_s;
  }
}

}  // namespace
}  // namespace arfm_vo
