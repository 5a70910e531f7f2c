/* The C interface of the library, for programs in C and for every language that calls C.

   Units are SI; vectors, poses and wrenches are in the world frame; a quaternion is w, x, y, z.
   Rows of bodies, tools and regions count from 0.

   Functions return 0, or -1 where they fail, or null where they make something; results go to the
   last argument. torsion_last_error then says why, for the calling thread. A null or freed handle,
   a null pointer, a row that is not there, an array of another length, and a handle that another
   thread's call is using are such failures; nothing is written then.

   Different objects may be used in different threads at the same time; models are constant, and one
   may be used by all of them. */
#ifndef TORSION_H
#define TORSION_H

#include <stddef.h>
#include <stdint.h>

#ifdef __cplusplus
extern "C" {
#endif

#define TORSION_C_API __attribute__((visibility("default")))

/* The version of this interface: functions and fields are only ever added to one. */
#define TORSION_INTERFACE_VERSION 1

typedef struct torsion_scene torsion_scene;
typedef struct torsion_model torsion_model;
typedef struct torsion_simulation torsion_simulation;
typedef struct torsion_coupling torsion_coupling;

typedef struct torsion_pose {
  double position[3];    /* m */
  double orientation[4]; /* w, x, y, z; unit length */
} torsion_pose;

typedef struct torsion_wrench {
  double force[3];  /* N */
  double torque[3]; /* N m */
} torsion_wrench;

typedef struct torsion_options {
  size_t size;               /* sizeof(torsion_options): torsion_default_options sets it */
  double rate;               /* Hz */
  const char* contact_model; /* null: as the scene says */
  const char* body_model;    /* null: as the scene says */
  uint32_t grid_side;        /* cells along a region's grid; 0: as the models need */
  uint32_t iterations;       /* of contact model patch in a step */
  uint32_t threads;          /* that torsion_build may use; 0: as many as there are cores */
  int32_t use_cache;         /* 1: distance fields and compliances from the user's cache folder */
} torsion_options;

typedef struct torsion_region {
  uint64_t id; /* in the order of formation, never used twice */
  size_t body;
  size_t tool;
  double point[3];      /* m: the centre of pressure, on the tool's surface */
  double normal[3];     /* unit, out of the body */
  double area;          /* m^2 */
  double radius;        /* m */
  double depth;         /* m */
  double normal_force;  /* N */
  double mean_pressure; /* Pa */
  double friction[3];   /* N, on the tool */
  double couple;        /* N m, on the tool about the normal through the point */
  double turn;          /* rad, of the tool about the normal since the region formed */
  double stick_share;   /* of the area, 0 to 1 */
  double stick_radius;  /* m */
} torsion_region;

/* A tool's load in parts: the contact couple apart from r x F. */
typedef struct torsion_load_parts {
  double normal_force[3]; /* N */
  double friction[3];     /* N */
  double couple[3];       /* N m: the sum of the contact couples */
  double lever_torque[3]; /* N m: the sum of r x F about the point asked for */
} torsion_load_parts;

typedef struct torsion_device_traits {
  size_t size;         /* sizeof(torsion_device_traits) */
  double damping;      /* N s/m: of the handle without motors on; here and below 0: not known */
  double turn_damping; /* N m s/rad */
  double mass;         /* kg */
  double inertia;      /* kg m^2 */
  double encoder_step; /* m */
  double encoder_turn_step;      /* rad */
  double period;                 /* s: between two forces */
  double delay;                  /* s: from a position read to its force sent, beyond the period */
  double largest_force;          /* N */
  double largest_torque;         /* N m */
  double largest_stiffness;      /* N/m */
  double largest_turn_stiffness; /* N m/rad */
} torsion_device_traits;

typedef enum torsion_hold {
  TORSION_HOLD_MASSLESS = 0,
  TORSION_HOLD_MASS = 1,
  TORSION_HOLD_DIRECT = 2
} torsion_hold;

TORSION_C_API uint32_t torsion_interface_version(void);
TORSION_C_API const char* torsion_version(void);
/* Why the last call in this thread failed; valid until the next one fails. */
TORSION_C_API const char* torsion_last_error(void);
/* Is called when the library finds a mistake of its own; if it returns, the process aborts. Null:
   none. */
TORSION_C_API void torsion_set_assertion_handler(void (*handler)(const char* condition,
                                                                 const char* file, int line));

/* A .gltf or .glb by the conventions of docs/scenes.md, or null. */
TORSION_C_API torsion_scene* torsion_load_scene(const char* path);
/* Null is left alone, here and below. */
TORSION_C_API int torsion_free_scene(torsion_scene* scene);
/* s: the end of the file's animations. */
TORSION_C_API int torsion_scene_duration(const torsion_scene* scene, double* seconds);
/* Where the file's animation holds a tool at a time [s]. */
TORSION_C_API int torsion_animated_pose(const torsion_scene* scene, size_t tool, double time,
                                        torsion_pose* pose);
/* Sets youngs_modulus [Pa], poisson_ratio, density [kg/m^3], static_friction, dynamic_friction or
   tolerance of the body of that name. torsion_build says what a number cannot be. */
TORSION_C_API int torsion_set_number(torsion_scene* scene, const char* body, const char* key,
                                     double value);

TORSION_C_API torsion_options torsion_default_options(void);
/* Prepares a scene, or null. Null options: the default ones. */
TORSION_C_API torsion_model* torsion_build(const torsion_scene* scene,
                                           const torsion_options* options);
/* Simulations of the model keep what they need of it. */
TORSION_C_API int torsion_free_model(torsion_model* model);
TORSION_C_API int torsion_body_count(const torsion_model* model, size_t* count);
TORSION_C_API int torsion_tool_count(const torsion_model* model, size_t* count);
/* The row of the tool of that name. */
TORSION_C_API int torsion_find_tool(const torsion_model* model, const char* name, size_t* tool);
TORSION_C_API int torsion_step_time(const torsion_model* model, double* seconds);

TORSION_C_API torsion_simulation* torsion_new_simulation(const torsion_model* model);
TORSION_C_API torsion_simulation* torsion_copy_simulation(const torsion_simulation* simulation);
TORSION_C_API int torsion_free_simulation(torsion_simulation* simulation);
/* One step; poses: one for each tool. Allocates nothing. Returns the step's fault bits: 0 where it
   was sound, above 0 where the forces fade (torsion_describe_faults), or -1. */
TORSION_C_API int torsion_step(torsion_simulation* simulation, const torsion_pose* poses,
                               size_t count);
/* Writes the faults in words, one a line, as many as fit with a zero at the end, and returns the
   length of all of them. */
TORSION_C_API size_t torsion_describe_faults(uint32_t faults, char* text, size_t size);
/* s, of the next step. */
TORSION_C_API int torsion_time(const torsion_simulation* simulation, double* seconds);
/* About the origin of the tool's frame. */
TORSION_C_API int torsion_tool_wrench(const torsion_simulation* simulation, size_t tool,
                                      torsion_wrench* wrench);
/* About a point, m. */
TORSION_C_API int torsion_tool_load_parts(const torsion_simulation* simulation, size_t tool,
                                          const double point[3], torsion_load_parts* parts);
/* 6 x 6, row by row, about the tool's mass centre: shifts, then turns. */
TORSION_C_API int torsion_tool_stiffness(const torsion_simulation* simulation, size_t tool,
                                         double stiffness[36]);
TORSION_C_API int torsion_region_count(const torsion_simulation* simulation, size_t* count);
TORSION_C_API int torsion_get_region(const torsion_simulation* simulation, size_t region,
                                     torsion_region* made);

TORSION_C_API torsion_coupling* torsion_new_coupling(const torsion_model* model, size_t tool,
                                                     const torsion_device_traits* traits,
                                                     torsion_hold hold);
TORSION_C_API int torsion_free_coupling(torsion_coupling* coupling);
/* The tool's pose for the next step, for a handle's pose. */
TORSION_C_API int torsion_coupling_next(torsion_coupling* coupling,
                                        const torsion_simulation* simulation,
                                        const torsion_pose* handle, torsion_pose* pose);
/* What the hand is to feel after that step, about the handle's origin. */
TORSION_C_API int torsion_coupling_felt(torsion_coupling* coupling,
                                        const torsion_simulation* simulation,
                                        torsion_wrench* wrench);

#ifdef __cplusplus
}
#endif

#endif
