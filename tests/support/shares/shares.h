/* Fields on a whole mesh and on its shares, whose bits are compared. */
#ifndef TESTS_SUPPORT_SHARES_H
#define TESTS_SUPPORT_SHARES_H
#include <dvi/march.h>

enum { SHARED_STEPS = 12, SHARED_OBSERVED = 16 };

/* What is measured on the whole mesh. */
typedef struct whole_run {
  dvi_field *(*make)(const dvi_mesh *mesh);
  int64_t cells, faces;
  double step;
  double *form[SHARED_STEPS]; /* E, then B */
  double seen[SHARED_STEPS][SHARED_OBSERVED];
} whole_run;

/* Give a mesh the parts "core", of its cells with x < 0.4, and "exit", of the boundary with
 * x > 0.7 if there is one. The plain mesh is destroyed. */
dvi_mesh *with_core_and_exit(dvi_mesh *plain, const double *period);

/* A field with materials, losses in the core, an absorbing exit, two currents and four probes. */
dvi_field *lossy_field(const dvi_mesh *mesh);

/* Electric walls all around. */
dvi_field *cavity_field(const dvi_mesh *mesh);

/* A wave with a source, fixed values in the core, and a flux through the exit. */
dvi_field *driven_wave(const dvi_mesh *mesh);

/* Run the field that `make` makes on the whole mesh. */
void run_whole(const dvi_mesh *mesh, whole_run *t);

/* Run it on the share of a process, and return the number of differences: of the step, of the forms
 * of owned cells, and of what is observed. -1 if it cannot begin, and dvi_last_error tells why. */
int64_t run_share(const dvi_mesh *share, int rank, const whole_run *t);

void whole_run_clear(whole_run *t);

#endif
