#include "arfm_vo/reconstruction/row_model.h"

#include <gtest/gtest.h>

#include <cmath>

#include "arfm_vo/base/random.h"

namespace arfm_vo {
namespace {

const StereoCamera kCamera{700, 700, 600, 180, 0.5, 1200, 360};
const CorrectionBelief kCalibration = CorrectionBelief::OfCalibration(kCamera);

/// The rows of a right camera that is turned: a pixel down in one corner, up in the other.
double TrueResidual(double u, double v) {
  return 0.3 + 0.2 * (u - 600) / 600 - 0.9 * (u - 600) / 600 * (v - 180) / 180;
}

std::vector<RowSample> Samples(int count, double noise_px, double wrong_share, int seed) {
  RandomEngine engine(seed);
  std::vector<RowSample> samples;
  for (int i = 0; i < count; ++i) {
    const double u = 1200 * RandomUnit(engine), v = 360 * RandomUnit(engine);
    const double noise = noise_px * (2 * RandomUnit(engine) - 1);
    const bool is_wrong = RandomUnit(engine) < wrong_share;
    const double wrong = 6 * RandomUnit(engine) - 3;
    samples.push_back({u, v, is_wrong ? wrong : TrueResidual(u, v) + noise, 0.1});
  }
  return samples;
}

double LargestError(const RowModel& model) {
  double largest = 0;
  for (int u = 0; u <= 1200; u += 100) {
    for (int v = 0; v <= 360; v += 60)
      largest = std::max(largest, std::abs(model.Predict(u, v) - TrueResidual(u, v)));
  }
  return largest;
}

TEST(RowModel, BeginsWithWhatIsKnown) {
  CorrectionBelief known = CorrectionBelief::Isotropic(0.02);
  known.mean.coefficients_px[StereoCorrection::kNumPlacing] = 0.4;
  RowModel model(kCamera, known);
  EXPECT_NEAR(model.Predict(300, 100), 0.4, 1e-12);
  model.Update({{100, 50, 2.0, 1}});  // one odd match does not undo it
  EXPECT_NEAR(model.Predict(300, 100), 0.4, 0.05);
}

TEST(RowModel, ExpectsNothingAtFirst) {
  const RowModel model(kCamera, kCalibration);
  EXPECT_EQ(model.Predict(100, 50), 0);
  EXPECT_FALSE(model.IsLearnt());
}

TEST(RowModel, LearnsATurnedCameraFromOnePair) {
  RowModel model(kCamera, kCalibration);
  model.Update(Samples(400, 0.2, 0, 1));
  EXPECT_TRUE(model.IsLearnt());
  EXPECT_LT(LargestError(model), 0.165);  // 0.2 px in 400 rows, twelve terms
  EXPECT_GT(model.spread_px(), 0.09);
  EXPECT_LT(model.spread_px(), 0.2);
}

TEST(RowModel, IsNotMisledByOneWrongMatchInFour) {
  RowModel model(kCamera, kCalibration);
  model.Update(Samples(400, 0.2, 0.25, 2));
  EXPECT_LT(LargestError(model), 0.2);
}

TEST(RowModel, GrowsBetterFromPairToPair) {
  RowModel one(kCamera, kCalibration), many(kCamera, kCalibration);
  one.Update(Samples(100, 0.5, 0.1, 1));
  for (int pair = 1; pair <= 20; ++pair) many.Update(Samples(100, 0.5, 0.1, pair));
  EXPECT_LT(LargestError(many), 0.5 * LargestError(one));
}

TEST(RowModel, FollowsACameraThatIsKnocked) {
  RowModel model(kCamera, kCalibration);
  std::vector<RowSample> knocked = Samples(300, 0.2, 0, 1);
  for (int pair = 1; pair <= 5; ++pair) model.Update(Samples(300, 0.2, 0, pair));
  for (RowSample& sample : knocked) sample.residual_px += 0.5;
  for (int pair = 0; pair < 30; ++pair) model.Update(knocked);
  EXPECT_NEAR(model.Predict(600, 180), 0.8, 0.05);
}

TEST(RowModel, TellsABumpOfOnePairAtOnce) {
  RowModel model(kCamera, kCalibration);
  for (int pair = 1; pair <= 10; ++pair) model.Update(Samples(300, 0.2, 0, pair));
  EXPECT_NEAR(model.shift_px(), 0, 0.05);
  std::vector<RowSample> bumped = Samples(300, 0.2, 0, 11);
  for (RowSample& sample : bumped) sample.residual_px += 2;
  model.Update(bumped);
  EXPECT_NEAR(model.Predict(600, 180) + model.shift_px(), TrueResidual(600, 180) + 2, 0.15);
}

TEST(RowModel, OfFewSamplesInOnePlaceStaysSober) {
  RowModel model(kCamera, kCalibration);
  model.Update({{100, 50, 0.5, 0.1}, {101, 50, 0.6, 0.1}, {100, 51, 0.4, 0.1}});
  EXPECT_NEAR(model.Predict(100, 50), 0.5, 0.1);
  EXPECT_LT(std::abs(model.Predict(1100, 300)), 1.5);
  EXPECT_FALSE(model.IsLearnt());
}

TEST(RowModel, NoSamplesChangeNothing) {
  RowModel model(kCamera, kCalibration);
  model.Update(Samples(400, 0.2, 0, 1));
  const double before = model.Predict(10, 20);
  model.Update({});
  EXPECT_EQ(model.Predict(10, 20), before);
}

TEST(RowModel, NoCalibrationErrsLikeThePicturesOfTwoMoments) {
  RowModel turned(kCamera, kCalibration);
  EXPECT_TRUE(turned.IsPlausible());
  turned.Update(Samples(400, 0.2, 0.2, 7));
  EXPECT_TRUE(turned.IsPlausible()) << "by a turn, and with wrong matches";
  // Ahead: all moves away from the centre of the picture.
  RowModel moved(kCamera, kCalibration);
  std::vector<RowSample> samples = Samples(400, 0.2, 0, 8);
  for (RowSample& sample : samples) sample.residual_px = 0.03 * (sample.v_right - 180);
  moved.Update(samples);
  EXPECT_FALSE(moved.IsPlausible());
}

}  // namespace
}  // namespace arfm_vo
