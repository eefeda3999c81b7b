#include "arfm_vo/hardware/frame_pairer.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <set>

#include "arfm_vo/base/random.h"

namespace arfm_vo {
namespace {

constexpr StereoSide kSides[] = {StereoSide::kLeft, StereoSide::kRight};

/// A frame that shows the number of its moment.
VideoFrame MakeFrame(int number, double stamp_s) {
  return {cv::Mat(1, 1, CV_32SC1, cv::Scalar(number)), stamp_s};
}
int NumberOf(const VideoFrame& frame) { return frame.grey.at<int>(0, 0); }

/// Adds frames of one moment; whether they gave a pair.
bool AddBoth(FramePairer& pairer, double left_s, double right_s) {
  pairer.Add(StereoSide::kLeft, MakeFrame(0, left_s));
  return pairer.Add(StereoSide::kRight, MakeFrame(0, right_s)).has_value();
}

TEST(FramePairer, PairsFramesWithinTheSkew) {
  FramePairer pairer(0.004);
  AddBoth(pairer, 0, 0);
  EXPECT_TRUE(AddBoth(pairer, 0.1, 0.1039));
  EXPECT_TRUE(AddBoth(pairer, 0.2, 0.1961));
  EXPECT_FALSE(AddBoth(pairer, 0.3, 0.3041));
  EXPECT_NEAR(pairer.rejected_skew_s(), 0.0041, 1e-9);
  EXPECT_FALSE(AddBoth(pairer, 0.4, 0.3959));
  EXPECT_TRUE(AddBoth(pairer, 0.5, 0.5));
}

TEST(FramePairer, TheSkewItTellsIsThatToTheNearerNeighbour) {
  FramePairer pairer(0.004);
  for (int i = 0; i < 9; ++i) {
    AddBoth(pairer, 0.1 * i, 0.1 * i + 0.012);
    if (i < 2) continue;
    EXPECT_NEAR(pairer.rejected_skew_s(), 0.012, 1e-9);
    pairer.Add(StereoSide::kLeft, MakeFrame(i, 0.1 * i + 0.05));
    EXPECT_NEAR(pairer.rejected_skew_s(), 0.012, 1e-9);
  }
}

TEST(FramePairer, AFirstFrameIsNotUsedAsItsNeighbourIsNotKnown) {
  FramePairer pairer(0.004);
  EXPECT_FALSE(AddBoth(pairer, 1, 1));
  EXPECT_EQ(pairer.num_unpaired(StereoSide::kLeft), 0);
  EXPECT_TRUE(AddBoth(pairer, 2, 2));
  pairer.Clear();
  EXPECT_FALSE(AddBoth(pairer, 3, 3));
}

TEST(FramePairer, FramesThatCouldShareAPartnerGetNone) {
  FramePairer pairer(0.004);
  AddBoth(pairer, 0, 0);
  pairer.Add(StereoSide::kLeft, MakeFrame(1, 0.1));
  pairer.Add(StereoSide::kLeft, MakeFrame(2, 0.107));
  EXPECT_FALSE(pairer.Add(StereoSide::kRight, MakeFrame(1, 0.1035)));
  EXPECT_EQ(pairer.num_ambiguous(), 2);
  EXPECT_TRUE(AddBoth(pairer, 0.2, 0.2));
  EXPECT_EQ(pairer.num_unpaired(StereoSide::kLeft), 2);
  EXPECT_EQ(pairer.num_unpaired(StereoSide::kRight), 1);
}

TEST(FramePairer, AStampThatGoesBackForgetsWhatWaits) {
  FramePairer pairer(0.004);
  AddBoth(pairer, 10, 10);
  pairer.Add(StereoSide::kLeft, MakeFrame(1, 10.1));
  pairer.Add(StereoSide::kLeft, MakeFrame(2, 5));
  EXPECT_FALSE(pairer.Add(StereoSide::kRight, MakeFrame(1, 10.1)));
  EXPECT_FALSE(AddBoth(pairer, 5.1, 5.1));  // the right camera goes back as well
  EXPECT_FALSE(AddBoth(pairer, 5.2, 5.2));  // the left camera's first since then
  EXPECT_TRUE(AddBoth(pairer, 5.3, 5.3));
}

TEST(FramePairer, FasterThanAskedAndOutOfStepGivesNoPairRatherThanAWrongOne) {
  FramePairer pairer(0.025);  // for 10 Hz
  for (int i = 0; i < 100; ++i) EXPECT_FALSE(AddBoth(pairer, i / 30.0, i / 30.0 + 0.016));
  EXPECT_GT(pairer.num_ambiguous(), 190);
}

/// The frames of both cameras, each moment at its time, stamped wrongly by as much as may be.
struct JitteredFrames {
  double period_s, max_skew_s, drop_share;
  std::deque<VideoFrame> frames[2];

  JitteredFrames(double jitter_share, RandomEngine& engine) {
    period_s = 0.005 + RandomUnit(engine);
    max_skew_s = (0.02 + 0.23 * RandomUnit(engine)) * period_s;
    drop_share = 0.5 * RandomUnit(engine);
    // At most this much off, the real skew of a camera included.
    const double most_s = 0.4999 * (period_s - max_skew_s) * jitter_share;
    const double offset_s = most_s * RandomUnit(engine);
    for (int number = 0; number < 400; ++number)
      for (const int side : {0, 1}) {
        if (RandomUnit(engine) < drop_share) continue;
        // At the ends of the range as often as within it.
        const double at = 2 * RandomUnit(engine) - 1;
        const double error = std::clamp(2 * at, -1.0, 1.0) * (most_s - offset_s) +
                             (side == 1 ? offset_s : -offset_s);
        frames[side].push_back(MakeFrame(number, 1000 + number * period_s + error));
      }
  }

  /// Pairs that can be told: both there, near enough, and with a neighbour that is far enough.
  std::set<int> Possible() const {
    std::set<int> clear[2];
    for (const int side : {0, 1})
      for (size_t i = 1; i < frames[side].size(); ++i) {
        const auto stamp_s = [&](size_t k) { return frames[side][k].stamp_s; };
        const bool is_clear =
            stamp_s(i) - stamp_s(i - 1) > 2 * max_skew_s &&
            (i + 1 == frames[side].size() || stamp_s(i + 1) - stamp_s(i) > 2 * max_skew_s);
        if (is_clear) clear[side].insert(NumberOf(frames[side][i]));
      }
    std::set<int> possible;
    for (const VideoFrame& left : frames[0])
      for (const VideoFrame& right : frames[1])
        if (NumberOf(left) == NumberOf(right) &&
            std::abs(left.stamp_s - right.stamp_s) <= max_skew_s &&
            clear[0].count(NumberOf(left)) && clear[1].count(NumberOf(left)))
          possible.insert(NumberOf(left));
    return possible;
  }
};

struct PairingResult {
  std::set<int> paired;
  int num_wrong = 0;
};

/// Gives the frames to a pairer in bursts: one camera can be up to 3 moments ahead of the other.
PairingResult PairInBursts(JitteredFrames source, RandomEngine& engine) {
  FramePairer pairer(source.max_skew_s);
  PairingResult result;
  while (!source.frames[0].empty() || !source.frames[1].empty()) {
    int side = RandomBelow(2, engine);
    const auto next = [&](int e) {
      return source.frames[e].empty() ? 1 << 30 : NumberOf(source.frames[e].front());
    };
    if (next(side) > next(1 - side) + 3) side = 1 - side;
    VideoFrame frame = source.frames[side].front();
    source.frames[side].pop_front();
    const auto pair = pairer.Add(kSides[side], std::move(frame));
    if (!pair) continue;
    result.num_wrong += NumberOf(pair->left) != NumberOf(pair->right);
    result.paired.insert(NumberOf(pair->left));
  }
  return result;
}

TEST(FramePairer, NoJitterThatItsPromiseAllowsGivesAWrongPair) {
  RandomEngine engine(21);
  size_t num_paired = 0, num_possible = 0;
  for (int round = 0; round < 400; ++round) {
    const JitteredFrames source(RandomUnit(engine) < 0.5 ? 1 : RandomUnit(engine), engine);
    const PairingResult result = PairInBursts(source, engine);
    EXPECT_EQ(result.num_wrong, 0) << "round " << round;
    const std::set<int> possible = source.Possible();
    for (const int number : possible)
      EXPECT_TRUE(result.paired.count(number)) << "round " << round << " lost " << number;
    num_paired += result.paired.size();
    num_possible += possible.size();
  }
  EXPECT_GT(num_possible, 5000u);
  EXPECT_GE(num_paired, num_possible);
}

// The bound of the promise is sharp: what goes a little over it can be paired wrongly.
TEST(FramePairer, BeyondItsPromiseTheStampsThemselvesAreWrong) {
  FramePairer pairer(0.025);
  AddBoth(pairer, 0, 0);
  pairer.Add(StereoSide::kLeft, MakeFrame(1, 0.138));  // 38 ms late, and its partner is lost
  const auto pair = pairer.Add(StereoSide::kRight, MakeFrame(2, 0.162));  // 38 ms early
  ASSERT_TRUE(pair);
  EXPECT_NE(NumberOf(pair->left), NumberOf(pair->right));
}

}  // namespace
}  // namespace arfm_vo
