/* The inside of a system: its terms, copied, with the unions of their patterns. */
#ifndef DVI_SYSTEM_SYSTEM_H
#define DVI_SYSTEM_SYSTEM_H
#include <dvi/system.h>
#include <limits.h>
#include <stdint.h>

#include "group/chart.h"
#include "num/linear.h"
#include "num/pattern.h"

/* What a system declares, and what a method can use: a set of bits. */
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
  DVI__PHASE_SPACE = DVI__CONSTRAINED_HAMILTONIAN | DVI__HAMILTONIAN,
  DVI__KINDS = DVI__ROTATIONS | DVI__DIRECTIONS | DVI__FAST,
  DVI__LAST_TERM = DVI__HAMILTONIAN
} dvi__term;

/* How to difference a missing Hessian block: columns of a group are moved together. */
typedef struct dvi__groups {
  int count;
  int *of_column; /* [n] */
} dvi__groups;

typedef struct dvi__potential_term {
  dvi_potential callbacks;
  char *name;
  dvi__pattern qq; /* empty until dvi__system_prepare_hessian if it was left out */
  int *in_qq;      /* [entries of qq]: where they stand in the system's qq */
  dvi__groups groups;
} dvi__potential_term;

/* The gradient of a function beside a one-form alpha, and where the entries of both stand in the
 * sum's. */
typedef struct dvi__gauge_term {
  dvi_gauge callbacks;               /* without a gradient: there is none */
  dvi__pattern qq, form_qq, form_qv; /* of f; of alpha alone */
  int *in_qq, *in_qv, *form_in_qq, *form_in_qv;
} dvi__gauge_term;

/* A Lagrangian that a part of the library computes from another one. Shapes as in
 * system/evaluate/evaluator.h; `of` is the term's. */
typedef struct dvi__computed {
  dvi_status (*value)(void *of, int count, const double *t, const double *q, const double *v,
                      double *L);
  dvi_status (*gradient)(void *of, int count, const double *t, const double *q, const double *v,
                         double *L_q, double *L_v);
  dvi_status (*hessian)(void *of, int count, const double *t, const double *q, const double *v,
                        double *L_qq, double *L_qv, double *L_vv);
  double (*noise)(const void *of);               /* as dvi__hessian_noise */
  dvi_status (*reserve)(void *of, int capacity); /* room for so many points in a batch */
} dvi__computed;

/* A general Lagrangian, or alpha(q).v; or a Hamiltonian, which is a function of p where these are
 * functions of v. */
typedef struct dvi__lagrangian_term {
  const char *name; /* for messages: "Lagrangian", "Hamiltonian", "constraint" */
  dvi_lagrangian callbacks;
  const struct dvi__computed *computed; /* not NULL: it stands in the place of the callbacks, */
  void *of;                             /* with this first argument */
  /* without a value: there is none, and the callbacks above count */
  dvi_one_form one_form;
  dvi__gauge_term gauge;
  dvi__pattern qq, qv, vv;
  dvi__pattern omega;             /* of the one-form's two-form: qv and its transpose */
  int *in_qq;                     /* [entries of qq] */
  dvi__groups q_groups, v_groups; /* q columns of qq; v columns of qv and vv together */
} dvi__lagrangian_term;

/* A factor, or a coordinate of R^n: which chart it has, and where its numbers begin. A factor of
 * rigid motions is one of rotations and three coordinates. */
typedef struct dvi__factor_slot {
  dvi__chart_kind kind;
  int q, v, x; /* of the stored coordinates, of the stored velocities, of the chart's coordinates */
} dvi__factor_slot;

/* Constraints phi(q,p) = 0. */
typedef struct dvi__constraint_term {
  dvi_constraint callbacks;
  dvi__pattern gradients; /* 2n rows, m columns */
  dvi__pattern bracket;   /* full, m x m */
  /* patterns and groups of phi.w, a function of q and p; without callbacks */
  dvi__lagrangian_term weighted;
} dvi__constraint_term;

/* Ints count coordinates, and up to four numbers of each. */
enum { DVI__DIMENSION_MOST = INT_MAX / 4 };

/* Hashes of all that is declared, but for what callbacks compute: terms, masses, patterns,
 * potentials, invariants. */
enum { DVI__DECLARED_PARTS = 5 };
typedef struct dvi__declared {
  uint64_t hash[DVI__DECLARED_PARTS];
} dvi__declared;

/* What the equations of motion are (system/evaluate/dynamics.h). */
typedef struct dvi__dynamics dvi__dynamics;

struct dvi_system {
  const dvi__dynamics *dynamics;
  int n;          /* stored coordinates */
  int nv;         /* numbers of a velocity: n without factors */
  int nx;         /* degrees of freedom */
  int slot_count; /* 0: no factors */
  dvi__factor_slot *slots;
  int autonomous; /* declared so */
  dvi__declared declared;
  unsigned terms; /* dvi__term bits */
  double mass_scalar;
  double *mass_diagonal;
  double *mass_values;              /* in the order of vv */
  dvi__lagrangian_term *lagrangian; /* general, or made of the one-form, or the Hamiltonian */
  dvi__constraint_term *constraint; /* with a Hamiltonian; else NULL */
  dvi__potential_term *potentials;
  int potential_count;
  dvi_symmetry *symmetries;
  int symmetry_count;
  dvi_invariant *invariants;
  int invariant_count;
  char **invariant_names; /* energy, symmetries, invariants */
  dvi__pattern qv,
      /* of L's Hessian; vv is diagonal for scalar and diagonal masses, empty for a one-form. With a
       * Hamiltonian: of its H_qp and H_pp */
      vv;
  dvi__pattern qq; /* the union over the terms; empty until dvi__system_prepare_hessian */
};

/* Complete the patterns of L_qq, once: left-out ones are full, n^2 entries that only a method with
 * Hessians should pay for. Integrators on several threads may call it at one time. DVI_BAD_SIZE if
 * an int cannot count the entries. */
dvi_status dvi__system_prepare_hessian(const dvi_system *system);

/* Whether all potentials give their gradient: nothing is differenced for forces. */
int dvi__system_has_gradients(const dvi_system *system);

/* The relative error of the second derivatives: 0 if all terms give theirs, else that of
 * differences (system/term/difference.h). */
double dvi__hessian_noise(const dvi_system *system);

/* DVI_OK if L_t is known: the system is autonomous, or all terms give their rates. Else the
 * sentence names the term without. */
dvi_status dvi__system_has_rates(const dvi_system *system);

/* DVI_OK if the Taylor coefficients of L are known: all terms give them. Else the sentence names
 * the term without. */
dvi_status dvi__system_has_taylor(const dvi_system *system);

/* The hashes; and in which part they differ first, in words. NULL: in none. */
void dvi__system_declared(const dvi_system *system, dvi__declared *declared);
const char *dvi__declared_difference(const dvi__declared *one, const dvi__declared *other);

/* DVI_OK if one may stand in for the other in all that is made for it: they declare the same terms,
 * masses, patterns, names, speeds, derivatives and reaches, and differ in what their callbacks
 * compute alone. */
dvi_status dvi__system_alike(const dvi_system *a, const dvi_system *b);

#endif
