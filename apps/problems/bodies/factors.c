/* Problems on products of SO(3), SE(3) and S^2, with their memory and the names of their
 * numbers. */
#include <stdio.h>

#include "entry.h"

enum { SUFFIX_SIZE = 16 };

static const char axis[] = "xyz";

static int factor_stored(const dvi_factor *factor)
{
  return factor->kind == DVI_SO3 ? 9 : factor->kind == DVI_SE3 ? 12 : 3;
}

static int factor_velocities(const dvi_factor *factor)
{
  return factor->kind == DVI_SE3 ? 6 : 3;
}

static int count_bodies(int count, const dvi_factor *factors)
{
  int bodies = 0;
  for (int f = 0; f < count; f++) bodies += factors[f].kind != DVI_S2;
  return bodies;
}

/* Name the numbers of a rotation, which are R11 .. R33, and the angular velocity and momentum in
 * the body's frame. */
static void factor_name_rotation(const problem *made, int i, int j, const char *suffix)
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

/* Name coordinates whose velocities are their rates, such as x or q1_x, with v_ and p_. */
static void factor_name_place(const problem *made, int i, int j, const char *prefix,
                              const char *suffix)
{
  for (int k = 0; k < 3; k++) {
    (void)snprintf(made->coordinate[i + k], PROBLEM_LABEL_SIZE, "%s%c%s", prefix, axis[k], suffix);
    (void)snprintf(made->velocity[j + k], PROBLEM_LABEL_SIZE, "v_%s%c%s", prefix, axis[k], suffix);
    (void)snprintf(made->momentum[j + k], PROBLEM_LABEL_SIZE, "p_%s%c%s", prefix, axis[k], suffix);
  }
}

/* Name all numbers. Bodies are numbered if there are several, as in R11_2. Directions always are,
 * as in q1_x. */
static void factor_name_all(const problem *made, int count, const dvi_factor *factors)
{
  const int several = count_bodies(count, factors) > 1;
  for (int f = 0, i = 0, j = 0, body = 0, direction = 0; f < count; f++) {
    const dvi_factor *factor = &factors[f];
    char number[SUFFIX_SIZE] = "";
    if (factor->kind == DVI_S2) {
      (void)snprintf(number, sizeof number, "q%d_", ++direction);
      factor_name_place(made, i, j, number, "");
    } else {
      if (several) (void)snprintf(number, sizeof number, "_%d", ++body);
      factor_name_rotation(made, i, j, number);
      if (factor->kind == DVI_SE3) factor_name_place(made, i + 9, j + 3, "", number);
    }
    i += factor_stored(factor);
    j += factor_velocities(factor);
  }
}

dvi_status problem_factors(problem *made, int count, const dvi_factor *factors,
                           size_t parameters_size)
{
  int nq = 0, nv = 0;
  for (int f = 0; f < count; f++) {
    nq += factor_stored(&factors[f]);
    nv += factor_velocities(&factors[f]);
  }
  made->velocity = problem_names(made, nv);
  if (!made->velocity || problem_room_of(made, nq, nv, parameters_size) != DVI_OK)
    return DVI_NO_MEMORY;
  factor_name_all(made, count, factors);
  return DVI_OK;
}
