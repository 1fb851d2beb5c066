/* A field on a mesh, a k-form: what is held, and the equations of the rest. */
#ifndef DVI_FIELD_MODEL_FIELD_H
#define DVI_FIELD_MODEL_FIELD_H
#include <dvi/march.h>
#include <dvi/maxwell.h>

#include "field/algebra/csr.h"
#include "field/mesh/mesh.h"

/* A translation of the field, q -> q + epsilon D q. */
typedef struct dvi__translation {
  char name[16];
  dvi__csr D;
} dvi__translation;

enum { DVI__CURRENTS = 64 };

/* A current that is given, J = profile times signal. The profile is zero but for some entries. */
typedef struct dvi__current {
  int64_t count;  /* of entries */
  int *unknown;   /* [count] ascending */
  double *weight; /* [count] */
  int (*signal)(double t, double *value, void *user);
  int (*impulse)(double from, double to, double *value, void *user); /* or NULL */
  void *user;
} dvi__current;

/* A sum of weights times values of a form. */
typedef struct dvi__functional {
  int count;
  int *cell;
  double *weight;
  int is_here; /* the process owns its place */
} dvi__functional;

/* What a probe measures: a value, the power through facets, or the energy in a part. */
typedef enum dvi__probe_kind {
  DVI__PROBE_VALUE,
  DVI__PROBE_FLUX,
  DVI__PROBE_ENERGY
} dvi__probe_kind;

/* A value of E times one of B, or of E again. */
typedef struct dvi__product {
  dvi__functional factor[2];
  int is_square;
} dvi__product;

typedef struct dvi__probe {
  char *name;
  dvi__probe_kind kind;
  int is_B;                    /* of a value */
  dvi__functional value;       /* of a value */
  int count;                   /* of products, whose sum is the power of a flux */
  dvi__product *product;       /* [count] */
  dvi__csr electric, magnetic; /* the matrices of an energy */
} dvi__probe;

struct dvi_field {
  dvi_star *star;
  const dvi_mesh *mesh; /* the star's */
  int degree;           /* k */
  int is_wave;          /* the form is what is looked at, not its rate */
  int64_t cells, unknowns;
  int64_t whole_unknowns; /* of all processes, if the mesh is a share */
  int *unknown;           /* [unknowns] k-cells */
  int *number;            /* [cells] of the unknown at a cell, or -1 */
  double *fixed;          /* [cells] values, 0 where they are not fixed */
  double *load;           /* [unknowns] W f + b, less what the fixed values take away */
  double rest;            /* energy of the fixed values alone */
  double *weight;         /* [unknowns] sums of the rows of W */
  double *point;          /* [unknowns*space] */
  int *component;         /* [unknowns] number of the free component, or -1 */
  int64_t components;     /* without a fixed value */
  dvi__csr mass, stiffness;
  dvi__csr damping;     /* S of the current S E. Without rows if there is none */
  int is_damped;        /* there is one, perhaps with rows on other processes alone */
  int mass_is_diagonal; /* the damping is then diagonal, too */
  dvi__current *current;
  int currents;
  dvi__probe *probe;
  int probes;
  dvi_field_potential potential; /* without a density if there is none */
  _Atomic double fastest;        /* bound of the frequencies, 0 until it is asked for */
  /* The rest is made for systems. */
  int *mass_start, *stiff_start; /* [unknowns+1] */
  int *diagonal_start;           /* [unknowns+1] 0, 1, 2 ..., also the rows */
  int *no_start, *damping_start; /* [unknowns+1] of an empty pattern, and of the damping's */
  dvi_force loss;
  int reach; /* largest distance of neighbours in the order of unknowns */
  dvi_potential potentials[2];
  dvi_symmetry symmetry[DVI_MESH_SPACE_MAX];
  dvi__translation translation[DVI_MESH_SPACE_MAX];
  int translations;
};

/* Take rows and columns of the unknowns. */
dvi_status dvi__field_select(const dvi_field *field, const dvi_matrix *A, dvi__csr *part);

/* Give row i of a matrix of the unknowns times a form [cells]. */
double dvi__field_row(const dvi_field *field, const dvi__csr *A, int64_t i, const double *form);

/* Number the unknowns, the cells whose `number` is not negative. */
dvi_status dvi__field_number(dvi_field *field);

/* Make mass and stiffness, and take away from the load what the fixed values pull. */
dvi_status dvi__field_make_matrices(dvi_field *field, double *load);

/* Subtract the product of the fixed values with a form [cells], times a factor, from their energy.
 * Called on all processes. */
dvi_status dvi__field_take_rest(dvi_field *field, double factor, const double *form);

/* Make the damping of conductors and absorbing walls. */
dvi_status dvi__maxwell_make_damping(dvi_field *field, const dvi_maxwell_terms *terms);

/* Give the integral of a current's signal, which is refused if it is not finite. */
dvi_status dvi__current_impulse(const dvi_field *field, int current, double from, double to,
                                double *impulse);

/* Return the first entry of a current at the unknown i or behind it. */
int64_t dvi__current_entry(const dvi__current *current, int64_t i);

/* Add scale times the sum of the currents' profiles, each times its factor [currents], to
 * b [unknowns]. */
void dvi__add_currents(const dvi_field *field, double scale, const double *factor, double *b);

/* Make the currents and the probes. */
dvi_status dvi__maxwell_make_currents(dvi_field *field, const dvi_maxwell_terms *terms);
dvi_status dvi__maxwell_make_probes(dvi_field *field, const dvi_maxwell_terms *terms);
void dvi__probe_clear(dvi__probe *probe);

/* Make the products of the power through a part, out of its cells or out of the mesh. */
dvi_status dvi__probe_make_flux(const dvi_field *field, const dvi_maxwell_terms *terms,
                                const char *part, dvi__probe *probe);

/* Refuse a part for a reason, such as "which has no cells". */
dvi_status dvi__probe_refuse(const char *name, const char *part, const char *why);

/* Mark the n-cells [n-cells] of a part with 1, for dvi__release. NULL without memory. */
char *dvi__mark_cells(const dvi_mesh *mesh, const char *part);

/* Return the admittance sqrt(eps/mu) of an n-cell. */
double dvi__admittance(const dvi_field *field, int64_t cell);

/* Give values of a form at cells, or at all if `cell` is NULL, as dvi__march_kind's sample does. */
typedef dvi_status dvi__field_sampler(const void *of, dvi_march_form form, int64_t count,
                                      const int *cell, double *values);

/* Evaluate the probe i. */
dvi_status dvi__field_probe(const dvi_field *field, int i, dvi__field_sampler *sample,
                            const void *of, double *value);

/* Make the functional of a form of degree k at a point, or at a place in an n-cell: the product of
 * `along` with its components. DVI_BAD_ARGUMENT if the point lies outside. Of a share, all
 * processes give the same point, and functionals are empty where its n-cell is not. */
dvi_status dvi__functional_at(const dvi_mesh *mesh, int k, const double *at, const double *along,
                              dvi__functional *functional);
dvi_status dvi__functional_make(const dvi_mesh *mesh, int k, int64_t cell, const double *place,
                                const double *along, dvi__functional *functional);
void dvi__functional_clear(dvi__functional *functional);

/* Find what is fixed: fill in `unknown`, `number`, `fixed`. */
dvi_status dvi__field_fix(dvi_field *field, const dvi_wave_terms *terms);

/* Add the fluxes of the conditions to b [vertices]. */
dvi_status dvi__field_add_fluxes(const dvi_field *field, const dvi_wave_terms *terms, double *b);

/* Find the components of the mesh without fixed values. */
dvi_status dvi__field_find_components(dvi_field *field);

/* Evaluate the sum of w V(u), and its derivatives, of unknowns `first` to `last`-1. Each result may
 * be NULL; the derivatives are [last-first]. */
typedef struct dvi__density {
  double *sum, *first, *second;
} dvi__density;
int dvi__field_density(const dvi_field *field, const double *q, int64_t first, int64_t last,
                       const dvi__density *density);

/* Find the translations under which the field is invariant. */
dvi_status dvi__field_find_translations(dvi_field *field);

/* Refuse a datum that is not finite, or whose callback failed, at a vertex or facet. */
dvi_status dvi__field_check_datum(const dvi_field *field, const char *what, int failed,
                                  double value, int k, int64_t cell);

#endif
