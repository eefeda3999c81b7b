#include "arfm_vo/driving/picture_watch.h"

#include <gtest/gtest.h>

#include <cmath>
#include <functional>
#include <limits>

namespace arfm_vo {
namespace {

/// The time of the picture with which the exposure has settled; infinity where it does not.
double SettledAfter(double period_s, const std::function<double(double, int)>& grey,
                    double duration_s = 20) {
  PictureWatch watch(1);
  for (int i = 0; i * period_s <= duration_s; ++i) {
    watch.Observe({100 + i * period_s, grey(i * period_s, i), 400, 300});
    if (watch.HasSettled()) return i * period_s;
  }
  return std::numeric_limits<double>::infinity();
}

double Converging(double time_s, double time_constant_s) {
  return 110 - 90 * std::exp(-time_s / time_constant_s);
}

TEST(PictureWatch, AnExposureThatConvergesHasSettledWhereAGreyLevelIsLeft) {
  for (const double period_s : {0.04, 0.1, 0.5}) {
    for (const double constant_s : {0.2, 0.5, 1.0}) {
      const auto grey = [&](double time_s, int) { return Converging(time_s, constant_s); };
      const double settled_s = SettledAfter(period_s, grey);
      ASSERT_LT(settled_s, 10) << period_s << " " << constant_s;
      // What changes from then on, within a second, is little.
      EXPECT_LT(Converging(settled_s + 1, constant_s) - Converging(settled_s, constant_s), 2)
          << period_s << " " << constant_s;
    }
  }
}

TEST(PictureWatch, ASteadyOneNeedsASecondAndFourPictures) {
  const auto steady = [](double, int i) { return 100 + 0.02 * (i % 2); };
  EXPECT_NEAR(SettledAfter(0.1, steady), 1, 1e-9);
  EXPECT_NEAR(SettledAfter(0.5, steady), 1.5, 1e-9);
}

TEST(PictureWatch, ItsOwnScatterHoldsNothingUpAndADriftOfSeveralGreyLevelsDoes) {
  EXPECT_LT(SettledAfter(0.1, [](double, int i) { return 100 + 8 * std::sin(2.4 * i); }), 3);
  EXPECT_TRUE(std::isinf(SettledAfter(0.1, [](double time_s, int) { return 20 + 5 * time_s; })));
  EXPECT_TRUE(std::isinf(SettledAfter(0.1, [](double, int) { return std::nan(""); })));
}

TEST(PictureWatch, OnceSettledItStaysSoUntilTheCameraWasAway) {
  PictureWatch watch(1);
  EXPECT_TRUE(watch.HasSettled());  // nobody tells of pictures
  double now_s = 0;
  for (; now_s < 2; now_s += 0.1) watch.Observe({now_s, 100, 400, 300});
  for (; now_s < 4; now_s += 0.1) watch.Observe({now_s, 100 + 10 * now_s, 400, 300});
  EXPECT_TRUE(watch.HasSettled());
  watch.Observe({now_s + 1.5, 100, 400, 300});
  EXPECT_FALSE(watch.HasSettled());
}

TEST(PictureWatch, TheCheckSaysWhatIsKnown) {
  PictureWatch watch(1);
  for (const CheckLine& line : watch.Check(0)) EXPECT_FALSE(line.is_well) << line.ToString();
  for (int i = 0; i <= 20; ++i) watch.Observe({0.1 * i, 100, 400, 300});
  EXPECT_EQ(watch.Check(2)[0].ToString(), "yes camera: 10.0 pictures a second");
  EXPECT_EQ(watch.Check(4)[0].ToString(), "no camera: the last picture is 2.0 s old");
  EXPECT_EQ(watch.Check(2)[1].ToString(), "yes exposure: has settled, mean grey 100");
  EXPECT_EQ(watch.Check(2)[2].ToString(),
            "yes both_cameras: 300 of 400 landmarks are seen by both");
  watch.Observe({2.1, 50, 400, 30});
  EXPECT_FALSE(*watch.Check(2.1)[2].is_well);
  watch.Observe({9, 50, 0, 0});
  EXPECT_EQ(watch.Check(9)[1].ToString(), "no exposure: has not settled, mean grey 50");
  EXPECT_FALSE(*watch.Check(9)[2].is_well);
}

}  // namespace
}  // namespace arfm_vo
