#include "arfm_vo/features/box_hessian.h"

namespace arfm_vo {

BoxHessian ComputeBoxHessian(const IntegralImage& integral, int x, int y, int size) {
  const int lobe = size / 3, half = size / 2, side = lobe - 1, middle = lobe / 2;
  BoxHessian sums;
  sums.xx = integral.BoxSum(x - half, y - side, x + half + 1, y + side + 1) -
            3 * integral.BoxSum(x - middle, y - side, x + middle + 1, y + side + 1);
  sums.yy = integral.BoxSum(x - side, y - half, x + side + 1, y + half + 1) -
            3 * integral.BoxSum(x - side, y - middle, x + side + 1, y + middle + 1);
  sums.xy = integral.BoxSum(x - lobe, y - lobe, x, y) +
            integral.BoxSum(x + 1, y + 1, x + lobe + 1, y + lobe + 1) -
            integral.BoxSum(x + 1, y - lobe, x + lobe + 1, y) -
            integral.BoxSum(x - lobe, y + 1, x, y + lobe + 1);
  return sums;
}

}  // namespace arfm_vo
