/* Problems on products of SO(3), SE(3) and S^2: their room and the names of their numbers. */
#include <stdio.h>

#include "entry.h"

enum { SUFFIX_SIZE = 16 };

static const char axis[] = "xyz";

static int stored_of(const dvi_factor *factor)
{
  return factor->kind == DVI_SO3 ? 9 : factor->kind == DVI_SE3 ? 12 : 3;
}

static int velocities_of(const dvi_factor *factor)
{
  return factor->kind == DVI_SE3 ? 6 : 3;
}

static int bodies_of(int count, const dvi_factor *factors)
{
  int bodies = 0;
  for (int f = 0; f < count; f++) bodies += factors[f].kind != DVI_S2;
  return bodies;
}

/* A body that turns: R11 .. R33, the angular velocity and the angular momentum in its own frame. */
static void name_rotation(const problem *made, int i, int j, const char *suffix)
{
  for (int k = 0; k < 9; k++) {
    made->q[i + k] = k % 4 == 0;
    (void)snprintf(made->coordinate[i + k], PROBLEM_LABEL_SIZE, "R%d%d%s", k / 3 + 1, k % 3 + 1,
                   suffix);
  }
  for (int k = 0; k < 3; k++) {
    (void)snprintf(made->velocity[j + k], PROBLEM_LABEL_SIZE, "Omega%d%s", k + 1, suffix);
    (void)snprintf(made->momentum[j + k], PROBLEM_LABEL_SIZE, "Pi%d%s", k + 1, suffix);
  }
}

/* Coordinates whose velocities are their rates: x or q1_x, v_, p_. */
static void name_place(const problem *made, int i, int j, const char *prefix, const char *suffix)
{
  for (int k = 0; k < 3; k++) {
    (void)snprintf(made->coordinate[i + k], PROBLEM_LABEL_SIZE, "%s%c%s", prefix, axis[k], suffix);
    (void)snprintf(made->velocity[j + k], PROBLEM_LABEL_SIZE, "v_%s%c%s", prefix, axis[k], suffix);
    (void)snprintf(made->momentum[j + k], PROBLEM_LABEL_SIZE, "p_%s%c%s", prefix, axis[k], suffix);
  }
}

/* Bodies are numbered if there are several: R11_2; directions always: q1_x. */
static void name_all(const problem *made, int count, const dvi_factor *factors)
{
  const int several = bodies_of(count, factors) > 1;
  for (int f = 0, i = 0, j = 0, body = 0, direction = 0; f < count; f++) {
    const dvi_factor *factor = &factors[f];
    char number[SUFFIX_SIZE] = "";
    if (factor->kind == DVI_S2) {
      (void)snprintf(number, sizeof number, "q%d_", ++direction);
      name_place(made, i, j, number, "");
    } else {
      if (several) (void)snprintf(number, sizeof number, "_%d", ++body);
      name_rotation(made, i, j, number);
      if (factor->kind == DVI_SE3) name_place(made, i + 9, j + 3, "", number);
    }
    i += stored_of(factor);
    j += velocities_of(factor);
  }
}

dvi_status problem_factors(problem *made, int count, const dvi_factor *factors,
                           size_t parameters_size)
{
  int nq = 0, nv = 0;
  for (int f = 0; f < count; f++) {
    nq += stored_of(&factors[f]);
    nv += velocities_of(&factors[f]);
  }
  made->velocity = problem_names(made, nv);
  if (!made->velocity || problem_room_of(made, nq, nv, parameters_size) != DVI_OK)
    return DVI_NO_MEMORY;
  name_all(made, count, factors);
  return DVI_OK;
}
