/* Torsion's gateway in C and C++: docs/gateway.md. One header, no library; POSIX sockets.
 *
 *   struct torsion_gateway gateway;
 *   if (torsion_gateway_open(&gateway, 7747) != 0) { perror("gateway"); }
 *   each time the handle was read: torsion_gateway_exchange(&gateway, &sample, &answer);
 *   then display answer.force and answer.torque. */
#ifndef TORSION_GATEWAY_H_
#define TORSION_GATEWAY_H_

#include <arpa/inet.h>
#include <netinet/in.h>
#include <stdint.h>
#include <string.h>
#include <sys/socket.h>
#include <sys/time.h>
#include <time.h>
#include <unistd.h>

enum { TORSION_TRANSLATION = 1, TORSION_ROTATION = 2, TORSION_TURN = 4 }; /* axes: sums of these */
enum torsion_state {
  TORSION_WAITING, TORSION_RISING, TORSION_LIVE, TORSION_FALLING, TORSION_SILENT, TORSION_REFUSED,
  TORSION_CHECKING, /* a small force to see whether the device goes where it is pushed: display it */
  TORSION_OFF       /* it went the other way: no force until the client begins anew */
};

/* As it is sent: little-endian machines only, no padding (every double is at a multiple of 8). */
struct torsion_sample {
  uint32_t magic;
  uint16_t version, kind;
  uint32_t session, sequence;
  double time;                        /* s, of this program */
  double position[3];                 /* m, from the middle of the workspace; +y up, +z towards the user */
  double rotation[4];                 /* x, y, z, w; unit */
  double velocity[3], turn_rate[3];   /* m/s, rad/s; zero where they are not known */
  uint32_t buttons, sensed, actuated, unused;
  double damping, turn_damping;       /* N s/m, N m s/rad: of the handle without motors. 0: not known, all below too */
  double mass, inertia;               /* kg, kg m^2 */
  double encoder_step, encoder_turn_step; /* m, rad: one count, at the handle */
  double period, delay;               /* s: between two samples; from a pose read to its force displayed, beyond that */
  double largest_force, largest_torque;   /* N, N m */
  double largest_stiffness, largest_turn_stiffness; /* N/m, N m/rad: as the maker says */
};

struct torsion_answer {
  uint32_t magic;
  uint16_t version, kind;
  uint32_t session, sequence, state, faults;
  double time;
  double force[3], torque[3];         /* N, N m: to display on the hand */
  double tool_position[3], tool_rotation[4];
};

struct torsion_gateway {
  int socket;
  uint32_t session, sequence;
};

#ifdef __cplusplus
static_assert(
#else
_Static_assert(
#endif
    sizeof(struct torsion_sample) == 240 && sizeof(struct torsion_answer) == 136, "packets have no padding");

/* -1 and errno where it cannot be. */
static inline int torsion_gateway_open(struct torsion_gateway *gateway, uint16_t port) {
  struct sockaddr_in to;
  struct timeval patience = {0, 5000}; /* 5 ms: then there is no force any more */
  memset(&to, 0, sizeof to);
  to.sin_family = AF_INET;
  to.sin_port = htons(port);
  to.sin_addr.s_addr = htonl(INADDR_LOOPBACK);
  gateway->session = (uint32_t)time(NULL) ^ ((uint32_t)getpid() << 16);
  gateway->sequence = 0;
  gateway->socket = socket(AF_INET, SOCK_DGRAM, 0);
  if (gateway->socket < 0) return -1;
  setsockopt(gateway->socket, SOL_SOCKET, SO_RCVTIMEO, &patience, sizeof patience);
  return connect(gateway->socket, (const struct sockaddr *)&to, sizeof to);
}

static inline void torsion_gateway_close(struct torsion_gateway *gateway) { close(gateway->socket); }

/* Sends a sample, whose head and time it fills in, and waits for its answer. 0: it came. Else -1, and an answer without
 * force: nothing came for 5 ms, or another client has the tool. */
static inline int torsion_gateway_exchange(struct torsion_gateway *gateway, struct torsion_sample *sample,
                                           struct torsion_answer *answer) {
  struct timespec now;
  clock_gettime(CLOCK_MONOTONIC, &now);
  sample->magic = 0x47524F54u;
  sample->version = 1;
  sample->kind = 1;
  sample->session = gateway->session;
  sample->sequence = ++gateway->sequence;
  sample->time = (double)now.tv_sec + 1e-9 * (double)now.tv_nsec;
  if (send(gateway->socket, sample, sizeof *sample, 0) == (ssize_t)sizeof *sample) {
    while (recv(gateway->socket, answer, sizeof *answer, 0) == (ssize_t)sizeof *answer) {
      if (answer->magic == sample->magic && answer->version == 1 && answer->kind == 2 &&
          answer->session == gateway->session && answer->sequence == gateway->sequence) {
        return answer->state == TORSION_SILENT || answer->state == TORSION_REFUSED ? -1 : 0;
      }
    }
  }
  memset(answer, 0, sizeof *answer);
  answer->state = TORSION_SILENT;
  return -1;
}

#endif /* TORSION_GATEWAY_H_ */
