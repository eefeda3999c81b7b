#include <arfm_vo/OdometryStatus.h>
#include <ros/callback_queue.h>
#include <ros/ros.h>

#include <sstream>
#include <stdexcept>

#include "arfm_vo/base/whole_file.h"
#include "arfm_vo/calibration/rectification.h"
#include "arfm_vo/configuration/program.h"
#include "arfm_vo/ros/replay/bag_sequence.h"
#include "hardware/loopback_writer.h"
#include "image/image_noise.h"

namespace {

using namespace arfm_vo;

struct Playing {
  std::string bag, folder, left = "/dev/video10", right = "/dev/video11";
  double rate_hz = 1;
  int num_pairs = 12;
  double timeout_s = 300;
};

/// The calibration as camera_info_manager reads it: the pictures are rectified already.
void WriteCalibration(const std::string& folder, const StereoCamera& camera) {
  const cv::Matx33d matrix(camera.fx, 0, camera.cx, 0, camera.fy, camera.cy, 0, 0, 1);
  for (const bool is_right : {false, true}) {
    const double tx = is_right ? -camera.fx * camera.baseline_m : 0;
    const cv::Matx34d projection(camera.fx, 0, camera.cx, tx, 0, camera.fy, camera.cy, 0, 0, 0, 1,
                                 0);
    const std::string name = is_right ? "right" : "left";
    WriteWholeFile(folder + "/" + name + ".yaml",
                   FormatCameraInfo(name, {camera.width, camera.height},
                                    {matrix, cv::Mat::zeros(1, 5, CV_64FC1)},
                                    {cv::Matx33d::eye(), projection}));
  }
}

std::string FormatPose(const Rigid3& pose) {
  const Eigen::Vector3d& t = pose.translation;
  std::ostringstream text;
  text << "true_end_m: " << t.x() << " " << t.y() << " " << t.z() << "\n";
  return text.str();
}

/// Two cameras that go on to the next pair when the odometry knows the pose of the last.
class Player {
 public:
  Player(const Playing& playing, const StereoCamera& camera)
      : playing_(playing),
        left_(playing.left, camera.width, camera.height),
        right_(playing.right, camera.width, camera.height),
        status_(ros::NodeHandle().subscribe("status", 10, &Player::TakeStatus, this)) {}

  /// Shows the pair again and again, with other noise each time as a camera does, until a picture
  /// told its pose.
  void Show(const StereoImages& images) {
    const ros::WallTime start = ros::WallTime::now();
    for (ros::WallTime next = start; answered_.toSec() < start.toSec();) {
      if (!ros::ok() || (ros::WallTime::now() - start).toSec() > playing_.timeout_s)
        throw std::runtime_error("no pose of the pair shown " + std::to_string(playing_.timeout_s) +
                                 " s ago");
      if (ros::WallTime::now() >= next) {
        left_.Write(Noisy(images.left));
        right_.Write(Noisy(images.right));
        next = ros::WallTime::now() + ros::WallDuration(1 / playing_.rate_hz);
      }
      ros::getGlobalCallbackQueue()->callAvailable(next - ros::WallTime::now());
    }
  }

 private:
  void TakeStatus(const OdometryStatus& status) {
    if (status.num_inliers > 0) answered_ = status.header.stamp;
  }
  cv::Mat Noisy(const cv::Mat& image) {
    cv::Mat noisy = image.clone();
    AddNoise(noisy, 1, random_);
    return noisy;
  }

  const Playing playing_;
  LoopbackWriter left_, right_;
  ros::Time answered_;
  cv::RNG random_;
  ros::Subscriber status_;
};

void Play(const Playing& playing) {
  PairSelection selection;
  selection.max_pairs = playing.num_pairs;
  BagSequence sequence(playing.bag, {}, selection);
  Player player(playing, sequence.camera());
  WriteCalibration(playing.folder, sequence.camera());
  Rigid3 first, last;
  for (int number = 0; auto pair = sequence.Next(); ++number) {
    if (!pair->true_world_from_camera) throw std::invalid_argument(playing.bag + ": has no truth");
    last = *pair->true_world_from_camera;
    if (number == 0) first = last;
    player.Show(pair->images);
    ROS_INFO("pair %d has its pose", number);
  }
  WriteWholeFile(playing.folder + "/truth.txt", FormatPose(first.Inverse() * last));
}

}  // namespace

int main(int argc, char** argv) {
  Playing playing;
  Program program;
  program.name = "loopback_player";
  program.description =
      "Shows the pairs of a bag with ground truth on two v4l2loopback cameras, each until its "
      "pose\n"
      "is known (topic status). FOLDER takes the calibration (left.yaml, right.yaml) at "
      "the\n"
      "start and truth.txt at the end.";
  program.inputs = {{"BAG", &playing.bag}, {"FOLDER", &playing.folder}};
  program.Add("rate", playing.rate_hz, "HZ", "how often a pair is shown");
  program.Add("pairs", playing.num_pairs, "N", "at most");
  program.Add("timeout", playing.timeout_s, "S", "for one pair");
  program.run = [&] { Play(playing); };
  ros::init(argc, argv, "loopback_player");
  return RunProgram(argc, argv, program);
}
