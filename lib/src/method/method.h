/* What a method is: one const struct. The driver (integrator.c) owns the states, failures and
 * counters.
 *
 * To add a method foo: foo.c defines `const dvi__method dvi__foo`, methods.def gets the line
 * METHOD(foo). */
#ifndef DVI_METHOD_METHOD_H
#define DVI_METHOD_METHOD_H
#include <dvi/shapes.h>
#include <stdint.h>

#include "system/evaluate/evaluator.h"

/* The state that a step advances. Sums are compensated: what a carry holds, its number is too large
 * by. */
typedef struct dvi__state {
  double t, t_compensation;
  double density; /* step control's z (integrator/control.c) */
  /* the driver's, of degenerate systems: dvi__two_form_side or dvi__dirac_side; 0: not known */
  int side;
  double *q, *p, *q_compensation, *p_compensation; /* [n] */
} dvi__state;

/* Several members of an ensemble side by side, each a state with the method's memory: number i of
 * member k is [i*count + k]. */
typedef struct dvi__members {
  int count;
  double *t, *t_compensation;                      /* [count] */
  double *q, *p, *q_compensation, *p_compensation; /* [n*count] */
  double *memory;                                  /* [memory_count*count] */
  /* [count] not 0: this member is left to `step`; what stands here for it does not count */
  char *left;
  /* [count] what the step took, as dvi_counters has it: residuals, gradients, fixed_points */
  long *residuals, *gradients, *fixed;
} dvi__members;

/* A key of a method's specification: a whole number, one of a list of names (or a number from
 * `least` on, above the names' indices, where `most` is not 0), or a positive number that "auto"
 * leaves to the method. */
typedef struct dvi__key {
  const char *name;
  const char *(*choice)(int index); /* name of a choice, NULL past the last one; NULL: a number */
  int least, most;                  /* of a whole number */
  /* the value of a key that is not given: a number, or the index of a choice */
  int left_out;
  const char *help;
} dvi__key;

/* As `least`: the key is a positive number, or auto, which it is if it is not given; the key is
 * a choice of what is said of the steps, and does not change them; it is the name of a file, of
 * which a method may have one, but not as its first key: what the file holds is in the
 * fingerprint. */
enum { DVI__POSITIVE = -2, DVI__SAID = -3, DVI__FILE = -4 };

enum { DVI__KEYS_MOST = 10, DVI__LIST_MOST = 16, DVI__LEFT_OUT = -1 };

/* Characters of a specification; and of a list of names in a sentence, with its end. */
enum { DVI__SPECIFICATION_MOST = INT_MAX / 4 };

/* Values of the keys, in the order of the method's table. A method may replace DVI__LEFT_OUT by
 * what it chose. */
typedef struct dvi__settings {
  int value[DVI__KEYS_MOST];
  double number[DVI__KEYS_MOST]; /* of keys that are DVI__POSITIVE; 0: auto */
  double list[DVI__LIST_MOST];   /* numbers of the key that is a list */
  int listed;                    /* how many; 0: it is not given */
  /* Owned; NULL: not given. */
  char *list_text; /* the list as it was written */
  char *file;      /* of the key that is DVI__FILE */
  char *rest; /* "key=value,..." that are not the method's own; only for methods that take them */
} dvi__settings;

typedef struct dvi__method dvi__method;

/* Whether the solution that a step takes is that of the branch from h = 0 (solve/branch.h): known
 * to be; for its energy to say, as its equations were nearly linear; for its energy and its motion
 * to say; known not to be. */
typedef enum dvi__doubt { DVI__SURE, DVI__LINEAR, DVI__DOUBTED, DVI__ASTRAY } dvi__doubt;

/* A method on a system. */
typedef struct dvi__stepper {
  const dvi__method *method;
  const dvi_system *system;
  /* the program's function space, for methods that take one; NULL: there is none. Outlives the
   * stepper */
  const dvi_shapes *shapes;
  dvi_counters *counters;
  dvi__settings settings;
  char *specification; /* every key spelled out; owned */
  uint64_t steps;      /* hash of the keys that determine the steps */
  /* A hash of what determines the steps beside keys, system and functions of the program, and
   * what that is, in the plural: set by create. */
  uint64_t fingerprint;
  const char *fingerprinted;
  int order;     /* what theory claims */
  int symmetric; /* a step of -h undoes a step of h */
  /* it keeps callbacks of the system, or what they gave at create, and so cannot take the terms of
   * another system that is alike */
  int bound;
  /* What the method carries from step to step beside the state: saved in checkpoints, restored when
   * a step fails. The method sets the count at create; the memory is the driver's, who has two and
   * exchanges them, and is there from the first start on. */
  double *memory;
  size_t memory_count;
  /* Of methods that choose their steps: the length of the last one, set by `step`; and what the
   * driver sets, not 0: the next one is as long as it says. */
  double taken;
  int exact;
  int late_hessians; /* it may ask for Hessians that it has not asked for at create */
  int follows; /* it solves equations, and can follow their branch from h = 0 */
  /* set by the driver: the step does so, in at least so many parts; 0: it does not */
  int follow;
  dvi__doubt doubt; /* set by `step`, reset by the driver, */
  double bend;      /* and so is how much its equations bent: the worst of dvi__solve_report */
  void *own;        /* the method's struct */
  void *lanes;      /* its struct for members side by side; NULL: each member steps on its own */
} dvi__stepper;

/* A growing text in memory of fixed size. */
typedef struct dvi__text {
  char *text;
  size_t size, length; /* length may exceed size: it counts what did not fit, too */
} dvi__text;

void dvi__text_add(dvi__text *text, const char *format, ...) __attribute__((format(printf, 2, 3)));

/* A text in memory of its own, to be released; NULL: there is none left. */
char *dvi__written(const char *format, ...) __attribute__((format(printf, 1, 2)));

struct dvi__method {
  const char *name, *summary, *cite;
  const dvi__key *keys; /* ended by a key without a name; NULL: none */
  /* the key of a list of decimal numbers, c1:c2:..., not one of the above; NULL: none */
  const char *list;
  const char *list_help;
  int takes_rest;   /* keys of others are collected in settings.rest */
  int takes_shapes; /* its space, or that of a method that it is made of, may be the program's */
  unsigned needs;   /* dvi__term bits that the system must declare */
  unsigned uses;    /* bits that it may declare; with DVI__FACTORS of every kind, but for */
  unsigned refuses; /* these kinds */
  /* `step` may take another length than h, of the same sign, and says it in `taken` */
  int chooses_steps;
  /* Set order, symmetric, memory_count, own. On failure destroy is called. */
  dvi_status (*create)(dvi__stepper *self);
  void (*destroy)(dvi__stepper *self);
  /* Steps will have `count` lengths in turn, those of a composition: keep what is made for each.
   * Once. NULL: nothing is made for a length alone. */
  dvi_status (*keep_lengths)(dvi__stepper *self, int count);
  /* Earlier steps are forgotten: the memory is zero, the state is new, and its velocity is v [n].
   * NULL: no more than that need be known. */
  void (*start)(dvi__stepper *self, const double *v);
  /* Advance the state. On failure the driver throws state and memory away. */
  dvi_status (*step)(dvi__stepper *self, dvi__state *state, double h);
  /* The same for `count` steps at once, out of place: from `now` and the memory `before` to `next`
   * and the stepper's memory. 1 if all of next's numbers are written and found finite; 0 if that
   * cannot be, or a step fails: then the driver takes it by `step`, which is to give the same bits,
   * and says what fails. NULL: no such thing. */
  int (*pass)(dvi__stepper *self, const dvi__state *now, const double *before, dvi__state *next,
              const double *h, int count);
  /* Bytes that this moves (dvi_integrator_traffic); 0: there is no pass with these settings. NULL:
   * not known. */
  double (*traffic)(const dvi__stepper *self, int count);
  /* q [n] and v [n] at tau in [0,1] of the last step, which started at q0 [n] with length h; not
   * finite where it cannot be had. NULL: Hermite's cubic. */
  void (*path)(const dvi__stepper *self, const double *q0, double h, double tau, double *q,
               double *v);
  /* Whether a memory that a checkpoint holds is of the same space. NULL: the specification
   * tells. */
  int (*recognizes)(const dvi__stepper *self, const double *memory);
  /* The multiplier [n] of the last step, in the memory; NULL if there is none. NULL: never. */
  const double *(*multiplier)(const dvi__stepper *self);
  /* The jump [n] between the last element and the next, in the stepper's memory. NULL: the method's
   * trajectories do not jump. */
  const double *(*jump)(const dvi__stepper *self);
  void (*explain)(const dvi__stepper *self, dvi__text *text);
  /* What became of the energy that the method conserves; NULL: it conserves none. */
  void (*balance)(const dvi__stepper *self, dvi_energy_balance *balance);
  /* Members as lanes; all three are NULL where there is no such way. prepare makes `lanes` for up
   * to `capacity` members, if the system allows it and it pays. step advances all members that are
   * not `left`, each with the bits and the counts of `step`, or leaves them to it. */
  dvi_status (*prepare_lanes)(dvi__stepper *self, int capacity);
  void (*clear_lanes)(dvi__stepper *self);
  void (*step_lanes)(dvi__stepper *self, dvi__members *members, double h);
};

/* Make a stepper from a specification; it owns all that destroy frees. shapes: NULL, or what the
 * method must take. */
dvi_status dvi__stepper_create(const dvi_system *system, const char *specification,
                               const dvi_shapes *shapes, dvi_counters *counters,
                               dvi__stepper *stepper);
void dvi__stepper_destroy(dvi__stepper *stepper);

/* The state is new, its velocity is v [n], and the memory zero. */
void dvi__stepper_start(dvi__stepper *stepper, const double *v);

/* A step of a stepper that the method itself is made of. */
dvi_status dvi__inner_step(dvi__stepper *self, dvi__stepper *inner, dvi__state *state, double h);

/* The stepper of another method, by the keys in self's settings.rest, which becomes the other's
 * keys spelled out: one method, one spelling. */
dvi_status dvi__stepper_create_inner(dvi__stepper *self, const char *method,
                                     const dvi_system *system, const dvi_shapes *shapes,
                                     dvi__stepper *inner);

/* Let a stepper serve up to `capacity` members side by side, if its method can: lanes stays NULL if
 * not. Once. */
dvi_status dvi__stepper_prepare_lanes(dvi__stepper *stepper, int capacity);

/* Parse a specification (settings.c); settings are to be cleared, whatever the status. */
dvi_status dvi__parse(const char *specification, const dvi__method **method,
                      dvi__settings *settings);
void dvi__settings_clear(dvi__settings *settings);

/* The specification with every key spelled out, to be released; NULL: no memory. */
char *dvi__spell_out(const dvi__method *method, const dvi__settings *settings);

/* The same of the keys that determine the steps: without what is said of them, and the name of a
 * file. */
char *dvi__spell_steps(const dvi__method *method, const dvi__settings *settings);

/* The method of a name, or NULL (table.c). */
const dvi__method *dvi__find_method(const char *name, size_t length);

/* Number of keys in a method's table, without that of a list. */
int dvi__key_count(const dvi__method *method);

#endif
