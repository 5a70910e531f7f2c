/* What examples/gateway/touch.c calls of OpenHaptics' HDAPI, as its reference manual declares it; to be compiled against
 * only. */
#ifndef TORSION_STUB_HD_H_
#define TORSION_STUB_HD_H_
typedef double HDdouble;
typedef int HDint;
typedef unsigned int HDenum;
typedef unsigned int HHD;
typedef unsigned int HDCallbackCode;
typedef unsigned long HDSchedulerHandle;
typedef unsigned short HDushort;
typedef unsigned int HDerror;
typedef struct {
  HDerror errorCode;
  int internalErrorCode;
  HHD hHD;
} HDErrorInfo;
#define HDCALLBACK
#define HD_DEFAULT_DEVICE 0
#define HD_CALLBACK_CONTINUE 1
#define HD_DEVICE_ERROR(e) ((e).errorCode != 0)
enum {
  HD_CURRENT_TRANSFORM, HD_CURRENT_VELOCITY, HD_CURRENT_BUTTONS, HD_CURRENT_FORCE, HD_NOMINAL_MAX_CONTINUOUS_FORCE,
  HD_NOMINAL_MAX_STIFFNESS, HD_FORCE_OUTPUT
};
#define HD_MAX_SCHEDULER_PRIORITY 65535
typedef HDCallbackCode(HDCALLBACK *HDSchedulerCallback)(void *data);
HHD hdInitDevice(const char *name);
HHD hdGetCurrentDevice(void);
HDErrorInfo hdGetError(void);
void hdBeginFrame(HHD device);
void hdEndFrame(HHD device);
void hdGetDoublev(HDenum name, HDdouble *values);
void hdGetIntegerv(HDenum name, HDint *values);
void hdSetDoublev(HDenum name, const HDdouble *values);
void hdEnable(HDenum capability);
HDSchedulerHandle hdScheduleAsynchronous(HDSchedulerCallback callback, void *data, HDushort priority);
void hdStartScheduler(void);
void hdStopScheduler(void);
void hdDisableDevice(HHD device);
#endif
