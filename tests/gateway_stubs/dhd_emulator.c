/* A handle that goes down (-z) by 4 mm within a second, behind DHD's calls: x towards the user, y to the right, z up. */
#include <dhdc.h>
#include <math.h>
#include <stdio.h>
#include <time.h>

static int frames;
static double last[3], highest;

static double share(void) {
  const double s = (frames - 500) / 1000.0;
  return s < 0.0 ? 0.0 : s > 1.0 ? 1.0 : s;
}

int dhdOpen(void) { return 0; }
int dhdClose(char ID) {
  (void)ID;
  printf("force %.4f %.4f %.4f up to %.4f\n", last[0], last[1], last[2], highest);
  return 0;
}
const char *dhdErrorGetLastStr(void) { return "none"; }
int dhdHasWrist(char ID) { return (void)ID, 1; }
int dhdHasActiveWrist(char ID) { return (void)ID, 0; }
int dhdEnableForce(unsigned char on, char ID) { return (void)ID, on == DHD_ON ? 0 : -1; }
int dhdKbHit(void) {
  const struct timespec millisecond = {0, 1000000};
  nanosleep(&millisecond, NULL);
  return ++frames > 3000;
}
char dhdKbGet(void) { return 'q'; }
int dhdGetPositionAndOrientationFrame(double *x, double *y, double *z, double matrix[3][3], char ID) {
  (void)ID;
  *x = *y = 0.0;
  *z = -0.004 * share();
  for (int i = 0; i < 9; ++i) matrix[i / 3][i % 3] = i % 4 == 0 ? 1.0 : 0.0;
  return 0;
}
int dhdGetLinearVelocity(double *x, double *y, double *z, char ID) {
  (void)ID;
  *x = *y = 0.0;
  *z = share() > 0.0 && share() < 1.0 ? -0.004 : 0.0;
  return 0;
}
unsigned int dhdGetButtonMask(char ID) { return (void)ID, 0u; }
int dhdSetForceAndTorqueAndGripperForce(double fx, double fy, double fz, double tx, double ty, double tz, double gripper,
                                        char ID) {
  (void)tx, (void)ty, (void)tz, (void)gripper, (void)ID;
  last[0] = fx, last[1] = fy, last[2] = fz;
  highest = fz > highest ? fz : highest;
  return 0;
}
