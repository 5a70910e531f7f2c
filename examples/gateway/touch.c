/* A 3D Systems Touch (or Touch X, Omni) for Torsion, through OpenHaptics' HDAPI:
 *
 *   cc -O2 touch.c -o touch -lHD
 *   torsion view scenes/ball_on_cube_soft.gltf --device gateway &
 *   ./touch
 *
 * Its stylus senses six axes and pushes on three. Millimetres and the transform are as HDAPI has them: y up, z towards
 * the user, columns one after another. Compiled here against stubs only: it was not tried on a device. */
#include <HD/hd.h>
#include <math.h>
#include <stdio.h>

#include "torsion_gateway.h"

static struct torsion_gateway gateway;
static int late;

/* Rotation matrix, columns one after another, to x, y, z, w. */
static void to_quaternion(const double *m, double *q) {
  const double trace = m[0] + m[5] + m[10];
  int i = 0, j, k;
  double s;
  if (trace > 0.0) {
    s = 2.0 * sqrt(trace + 1.0);
    q[3] = 0.25 * s;
    q[0] = (m[6] - m[9]) / s;
    q[1] = (m[8] - m[2]) / s;
    q[2] = (m[1] - m[4]) / s;
    return;
  }
  if (m[5] > m[0]) i = 1;
  if (m[10] > m[5 * i]) i = 2;
  j = (i + 1) % 3;
  k = (i + 2) % 3;
  s = 2.0 * sqrt(1.0 + m[5 * i] - m[5 * j] - m[5 * k]);
  q[i] = 0.25 * s;
  q[3] = (m[4 * j + k] - m[4 * k + j]) / s;
  q[j] = (m[4 * i + j] + m[4 * j + i]) / s;
  q[k] = (m[4 * i + k] + m[4 * k + i]) / s;
}

static HDCallbackCode HDCALLBACK servo(void *unused) {
  HDdouble transform[16], velocity[3], force[3];
  HDint buttons = 0;
  struct torsion_sample sample;
  struct torsion_answer answer;
  int i;
  (void)unused;
  memset(&sample, 0, sizeof sample);
  hdBeginFrame(hdGetCurrentDevice());
  hdGetDoublev(HD_CURRENT_TRANSFORM, transform);
  hdGetDoublev(HD_CURRENT_VELOCITY, velocity);
  hdGetIntegerv(HD_CURRENT_BUTTONS, &buttons);
  for (i = 0; i < 3; ++i) {
    sample.position[i] = 1e-3 * transform[12 + i];
    sample.velocity[i] = 1e-3 * velocity[i];
  }
  to_quaternion(transform, sample.rotation);
  sample.buttons = (uint32_t)buttons;
  sample.sensed = TORSION_TRANSLATION | TORSION_ROTATION;
  sample.actuated = TORSION_TRANSLATION;
  sample.encoder_step = 5.5e-5; /* 450 dpi, as the maker says; damping and mass are not published: left at 0 */
  sample.period = 1e-3;
  hdGetDoublev(HD_NOMINAL_MAX_CONTINUOUS_FORCE, &sample.largest_force);
  hdGetDoublev(HD_NOMINAL_MAX_STIFFNESS, &sample.largest_stiffness);
  sample.largest_stiffness *= 1e3; /* N/mm */
  late += torsion_gateway_exchange(&gateway, &sample, &answer) != 0;
  for (i = 0; i < 3; ++i) force[i] = answer.force[i]; /* zero where nothing came */
  hdSetDoublev(HD_CURRENT_FORCE, force);
  hdEndFrame(hdGetCurrentDevice());
  return HD_CALLBACK_CONTINUE;
}

int main(int count, char **words) {
  const HHD device = hdInitDevice(HD_DEFAULT_DEVICE);
  HDErrorInfo error = hdGetError();
  if (HD_DEVICE_ERROR(error)) {
    fprintf(stderr, "No device: is it plugged in, and set up by Touch Setup?\n");
    return 1;
  }
  if (torsion_gateway_open(&gateway, count, words) != 0) return 1;
  hdEnable(HD_FORCE_OUTPUT);
  hdScheduleAsynchronous(servo, NULL, HD_MAX_SCHEDULER_PRIORITY);
  hdStartScheduler();
  printf("Bring the stylus to the tool. Enter ends.\n");
  getchar();
  hdStopScheduler();
  hdDisableDevice(device);
  torsion_gateway_close(&gateway);
  printf("%d answers late\n", late);
  return 0;
}
