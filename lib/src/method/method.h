/* The interface of a method is one const struct. The driver (integrator.c) owns the states,
 * failures and counters.
 *
 * To add a method foo, define `const dvi__method dvi__foo` in foo.c and add the line METHOD(foo) to
 * methods.def. */
#ifndef DVI_METHOD_METHOD_H
#define DVI_METHOD_METHOD_H
#include <dvi/shapes.h>
#include <stdint.h>

#include "system/evaluate/evaluator.h"

/* A step advances this state. Sums are compensated. Each number is too large by its
 * compensation. */
typedef struct dvi__state {
  double t, t_compensation;
  double density; /* z of step control (integrator/control.c) */
  /* the side of singular points (dvi__state_constraint), 0 if not known; more than 1 where rows of
   * holonomic constraints depend on others */
  int side;
  double *q, *p, *q_compensation, *p_compensation; /* [n] */
  /* what forces supplied to the energy and to the momenta of the symmetries since the start, NULL
   * unless that is asked for (dvi_integrator_supplied) */
  double *supplied, *supplied_compensation; /* [1 + symmetries] */
} dvi__state;

/* Rows for the states after steps that are taken together, one after every `every` steps. */
typedef struct dvi__trail {
  int nq, nv;
  long every, wait; /* steps between two rows, and up to the next one */
  long rows;        /* number of rows so far */
  double *t;        /* [rows] */
  double *q, *p;    /* [rows*nq], [rows*nv], or NULL */
} dvi__trail;

/* Add a row. */
void dvi__trail_add(dvi__trail *trail, const dvi__state *state);

/* Count a step, after which there is this state. NULL is allowed. */
static inline void dvi__trail_put(dvi__trail *trail, const dvi__state *state)
{
  if (trail != NULL && --trail->wait == 0) dvi__trail_add(trail, state);
}

/* Several members of an ensemble side by side. Each is a state with the method's memory, and number
 * i of member k is [i*count + k]. */
typedef struct dvi__members {
  int count;
  double *t, *t_compensation;                      /* [count] */
  double *q, *p, *q_compensation, *p_compensation; /* [n*count] */
  double *memory;                                  /* [memory_count*count] */
  /* [count] not 0 for members that are left to `step`, and whose numbers here are invalid */
  char *left;
  /* [count] evaluations in the step, as in dvi_counters */
  long *residuals, *gradients, *fixed;
  long *simplified, *jacobians, *hessians;
} dvi__members;

/* A key of a method's specification. The value is a whole number, one of a list of names, or a
 * positive number. Where `most` is not 0, numbers from `least` on, above the indices of the names,
 * are possible beside names. A positive number may be "auto", which leaves the choice to the
 * method. */
typedef struct dvi__key {
  const char *name;
  /* name of a choice, NULL past the last one; NULL for a number */
  const char *(*choice)(int index);
  int least, most; /* range of a whole number */
  /* default value: a number, or the index of a choice */
  int default_value;
  const char *help;
} dvi__key;

/* Special values of `least`. DVI__POSITIVE marks a positive number or auto (default auto).
 * DVI__SAID marks a choice of what is reported about the steps, which does not change them.
 * DVI__FILE marks the name of a file. A method may have one such key, but not as its first key. The
 * contents of the file are part of the fingerprint. */
enum { DVI__POSITIVE = -2, DVI__SAID = -3, DVI__FILE = -4 };

enum { DVI__KEYS_MOST = 10, DVI__LIST_MOST = 16, DVI__LEFT_OUT = -1 };

/* The most characters of a specification. A second limit holds for a list of names in a sentence,
 * with its terminating 0. */
enum { DVI__SPECIFICATION_MOST = INT_MAX / 4 };

/* Values of the keys, in the order of the method's table. A method may replace DVI__LEFT_OUT by its
 * choice. */
typedef struct dvi__settings {
  int value[DVI__KEYS_MOST];
  double number[DVI__KEYS_MOST]; /* values of keys that are DVI__POSITIVE; 0 is auto */
  double list[DVI__LIST_MOST];   /* numbers of the key that is a list */
  int listed;                    /* length of the list (default 0, no list) */
  /* The settings own the next three, which are NULL if not given. */
  char *list_text; /* the list as text */
  char *file;      /* value of the key that is DVI__FILE */
  char *rest;      /* "key=value,..." for another method; only for methods with takes_rest */
} dvi__settings;

typedef struct dvi__method dvi__method;

/* This tells if the solution of a step lies on the branch connected to h = 0 (solve/branch.h).
 * DVI__SURE is known to lie on it. DVI__LINEAR had nearly linear equations, and the energy decides.
 * For DVI__DOUBTED the energy and the motion decide. DVI__ASTRAY is known not to lie on it. */
typedef enum dvi__doubt { DVI__SURE, DVI__LINEAR, DVI__DOUBTED, DVI__ASTRAY } dvi__doubt;

/* A stepper is a method on a system. */
typedef struct dvi__stepper {
  const dvi__method *method;
  const dvi_system *system;
  /* the program's function space, which outlives the stepper, or NULL */
  const dvi_shapes *shapes;
  dvi_counters *counters;
  dvi__settings settings;
  char *specification; /* specification with every key, owned */
  uint64_t steps;      /* hash of the keys that determine the steps */
  /* create sets a hash of everything else that determines the steps, beside keys, system and
   * functions of the program, and the name of these things, in the plural. */
  uint64_t fingerprint;
  const char *fingerprinted;
  int order;     /* order by theory */
  int symmetric; /* a step of -h undoes a step of h */
  /* the stepper keeps callbacks of the system, or their results at create, and therefore refuses
   * the terms of another system of the same kind */
  int bound;
  /* The memory holds all numbers that the method carries from step to step beside the state. It is
   * saved in checkpoints and restored when a step fails. The method sets the count at create. The
   * driver owns two memories, exchanges them, and allocates them before the first start. */
  double *memory;
  size_t memory_count;
  /* For methods that choose their steps. `step` sets `taken`, the length of the last step. The
   * driver sets `exact`, which is not 0 if the next step must have the given length. */
  double taken;
  int exact;
  /* the largest product of a step and a frequency that is stable, 0 if there is no bound. `create`
   * sets it, and the driver refuses longer steps for the frequencies that a system declares */
  double stable;
  int marches;       /* create sets it if `march` takes steps of the system */
  dvi__trail *trail; /* set by the driver: `march` puts the states after all steps but its last */
  int late_hessians; /* the step may ask for Hessians that create has not asked for */
  int follows;       /* the step solves equations and can follow their branch from h = 0 */
  /* set by the driver: follow the branch in at least this many parts (default 0, no following) */
  int follow;
  uint32_t member;  /* set by the driver: number of the member of an ensemble that starts */
  dvi__doubt doubt; /* set by `step`, reset by the driver */
  /* set by `step`: the momenta [n] between which it conserves the energy, for the test of its
   * branch. NULL (default) for those of the states before and after it */
  const double *free_p[2];
  /* set by `step` beside a doubt: what forces, and rates of a Lagrangian that depends on time,
   * supplied to the energy in the step, by the method's own quadrature. NULL (default) for the mean
   * of the forces' power before and after it */
  const double *work;
  int asks_work; /* an outer stepper wants `work` of all steps */
  double worked; /* the sum of that of inner steps, NaN if one is not known */
  /* curvature of the equations, the worst of dvi__solve_report; set and reset as `doubt` */
  double bend;
  void *own; /* the method's struct */
  /* create sets it if `step` counts what damping takes from the energy (dvi_integrator_supplied) */
  int weighs_damping;
  struct dvi__damping *damping; /* the halves of damping around steps, or NULL (damping.h) */
  /* the method's struct for members side by side; NULL if each member steps on its own */
  void *lanes;
} dvi__stepper;

/* A text that grows in memory of fixed size. */
typedef struct dvi__text {
  char *text;
  size_t size, length; /* length counts the characters that did not fit, too, and may exceed size */
} dvi__text;

void dvi__text_add(dvi__text *text, const char *format, ...) __attribute__((format(printf, 2, 3)));

/* A formatted text in memory of its own, which the caller releases. NULL if there is no memory. */
char *dvi__written(const char *format, ...) __attribute__((format(printf, 1, 2)));

struct dvi__method {
  const char *name, *summary, *cite;
  const dvi__key *keys; /* ended by a key without a name, or NULL */
  /* the key of a list of decimal numbers, c1:c2:..., which is none of `keys`, or NULL */
  const char *list;
  const char *list_help;
  int takes_rest; /* settings.rest collects the keys of other methods */
  /* the function space of the method, or of an inner method, may be the program's */
  int takes_shapes;
  unsigned needs; /* dvi__term bits that the system must declare */
  /* bits that the system may declare, with DVI__FACTORS of every kind except `refuses` */
  unsigned uses;
  unsigned refuses; /* kinds of factors that the method refuses */
  /* `step` may take another length than h, of the same sign, and sets `taken` */
  int chooses_steps;
  /* `step` treats the contacts itself. The driver divides the steps of all other methods at the
   * hits (integrator/hits.h) */
  int takes_contacts;
  /* steps are those of an inner stepper, by dvi__inner_step, and each of them is damped */
  int composes;
  /* Set order, symmetric, memory_count and own. On failure the caller calls destroy. */
  dvi_status (*create)(dvi__stepper *self);
  void (*destroy)(dvi__stepper *self);
  /* Keep the tables of `count` lengths of steps, which a composition takes in turn. Called once.
   * NULL if no table depends on the length. */
  dvi_status (*keep_lengths)(dvi__stepper *self, int count);
  /* Forget earlier steps. The memory is zero, the state is new, and its velocity is v [n]. NULL if
   * this needs no action. */
  void (*start)(dvi__stepper *self, const double *v);
  /* Advance the state. On failure the driver discards state and memory. */
  dvi_status (*step)(dvi__stepper *self, dvi__state *state, double h);
  /* Take `count` steps at once, out of place, from `now` and the memory `before` to `next` and the
   * stepper's memory. Returns 1 if all numbers of `next` are written and finite. Returns 0 if this
   * is not possible or a step fails. Then the driver calls `step`, which must give the same bits
   * and names the failure. NULL if the method has no such pass. */
  int (*pass)(dvi__stepper *self, const dvi__state *now, const double *before, dvi__state *next,
              const double *h, int count);
  /* Take up to `count` steps of length h one after the other, with the bits of `step`, as long as
   * each is sure to be accepted. Advances `state` and the stepper's memory, and puts the state
   * before the last of several steps, without compensations, into `last`. Returns the number of
   * steps taken. After 0 state and memory may hold anything. May be NULL. */
  int (*march)(dvi__stepper *self, dvi__state *state, dvi__state *last, double h, int count);
  /* Bytes that a pass moves (dvi_integrator_traffic), or 0 without a pass with these settings. NULL
   * if not known. */
  double (*traffic)(const dvi__stepper *self, int count);
  /* Evaluate q [n] and v [n] at tau in [0,1] of the last step, which started at q0 [n] with length
   * h. The results are not finite where the path does not exist. NULL selects Hermite's cubic. */
  void (*path)(const dvi__stepper *self, const double *q0, double h, double tau, double *q,
               double *v);
  /* Return 1 if the memory in a checkpoint belongs to the same function space. NULL if the
   * specification determines the space. */
  int (*recognizes)(const dvi__stepper *self, const double *memory);
  /* The multiplier [n] of the last step in the memory, or NULL if there is none. A NULL function
   * means that there never is one. */
  const double *(*multiplier)(const dvi__stepper *self);
  /* The jump [n] between the last element and the next, in the stepper's memory. NULL if the
   * trajectories do not jump. */
  const double *(*jump)(const dvi__stepper *self);
  void (*explain)(const dvi__stepper *self, dvi__text *text);
  /* Report the balance of the energy that the method conserves. NULL if the method conserves no
   * energy. */
  void (*balance)(const dvi__stepper *self, dvi_energy_balance *balance);
  /* Compute the kinetic temperature 2K/n where in the last step its mean is the most accurate. NULL
   * without noise. */
  dvi_status (*temperature)(dvi__stepper *self, const dvi__state *state, double *temperature);
  /* Step members as lanes. All three functions are NULL if the method has no lanes. prepare_lanes
   * allocates `lanes` for up to `capacity` members, if the system allows lanes and they are faster.
   * step_lanes advances all members that are not `left`, each with the bits and the counts of
   * `step`, or marks members as `left`. It is called by dvi__take_step_lanes (damping.h). */
  dvi_status (*prepare_lanes)(dvi__stepper *self, int capacity);
  void (*clear_lanes)(dvi__stepper *self);
  void (*step_lanes)(dvi__stepper *self, dvi__members *members, double h);
};

/* Make a stepper from a specification. The stepper owns all that destroy frees. The method must
 * take `shapes` unless it is NULL. */
dvi_status dvi__stepper_create(const dvi_system *system, const char *specification,
                               const dvi_shapes *shapes, dvi_counters *counters,
                               dvi__stepper *stepper);
void dvi__stepper_destroy(dvi__stepper *stepper);

/* Start from a new state with the velocity v [n] and zero memory. */
void dvi__stepper_start(dvi__stepper *stepper, const double *v);

/* Take a step of an inner stepper on behalf of self. */
dvi_status dvi__inner_step(dvi__stepper *self, dvi__stepper *inner, dvi__state *state, double h);

/* Make the stepper of another method from the keys in self's settings.rest. The rest becomes the
 * keys of the inner method with all defaults, so that each method has one spelling. */
dvi_status dvi__stepper_create_inner(dvi__stepper *self, const char *method,
                                     const dvi_system *system, const dvi_shapes *shapes,
                                     dvi__stepper *inner);

/* Refuse a step that is unstable at the frequencies that the system declares.
 * DVI_STEP_TOO_LARGE. */
dvi_status dvi__stepper_check_step(const dvi__stepper *stepper, double h);

/* Let a stepper serve up to `capacity` members side by side. `lanes` stays NULL if the method
 * cannot do this. Called once. */
dvi_status dvi__stepper_prepare_lanes(dvi__stepper *stepper, int capacity);

/* Parse a specification (settings.c). The caller clears the settings, whatever the status. */
dvi_status dvi__parse(const char *specification, const dvi__method **method,
                      dvi__settings *settings);
void dvi__settings_clear(dvi__settings *settings);

/* The specification with every key, which the caller releases. NULL if there is no memory. */
char *dvi__spell_out(const dvi__method *method, const dvi__settings *settings);

/* The specification with the keys that determine the steps. Keys that are DVI__SAID and the name of
 * a file are not included. */
char *dvi__spell_steps(const dvi__method *method, const dvi__settings *settings);

/* The method with a name, or NULL (table.c). */
const dvi__method *dvi__find_method(const char *name, size_t length);

/* Number of keys in a method's table, without that of a list. */
int dvi__key_count(const dvi__method *method);

#endif
