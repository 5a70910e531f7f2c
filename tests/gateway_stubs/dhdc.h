/* What examples/gateway/force_dimension.c calls of Force Dimension's DHD, as its documentation declares it; to be compiled
 * against only. */
#ifndef TORSION_STUB_DHDC_H_
#define TORSION_STUB_DHDC_H_
#define DHD_ON 1
int dhdOpen(void);
int dhdClose(char ID);
const char *dhdErrorGetLastStr(void);
int dhdHasWrist(char ID);
int dhdHasActiveWrist(char ID);
int dhdEnableForce(unsigned char on, char ID);
int dhdKbHit(void);
char dhdKbGet(void);
int dhdGetPositionAndOrientationFrame(double *x, double *y, double *z, double matrix[3][3], char ID);
int dhdGetLinearVelocity(double *x, double *y, double *z, char ID);
unsigned int dhdGetButtonMask(char ID);
int dhdSetForceAndTorqueAndGripperForce(double fx, double fy, double fz, double tx, double ty, double tz, double gripper,
                                        char ID);
#endif
