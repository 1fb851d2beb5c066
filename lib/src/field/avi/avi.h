/* Asynchronous steps of a k-form A, on arrays.
 *
 * The k-cells are called edges here, and the (k+1)-cells faces, as they are for Maxwell's equations
 * (k = 1). The discrete action of a run is
 *
 *     S = sum over edges e and their intervals of  M1_e E_e^2 (t_e^{i+1} - t_e^i)/2
 *       - sum over faces f and their times t_f^m = t_0 + m h_f of  h_f M2_f (dA)_f^2/2
 *
 * with E = -A', constant between two events of the edge, and a whole sum over m that begins with
 * h_f/2. An edge has an event whenever one of its faces has. Its stationarity conditions are
 *
 *     A_e -= E_e (t - t_e),    D_e += sign h_f M2_f (dA)_f  for each face f of e that acts at t,
 *
 * where D = M1 E, and the first kicks of a run are half as large. Events of one time happen in the
 * order of their faces, which are numbered by their steps, the shortest ones first.
 *
 * A current J pushes by its integral over each interval of an edge, one half at its begin and the
 * other at its end. With a damping C a passage is the exact one of D' = -J - C E for a J that is
 * constant in the interval, so that no C is too large and none makes D swing (passage.c):
 *
 *     A_e -= phi1(z) E_e (t - t_e),  D_e *= exp(-z),     z = C_e (t - t_e)/M1_e.
 *
 * With equal steps of all faces and without dampings this is leapfrog. Source: Stern 2009,
 * sec. 3.3.4, with the weights and clocks that it leaves out; Lew, Marsden, Ortiz and West 2003. */
#ifndef DVI_FIELD_AVI_AVI_H
#define DVI_FIELD_AVI_AVI_H
#include <dvi/march.h>

#include "field/mesh/mesh.h"
#include "march/sections.h"

/* A current profile [edges] times a signal, which is given by its integral over an interval. It is
 * finite, or the call fails with a sentence. */
typedef struct dvi__avi_current {
  const double *profile;
  dvi_status (*impulse)(double from, double to, double *impulse, void *user);
  void *user;
} dvi__avi_current;

/* What asynchronous steps consist of. All arrays but the users of currents are copied. */
typedef struct dvi__avi_terms {
  const dvi_mesh *mesh; /* whose cells sentences name, or NULL */
  int degree;           /* of the edges in the mesh */
  int64_t edges, faces;
  int width;              /* edges of a face */
  const int *facet;       /* [faces*width] the rows of d_k */
  const int8_t *sign;     /* [faces*width] */
  const double *M1;       /* [edges] positive where they are not fixed */
  const double *M2;       /* [faces] not negative. Faces with 0 have no events */
  const int8_t *is_fixed; /* [edges] not 0 where A stays as it is. NULL for nowhere */
  const double *damping;  /* [edges] C, not negative. NULL for 0 */
  const dvi__avi_current *current;
  int currents;
  int64_t nodes;           /* (k-1)-cells, 0 for k = 0 */
  int node_width;          /* nodes of an edge */
  const int *node;         /* [edges*node_width] the rows of d_{k-1} */
  const int8_t *node_sign; /* [edges*node_width] */
  double fraction;         /* of each face's longest stable step, below 1. 0 for 0.5 */
  double shortest;         /* above 0 in place of the fraction: the shortest step */
  double span;             /* above 0: whole numbers of the shortest step make it */
  int is_free;             /* faces have their own steps, not powers of 2 of the shortest one */
  const double *step;      /* [faces] explicit steps in place of all that, or NULL */
  int is_queued;           /* events are always taken from a queue, with the same bits */
  int threads;             /* 0 for 1 */
  double band;             /* by which the energy may grow until a run stops. 0 for 2 */
} dvi__avi_terms;

typedef struct dvi__avi dvi__avi;

/* Name an edge for `up` = 0, or a face for 1. */
dvi__cell_name dvi__avi_name(const dvi__avi_terms *terms, int up, int64_t cell);

/* Create the steps. DVI_BAD_ARGUMENT if a step is not stable or an array is not as described,
 * DVI_SINGULAR for entries of M1 or M2 that are not positive, DVI_NO_MEMORY. */
dvi_status dvi__avi_create(const dvi__avi_terms *terms, dvi__avi **avi);
void dvi__avi_destroy(dvi__avi **avi);

/* Start at a time. NULL for A = 0, E = 0, and B = dA. What B has beside dA stays as it is.
 * DVI_NOT_FINITE if the energy is not finite. */
dvi_status dvi__avi_start(dvi__avi *avi, double t, const double *A, const double *E,
                          const double *B);

/* Let all events up to t happen, and those at t up to a few roundings. Once in 64 of the longest
 * steps the energy is compared with that of the start and the work of the currents. If it left the
 * band, DVI_STEP_TOO_LARGE, and if it is not finite or 1e100 times too large, DVI_NOT_FINITE. The
 * march stands at the time of the comparison then, with a valid state. In the first case the band
 * is doubled, so that another call goes on. */
dvi_status dvi__avi_advance(dvi__avi *avi, double t);

double dvi__avi_time(const dvi__avi *avi);

/* Give values at the march's time. `cell` [count] may be NULL for all. */
dvi_status dvi__avi_sample(const dvi__avi *avi, dvi_march_form form, int64_t count, const int *cell,
                           double *values);

/* Give the energy E.M1 E/2 + B.M2 B/2 at the march's time, and its size beside that of the start
 * with the work of the currents, counted as positive. `growth` may be NULL. */
dvi_status dvi__avi_energy(const dvi__avi *avi, double *energy, double *growth);

/* Give the largest change of d^T D + (charge that flowed in) at a node without fixed edges, beside
 * the largest sum of the terms at a node. 0 without nodes. */
double dvi__avi_gauss(const dvi__avi *avi);

void dvi__avi_facts(const dvi__avi *avi, dvi_march_facts *facts);

/* Put the section "avi", and take it back. */
void dvi__avi_save(const dvi__avi *avi, dvi__sections_writer *writer);
dvi_status dvi__avi_load(dvi__avi *avi, const dvi__sections *sections);

#endif
