/* What the C clients make of a maker's rotation matrix, against the matrix itself: q v must be where the matrix puts v, in
 * Torsion's axes. Compiled once for each client, -DCLIENT="touch.c" or "force_dimension.c". */
#define main client_main
#include CLIENT
#undef main

#include <stdlib.h>

/* The rotation by the unit quaternion x, y, z, w. */
static void rotate(const double *q, const double *v, double *out) {
  const double t[3] = {2.0 * (q[1] * v[2] - q[2] * v[1]), 2.0 * (q[2] * v[0] - q[0] * v[2]),
                       2.0 * (q[0] * v[1] - q[1] * v[0])};
  out[0] = v[0] + q[3] * t[0] + q[1] * t[2] - q[2] * t[1];
  out[1] = v[1] + q[3] * t[1] + q[2] * t[0] - q[0] * t[2];
  out[2] = v[2] + q[3] * t[2] + q[0] * t[1] - q[1] * t[0];
}

static double number(void) { return 2.0 * rand() / RAND_MAX - 1.0; }

int main(void) {
  double worst = 0.0;
  for (int i = 0; i < 20000; ++i) {
    /* A turn by less than 170 degrees about any axis, Rodrigues' formula. */
    double axis[3] = {number(), number(), number()}, m[3][3], q[4], v[3] = {number(), number(), number()}, turned[3] = {0};
    const double length = sqrt(axis[0] * axis[0] + axis[1] * axis[1] + axis[2] * axis[2]);
    const double angle = 2.9 * number(), c = cos(angle), s = sin(angle);
    for (int k = 0; k < 3; ++k) axis[k] /= length;
    for (int row = 0; row < 3; ++row) {
      for (int column = 0; column < 3; ++column) {
        m[row][column] = (row == column ? c : 0.0) + (1.0 - c) * axis[row] * axis[column];
      }
    }
    m[0][1] -= s * axis[2], m[1][0] += s * axis[2];
    m[0][2] += s * axis[1], m[2][0] -= s * axis[1];
    m[1][2] -= s * axis[0], m[2][1] += s * axis[0];
    for (int row = 0; row < 3; ++row) {
      for (int column = 0; column < 3; ++column) turned[row] += m[row][column] * v[column];
    }
    double seen[3], wanted[3], from[3];
#ifdef TORSION_STUB_HD_H_
    double columns[16] = {0};
    for (int row = 0; row < 3; ++row) {
      for (int column = 0; column < 3; ++column) columns[4 * column + row] = m[row][column];
    }
    columns[15] = 1.0;
    to_quaternion(columns, q);
    memcpy(from, v, sizeof from);
    memcpy(wanted, turned, sizeof wanted);
#else
    to_quaternion((const double(*)[3])m, q);
    to_torsion(v, from);
    to_torsion(turned, wanted);
#endif
    rotate(q, from, seen);
    for (int k = 0; k < 3; ++k) worst = fmax(worst, fabs(seen[k] - wanted[k]));
  }
  printf("rotations off by up to %.2g\n", worst);
  return worst < 1e-9 ? 0 : 1;
}
