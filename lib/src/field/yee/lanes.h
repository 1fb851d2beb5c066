/* Loops over rows of Yee's grid, for several instruction sets, with the same bits
 * (num/simd/lanes.h). All counts are multiples of 8, so that whole vectors reach the end. Rows may
 * begin anywhere. */
#ifndef DVI_FIELD_YEE_LANES_H
#define DVI_FIELD_YEE_LANES_H
#include <stddef.h>
#include <stdint.h>

/* B -= dt ((p1 - p0) - (q1 - q0)). The row `soon` is fetched from memory meanwhile, because rows of
 * several components are too short for the hardware's own look-ahead. Nothing of it is read. */
typedef struct dvi__yee_faces_row {
  size_t count;
  double *b;
  const double *p1, *p0, *q1, *q0;
  double dt;
  uintptr_t soon; /* address */
} dvi__yee_faces_row;

/* The factors of the differences of a row of edges: one number for each, two numbers for each, or
 * arrays `up` and `down` for the difference p or q that is along x, and two numbers for the
 * other. */
typedef enum dvi__yee_metric {
  DVI__YEE_EQUAL,
  DVI__YEE_ACROSS,
  DVI__YEE_P_ALONG,
  DVI__YEE_Q_ALONG
} dvi__yee_metric;

/* E <- ca E + ce ((p_up p1 - p_down p0) - (q_up q1 - q_down q0)), without ca or ce where they are
 * NULL. With one number for each difference the sum is p_up (p1 - p0) - q_up (q1 - q0). */
typedef struct dvi__yee_edges_row {
  size_t count;
  dvi__yee_metric metric;
  double *e;
  const double *p1, *p0, *q1, *q0;
  double p_up, p_down, q_up, q_down;
  const double *up, *down;
  const double *ca, *ce;
  uintptr_t soon; /* address */
} dvi__yee_edges_row;

/* A row across absorbing layers: psi <- b psi + a D and F += sign ce (psi + r D) with
 * D = up p1 - down p0. */
typedef struct dvi__yee_layers_row {
  size_t count;
  double *f, *psi;
  const double *p1, *p0, *ce;
  double sign, b, a, r, up, down;
  uintptr_t soon; /* distance in bytes */
} dvi__yee_layers_row;

/* The same for one end of a row along x, whose factors are arrays, and for up to two components,
 * the second with psi behind that of the first. A component without F is left out. */
typedef struct dvi__yee_layers_end {
  size_t count;
  double *psi;
  const double *b, *a, *r, *up, *down;
  struct {
    double *f;
    const double *p1, *p0, *ce;
    double sign;
  } of[2];
} dvi__yee_layers_end;

typedef struct dvi__yee_lanes {
  void (*faces)(const dvi__yee_faces_row *row);
  void (*edges)(const dvi__yee_edges_row *row);
  void (*layers)(const dvi__yee_layers_row *row);
  void (*layers_end)(const dvi__yee_layers_end *end);
  /* h = mi b */
  void (*product)(size_t count, const double *mi, const double *b, double *h);
} dvi__yee_lanes;

/* Give the loops of the level in use. */
const dvi__yee_lanes *dvi__yee_lanes_in_use(void);

#endif
