/* A field with a density: its parts, what the boundary fixes, and integrals of its parts. */
#ifndef DVI_FIELD_DENSITY_DENSITY_H
#define DVI_FIELD_DENSITY_DENSITY_H
#include <dvi/density.h>

#include "field/algebra/csr.h"
#include "field/density/rooms.h"
#include "field/space/space.h"
#include "num/pattern.h"

enum {
  DVI__MODES_WITH_HESSIAN = 300, /* unknowns of a Fourier field whose Hessian is declared */
  DVI__BLOCK_MOST = 256          /* points of a call of a sparse field's callback */
};

/* A variable at the points, a sparse matrix of the coordinates: z = value.q + fixed + moving.G(t).
 * A column is given by its place in the list of the point's group. */
typedef struct dvi__jet_rows {
  int64_t *start;  /* [points+1] */
  int *local;      /* [entries] */
  double *value;   /* [entries] */
  double *fixed;   /* [points] what values that do not move add. NULL for 0 */
  dvi__csr moving; /* [points x moving]. Without rows for 0 */
} dvi__jet_rows;

/* Points whose variables depend on the same coordinates, as those of a cell. */
typedef struct dvi__point_groups {
  int *of; /* [points] */
  int64_t groups;
  int64_t *start;  /* [groups+1] */
  int *list;       /* coordinates of each, ascending */
  int64_t *square; /* [groups+1] sums of the squares of the lists' lengths */
} dvi__point_groups;

/* Places in the values of a Hessian for pairs of a group's coordinates, row by row, -1 where there
 * is none. Each is NULL without such derivatives. */
typedef struct dvi__slots {
  int *qq, *qv, *vv;
} dvi__slots;

/* Points whose variables are coordinates. From `first` on the coordinates of a point are those of
 * the point before, plus `stride`. `weight` is that of all these points, or 0 if they differ. */
typedef struct dvi__own_points {
  int64_t first;
  int stride;
  double weight;
} dvi__own_points;

/* Rows of a matrix that repeat. Rows first+period to last-1 have the entries of the row `period`
 * before, shifted by as much. */
typedef struct dvi__repeated_rows {
  int64_t first, last;
  int period;
} dvi__repeated_rows;

/* A condition of the boundary that adds g u - a u^2/2 to l. */
typedef struct dvi__boundary_term {
  dvi_density_condition given;
  int is_moving;
} dvi__boundary_term;

/* A part, with its points. Those of the domain are the space's, or taken from them
 * (field/density/points.c). */
typedef struct dvi__density_part {
  char *name;
  dvi_density_part given; /* with copies of its arrays. The name is the one above */
  dvi__boundary_term *boundary;
  int64_t points;
  const double *x, *weight; /* [dimension*points], [points] */
  double *own;              /* x and weight, where they are not the space's */
  dvi__csr trace;           /* [points x functions] values on a boundary. Else without rows */
  dvi__jet_rows *rows;      /* [variables] NULL for Fourier spaces */
  dvi__own_points own_points;
  dvi__point_groups group;
  dvi__slots slots;
  int64_t *low, *high; /* [unknowns] points of coordinate i and later, and i and earlier */
  dvi__space_operator *transform; /* [variables] */
  int is_constant;                /* second derivatives do not depend on z */
} dvi__density_part;

/* The second derivatives of an integral. Columns of qv are those of v. */
typedef struct dvi__density_patterns {
  dvi__pattern qq, qv, vv;
} dvi__density_patterns;

/* The sum of some parts over their points, times a sign. */
typedef struct dvi__integral {
  const dvi_density *density;
  int parts;
  dvi__density_part **part; /* [parts] */
  double sign;
  dvi__density_patterns patterns;
  int reach;           /* largest distance of two coordinates that a point couples */
  int has_ranges;      /* points of neighbours are neighbours */
  int has_hessian;     /* full for Fourier spaces */
  int depends_on_time; /* also by data that move */
  int has_rate;        /* the derivative in time is known */
  int takes_rates;     /* a part has rates among its variables */
  const dvi__csr
      *less; /* q.less q/2 is taken away, and q.load added, less a value. NULL for none */
  const double *load;
  double less_value;
} dvi__integral;

/* Where an integral is evaluated. Missing vectors are 0. */
typedef struct dvi__density_point {
  double t;
  const double *q, *v;
  int first, last; /* of the coordinates whose derivatives are wanted. 0, 0 for all */
  int take_second; /* second derivatives of values that move stand for their rates */
} dvi__density_point;

/* Results, which are set, each NULL if it is not wanted. */
typedef struct dvi__density_sums {
  double *value, *rate;
  double *q, *v; /* [last-first] */
  double *qq, *qv, *vv;
} dvi__density_sums;

/* Values that are fixed and move. Those of a condition stand in a row. */
typedef struct dvi__moving_values {
  dvi_density_condition given;
  int component;
  int64_t first, count;
  double *x; /* [dimension*count] */
} dvi__moving_values;

struct dvi_density {
  dvi_space *space;
  int dimension, components;
  int64_t functions, places; /* places = components*functions */
  int is_fourier;
  int *unknown;  /* [unknowns] places in U, function by function */
  int *number;   /* [places] of the coordinate, -1 if fixed, -2-i if moving value i */
  double *fixed; /* [places] 0 where a value is not fixed, or moves */
  int64_t unknowns, moving;
  double *site; /* [dimension*functions] the points where functions of a boundary are 1, or NULL */
  dvi__moving_values *mover;
  int movers;
  dvi__density_part *part; /* those of the terms, and then those of the boundary */
  int parts, declared;
  int count[DVI_DENSITY_GENERAL + 1]; /* parts of each kind */
  dvi__rooms *rooms;
  double *constant; /* [functions] coefficients of 1, of a field of first order */
  int *gauge;       /* [components] 1 if a coefficient is left out, because constants do not move */

  dvi__integral kinetic, quadratic, one_form, lagrangian;
  dvi__integral *potential; /* [count of potentials], and the rest of quadratic parts behind */
  int potentials;
  dvi__csr mass, stiffness;
  double mass_scalar;
  int mass_is_diagonal;
  dvi__repeated_rows repeated; /* of the stiffness */
  int has_load;
  double *load; /* [unknowns] minus the gradient of the quadratic parts at 0, without those in t */
  double rest;  /* value of the quadratic parts at 0 */
  int has_rest; /* K and the load are not all of a Fourier field's quadratic parts */
  dvi__csr gradients; /* row j is that of alpha_j. Constant if the one-form is linear */
  int is_linear;
  double fastest;

  /* terms of a system */
  dvi_system_terms terms;
  dvi_potential *potential_term;
  dvi_lagrangian lagrangian_term;
  dvi_one_form one_form_term;
  dvi_vector_potential vector_potential_term;
  dvi_symmetry symmetry[DVI_AXES_MAX];
  struct dvi__field_translation {
    const dvi_density *density;
    int axis;
    char name[32];
  } translation[DVI_AXES_MAX];
  int translations;
  int *no_start; /* [unknowns+1] of empty patterns */
  int *mass_start, *stiffness_start, *gradients_start;
};

/* Copy the parts, and make their operators. */
dvi_status dvi__density_copy_parts(dvi_density *density, const dvi_density_terms *terms);
void dvi__density_part_clear(dvi__density_part *part);

/* Return the matrix that gives variable a of a sparse field's part. */
static inline const dvi__csr *dvi__part_operator(const dvi__density_part *part, int a)
{
  return part->trace.rows > 0 ? &part->trace : &part->transform[a].matrix;
}

/* Make what maps coordinates to the variables of a part. Unbinding takes it away. */
dvi_status dvi__density_bind(dvi_density *density, dvi__density_part *part);
void dvi__density_unbind(dvi__density_part *part);

/* Put the points of a part into the order of their first coordinates, and make one point of those
 * that are the same. `row` [points] has the rows of the operators at the points. It is NULL if the
 * points are the space's, in its order. */
dvi_status dvi__density_order_points(const dvi_density *density, dvi__density_part *part,
                                     int64_t **row);

/* Refuse parts that are not of their kinds, by derivatives at some points. */
dvi_status dvi__density_check_kinds(dvi_density *density);

/* Find what conditions fix, and add parts for fluxes. */
dvi_status dvi__density_fix(dvi_density *density, const dvi_density_terms *terms);
dvi_status dvi__density_number(dvi_density *density);

/* Tell if the space is sparse and its domain is one periodic axis. */
int dvi__density_is_circle(const dvi_density *density);

dvi_status dvi__density_check_datum(const dvi_density *density,
                                    const dvi_density_condition *condition, int failed,
                                    int64_t count, const double *x, const double *datum);
dvi_status dvi__density_add_fluxes(dvi_density *density, const dvi_density_terms *terms);

/* Give the values that move [moving], and their first and second derivatives in time. Returns as
 * callbacks do. Each may be NULL, but the second ones want the first. */
int dvi__density_moving(const dvi_density *density, double t, double *G, double *rate,
                        double *second);

/* Make the integral of the parts of a kind, or of a part alone. `second` tells by bits of
 * dvi__second which second derivatives get patterns. */
typedef enum dvi__second { DVI__QQ = 1, DVI__QV = 2, DVI__VV = 4 } dvi__second;
dvi_status dvi__integral_make(const dvi_density *density, double sign, unsigned second,
                              dvi__integral *integral);
dvi_status dvi__integral_add(dvi__integral *integral, dvi__density_part *part);
void dvi__integral_clear(dvi__integral *integral);

/* Evaluate an integral. Returns as callbacks do, and takes no memory on a single thread. */
int dvi__integral_evaluate(const dvi__integral *integral, const dvi__density_point *at,
                           const dvi__density_sums *sums);

/* The evaluation of a part for sparse spaces, and for Fourier spaces. They add to the sums. */
int dvi__part_sum(const dvi__integral *integral, const dvi__density_part *part,
                  const dvi__density_point *at, const double *room, const dvi__density_sums *sums);
int dvi__part_sum_by_transforms(const dvi__integral *integral, const dvi__density_part *part,
                                const dvi__density_point *at, double *room,
                                const dvi__density_sums *sums);

/* Return the doubles that a room of the field has. */
int64_t dvi__density_room(const dvi_density *density);

/* Make a matrix without values whose rows are the columns of a pattern. */
dvi_status dvi__matrix_of_pattern(const dvi__pattern *pattern, dvi__csr *matrix);

/* Take the coordinates q from coefficients U [places], which may be NULL for 0. */
void dvi__density_take(const dvi_density *density, const double *U, double *q);

/* Make the mass, the stiffness, and the load. */
dvi_status dvi__density_make_mass(dvi_density *density);
dvi_status dvi__density_make_stiffness(dvi_density *density);
/* Set `fastest`. It stays 0 if it is not known, as with a two-form that is not constant. */
dvi_status dvi__density_find_fastest(dvi_density *density);

/* Find rows that repeat, and give y [last-first] = A q for some rows. The bits are those of sums
 * over the entries of each row. */
void dvi__find_repeated_rows(const dvi__csr *A, dvi__repeated_rows *repeated);
void dvi__multiply_rows(const dvi__csr *A, const dvi__repeated_rows *repeated, int64_t first,
                        int64_t last, const double *q, double *y);

/* Make the matrix of the mean coefficients of a Fourier field's kinetic or quadratic parts, and
 * tell whether the coefficients are constant. */
dvi_status dvi__fourier_matrix(const dvi__integral *integral, dvi__csr *matrix, int *is_constant);

/* Give the number of values of a Hessian. */
int64_t dvi__integral_entries(const dvi__integral *integral, const dvi__pattern *pattern);

/* Make the one-form's gauge and refuse a singular two-form. */
dvi_status dvi__density_fix_gauge(dvi_density *density);
dvi_status dvi__density_check_two_form(dvi_density *density);
dvi_status dvi__density_make_one_form(dvi_density *density);

/* Make the terms of a system. */
dvi_status dvi__density_make_terms(dvi_density *density, const dvi_density_terms *terms);

/* Refuse a failure of a part at create, or a number that is not finite. */
dvi_status dvi__density_refuse(int failed, const char *where);

/* Make the Hessian of all parts without rates at q, with a minus sign. */
dvi_status dvi__density_hessian(const dvi_density *density, const double *q, dvi__csr *hessian);

#endif
