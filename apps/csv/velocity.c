#include "csv/velocity.h"

#include <string.h>

/* Remove the normal component of a direction's momentum. */
static void project_to_tangent(const double *q, double *p)
{
  const double along = q[0] * p[0] + q[1] * p[1] + q[2] * p[2];
  for (int i = 0; i < 3; i++) p[i] -= along * q[i];
}

static void project_all_to_tangent(const dvi_system_terms *terms, const double *q, double *p)
{
  static const int stored[] = {[DVI_SO3] = 9, [DVI_SE3] = 12, [DVI_S2] = 3},
                   velocities[] = {[DVI_SO3] = 3, [DVI_SE3] = 6, [DVI_S2] = 3};
  for (int f = 0; f < terms->factor_count; f++) {
    const dvi_factor_kind kind = terms->factors[f].kind;
    if (kind == DVI_S2) project_to_tangent(q, p);
    q += stored[kind];
    p += velocities[kind];
  }
}

dvi_status velocity_near(const problem *scene, double t, const double *q, const double *p,
                         double *room, double *v)
{
  double *near_q = room, *near_p = room + scene->nq;
  memcpy(near_q, q, (size_t)scene->nq * sizeof *q);
  memcpy(near_p, p, (size_t)scene->nv * sizeof *p);
  const dvi_status status = dvi_system_project(scene->system, near_q);
  if (status != DVI_OK) return status;
  project_all_to_tangent(scene->terms, near_q, near_p);
  return dvi_system_velocity(scene->system, t, near_q, near_p, v);
}
