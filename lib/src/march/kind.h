/* Kinds of marches: the functions behind dvi/march.h. */
#ifndef DVI_MARCH_KIND_H
#define DVI_MARCH_KIND_H
#include <dvi/march.h>

#include "march/sections.h"

/* The functions of a kind. `self` is its state. The last three functions may be NULL. A function
 * that gives a status changes nothing if it fails, except that `advance` may stand at a later good
 * time. */
typedef struct dvi__march_kind {
  const char *name; /* "leapfrog", the name of its section in files */
  void (*destroy)(void *self);
  dvi_status (*start)(void *self, const dvi_march_state *state);
  /* Advance to t, which is finite and not before the time. */
  dvi_status (*advance)(void *self, double t);
  double (*time)(const void *self);
  int64_t (*size)(const void *self, dvi_march_form form);
  /* Cells are in range. `cell` is NULL for all of them. */
  dvi_status (*sample)(const void *self, dvi_march_form form, int64_t count, const int *cell,
                       double *values);
  int (*observables)(const void *self);
  const char *(*observable)(const void *self, int i);
  dvi_status (*observe)(const void *self, int i, double *value);
  void (*facts)(const void *self, dvi_march_facts *facts);
  /* Put sections that identify the march and hold its state, and take them back. */
  dvi_status (*save)(const void *self, dvi__sections_writer *writer);
  dvi_status (*load)(void *self, const dvi__sections *sections);
  /* Of kinds that several processes may divide among themselves: agree whether all have succeeded
   * so far, tell the process that writes the file of all, and tell if the state is lost because
   * values of others did not arrive. */
  dvi_status (*agree)(const void *self, dvi_status status);
  int (*writes)(const void *self);
  int (*is_lost)(const void *self);
  int has_parts; /* large arrays of its state may be held elsewhere (march/parts.h) */
} dvi__march_kind;

/* Make a march of a state, which the march owns then, after a failure, too. */
dvi_status dvi__march_wrap(const dvi__march_kind *kind, void *self, dvi_march **march);

/* Agree with the processes that march together, if there are any, whether all have succeeded so
 * far. What may fail on one of them alone comes before. */
dvi_status dvi__march_agree(const dvi_march *march, dvi_status status);

/* Shorten a step so that a whole number of steps makes a span, unless the span is 0. A step that
 * makes it up to roundings is not shortened by one more. */
double dvi__fit_step(double step, double span);

#endif
