#include "arfm_vo/ros/odometry/map_keeper.h"

#include <gtest/gtest.h>
#include <unistd.h>

#include "arfm_vo/base/random.h"
#include "arfm_vo/base/whole_file.h"
#include "arfm_vo/mapping/map_file.h"
#include "base/folder_test.h"

namespace arfm_vo {
namespace {

namespace fs = std::filesystem;

const StereoCamera kCamera{400, 400, 320, 240, 0.3, 640, 480};

/// Files of a drive of some keyframes along a wall, and of the next one.
class MapKeeperTest : public FolderTest {
 protected:
  MapKeeperTest() { options_.map_file = folder_ / "site.map"; }

  /// Of the camera, seen from the first keyframe's.
  static Rigid3 At(int number) { return {Eigen::Quaterniond::Identity(), {0.5 * number, 0, 0}}; }

  /// Keyframe `number` of a camera that goes half a metre along a wall from one to the next.
  static PlacedKeyframe MakeKeyframe(int number, const StereoCamera& camera) {
    RandomEngine engine(3);
    PlacedKeyframe keyframe;
    keyframe.epoch = 1;
    keyframe.camera = camera;
    keyframe.keyframe.id = number;
    keyframe.keyframe.stamp_s = 10 + number;
    keyframe.keyframe.camera_from_world = At(number).Inverse();
    for (int i = 0; i < 200; ++i) {
      Landmark landmark;
      landmark.id = i;
      landmark.x_in_world = {6 * RandomUnit(engine) - 2, 4 * RandomUnit(engine) - 2,
                             5 + RandomUnit(engine)};
      for (float& value : landmark.descriptor)
        value = static_cast<float>(0.5 * RandomUnit(engine) - 0.25);
      if (number == 0) keyframe.landmarks.push_back(landmark);
      const Eigen::Vector3d x = keyframe.keyframe.camera_from_world * landmark.x_in_world;
      const Eigen::Vector3d seen = camera.ProjectStereo(x);
      if (!camera.Contains(seen.head<2>()) || seen.z() < 0) continue;
      keyframe.keyframe.observations.push_back(
          {{{seen.x(), seen.y(), seen.z(), seen.y()}, true, 0.3}, i});
    }
    return keyframe;
  }

  /// What the front end makes of the pair that keyframe `number` is of.
  static StereoFrame MakeFrame(int number, const StereoCamera& camera) {
    const std::vector<Landmark> landmarks = MakeKeyframe(0, camera).landmarks;
    StereoFrame frame;
    for (const auto& seen : MakeKeyframe(number, camera).keyframe.observations) {
      const Landmark& landmark = landmarks[seen.landmark];
      StereoPoint& point = frame.points.emplace_back();
      point.keypoint = frame.features.size();
      const Eigen::Vector4d pixels = seen.Pixels();
      point.observation = pixels.head<3>();
      point.x_in_camera =
          camera.TriangulateMeasured(pixels.x(), pixels.y(), pixels.x() - pixels.z());
      Keypoint& keypoint = frame.features.keypoints.emplace_back(landmark.keypoint);
      keypoint.x = static_cast<float>(pixels.x());
      keypoint.y = static_cast<float>(pixels.y());
      keypoint.scale = 1;
      frame.features.descriptors.push_back(cv::Mat(landmark.descriptor, true).reshape(1, 1));
    }
    return frame;
  }

  /// The state after each keyframe, and what was saved at the end.
  std::vector<int> Drive(const StereoCamera& camera = kCamera) {
    MapKeeper keeper(options_, "map");
    PlacedMap map{GlobalMapOptions()};
    std::vector<int> states;
    for (int number = 0; number < 4; ++number) {
      keeper.LoadFor(camera, map);
      map.Add(MakeKeyframe(number, camera));
      map.Localise(MakeFrame(number, camera), At(number));
      if (const auto news = keeper.News(map, ros::Time(1))) {
        states.push_back(news->state);
        text_ = news->text;
      }
    }
    map.Adjust();
    saved_ = keeper.Save(map);
    return states;
  }

  std::vector<std::string> Files() const {
    std::vector<std::string> names;
    for (const auto& entry : fs::directory_iterator(folder_))
      names.push_back(entry.path().filename());
    std::sort(names.begin(), names.end());
    return names;
  }

  MapKeeperOptions options_;
  std::string text_, saved_;
};

using States = std::vector<int>;
using Names = std::vector<std::string>;

TEST_F(MapKeeperTest, ADriveIsFoundInTheMapOfTheOneBefore) {
  EXPECT_EQ(Drive(), States{MapStatus::NEW_MAP});
  EXPECT_EQ(Drive(), (States{MapStatus::LOCALISING, MapStatus::LOCALISED}));
  EXPECT_EQ(Files(), Names{"site.map"});
  const KnownMap map = ReadMap(options_.map_file);
  EXPECT_EQ(map.frame_id, "map");
  EXPECT_EQ(map.keyframes.size(), 8u);
  for (const KnownKeyframe& keyframe : map.keyframes) EXPECT_EQ(keyframe.frame, 0);
  EXPECT_NEAR(map.keyframes[7].map_from_camera.translation.x(), 1.5, 0.01);
}

TEST_F(MapKeeperTest, AfterALossOrARestartTheOdometryIsFoundInWhatWasSeenBefore) {
  for (const bool is_restart : {false, true}) {
    MapKeeper keeper(options_, "map");
    PlacedMap map{GlobalMapOptions()};
    keeper.LoadFor(kCamera, map);
    States states;
    for (int i = 0; i < 8; ++i) {
      PlacedKeyframe keyframe = MakeKeyframe(i % 4, kCamera);
      if (i >= 4) keyframe.odom_from_world.translation.x() = 7;
      if (i >= 4 && !is_restart) {
        keyframe.epoch = 2;
        keyframe.keyframe.stamp_s += 100;
      }
      EXPECT_EQ(map.Add(keyframe), !(is_restart && i == 4));
      map.Localise(MakeFrame(i % 4, kCamera), keyframe.odom_from_world * At(i % 4));
      if (i == 3) map.Adjust();
      if (const auto news = keeper.News(map, ros::Time(1))) states.push_back(news->state);
    }
    EXPECT_EQ(states, (States{MapStatus::NEW_MAP, MapStatus::LOCALISING, MapStatus::LOCALISED}));
    EXPECT_NEAR(map.map_from_odom().translation.x(), -7, 0.01);
    EXPECT_EQ(map.BasePoses().size(), 8u);
    EXPECT_EQ(map.MakeTrajectory().size(), is_restart ? 4u : 8u);
  }
}

TEST_F(MapKeeperTest, AMapThatIsRefusedStaysAndTheDriveGoesBeside) {
  WriteWholeFile(options_.map_file, "no map");
  EXPECT_EQ(Drive(), States{MapStatus::NEW_MAP});
  EXPECT_EQ(text_, options_.map_file + ": is not a map");
  EXPECT_EQ(ReadWholeFile(options_.map_file), "no map");
  EXPECT_EQ(Files(), (Names{"site.map", "site_2.map"}));
  EXPECT_EQ(Drive(), States{MapStatus::NEW_MAP});
  EXPECT_EQ(Files(), (Names{"site.map", "site_2.map", "site_3.map"}));
}

TEST_F(MapKeeperTest, TheMapOfAnotherCameraStays) {
  Drive();
  const std::string before = ReadWholeFile(options_.map_file);
  StereoCamera other = kCamera;
  other.baseline_m = 0.2;
  EXPECT_EQ(Drive(other), States{MapStatus::NEW_MAP});
  EXPECT_EQ(text_, options_.map_file +
                       ": it is of another camera: its baseline is 0.3, that of the camera now "
                       "0.2");
  EXPECT_EQ(ReadWholeFile(options_.map_file), before);
  EXPECT_TRUE(ReadMap(folder_ / "site_2.map").camera == other);
}

TEST_F(MapKeeperTest, AFileThatAnotherProgramHasWrittenMeanwhileStays) {
  MapKeeper keeper(options_, "map");
  PlacedMap map{GlobalMapOptions()};
  keeper.LoadFor(kCamera, map);
  for (int number = 0; number < 4; ++number) map.Add(MakeKeyframe(number, kCamera));
  keeper.Save(map);
  keeper.Save(map);
  EXPECT_EQ(Files(), Names{"site.map"});
  WriteWholeFile(options_.map_file, "another's");
  fs::last_write_time(options_.map_file, fs::file_time_type::max());
  keeper.Save(map);
  EXPECT_EQ(ReadWholeFile(options_.map_file), "another's");
  EXPECT_EQ(Files(), (Names{"site.map", "site_2.map"}));
}

TEST_F(MapKeeperTest, SavesWhatCameSinceWhenItIsTime) {
  options_.map_save_interval_s = 1e-9;
  MapKeeper keeper(options_, "map");
  PlacedMap map{GlobalMapOptions()};
  keeper.SaveIfDue(map);
  EXPECT_TRUE(Files().empty());
  keeper.LoadFor(kCamera, map);
  for (int number = 0; number < 4; ++number) map.Add(MakeKeyframe(number, kCamera));
  keeper.SaveIfDue(map);
  EXPECT_EQ(Files(), Names{"site.map"});
  fs::remove(options_.map_file);
  keeper.SaveIfDue(map);
  EXPECT_TRUE(Files().empty()) << "nothing came";
}

TEST_F(MapKeeperTest, NothingIsSavedWhereThereIsNothing) {
  const PlacedMap map{GlobalMapOptions()};
  EXPECT_THROW(MapKeeper(options_, "map").Save(map), std::invalid_argument);
  EXPECT_THROW(MapKeeper(MapKeeperOptions(), "map").Save(map), std::invalid_argument);
  options_.map_max_mb = 0.01;
  EXPECT_THROW(MapKeeper(options_, "map"), std::invalid_argument);
}

}  // namespace
}  // namespace arfm_vo
