#include "arfm_vo/calibration/image_pairs.h"

#include <gmock/gmock.h>
#include <unistd.h>

#include <fstream>

#include "base/folder_test.h"
#include "base/refusal.h"

namespace arfm_vo {
namespace {

using testing::HasSubstr;

namespace fs = std::filesystem;

class ImagePairs : public FolderTest {
 protected:
  void Touch(const std::string& name) {
    fs::create_directories((folder_ / name).parent_path());
    std::ofstream(folder_ / name) << 'x';
  }
  std::string Message() {
    return RefusalOf([&] { FindImagePairs(folder_); });
  }
};

TEST_F(ImagePairs, FilesOfOneFolderPairByWhatFollowsTheCamera) {
  for (const char* name : {"left10.jpg", "right10.jpg", "left2.jpg", "right2.jpg", "left_info.yml"})
    Touch(name);
  const auto pairs = FindImagePairs(folder_);
  ASSERT_EQ(pairs.size(), 2U);
  EXPECT_EQ(pairs[0].name, "2");  // as a number, not as text
  EXPECT_EQ(pairs[0].left.filename(), "left2.jpg");
  EXPECT_EQ(pairs[1].right.filename(), "right10.jpg");
}

TEST_F(ImagePairs, SubFoldersPairByName) {
  for (const char* name : {"left/a_01.png", "left/a_02.PNG", "right/a_01.png", "right/a_02.png"})
    Touch(name);
  const auto pairs = FindImagePairs(folder_);
  ASSERT_EQ(pairs.size(), 2U);
  EXPECT_EQ(pairs[1].name, "a_02");
  EXPECT_EQ(pairs[1].left, folder_ / "left" / "a_02.PNG");
}

TEST_F(ImagePairs, SubFoldersWithNamesOfTheirOwnPairByTheLastNumber) {
  for (const char* name :
       {"left/Im_L_1.png", "left/Im_L_12.png", "right/Im_R_12.png", "right/Im_R_1.png"})
    Touch(name);
  const auto pairs = FindImagePairs(folder_);
  ASSERT_EQ(pairs.size(), 2U);
  EXPECT_EQ(pairs[1].right.filename(), "Im_R_12.png");
}

TEST_F(ImagePairs, AnUnequalNumberIsRefusedNamingTheLonelyFile) {
  for (const char* name : {"left1.png", "left2.png", "right1.png"}) Touch(name);
  EXPECT_THAT(Message(), HasSubstr("left2.png"));
  EXPECT_THAT(Message(), HasSubstr("2 left images, 1 right images"));
  fs::remove(folder_ / "left2.png");
  Touch("right7.png");
  EXPECT_THAT(Message(), HasSubstr("right7.png"));
}

TEST_F(ImagePairs, EmptyAndMissingFoldersAreRefusedByName) {
  EXPECT_THAT(Message(), HasSubstr(folder_.string()));
  fs::remove_all(folder_);
  EXPECT_THAT(Message(), HasSubstr("no folder"));
}

}  // namespace
}  // namespace arfm_vo
