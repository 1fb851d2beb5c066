/* A layer of width 1 at the sides of a box, on triangles at rest and on triangles whose nodes move
 * to where the energy is least. */
#include <dvi/dvi.h>
#include <stdio.h>

enum { CELLS = 12, NODES = (CELLS + 1) * (CELLS + 1) };

static const double side = 20, exact = 37.453521;

/* l = -(u_x^2 + u_y^2 + u^2)/2. */
static int density(int count, double t, const double *x, const double *z, double *l, double *l_z,
                   double *l_zz, void *user)
{
  (void)t, (void)x, (void)user;
  for (int k = 0; k < count; k++) {
    if (l != NULL) l[k] = 0;
    for (int j = 0; j < 3; j++) {
      const double s = z[j * count + k];
      if (l != NULL) l[k] -= s * s / 2;
      if (l_z != NULL) l_z[j * count + k] = -s;
      if (l_zz != NULL) l_zz[j * count + k] = -1;
    }
  }
  return 0;
}

static int one(int64_t count, double t, const double *x, double *value, void *user)
{
  (void)t, (void)x, (void)user;
  for (int64_t k = 0; k < count; k++) value[k] = 1;
  return 0;
}

static int flat(int64_t count, const double *x, double *u, double *u_x, double *u_t,
                double *velocity, void *user)
{
  (void)u_x, (void)u_t, (void)velocity;
  return one(count, 0, x, u, user);
}

static dvi_status settle(const dvi_mesh *mesh, dvi_moving_motion motion)
{
  const dvi_jet variable[3] = {{.order = {1}}, {.order = {0, 1}}, {0}};
  const int pair[3][2] = {{0, 0}, {1, 1}, {2, 2}};
  const dvi_density_part part = {
      .variable = variable, .variables = 3, .pair = pair, .pairs = 3, .density = density};
  const dvi_density_condition rim = {
      .part = "boundary", .component = -1, .kind = DVI_FIXED, .datum = one};
  const dvi_moving_terms terms = {.size = sizeof terms,
                                  .mesh = mesh,
                                  .part = &part,
                                  .translations = 1,
                                  .motion = motion,
                                  .kappa = motion == DVI_MOVING_FREE ? 1e-4 : 0,
                                  .condition = &rim,
                                  .conditions = 1,
                                  .slide = 1};
  double q[3 * NODES], x[2 * NODES];
  dvi_moving_report report;
  dvi_moving *moving = NULL;
  dvi_status status = dvi_moving_create(&terms, &moving);
  if (!status) status = dvi_moving_start(moving, flat, NULL, q, NULL, NULL);
  if (!status) status = dvi_moving_solve(moving, q, &report);
  if (!status) status = dvi_moving_lift(moving, 0, q, x, NULL);
  if (!status)
    printf("%s nodes: energy %.4f more than %.4f, the first cell is %.3f wide\n",
           motion == DVI_MOVING_FREE ? "free" : "resting", report.energy - report.barrier - exact,
           exact, x[1] - x[0]);
  dvi_moving_destroy(&moving);
  return status;
}

int main(void)
{
  const dvi_generator_options box = {
      .size = sizeof box, .cells = {CELLS, CELLS}, .extent = {side, side}};
  dvi_mesh *mesh = NULL;
  dvi_status status = dvi_mesh_generate("kuhn", &box, &mesh);
  if (!status) status = settle(mesh, DVI_MOVING_PRESCRIBED);
  if (!status) status = settle(mesh, DVI_MOVING_FREE);
  if (status) fprintf(stderr, "%s\n", dvi_last_error());
  dvi_mesh_destroy(&mesh);
  return status != 0;
}
