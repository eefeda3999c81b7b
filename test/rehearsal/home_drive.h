#pragma once

#include <cmath>
#include <functional>
#include <optional>
#include <string>

#include "arfm_vo/driving/way_home.h"
#include "arfm_vo/hardware/chassis_driver.h"
#include "arfm_vo/mapping/map_file.h"
#include "arfm_vo/simulation/simulated_chassis.h"
#include "driving/attend.h"
#include "mapping/odometry_chain.h"
#include "rehearsal/goal_scene.h"
#include "rehearsal/simulated_sight.h"
#include "simulation/can_memory_bus.h"

namespace arfm_vo {

/// A rover on simulated ground that is switched off and on: what lasts is where it stands, and the
/// bytes of its map's file.
class LastingRover {
 public:
  LastingRover(const GoalScene& scene, double forward_slip, int seed)
      : ground_(scene.Ground()),
        map_from_world_(ground_(scene.start()).Inverse()),
        renderer_(scene.terrain(), SimulatedSightOptions().render),
        chassis_(bus_.OpenEnd(),
                 TrackedPlant(Slipping(forward_slip, seed), scene.start(), ground_)) {}

  /// Wakes up, and drives along what `plan` makes of the path of this drive and those that it was
  /// found to go on, and of where the rover believes to stand. Says what became of it.
  using Plan = std::function<Route(const std::vector<RoverPose>& path, const RoverPose& rover)>;
  std::string Drive(const Plan& plan) {
    ChassisDriver driver(PilotOptions(), bus_.OpenEnd());
    OdometryChain chain(StereoRigOptions().Camera(), BaseFromLeftCamera({}));
    const bool has_map = !file_.empty();
    chain.map().Keep(has_map ? ParseMap(file_, "map") : KnownMap(), kMaxPoints);
    const double begin_s = Now(), limit_s = begin_s + kMaxSeconds;
    std::string outcome;
    for (bool is_started = false; outcome.empty() && Now() < limit_s; ++num_steps_) {
      chassis_.Tick(Now());
      if (num_steps_ % kStepsAPair == 0) Look(chain, driver.pilot());
      Attend(driver.pilot().operator_watch(), Now());
      if (num_steps_ % 2 == 0) driver.Tick(Now());
      const bool is_found = chain.map().localiser().state() == MapState::kLocalised;
      if (!is_started && Now() > begin_s + 3 && (is_found || !has_map)) {
        is_started = true;
        driver.pilot().Start(Now());
        std::vector<RoverPose> path;
        for (const MapPose& pose : chain.map().BasePoses())
          path.push_back(ProjectToPlane(pose.map_from_base));
        const Reply reply = driver.pilot().SetRoute(plan(path, believed_));
        if (!reply.is_accepted) outcome = reply.text;
      }
      for (const GoalResult& result : driver.pilot().TakeResults())
        outcome = ToString(result.outcome);
    }
    chain.map().Adjust();
    file_ = FormatMap(chain.map().MakeKnownMap(), 200000000);
    return outcome.empty() ? "not there in time" : outcome;
  }

  /// Where it truly stands, in the first drive's map.
  RoverPose Truth() const {
    return ProjectToPlane(map_from_world_ * chassis_.plant().WorldFromBase());
  }

 private:
  static constexpr int kStepsAPair = 75;
  static constexpr double kMaxSeconds = 1200;

  static TrackedPlantOptions Slipping(double forward_slip, int seed) {
    TrackedPlantOptions options;
    options.forward_slip = forward_slip;
    options.seed = seed;
    return options;
  }
  double Now() const { return 0.01 * static_cast<double>(num_steps_); }

  void Look(OdometryChain& chain, Pilot& pilot) {
    const Rigid3 world_from_camera = chassis_.plant().WorldFromBase() * BaseFromLeftCamera({});
    const int pair = static_cast<int>(num_steps_ / kStepsAPair);
    const SessionUpdate update = chain.Process(
        renderer_.RenderPair(StereoRigOptions().Camera(), world_from_camera, pair, Now()));
    pilot.ObserveEpoch(update.epoch, Now());
    const Matrix6& covariance = update.covariance;
    pilot.ObserveUncertainty(Now(), {Now(), std::sqrt(covariance.topLeftCorner<2, 2>().trace()),
                                     std::sqrt(covariance(5, 5))});
    if (!update.update.pose.IsMeasured()) return;
    pilot.ObservePose(Now(), {Now(), update.odom_from_base, chain.map().map_from_odom()});
    believed_ = ProjectToPlane(chain.map().map_from_odom() * update.odom_from_base);
  }

  PlaceOnGround ground_;
  Rigid3 map_from_world_;
  TerrainRenderer renderer_;
  CanMemoryBus bus_;
  SimulatedChassis chassis_;
  RoverPose believed_;
  std::string file_;
  long num_steps_ = 0;
};

/// Out to the scene's goal, off, on, home: how far from its start the rover ends, m; nothing where
/// it does not arrive.
inline std::optional<double> DriveOutAndHome(const GoalScene& scene, double slip, int seed) {
  LastingRover rover(scene, slip, seed);
  const std::string out =
      rover.Drive([&](const auto&, const auto&) { return Route{scene.GoalInMap()}; });
  const std::string home = rover.Drive(FindWayHome);
  std::printf("out %s, home %s\n", out.c_str(), home.c_str());
  if (out != "arrived" || home != "arrived") return std::nullopt;
  return std::hypot(rover.Truth().x_m, rover.Truth().y_m);
}

}  // namespace arfm_vo
