#include "arfm_vo/geometry/kitti_poses.h"

#include <gtest/gtest.h>

#include "arfm_vo/base/whole_file.h"
#include "base/folder_test.h"
#include "base/refusal.h"

namespace arfm_vo {
namespace {

class KittiPosesTest : public FolderTest {
 protected:
  std::string ErrorOf(const std::string& text) {
    WriteWholeFile(path_, text);
    return RefusalBehind(path_, [&] { ReadKittiPoses(path_); });
  }
  const std::string path_ = folder_ / "test.txt";
};

TEST_F(KittiPosesTest, ReadsTheRowsOfRotationAndTranslation) {
  WriteWholeFile(path_, "1 0 0 7 0 1 0 8 0 0 1 9\n0 -1 0 1 1 0 0 2 0 0 1 3\n");
  const auto poses = ReadKittiPoses(path_);
  ASSERT_EQ(poses.size(), 2u);
  EXPECT_EQ(poses[0].translation, Eigen::Vector3d(7, 8, 9));
  EXPECT_LT((poses[1] * Eigen::Vector3d(1, 0, 0) - Eigen::Vector3d(1, 3, 3)).norm(), 1e-12);
}

TEST_F(KittiPosesTest, NamesTheLineThatIsNoPose) {
  EXPECT_EQ(ErrorOf("1 0 0 7 0 1 0 8 0 0 1 9\n1 0 0 7 0 1.01 0 8 0 0 1 9\n"),
            ":2: the 3x3 part is not a rotation");
  EXPECT_EQ(ErrorOf("1 0 0 7 0 1 0 8 0 0 -1 9\n"), ":1: the 3x3 part is not a rotation");
  EXPECT_EQ(ErrorOf("1 0 0 nan 0 1 0 8 0 0 1 9\n"), ":1: 'nan' is not finite");
}

}  // namespace
}  // namespace arfm_vo
