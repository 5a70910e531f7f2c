/* Torsion's gateway in C and C++: docs/gateway.md. One header, no library; POSIX sockets. With TORSION_GATEWAY_NETWORK
 * defined, for Torsion on another machine, too: that needs libsodium (-lsodium).
 *
 *   struct torsion_gateway gateway;
 *   if (torsion_gateway_open(&gateway, argc, argv) != 0) return 1;
 *   each time the handle was read: torsion_gateway_exchange(&gateway, &sample, &answer);
 *   then display answer.force and answer.torque. */
#ifndef TORSION_GATEWAY_H_
#define TORSION_GATEWAY_H_

#include <netdb.h>
#include <stdint.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/socket.h>
#include <sys/time.h>
#include <time.h>
#include <unistd.h>
#ifdef TORSION_GATEWAY_NETWORK
#include <sodium.h>
#endif

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

struct torsion_challenge {
  uint32_t magic;
  uint16_t version, kind;
  uint32_t session, sequence;
  uint8_t nonce[16];
};

struct torsion_gateway {
  int socket;
  uint32_t session, sequence;
  double round_trip;                  /* s: from a sample to its answer, in the mean; 0 before the first */
  uint8_t secret[256], nonce[16];
  size_t secret_size;                 /* 0: Torsion is on this machine and has none */
};

#ifdef __cplusplus
static_assert(
#else
_Static_assert(
#endif
    sizeof(struct torsion_sample) == 240 && sizeof(struct torsion_answer) == 136 && sizeof(struct torsion_challenge) == 32,
    "packets have no padding");

enum { TORSION_TAG = 16, TORSION_LONGEST = sizeof(struct torsion_sample) + TORSION_TAG };

static inline double torsion_gateway_clock(void) {
  struct timespec now;
  clock_gettime(CLOCK_MONOTONIC, &now);
  return (double)now.tv_sec + 1e-9 * (double)now.tv_nsec;
}

/* -1, and why on stderr, where it cannot be. */
static inline int torsion_gateway_connect(struct torsion_gateway *gateway, const char *host, const char *port) {
  struct timeval patience = {0, 5000}; /* 5 ms: then there is no force any more */
  struct addrinfo wanted, *found;
  int failed;
  memset(gateway, 0, sizeof *gateway);
  memset(&wanted, 0, sizeof wanted);
  wanted.ai_socktype = SOCK_DGRAM;
  failed = getaddrinfo(host, port, &wanted, &found);
  if (failed) {
    fprintf(stderr, "%s port %s: %s\n", host, port, gai_strerror(failed));
    return -1;
  }
  gateway->session = (uint32_t)(1e6 * torsion_gateway_clock()) ^ ((uint32_t)time(NULL) << 8) ^ ((uint32_t)getpid() << 16);
  gateway->socket = socket(found->ai_family, SOCK_DGRAM, 0);
  failed = gateway->socket < 0 || connect(gateway->socket, found->ai_addr, found->ai_addrlen) != 0;
  freeaddrinfo(found);
  if (failed) {
    perror(host);
    return -1;
  }
  return setsockopt(gateway->socket, SOL_SOCKET, SO_RCVTIMEO, &patience, sizeof patience);
}

/* What a program of its own is called with: nothing, or PORT of this machine, or HOST PORT SECRET_FILE, where SECRET_FILE
 * is a copy of what Torsion was given as --gateway-secret. -1, and why on stderr, where it cannot be. */
static inline int torsion_gateway_open(struct torsion_gateway *gateway, int count, char **words) {
  if (count <= 2) return torsion_gateway_connect(gateway, "127.0.0.1", count == 2 ? words[1] : "7747");
#ifdef TORSION_GATEWAY_NETWORK
  if (count == 4) {
    char text[256];
    FILE *file = fopen(words[3], "r");
    size_t size = file ? fread(text, 1, sizeof text, file) : 0, from = 0;
    if (file) fclose(file);
    while (size > 0 && strchr(" \t\r\n", text[size - 1])) --size;
    while (from < size && strchr(" \t\r\n", text[from])) ++from;
    if (size == from || size == sizeof text || sodium_init() < 0) {
      fprintf(stderr, "%s: no secret that Torsion takes\n", words[3]);
      return -1;
    }
    if (torsion_gateway_connect(gateway, words[1], words[2]) != 0) return -1;
    gateway->secret_size = size - from;
    memcpy(gateway->secret, text + from, gateway->secret_size);
    randombytes_buf(&gateway->session, sizeof gateway->session);
    return 0;
  }
  fprintf(stderr, "usage: %s [PORT | HOST PORT SECRET_FILE]\n", words[0]);
#else
  fprintf(stderr, "usage: %s [PORT]; for another machine build it with -DTORSION_GATEWAY_NETWORK -lsodium\n", words[0]);
#endif
  return -1;
}

static inline void torsion_gateway_close(struct torsion_gateway *gateway) { close(gateway->socket); }

/* The tag of a packet: who has no secret cannot make it. */
static inline void torsion_gateway_tag(const struct torsion_gateway *gateway, const uint8_t *packet, size_t size,
                                       const uint8_t *nonce, uint8_t *tag) {
#ifdef TORSION_GATEWAY_NETWORK
  uint8_t whole[crypto_auth_hmacsha256_BYTES];
  crypto_auth_hmacsha256_state state;
  crypto_auth_hmacsha256_init(&state, gateway->secret, gateway->secret_size);
  crypto_auth_hmacsha256_update(&state, nonce, sizeof gateway->nonce);
  crypto_auth_hmacsha256_update(&state, packet, size);
  crypto_auth_hmacsha256_final(&state, whole);
  memcpy(tag, whole, TORSION_TAG);
#else
  (void)gateway, (void)packet, (void)size, (void)nonce, (void)tag;
#endif
}

static inline int torsion_gateway_send(const struct torsion_gateway *gateway, const struct torsion_sample *sample) {
  uint8_t bytes[TORSION_LONGEST];
  const size_t size = sizeof *sample + (gateway->secret_size > 0 ? TORSION_TAG : 0);
  memcpy(bytes, sample, sizeof *sample);
  if (gateway->secret_size > 0) torsion_gateway_tag(gateway, bytes, sizeof *sample, gateway->nonce, bytes + sizeof *sample);
  return send(gateway->socket, bytes, size, 0) == (ssize_t)size;
}

/* The next packet: its size without its tag. 0: nothing came for 5 ms; -1: it is not Torsion's. */
static inline int torsion_gateway_receive(const struct torsion_gateway *gateway, uint8_t *bytes) {
  const int came = (int)recv(gateway->socket, bytes, TORSION_LONGEST, 0);
  uint8_t tag[TORSION_TAG] = {0};
  int size = came, wrong = 0, i;
  if (came <= 0) return 0;
  if (gateway->secret_size > 0) {
    size = came - TORSION_TAG;
    if (size != (int)sizeof(struct torsion_answer) && size != (int)sizeof(struct torsion_challenge)) return -1;
    torsion_gateway_tag(gateway, bytes, (size_t)size,
                        size == (int)sizeof(struct torsion_challenge) ? bytes + 16 : gateway->nonce, tag);
    for (i = 0; i < TORSION_TAG; ++i) wrong |= tag[i] ^ bytes[size + i];
  }
  return wrong ? -1 : size;
}

static inline void torsion_gateway_measure(struct torsion_gateway *gateway, double since) {
  const double now = torsion_gateway_clock() - since;
  gateway->round_trip += (gateway->round_trip > 0.0 ? 0.01 : 1.0) * (now - gateway->round_trip);
}

/* Sends a sample, whose head and time it fills in and to whose delay it adds the round trip, and waits for its answer.
 * 0: it came. Else -1, and an answer without force: nothing came for 5 ms, or another client has the tool. */
static inline int torsion_gateway_exchange(struct torsion_gateway *gateway, const struct torsion_sample *read,
                                           struct torsion_answer *answer) {
  struct torsion_sample sample = *read;
  struct torsion_challenge challenge;
  uint8_t bytes[TORSION_LONGEST];
  int size, sent;
  sample.magic = 0x47524F54u;
  sample.version = 1;
  sample.kind = 1;
  sample.session = gateway->session;
  sample.sequence = ++gateway->sequence;
  sample.time = torsion_gateway_clock();
  sample.delay += gateway->round_trip;
  sent = torsion_gateway_send(gateway, &sample);
  while (sent && torsion_gateway_clock() < sample.time + 5e-3 && (size = torsion_gateway_receive(gateway, bytes)) != 0) {
    memcpy(&challenge, bytes, sizeof challenge);
    if (size < (int)sizeof challenge || challenge.magic != sample.magic || challenge.version != 1 ||
        challenge.session != sample.session || challenge.sequence != sample.sequence) {
      continue;
    }
    if (size == (int)sizeof *answer && challenge.kind == 2) {
      memcpy(answer, bytes, sizeof *answer);
      torsion_gateway_measure(gateway, sample.time);
      return answer->state == TORSION_SILENT || answer->state == TORSION_REFUSED ? -1 : 0;
    }
    if (gateway->secret_size > 0 && size == (int)sizeof challenge && challenge.kind == 3) {
      memcpy(gateway->nonce, challenge.nonce, sizeof gateway->nonce);
      torsion_gateway_measure(gateway, sample.time);
      sample.delay = read->delay + gateway->round_trip;
      sent = torsion_gateway_send(gateway, &sample);
    }
  }
  memset(gateway->nonce, 0, sizeof gateway->nonce); /* Torsion may have drawn another: it says so again */
  memset(answer, 0, sizeof *answer);
  answer->state = TORSION_SILENT;
  return -1;
}

#endif /* TORSION_GATEWAY_H_ */
