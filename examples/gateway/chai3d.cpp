/* Whatever CHAI3D drives (its custom devices, too), for Torsion:
 *
 *   c++ -O2 chai3d.cpp -o chai3d_client $(pkg-config --cflags --libs chai3d)
 *   torsion view scenes/ball_on_cube_soft.gltf --device gateway &
 *   ./chai3d_client
 *
 * Its axes: x towards the user, y to the right, z up. Compiled here against a stub only: it was not
 * tried on a device. */
#include <chrono>
#include <csignal>
#include <cstdio>
#include <thread>

#include <chai3d.h>

#include "torsion_gateway.h"

namespace {

volatile std::sig_atomic_t ends = 0;

/* CHAI3D's (x, y, z) is Torsion's (z, x, y). */
void to_torsion(const chai3d::cVector3d& v, double* out) {
  out[0] = v.y();
  out[1] = v.z();
  out[2] = v.x();
}

chai3d::cVector3d to_chai(const double* v) {
  return chai3d::cVector3d(v[2], v[0], v[1]);
}

/* Unit quaternion x, y, z, w, about axes of Torsion's. */
void to_quaternion(const chai3d::cMatrix3d& matrix, double* q) {
  chai3d::cQuaternion turn;
  turn.fromRotMat(matrix);
  turn.normalize();
  q[0] = turn.y;
  q[1] = turn.z;
  q[2] = turn.x;
  q[3] = turn.w;
}

}  // namespace

int main(int count, char** words) {
  chai3d::cHapticDeviceHandler handler;
  chai3d::cGenericHapticDevicePtr device;
  if (!handler.getDevice(device, 0) || !device->open()) {
    std::fprintf(stderr, "No device.\n");
    return 1;
  }
  device->calibrate();
  torsion_gateway gateway;
  if (torsion_gateway_open(&gateway, count, words) != 0) {
    device->close();
    return 1;
  }
  const chai3d::cHapticDeviceInfo info = device->getSpecifications();
  std::signal(SIGINT, [](int) { ends = 1; });
  std::printf("Bring the handle to the tool. Ctrl-C ends.\n");
  int late = 0;
  auto next = std::chrono::steady_clock::now();
  while (ends == 0) {
    chai3d::cVector3d at, moving;
    chai3d::cMatrix3d turned;
    unsigned int buttons = 0;
    device->getPosition(at);
    device->getRotation(turned);
    device->getLinearVelocity(moving);
    device->getUserSwitches(buttons);
    torsion_sample sample = {};
    torsion_answer answer = {};
    to_torsion(at, sample.position);
    to_torsion(moving, sample.velocity);
    to_quaternion(turned, sample.rotation);
    sample.buttons = buttons;
    sample.sensed = static_cast<unsigned char>((info.m_sensedPosition ? TORSION_TRANSLATION : 0) |
                                               (info.m_sensedRotation ? TORSION_ROTATION : 0));
    sample.actuated =
        static_cast<unsigned char>((info.m_actuatedPosition ? TORSION_TRANSLATION : 0) |
                                   (info.m_actuatedRotation ? TORSION_ROTATION : 0));
    sample.period = 1e-3;
    sample.largest_force = info.m_maxLinearForce;
    sample.largest_torque = info.m_actuatedRotation ? info.m_maxAngularTorque : 0.0;
    sample.largest_stiffness = info.m_maxLinearStiffness;
    sample.largest_turn_stiffness = info.m_maxAngularStiffness;
    late += torsion_gateway_exchange(&gateway, &sample, &answer) != 0 ? 1 : 0;
    device->setForceAndTorqueAndGripperForce(to_chai(answer.force), to_chai(answer.torque), 0.0);
    next += std::chrono::milliseconds(1);
    std::this_thread::sleep_until(next);
  }
  device->close();
  torsion_gateway_close(&gateway);
  std::printf("%d answers late\n", late);
  return 0;
}
