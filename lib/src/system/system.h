/* The inside of a system, with its terms, copied, and the unions of their patterns. */
#ifndef DVI_SYSTEM_SYSTEM_H
#define DVI_SYSTEM_SYSTEM_H
#include <dvi/contact.h>
#include <dvi/noise.h>
#include <limits.h>
#include <stdint.h>

#include "group/chart.h"
#include "num/linear.h"
#include "num/pattern.h"

/* A set of bits for the terms of a system, and for the terms that a method can use. */
typedef enum dvi__term {
  DVI__CONSTANT_MASS = 1,
  DVI__LAGRANGIAN = 2,
  DVI__ONE_FORM = 4,
  DVI__POTENTIAL = 8,
  DVI__CONSTRAINED_HAMILTONIAN = 16,
  DVI__FACTORS = 32,
  DVI__ROTATIONS = 64, /* among the factors */
  DVI__DIRECTIONS = 128,
  DVI__FAST = 256,        /* among the potentials */
  DVI__HAMILTONIAN = 512, /* without constraints */
  DVI__FORCE = 1024,      /* forces F(t,q) without a potential */
  DVI__FRICTION = 2048,   /* forces F(t,q,v) */
  DVI__FORCES = DVI__FORCE | DVI__FRICTION,
  DVI__HOLONOMIC = 4096, /* constraints phi(t,q) = 0 */
  DVI__VECTOR_POTENTIAL = 8192,
  DVI__NONHOLONOMIC = 16384, /* constraints A(t,q) v + a(t,q) = 0 */
  DVI__CONTACT = 32768,      /* gaps phi(t,q) >= 0 */
  DVI__RUBBING = 65536,      /* contacts with friction */
  DVI__DAMPING = 131072,     /* uniform friction -gamma p */
  DVI__NOISE = 262144,
  DVI__PHASE_SPACE = DVI__CONSTRAINED_HAMILTONIAN | DVI__HAMILTONIAN,
  DVI__DYNAMICS = DVI__CONSTANT_MASS | DVI__LAGRANGIAN | DVI__ONE_FORM | DVI__FACTORS |
                  DVI__PHASE_SPACE, /* one of these is declared */
  DVI__KINDS = DVI__ROTATIONS | DVI__DIRECTIONS | DVI__FAST,
  DVI__LAST_TERM = DVI__NOISE
} dvi__term;

/* Groups of columns that are moved together when a missing Hessian block is differenced. */
typedef struct dvi__groups {
  int count;
  int *of_column; /* group [n] of each column */
} dvi__groups;

typedef struct dvi__potential_term {
  dvi_potential callbacks;
  char *name;
  dvi__pattern qq; /* pattern, empty until dvi__system_prepare_hessian if not declared */
  int *in_qq;      /* places [entries of qq] in the system's qq */
  dvi__groups groups;
} dvi__potential_term;

typedef struct dvi__force_term {
  dvi_force callbacks;
  char *name;
  dvi__pattern by_q, by_v; /* empty until dvi__system_prepare_hessian if not declared */
  int *in_by_q, *in_by_v;  /* places in the system's by_q and by_v */
  dvi__groups q_groups, v_groups;
} dvi__force_term;

/* Some rows of holonomic constraints. */
typedef struct dvi__holonomic_term {
  dvi_holonomic callbacks;
  char *name, **row_names; /* the names of rows may be NULL */
  int first;               /* its first row among all */
  dvi__pattern gradients;  /* n rows, a column for each row of phi */
  dvi__pattern qq;
  int *in_qq; /* places in the system's rows_qq */
  dvi__groups groups;
} dvi__holonomic_term;

typedef struct dvi__vector_term {
  dvi_vector_potential callbacks;
  dvi__pattern gradients; /* column j holds dA_j/dq, as L_qv does */
  dvi__pattern qq;        /* of A.w, empty until dvi__system_prepare_hessian if not declared */
  int *in_qq;             /* places in the system's qq */
  dvi__groups groups;
} dvi__vector_term;

/* Some rows of nonholonomic constraints. */
typedef struct dvi__nonholonomic_term {
  dvi_nonholonomic callbacks;
  char *name;
  int first;               /* its first row among all */
  dvi__pattern transposed; /* n rows, a column for each row of A */
  dvi__pattern by_q;       /* of d(A v + a)/dq, a row for each row of A, n columns */
  dvi__groups groups;
} dvi__nonholonomic_term;

/* A contact. Its gap is a function as that of a holonomic constraint of one row. */
typedef struct dvi__contact_term {
  dvi_contact callbacks;
  dvi__holonomic_term gap; /* its callbacks, name and gradients alone */
  dvi__pattern tangents;   /* n rows, tangent_count columns */
} dvi__contact_term;

/* The gradient of a function beside a one-form alpha, and the places of the entries of both in the
 * sum. */
typedef struct dvi__gauge_term {
  dvi_gauge callbacks;               /* without a gradient there is no gauge */
  dvi__pattern qq, form_qq, form_qv; /* qq is that of f, the others those of alpha alone */
  int *in_qq, *in_qv, *form_in_qq, *form_in_qv;
} dvi__gauge_term;

/* A Lagrangian that a part of the library computes from another one. Shapes are as in
 * system/evaluate/evaluator.h. `of` is that of the term. */
typedef struct dvi__computed {
  dvi_status (*value)(void *of, int count, const double *t, const double *q, const double *v,
                      double *L);
  dvi_status (*gradient)(void *of, int count, const double *t, const double *q, const double *v,
                         double *L_q, double *L_v);
  dvi_status (*hessian)(void *of, int count, const double *t, const double *q, const double *v,
                        double *L_qq, double *L_qv, double *L_vv);
  double (*noise)(const void *of);               /* as dvi__hessian_noise */
  dvi_status (*reserve)(void *of, int capacity); /* make room for so many points in a batch */
} dvi__computed;

/* A general Lagrangian, or alpha(q).v, or a Hamiltonian, which is a function of p in the place of
 * v. */
typedef struct dvi__lagrangian_term {
  const char *name; /* name for messages, "Lagrangian", "Hamiltonian" or "constraint" */
  dvi_lagrangian callbacks;
  const struct dvi__computed *computed; /* replaces the callbacks if not NULL */
  void *of;                             /* first argument of `computed` */
  dvi_one_form one_form;                /* used if one_form.value is not NULL */
  dvi__gauge_term gauge;
  dvi__pattern qq, qv, vv;
  dvi__pattern omega; /* pattern of the two-form, qv and its transpose */
  int *in_qq;         /* places [entries of qq] */
  /* groups of q columns of qq, and of v columns of qv and vv together */
  dvi__groups q_groups, v_groups;
} dvi__lagrangian_term;

/* A factor, or a coordinate of R^n, with its chart and the first index of its numbers. A factor of
 * rigid motions has one slot of rotations and three of coordinates. */
typedef struct dvi__factor_slot {
  dvi__chart_kind kind;
  int q, v, x; /* first stored coordinate, first stored velocity, first chart coordinate */
} dvi__factor_slot;

/* Constraints phi(q,p) = 0. */
typedef struct dvi__constraint_term {
  dvi_constraint callbacks;
  dvi__pattern gradients; /* 2n rows, m columns */
  dvi__pattern bracket;   /* full, m x m */
  /* patterns and groups of phi.w, a function of q and p, without callbacks */
  dvi__lagrangian_term weighted;
} dvi__constraint_term;

/* Ints count coordinates, and up to four numbers of each. */
enum { DVI__DIMENSION_MOST = INT_MAX / 4 };

/* Hashes of all that is declared, without the results of callbacks. The parts are terms, masses,
 * patterns, potentials, invariants, forces, holonomic and nonholonomic constraints, contacts,
 * damping, noise. */
enum { DVI__DECLARED_NOISE = 10, DVI__DECLARED_PARTS };
typedef struct dvi__declared {
  uint64_t hash[DVI__DECLARED_PARTS];
} dvi__declared;

/* The form of the equations of motion (system/evaluate/dynamics.h). */
typedef struct dvi__dynamics dvi__dynamics;

struct dvi_system {
  const dvi__dynamics *dynamics;
  int n;          /* stored coordinates */
  int nv;         /* numbers of a velocity, n without factors */
  int nx;         /* degrees of freedom */
  int slot_count; /* 0 without factors */
  dvi__factor_slot *slots;
  int autonomous; /* declared autonomous */
  dvi__declared declared;
  unsigned terms; /* dvi__term bits */
  double damping; /* gamma of DVI__DAMPING, else 0 */
  double mass_scalar;
  double *mass_diagonal;
  double *mass_values;              /* in the order of vv */
  dvi__linear *mass_factor;         /* of mass_values if they are positive definite, or NULL */
  const dvi_system *mass_of;        /* the system whose mass this one has, or NULL */
  dvi__lagrangian_term *lagrangian; /* general, of the one-form, or the Hamiltonian */
  dvi__constraint_term *constraint; /* constraints of a Hamiltonian, or NULL */
  dvi__potential_term *potentials;
  int potential_count;
  dvi__force_term *forces;
  int force_count;
  dvi__vector_term *vector; /* the vector potential, or NULL */
  dvi__holonomic_term *holonomics;
  int holonomic_count;
  dvi__nonholonomic_term *nonholonomics;
  int nonholonomic_count;
  /* The rows of holonomic constraints, followed by those of nonholonomic ones, and how many there
   * are of the former. Patterns [n x row_count] of d phi/dq and A^T by columns, and of the Hessian
   * of phi.w. */
  int row_count, place_rows;
  dvi__pattern rows_q, rows_qq;
  dvi__contact_term *contacts;
  int contact_count;
  const dvi_system *held_of;            /* the system of which this one holds a contact, or NULL */
  dvi_noise noise;                      /* zero without DVI__NOISE */
  dvi__potential_term *noise_functions; /* [noise.function_count] */
  dvi_symmetry *symmetries;
  int symmetry_count;
  dvi_invariant *invariants;
  int invariant_count;
  char **invariant_names; /* names of energy, symmetries, invariants */
  /* Patterns of L's Hessian. vv is diagonal for scalar and diagonal masses, empty for a one-form.
   * Beside a constant mass qv is that of a vector potential's gradients, or empty.
   * With a Hamiltonian qv and vv are those of H_qp and H_pp. qq is the union over the terms, empty
   * until dvi__system_prepare_hessian. by_q and by_v are those of F_q and F_v of all forces (row i
   * for component i), made with qq. */
  dvi__pattern qv, vv, qq, by_q, by_v;
};

/* Create a system like dvi_system_create. It has the mass of another system, which must outlive it
 * and whose factor it shares, or one of its own if that is NULL. */
dvi_status dvi__system_create_part(const dvi_system_terms *terms, const dvi_system *mass_of,
                                   dvi_system **system);

/* Give a lower bound of the entries of L_qq. A pattern that was not declared counts as full, and
 * that of a potential without a Hessian as empty. */
size_t dvi__system_least_entries(const dvi_system *system);

/* Complete the patterns of L_qq and of the forces, once. Patterns that were not declared become
 * full, with n^2 entries that only a method with Hessians should pay for. Integrators on several
 * threads may call this at one time. Return DVI_BAD_SIZE if an int cannot count the entries, and
 * DVI_UNSUPPORTED if a potential is declared without a Hessian. */
dvi_status dvi__system_prepare_hessian(const dvi_system *system);

/* Do the same for the terms that have Hessians alone. */
dvi_status dvi__system_complete_patterns(const dvi_system *system);

/* Return the name of the first potential that is declared without a Hessian, or NULL. The second
 * function returns DVI_UNSUPPORTED if there is one. */
const char *dvi__system_without_hessian(const dvi_system *system);
dvi_status dvi__system_has_hessians(const dvi_system *system);

/* Return a bound of the frequencies of the quadratic potentials that declare theirs, 0 if none
 * does. */
double dvi__system_fastest(const dvi_system *system);

/* Return 1 if all potentials give their gradient, so that no force is differenced. */
int dvi__system_has_gradients(const dvi_system *system);

/* Return the relative error of the second derivatives. It is 0 if all terms give theirs, else that
 * of differences (system/term/difference.h). */
double dvi__hessian_noise(const dvi_system *system);

/* Return DVI_OK if L_t is known, because the system is autonomous, or all terms give their rates.
 * Else the sentence names the term without a rate. */
dvi_status dvi__system_has_rates(const dvi_system *system);

/* Return DVI_OK if A_t of the vector potential is known. Else the sentence says what to give. */
dvi_status dvi__system_has_field(const dvi_system *system);

/* Return DVI_OK if all terms give the Taylor coefficients of L. Else the sentence names the term
 * without them. */
dvi_status dvi__system_has_taylor(const dvi_system *system);

/* Compute the hashes. The second function names the first part in which they differ, or returns
 * NULL. */
void dvi__system_declared(const dvi_system *system, dvi__declared *declared);
const char *dvi__declared_difference(const dvi__declared *one, const dvi__declared *other);

/* Return DVI_OK if one system may replace the other in all that is made for it. Both then declare
 * the same terms, masses, patterns, names, speeds, derivatives and reaches, and differ only in the
 * results of their callbacks. */
dvi_status dvi__system_alike(const dvi_system *a, const dvi_system *b);

#endif
