/* What the CHAI3D client makes of a rotation matrix, against the matrix itself: q v must be where
 * the matrix puts v, in Torsion's axes. */
#define main client_main
#include "chai3d.cpp"
#undef main

#include <random>

int main() {
  std::mt19937 random(1);
  std::uniform_real_distribution<double> number(-1.0, 1.0);
  double worst = 0.0;
  for (int i = 0; i < 20000; ++i) {
    double axis[3] = {number(random), number(random), number(random)};
    const double length = std::sqrt(axis[0] * axis[0] + axis[1] * axis[1] + axis[2] * axis[2]);
    const double angle = 3.1 * number(random), c = std::cos(angle), s = std::sin(angle);
    for (double& part : axis)
      part /= length;
    /* Rodrigues' formula. */
    const double cross[3][3] = {
        {0.0, -axis[2], axis[1]}, {axis[2], 0.0, -axis[0]}, {-axis[1], axis[0], 0.0}};
    chai3d::cMatrix3d matrix;
    const double v[3] = {number(random), number(random), number(random)};
    double turned[3] = {0.0, 0.0, 0.0};
    for (int row = 0; row < 3; ++row) {
      for (int column = 0; column < 3; ++column) {
        matrix.m[row][column] = (row == column ? c : 0.0) + (1.0 - c) * axis[row] * axis[column] +
                                s * cross[row][column];
        turned[row] += matrix.m[row][column] * v[column];
      }
    }
    double q[4], from[3], wanted[3];
    to_quaternion(matrix, q);
    to_torsion(chai3d::cVector3d(v[0], v[1], v[2]), from);
    to_torsion(chai3d::cVector3d(turned[0], turned[1], turned[2]), wanted);
    const double t[3] = {2.0 * (q[1] * from[2] - q[2] * from[1]),
                         2.0 * (q[2] * from[0] - q[0] * from[2]),
                         2.0 * (q[0] * from[1] - q[1] * from[0])};
    const double seen[3] = {from[0] + q[3] * t[0] + q[1] * t[2] - q[2] * t[1],
                            from[1] + q[3] * t[1] + q[2] * t[0] - q[0] * t[2],
                            from[2] + q[3] * t[2] + q[0] * t[1] - q[1] * t[0]};
    for (int k = 0; k < 3; ++k)
      worst = std::max(worst, std::abs(seen[k] - wanted[k]));
  }
  std::printf("rotations off by up to %.2g\n", worst);
  return worst < 1e-9 ? 0 : 1;
}
