#include "arfm_vo/mapping/localiser.h"

#include <gtest/gtest.h>

#include "arfm_vo/base/random.h"

namespace arfm_vo {
namespace {

const StereoCamera kCamera{400, 400, 320, 240, 0.2, 640, 480};
constexpr size_t kMaxPoints = 100000;

/// A wall of points along x, and cameras that look at it as they go along.
class LocaliserTest : public ::testing::Test {
 protected:
  struct Point {
    Eigen::Vector3d x_in_site;
    Appearance appearance;
  };

  LocaliserTest() {
    for (int i = 0; i < 3000; ++i) {
      std::array<float, 64> descriptor{};
      for (float& value : descriptor) value = static_cast<float>(Random(-0.25, 0.25));
      points_.push_back({{Random(-10, 50), Random(-2, 2), Random(4, 8)}, {descriptor.data(), 1}});
    }
  }

  double Random(double low, double high) { return low + (high - low) * RandomUnit(engine_); }

  /// site_from_camera.
  static Rigid3 At(double x_m) { return {Eigen::Quaterniond::Identity(), {x_m, 0, 0}}; }

  std::vector<SeenPoint> See(const Rigid3& site_from_camera) const {
    std::vector<SeenPoint> view;
    ForEachSeen(site_from_camera, [&](const Point& point, const Eigen::Vector3d& x) {
      auto& [id, appearance, observation] = view.emplace_back();
      appearance = point.appearance;
      observation.pixels = kCamera.ProjectStereo(x);
    });
    return view;
  }

  /// What a drive leaves that began at `first_m`, in its own frame and its first camera's axes.
  std::vector<KnownKeyframe> Epoch(double first_m, int num_keyframes, int frame) const {
    std::vector<KnownKeyframe> keyframes;
    for (int k = 0; k < num_keyframes; ++k) {
      KnownKeyframe& keyframe = keyframes.emplace_back();
      keyframe.map_from_camera = At(k);
      keyframe.frame = frame;
      Place place;
      ForEachSeen(At(first_m + k), [&](const Point& point, const Eigen::Vector3d& x) {
        place.push_back({0, x, point.appearance});
      });
      keyframe.SetPoints(std::move(place));
    }
    return keyframes;
  }

  static KnownMap MapOf(std::vector<KnownKeyframe> keyframes) {
    return {"map", kCamera, {}, std::move(keyframes)};
  }

  Localiser WithMap(int num_keyframes) const {
    Localiser localiser;
    localiser.Keep(MapOf(Epoch(0, num_keyframes, 0)), kMaxPoints);
    return localiser;
  }

  /// View `number` of a drive that began at `first_m` and says that each metre is `said_m`.
  std::optional<Rigid3> Drive(Localiser& localiser, double first_m, int number,
                              double said_m = 1) const {
    if (!localiser.MayLocalise(kCamera)) return std::nullopt;
    return localiser.Localise(See(At(first_m + number)), At(said_m * number), Rigid3());
  }

  std::vector<Point> points_;
  RandomEngine engine_{11};

 private:
  template <class Do>
  void ForEachSeen(const Rigid3& site_from_camera, const Do& what) const {
    for (const Point& point : points_) {
      const Eigen::Vector3d x = site_from_camera.Inverse() * point.x_in_site;
      if (x.z() > 1 && kCamera.Contains(kCamera.Project(x)) && kCamera.ProjectStereo(x).z() > 0)
        what(point, x);
    }
  }
};

TEST_F(LocaliserTest, IsFoundByTwoViewsAndNotBefore) {
  Localiser localiser = WithMap(10);
  EXPECT_EQ(localiser.state(), MapState::kLocalising);
  EXPECT_FALSE(Drive(localiser, 4.3, 0));
  EXPECT_EQ(localiser.state(), MapState::kLocalising);
  const auto map_from_own = Drive(localiser, 4.3, 1);
  ASSERT_TRUE(map_from_own);
  EXPECT_EQ(localiser.state(), MapState::kLocalised);
  EXPECT_NEAR(map_from_own->translation.x(), 4.3, 1e-3);
  EXPECT_LT(map_from_own->Angle(), 1e-3);
  EXPECT_EQ(localiser.own_frame(), 0);
  EXPECT_NE(localiser.found().find("of the map"), std::string::npos) << localiser.found();
}

TEST_F(LocaliserTest, IsFoundAtRest) {
  Localiser localiser = WithMap(10);
  EXPECT_FALSE(Drive(localiser, 4.3, 0));
  EXPECT_TRUE(Drive(localiser, 4.3, 0));
}

TEST_F(LocaliserTest, APoseOnWhichAThirdOfTheMatchesAgreeMayBeChance) {
  std::vector<SeenPoint> view = See(At(4.3));
  view.resize(90);
  for (const bool is_exact : {true, false}) {
    for (size_t i = 30; !is_exact && i + 1 < view.size(); ++i)
      std::swap(view[i].observation, view[i + 1].observation);
    Localiser localiser = WithMap(10);
    for (int i = 0; i < 3; ++i) localiser.Localise(view, Rigid3(), Rigid3());
    EXPECT_EQ(localiser.state() == MapState::kLocalised, is_exact);
  }
}

TEST_F(LocaliserTest, PlacesThatAreNotWhereTheMotionLeadsAreNotTaken) {
  Localiser localiser = WithMap(10);
  for (int k = 0; k < 8; ++k) EXPECT_FALSE(Drive(localiser, 1, k, 1.5));
  EXPECT_EQ(localiser.state(), MapState::kLocalising);
}

TEST_F(LocaliserTest, ElsewhereNothingIsFound) {
  Localiser localiser = WithMap(8);
  for (int k = 0; k < 10; ++k) EXPECT_FALSE(Drive(localiser, 30, k));
  EXPECT_EQ(localiser.state(), MapState::kLocalising);
}

TEST_F(LocaliserTest, WithoutAMapItIsANewOneAndAClosedEpochIsFound) {
  Localiser localiser;
  localiser.Keep({}, kMaxPoints);
  EXPECT_EQ(localiser.state(), MapState::kNewMap);
  EXPECT_FALSE(Drive(localiser, 0, 0));
  localiser.Close(Epoch(0, 8, localiser.own_frame()), kCamera);
  EXPECT_EQ(localiser.own_frame(), 1);
  EXPECT_EQ(localiser.state(), MapState::kLocalising);
  EXPECT_FALSE(Drive(localiser, 2, 0));
  EXPECT_TRUE(Drive(localiser, 2, 1));
  EXPECT_EQ(localiser.own_frame(), 0);
}

TEST_F(LocaliserTest, UnlessItIsKeptNothingIsLookedFor) {
  Localiser localiser;
  localiser.Close(Epoch(0, 8, 0), kCamera);
  EXPECT_EQ(localiser.state(), MapState::kNewMap);
  EXPECT_FALSE(localiser.MayLocalise(kCamera));
  EXPECT_EQ(localiser.own_frame(), 0);
  EXPECT_EQ(NumPoints(localiser.keyframes()), 0u);
  EXPECT_EQ(localiser.keyframes().size(), 8u);
}

TEST_F(LocaliserTest, FramesThatMeetBecomeTheOlderOneWhicheverIsMetFirst) {
  KnownMap map = MapOf(Epoch(0, 8, 0));
  for (const KnownKeyframe& keyframe : Epoch(12, 8, 1)) map.keyframes.push_back(keyframe);
  Localiser localiser;
  localiser.Keep(map, kMaxPoints);
  Rigid3 map_from_own;
  const auto drive_to = [&](int first, int last) {  // from 14 m to the left
    for (int k = first; k <= last; ++k) {
      const auto moved = localiser.Localise(See(At(14 - k)), At(-k), map_from_own);
      if (moved) map_from_own = *moved * map_from_own;
    }
  };
  drive_to(0, 1);
  EXPECT_EQ(localiser.own_frame(), 1);
  EXPECT_NEAR(map_from_own.translation.x(), 2, 1e-3);
  drive_to(2, 14);
  EXPECT_EQ(localiser.own_frame(), 0);
  EXPECT_NEAR(map_from_own.translation.x(), 14, 1e-3);
  for (const KnownKeyframe& keyframe : localiser.keyframes()) EXPECT_EQ(keyframe.frame, 0);
  EXPECT_NEAR(localiser.keyframes()[8].map_from_camera.translation.x(), 12, 1e-3);
}

TEST_F(LocaliserTest, APlaceThatContradictsAStatementIsNotTaken) {
  struct Case {
    double stated_m, sigma_m;
    bool is_taken;
  };
  for (const auto& [stated_m, sigma_m, is_taken] :
       {Case{4, 0.5, true}, {4.8, 0.5, true}, {9, 0.5, false}, {9, 3, true}, {9, 0, true}}) {
    Localiser localiser = WithMap(10);
    const Eigen::Vector3d variances(sigma_m * sigma_m, sigma_m * sigma_m, 0.07 * sigma_m);
    localiser.Move(Rigid3(), {At(stated_m), At(0), variances.asDiagonal()});
    for (int k = 0; k < 4; ++k) Drive(localiser, 4, k);
    EXPECT_EQ(localiser.state(), is_taken ? MapState::kLocalised : MapState::kLocalising)
        << stated_m << " +- " << sigma_m;
    EXPECT_EQ(localiser.found().find("contradicts") == std::string::npos, is_taken);
  }
}

TEST_F(LocaliserTest, AStatementTakesAFoundDriveOutOfTheMapUntilItIsFoundAgain) {
  Localiser localiser = WithMap(10);
  for (int k = 0; k < 3; ++k) Drive(localiser, 2, k);
  ASSERT_EQ(localiser.state(), MapState::kLocalised);
  localiser.Move(At(1), {At(3), At(0), Eigen::Matrix3d::Zero()});
  EXPECT_EQ(localiser.state(), MapState::kLocalising);
  EXPECT_EQ(localiser.own_frame(), 1);
  EXPECT_EQ(localiser.keyframes()[3].map_from_camera.translation.x(), 3);
  for (int k = 3; k < 6; ++k) Drive(localiser, 2, k);
  EXPECT_EQ(localiser.state(), MapState::kLocalised);
}

TEST_F(LocaliserTest, WhatSeesTheSameIsKeptOnceAndAnUnseenFrameNotAtAll) {
  Localiser localiser = WithMap(10);
  const size_t known = NumPoints(localiser.keyframes());
  std::vector<KnownKeyframe> again = Epoch(0, 10, 0);
  EXPECT_EQ(NumPoints(localiser.WithNewest(again, kCamera).keyframes), known);
  EXPECT_EQ(localiser.WithNewest(again, kCamera).keyframes.size(), 20u);
  for (KnownKeyframe& keyframe : again) {
    keyframe.frame = 1;
    keyframe.points = Place();
  }
  EXPECT_EQ(localiser.WithNewest(again, kCamera).keyframes.size(), 10u);
  StereoCamera other = kCamera;
  other.fx = 500;
  EXPECT_EQ(localiser.WithNewest(Epoch(0, 10, 1), other).keyframes.size(), 10u);
  EXPECT_FALSE(localiser.MayLocalise(other));
}

TEST_F(LocaliserTest, KeepsNoMorePointsThanItMay) {
  Localiser localiser;
  localiser.Keep({}, 2000);
  localiser.Close(Epoch(0, 30, 0), kCamera);
  EXPECT_LE(NumPoints(localiser.keyframes()), 2000u);
  EXPECT_GT(NumPoints(localiser.keyframes()), 500u);
}

}  // namespace
}  // namespace arfm_vo
