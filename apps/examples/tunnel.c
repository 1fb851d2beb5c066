/* A particle in a double well: its lowest energies, and how it tunnels from one side to the other.
 * Then a condensate in a trap. */
#include <dvi/dvi.h>
#include <math.h>
#include <stdio.h>
#include <stdlib.h>

static int double_well(int64_t count, double t, const double *x, double *V, void *user)
{
  (void)t, (void)user;
  for (int64_t i = 0; i < count; i++) V[i] = pow(x[i] * x[i] - 4, 2) / 8;
  return 0;
}

static int trap(int64_t count, double t, const double *x, double *V, void *user)
{
  (void)t, (void)user;
  for (int64_t i = 0; i < count; i++) V[i] = x[i] * x[i] / 2;
  return 0;
}

/* Follow psi, which is overwritten, through half a beat of two states, to the other side. */
static dvi_status follow(const dvi_schroedinger *well, double *psi, double beat)
{
  const dvi_schroedinger_march_options options = {
      .size = sizeof options, .method = "gauss:stages=2", .step = 0.1, .span = beat / 4};
  const dvi_march_state start = {.size = sizeof start, .A = psi};
  dvi_march *march = NULL;
  dvi_status status = dvi_schroedinger_march(well, &options, &march);
  if (!status) status = dvi_march_start(march, &start);
  for (int i = 0; i <= 2 && !status; i++) {
    const double t = i * beat / 4;
    dvi_schroedinger_values now = {0};
    status = dvi_march_advance(march, t);
    if (!status) status = dvi_march_sample(march, DVI_FORM_A, 0, NULL, psi);
    if (!status) status = dvi_schroedinger_measure(well, t, psi, &now);
    if (!status) printf("t = %7.3f, norm %.12f, <x> = %+.6f\n", t, now.norm, now.position[0]);
  }
  dvi_march_destroy(&march);
  return status;
}

static dvi_status tunnel(const dvi_space *line)
{
  const dvi_schroedinger_terms terms = {
      .size = sizeof terms, .space = line, .potential = double_well};
  const int64_t n = dvi_space_functions(line);
  double energy[2], *state = (double *)calloc(4 * (size_t)n, sizeof *state), *psi = state + 2 * n;
  dvi_schroedinger *well = NULL;
  dvi_status status = state != NULL ? dvi_schroedinger_create(&terms, &well) : DVI_NO_MEMORY;
  if (!status) status = dvi_schroedinger_modes(well, 2, energy, state);
  if (!status) printf("E = %.10f, %.10f\n", energy[0], energy[1]);
  for (int64_t i = 0; i < n && !status; i++) psi[i] = sqrt(0.5) * (state[i] + state[n + i]);
  if (!status) status = follow(well, psi, 2 * acos(-1) / (energy[1] - energy[0]));
  dvi_schroedinger_destroy(&well);
  free(state);
  return status;
}

static dvi_status condense(const dvi_space *line)
{
  const dvi_schroedinger_terms terms = {
      .size = sizeof terms, .space = line, .potential = trap, .interaction = 10};
  dvi_schroedinger_ground_report state = {0};
  dvi_schroedinger *gas = NULL;
  dvi_status status = dvi_schroedinger_create(&terms, &gas);
  if (!status) status = dvi_schroedinger_ground(gas, 1, &state, NULL);
  if (!status) printf("condensate: mu = %.10f, E = %.10f\n", state.mu, state.energy);
  dvi_schroedinger_destroy(&gas);
  return status;
}

int main(void)
{
  const dvi_axis axis = {.from = -9, .to = 9};
  const dvi_space_options options = {
      .size = sizeof options, .kind = "fem:degree=8,cells=36", .axis = &axis, .axes = 1};
  dvi_space *line = NULL;
  dvi_status status = dvi_space_create(&options, &line);
  if (!status) status = tunnel(line);
  if (!status) status = condense(line);
  if (status) fprintf(stderr, "%s\n", dvi_last_error());
  dvi_space_destroy(&line);
  return status ? EXIT_FAILURE : EXIT_SUCCESS;
}
