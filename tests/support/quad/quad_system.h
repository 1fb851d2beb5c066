/* A problem in quadruple precision, the interface between the judge's scheme (quad.c) and the
 * definitions (quad_problems.c). */
#ifndef SUPPORT_QUAD_SYSTEM_H
#define SUPPORT_QUAD_SYSTEM_H
#include "quad.h"
#include "quad_real.h"

#define QUAD_PARAMETERS_MAX 8
#define QUAD_BODIES_MAX 6
#define QUAD_SLOTS_MAX 8
#define QUAD_POINTS_MAX 48

/* A point of a system of rotations, places and directions (quad_factors.c). */
typedef struct quad_point {
  quad mass, weight[3], spring, pull;
  quad arm[QUAD_SLOTS_MAX][3]; /* of each slot, rho of a rotation, or (factor, 0, 0) */
} quad_point;

typedef struct quad_system {
  int n;  /* of q */
  int nv; /* length of v and p (default n, set by quad_prepare) */
  char slots[QUAD_SLOTS_MAX + 1];
  int points;
  quad_point point[QUAD_POINTS_MAX];
  quad value[QUAD_PARAMETERS_MAX];
  int bodies, dimension; /* the point masses, where there are any */
  quad G, mass[QUAD_BODIES_MAX];
  quad q[QUAD_N_MAX], v[QUAD_N_MAX]; /* the start */
} quad_system;

typedef struct quad_problem {
  const char *name;
  const char *parameter[QUAD_PARAMETERS_MAX + 1]; /* names, ended by NULL */
  const char *standard[QUAD_PARAMETERS_MAX];      /* default values */
  /* sets the other members from `value`; n stays 0 if there is no room */
  void (*prepare)(quad_system *system);
  /* v [n], and behind it the time since the start */
  void (*acceleration)(const quad_system *system, const quad *q, const quad *v, quad *a);
  /* default NULL, p = v */
  void (*momentum)(const quad_system *system, const quad *q, const quad *v, quad *p);
  void (*velocity)(const quad_system *system, const quad *q, const quad *p, quad *v);
  /* replaces the acceleration, for y = (q, v), [2 n] */
  void (*flow)(const quad_system *system, const quad *y, quad *rate);
  /* replaces the acceleration of a degenerate problem, whose v stays 0 */
  void (*rate)(const quad_system *system, const quad *q, quad *qdot);
} quad_problem;

/* Chains and nets of springs (quad_chains.c), ended by one without a name. */
extern const quad_problem quad_chains[];

/* The degenerate ones (quad_degenerate.c), likewise. */
extern const quad_problem quad_degenerate[];

/* Those with rotations and directions (quad_factors.c), likewise. */
extern const quad_problem quad_factors[];

/* Mechanisms with holonomic constraints (quad_mechanisms.c), likewise. */
extern const quad_problem quad_mechanisms[];

/* The nonholonomic ones (quad_rolling.c), likewise. */
extern const quad_problem quad_rolling[];

/* Those with holonomic constraints (quad_constrained.c), likewise. */
extern const quad_problem quad_constrained[];

/* A problem with its parameters set. */
typedef struct quad_field {
  const quad_problem *problem;
  quad_system system;
} quad_field;

/* Finds a problem, or returns NULL. */
const quad_problem *quad_problem_find(const char *name);

/* Sets the parameters of a problem. Returns 1 if there is such a problem, with such settings, and
 * room for it. */
int quad_prepare(quad_field *field, const char *problem, int setting_count,
                 const char *const *settings);

/* Advances y = (q, v, 0) [2 n + 1] by time t, which then stands last. Returns the judge's own error
 * as quad_solve does. */
quad quad_march(const quad_field *field, quad t, quad *y);

/* Gives p [nv] at y = (q, v, time). */
void quad_momentum(const quad_field *field, const quad *y, quad *p);

/* Reads a decimal number or a quotient of two, such as "1/1.3e8". */
quad quad_number(const char *text);

static inline quad quad_cube(quad x)
{
  return x * x * x;
}

#endif
