#include "arfm_vo/geometry/kitti_poses.h"

#include <Eigen/LU>

#include "arfm_vo/base/check.h"
#include "arfm_vo/base/number_rows.h"

namespace arfm_vo {

std::vector<Rigid3> ReadKittiPoses(const std::string& path) {
  std::vector<Rigid3> poses;
  for (const NumberRow& row : ReadNumberRows(path, 12)) {
    using Matrix34 = Eigen::Matrix<double, 3, 4, Eigen::RowMajor>;
    const Matrix34 matrix = Eigen::Map<const Matrix34>(row.values.data());
    const Eigen::Matrix3d rotation = matrix.leftCols<3>();
    const double deviation =
        (rotation.transpose() * rotation - Eigen::Matrix3d::Identity()).cwiseAbs().maxCoeff();
    Require(deviation < 1e-3 && rotation.determinant() > 0,
            path + ":" + std::to_string(row.line) + ": the 3x3 part is not a rotation");
    poses.emplace_back(rotation, Eigen::Vector3d(matrix.col(3)));
  }
  return poses;
}

}  // namespace arfm_vo
