/* A cavity with conducting walls: its lowest frequencies, and those that a probe sees in time. A
 * mode of the frequency omega swings with omega_h in time, omega h/2 = sin(omega_h h/2). */
#include <dvi/dvi.h>
#include <math.h>
#include <stdio.h>
#include <stdlib.h>

enum { SAMPLES = 600, LINES = 3 };

static const double h = 0.02, interval = 0.1;

/* E_x = y(1 - y) exp(x) vanishes along the walls y = 0 and y = 1, and E_y is 0. */
static int initial_field(const double *x, double *E, void *user)
{
  (void)user;
  E[0] = x[1] * (1 - x[1]) * exp(x[0]);
  E[1] = 0;
  return 0;
}

/* Start from the field, and record the probe. */
static dvi_status record(const dvi_mesh *mesh, dvi_march *march, double *series)
{
  double energy;
  double *E = (double *)calloc((size_t)dvi_mesh_count(mesh, 1), sizeof *E);
  const dvi_march_state state = {.size = sizeof state, .E = E};
  dvi_status status = E != NULL ? dvi_form_integrate(mesh, 1, initial_field, NULL, E)
                                : DVI_NO_MEMORY;
  if (!status) status = dvi_march_start(march, &state);
  for (int i = 0; i < SAMPLES && !status; i++) {
    status = dvi_march_advance(march, i * interval);
    if (!status) status = dvi_march_observe(march, 2, &series[i]); /* energy, gauss, ear */
    if (!status) status = dvi_march_observe(march, 0, &energy);
    if (!status && i % 200 == 0) printf("t = %g, energy %.12f\n", i * interval, energy);
  }
  free(E);
  return status;
}

static dvi_status listen(const dvi_mesh *mesh, const dvi_field *cavity)
{
  const dvi_march_options options = {.size = sizeof options, .step = h};
  const dvi_spectrum_options band = {.size = sizeof band, .lowest = 1, .highest = 5};
  dvi_spectral_line line[LINES];
  double series[SAMPLES];
  int count = 0;
  dvi_march *march = NULL;
  dvi_status status = dvi_march_create(cavity, &options, &march);
  if (!status) status = record(mesh, march, series);
  if (!status)
    status = dvi_spectrum(SAMPLES, 1, series, interval, &band, LINES, &count, line, NULL, NULL,
                          NULL);
  for (int i = 0; i < count && !status; i++)
    printf("omega_h %.9f, omega %.9f\n", line[i].frequency, 2 / h * sin(line[i].frequency * h / 2));
  dvi_march_destroy(&march);
  return status;
}

int main(void)
{
  const dvi_wall walls = {.part = "boundary", .kind = DVI_PEC};
  const dvi_field_probe ear = {.name = "ear", .of = "B", .at = {0.3, 0.2}, .along = {1}};
  double eigenvalue[3];
  int64_t zeros;
  dvi_mesh *mesh = NULL;
  dvi_star *star = NULL;
  dvi_field *cavity = NULL;
  dvi_status status = dvi_mesh_generate("staggered", NULL, &mesh);
  if (!status) status = dvi_star_create(mesh, NULL, &star);
  const dvi_maxwell_terms terms = {
      .size = sizeof terms, .star = star, .wall = &walls, .walls = 1, .probe = &ear, .probes = 1};
  const dvi_modes_options three = {.size = sizeof three, .count = 3};
  if (!status) status = dvi_maxwell_create(&terms, &cavity);
  if (!status) status = dvi_field_modes(cavity, &three, eigenvalue, NULL, &zeros);
  for (int i = 0; i < 3 && !status; i++) printf("omega %.9f\n", sqrt(eigenvalue[i]));
  if (!status) status = listen(mesh, cavity);
  if (status) fprintf(stderr, "%s\n", dvi_last_error());
  dvi_field_destroy(&cavity);
  dvi_star_destroy(&star);
  dvi_mesh_destroy(&mesh);
  return status != 0;
}
