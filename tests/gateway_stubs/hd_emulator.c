/* A stylus that goes down by 4 mm within a second and stays, behind OpenHaptics' calls: what is set as its force comes out
 * as a line of numbers at the end. */
#include <HD/hd.h>
#include <stdio.h>
#include <string.h>
#include <time.h>

static HDSchedulerCallback scheduled;
static double now, last_force[3], highest;
static int enabled;

HHD hdInitDevice(const char *name) {
  (void)name;
  return 1;
}
HHD hdGetCurrentDevice(void) { return 1; }
HDErrorInfo hdGetError(void) {
  const HDErrorInfo none = {0, 0, 1};
  return none;
}
void hdBeginFrame(HHD device) { (void)device; }
void hdEndFrame(HHD device) { (void)device; }
void hdGetDoublev(HDenum name, HDdouble *values) {
  const double share = now < 0.5 ? 0.0 : now > 1.5 ? 1.0 : now - 0.5;
  if (name == HD_CURRENT_TRANSFORM) { /* mm, columns one after another */
    const double identity[16] = {1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1};
    memcpy(values, identity, sizeof identity);
    values[13] = -4.0 * share;
  } else if (name == HD_CURRENT_VELOCITY) {
    values[0] = values[2] = 0.0;
    values[1] = now > 0.5 && now < 1.5 ? -4.0 : 0.0;
  } else if (name == HD_NOMINAL_MAX_CONTINUOUS_FORCE) {
    values[0] = 0.88;
  } else if (name == HD_NOMINAL_MAX_STIFFNESS) {
    values[0] = 0.5; /* N/mm */
  }
}
void hdGetIntegerv(HDenum name, HDint *values) {
  (void)name;
  values[0] = 0;
}
void hdSetDoublev(HDenum name, const HDdouble *values) {
  if (name == HD_CURRENT_FORCE && enabled) {
    memcpy(last_force, values, sizeof last_force);
    highest = values[1] > highest ? values[1] : highest;
  }
}
void hdEnable(HDenum capability) { enabled = capability == HD_FORCE_OUTPUT; }
HDSchedulerHandle hdScheduleAsynchronous(HDSchedulerCallback callback, void *data, HDushort priority) {
  (void)data;
  (void)priority;
  scheduled = callback;
  return 1;
}
void hdStartScheduler(void) {
  const struct timespec millisecond = {0, 1000000};
  for (; now < 3.0; now += 1e-3) {
    scheduled(NULL);
    nanosleep(&millisecond, NULL);
  }
}
void hdStopScheduler(void) { printf("force %.4f %.4f %.4f up to %.4f\n", last_force[0], last_force[1], last_force[2], highest); }
void hdDisableDevice(HHD device) { (void)device; }
