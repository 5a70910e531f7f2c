/* What examples/gateway/chai3d.cpp calls of CHAI3D 3.x, as its documentation declares it: a device
 * that goes down (-z) by 4 mm within a second. x towards the user, y to the right, z up. */
#ifndef TORSION_STUB_CHAI3D_H_
#define TORSION_STUB_CHAI3D_H_

#include <algorithm>
#include <cmath>
#include <csignal>
#include <cstdio>
#include <memory>

namespace chai3d {

class cVector3d {
 public:
  cVector3d(double x = 0.0, double y = 0.0, double z = 0.0) : m_{x, y, z} {}
  double x() const { return m_[0]; }
  double y() const { return m_[1]; }
  double z() const { return m_[2]; }

 private:
  double m_[3];
};

/* Rows and columns as the maker has them. */
class cMatrix3d {
 public:
  double m[3][3] = {{1.0, 0.0, 0.0}, {0.0, 1.0, 0.0}, {0.0, 0.0, 1.0}};
};

class cQuaternion {
 public:
  double w = 1.0, x = 0.0, y = 0.0, z = 0.0;
  /* Shepperd's method, of the largest of the four. */
  void fromRotMat(const cMatrix3d& matrix) {
    const auto& m = matrix.m;
    const double squares[4] = {1.0 + m[0][0] + m[1][1] + m[2][2], 1.0 + m[0][0] - m[1][1] - m[2][2],
                               1.0 - m[0][0] + m[1][1] - m[2][2],
                               1.0 - m[0][0] - m[1][1] + m[2][2]};
    const auto largest = std::max_element(squares, squares + 4) - squares;
    const double twice = std::sqrt(squares[largest]), part = 0.5 / twice;
    const double a = m[2][1] - m[1][2], b = m[0][2] - m[2][0], c = m[1][0] - m[0][1];
    const double xy = m[0][1] + m[1][0], xz = m[0][2] + m[2][0], yz = m[1][2] + m[2][1];
    const double all[4][4] = {{0.5 * twice, a * part, b * part, c * part},
                              {a * part, 0.5 * twice, xy * part, xz * part},
                              {b * part, xy * part, 0.5 * twice, yz * part},
                              {c * part, xz * part, yz * part, 0.5 * twice}};
    w = all[largest][0], x = all[largest][1], y = all[largest][2], z = all[largest][3];
  }
  void normalize() {
    const double length = std::sqrt(w * w + x * x + y * y + z * z);
    w /= length, x /= length, y /= length, z /= length;
  }
};

struct cHapticDeviceInfo {
  double m_maxLinearForce = 8.0, m_maxAngularTorque = 0.0;
  double m_maxLinearStiffness = 3000.0, m_maxAngularStiffness = 0.0;
  bool m_sensedPosition = true, m_sensedRotation = true;
  bool m_actuatedPosition = true, m_actuatedRotation = false;
};

class cGenericHapticDevice {
 public:
  bool open() { return true; }
  bool calibrate() { return true; }
  bool close() {
    std::printf("force %.4f %.4f %.4f up to %.4f\n", last_.x(), last_.y(), last_.z(), highest_);
    return true;
  }
  cHapticDeviceInfo getSpecifications() { return {}; }
  bool getPosition(cVector3d& at) {
    if (++frames_ == 3000)
      std::raise(SIGINT);
    at = cVector3d(0.0, 0.0, -0.004 * share());
    return true;
  }
  bool getRotation(cMatrix3d& turned) { return turned = cMatrix3d(), true; }
  bool getLinearVelocity(cVector3d& moving) {
    moving = cVector3d(0.0, 0.0, share() > 0.0 && share() < 1.0 ? -0.004 : 0.0);
    return true;
  }
  bool getUserSwitches(unsigned int& buttons) { return buttons = 0, true; }
  bool setForceAndTorqueAndGripperForce(const cVector3d& force, const cVector3d&, double) {
    last_ = force;
    highest_ = std::max(highest_, force.z());
    return true;
  }

 private:
  double share() const { return std::clamp((frames_ - 500) / 1000.0, 0.0, 1.0); }
  int frames_ = 0;
  cVector3d last_;
  double highest_ = 0.0;
};
using cGenericHapticDevicePtr = std::shared_ptr<cGenericHapticDevice>;

class cHapticDeviceHandler {
 public:
  bool getDevice(cGenericHapticDevicePtr& device, unsigned int = 0) {
    device = std::make_shared<cGenericHapticDevice>();
    return true;
  }
};

}  // namespace chai3d

#endif
