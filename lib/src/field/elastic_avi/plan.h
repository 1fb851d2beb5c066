/* The steps of the cells. */
#ifndef DVI_FIELD_ELASTIC_AVI_PLAN_H
#define DVI_FIELD_ELASTIC_AVI_PLAN_H
#include "field/elastic_avi/engine.h"

/* What a march is asked for. */
typedef struct dvi__solid_request {
  double step, fraction, span; /* as in dvi_march_options */
  int threads;
  int is_equal;  /* one step for all cells */
  int is_free;   /* cells have their own steps, not powers of 2 of the shortest one */
  int is_linear; /* for small vibrations about rest, without loads and obstacles */
  double band;   /* by which the energy may grow until a run stops. 0 for 2 */
} dvi__solid_request;

/* By the mesh's numbers of cells. */
typedef struct dvi__solid_plan {
  double *bound; /* [cells] longest stable step of a cell by itself. Infinite without events */
  double *step;  /* [cells] infinite without events */
  int *class;    /* [cells] log2 of the step beside the shortest one. 0 for free steps */
  int *slab;     /* [cells] below `slabs` */
  uint8_t *turn; /* [cells] 0 to 2, the order in a class */
  int classes, slabs;
  double shortest, longest, tightest; /* steps, and the least bound, of all processes */
  double least_here;                  /* least bound of a cell by itself of this process, */
  int64_t tightest_cell;              /* and which cell has it */
} dvi__solid_plan;

/* Make the plan. On failure nothing is owned. */
dvi_status dvi__solid_plan_make(const dvi_elastic *solid, const dvi__solid_request *request,
                                dvi__solid_plan *plan);
void dvi__solid_plan_clear(dvi__solid_plan *plan);

/* Make the steps of a solid, and their memory. */
dvi_status dvi__solid_avi_create(const dvi_elastic *solid, const dvi__solid_request *request,
                                 dvi__solid_avi **avi);
void dvi__solid_avi_destroy(dvi__solid_avi **avi);

/* Start at a time with displacements and rates [vertices*n], or NULL for 0. On failure the march
 * stays as it was. */
dvi_status dvi__solid_avi_start(dvi__solid_avi *avi, double t, const double *u, const double *rate);

/* Let all events up to t happen, and those at t up to a few roundings. */
dvi_status dvi__solid_avi_advance(dvi__solid_avi *avi, double t);

/* Give u or u' at the march's time, at `count` components, or all for NULL. The other is NULL. */
dvi_status dvi__solid_avi_sample(const dvi__solid_avi *avi, int64_t count, const int *component,
                                 double *u, double *rate);

/* Make u and u' of the view at the march's time, or the whole view. */
dvi_status dvi__solid_avi_see(const dvi__solid_avi *avi);
dvi_status dvi__solid_avi_look(const dvi__solid_avi *avi);

/* Give the component k of m u' of the view, or from k = n on that of x cross m u' about the origin,
 * and the sum of the sizes of its terms on this process. A linear solid knows turns of X alone in
 * place of x. */
dvi_status dvi__solid_momentum(const dvi__solid_avi *avi, int k, double *value, double *size);

/* Put the section "elastic", and take it back. */
dvi_status dvi__solid_avi_save(const dvi__solid_avi *avi, dvi__sections_writer *writer);
dvi_status dvi__solid_avi_load(dvi__solid_avi *avi, const dvi__sections *sections);

#endif
