/* A Force Dimension omega, delta, sigma or lambda, or a Novint Falcon, for Torsion, through the maker's DHD library:
 *
 *   cc -O2 force_dimension.c -o force_dimension -ldhd -lm
 *   torsion view scenes/ball_on_cube_soft.gltf --device gateway &
 *   ./force_dimension
 *
 * Their axes: x towards the user, y to the right, z up. Compiled here against stubs only: it was not tried on a
 * device. */
#include <dhdc.h>
#include <math.h>
#include <stdio.h>

#include "torsion_gateway.h"

/* The device's (x, y, z) is Torsion's (z, x, y). */
static void to_torsion(const double *v, double *out) {
  out[0] = v[1];
  out[1] = v[2];
  out[2] = v[0];
}

static void to_device(const double *v, double *out) {
  out[0] = v[2];
  out[1] = v[0];
  out[2] = v[1];
}

/* Rotation vector to x, y, z, w, about axes of Torsion's. */
static void to_quaternion(const double m[3][3], double *q) {
  double vector[3], turned[3], sine, cosine, angle;
  vector[0] = 0.5 * (m[2][1] - m[1][2]);
  vector[1] = 0.5 * (m[0][2] - m[2][0]);
  vector[2] = 0.5 * (m[1][0] - m[0][1]);
  to_torsion(vector, turned);
  sine = sqrt(vector[0] * vector[0] + vector[1] * vector[1] + vector[2] * vector[2]);
  cosine = 0.5 * (m[0][0] + m[1][1] + m[2][2] - 1.0);
  angle = atan2(sine, cosine); /* a wrist turns by less than half a turn */
  for (int i = 0; i < 3; ++i) q[i] = sine > 1e-12 ? turned[i] / sine * sin(0.5 * angle) : 0.0;
  q[3] = cos(0.5 * angle);
}

int main(int count, char **words) {
  struct torsion_gateway gateway;
  struct torsion_sample sample;
  struct torsion_answer answer;
  int late = 0, wrist, active;
  if (dhdOpen() < 0) {
    fprintf(stderr, "No device: %s\n", dhdErrorGetLastStr());
    return 1;
  }
  if (torsion_gateway_open(&gateway, count, words) != 0) {
    dhdClose(-1);
    return 1;
  }
  wrist = dhdHasWrist(-1);
  active = dhdHasActiveWrist(-1);
  dhdEnableForce(DHD_ON, -1);
  printf("Bring the handle to the tool. q ends.\n");
  while (!dhdKbHit() || dhdKbGet() != 'q') {
    double at[3], moving[3], matrix[3][3] = {{1, 0, 0}, {0, 1, 0}, {0, 0, 1}}, force[3], torque[3];
    memset(&sample, 0, sizeof sample);
    dhdGetPositionAndOrientationFrame(&at[0], &at[1], &at[2], matrix, -1);
    dhdGetLinearVelocity(&moving[0], &moving[1], &moving[2], -1);
    to_torsion(at, sample.position);
    to_torsion(moving, sample.velocity);
    to_quaternion((const double(*)[3])matrix, sample.rotation);
    sample.buttons = (uint32_t)dhdGetButtonMask(-1);
    sample.sensed = TORSION_TRANSLATION | (wrist ? TORSION_ROTATION : 0);
    sample.actuated = TORSION_TRANSLATION | (active ? TORSION_ROTATION : 0);
    sample.period = 1e-3; /* what it reaches is measured; the rest is not published, so Torsion is cautious */
    late += torsion_gateway_exchange(&gateway, &sample, &answer) != 0;
    to_device(answer.force, force);
    to_device(answer.torque, torque);
    dhdSetForceAndTorqueAndGripperForce(force[0], force[1], force[2], torque[0], torque[1], torque[2], 0.0, -1);
  }
  dhdClose(-1);
  torsion_gateway_close(&gateway);
  printf("%d answers late\n", late);
  return 0;
}
