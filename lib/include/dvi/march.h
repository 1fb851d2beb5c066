/** A field that advances in time by methods of its own: leapfrog, asynchronous steps, tents.
 *
 *  A k-form A on a mesh has the Lagrangian A'.M_k A'/2 - (dA).M_{k+1} (dA)/2 + J.A (dvi/field.h).
 *  A march holds E = -A' on the k-cells and B = dA on the (k+1)-cells, perhaps at different times.
 *  It advances by its own steps. What is asked for at a time in between is computed beside the
 *  state: observations change no bit of the motion, and neither does the way in which it is cut.
 *
 *  A march serves one thread at a time. It may use several for its steps, with the same bits.
 *
 *  Steps of a field are linear. After a common period of all steps of a schedule the state is a
 *  matrix times the state before, the monodromy matrix, and the schedule is stable if none of its
 *  eigenvalues lies outside of the unit circle. Local bounds of the steps do not tell: steps of
 *  different lengths can be in resonance with a field at any fraction of them (Fong, Darve and Lew
 *  2008). dvi_field_stability tells before a run shows it. */
#ifndef DVI_MARCH_H
#define DVI_MARCH_H
#include <dvi/field.h>
#include <dvi/run.h>

/** A march. */
typedef struct dvi_march dvi_march;

/** Options of a march. Zero means the default. */
typedef struct dvi_march_options {
  size_t size; /**< sizeof(dvi_march_options) */
  /** The method, with its options: "leapfrog" (default), "avi", "avi:classes=no", "tents",
   *  "tents:least=0.5,seed=3" (docs/fields/maxwell.md). "bossavit-kettunen" is another name of
   *  leapfrog. On shares also "midpoint", and of waves "imex" and "galerkin:degree=1" or 2
   *  (docs/fields/implicit-shares.md) */
  const char *method;
  double step;     /**< the step, above 0. Default: `fraction` of the largest stable one */
  double fraction; /**< of the largest stable step, or of each local one. Default: 0.5 */
  /** With a fraction the step is shortened so that a whole number of steps makes this span.
   *  Default: it is not */
  double span;
  int threads;   /**< default 1. The bits do not depend on it */
  int potential; /**< not 0 to keep A, too, where the method does not need it */
} dvi_march_options;

/** A start. Zero means the default. */
typedef struct dvi_march_state {
  size_t size; /**< sizeof(dvi_march_state) */
  double t;    /**< the time. Default: 0 */
  /** [k-cells] the form A. Default: 0, or what the boundary says. For a wave A = u */
  const double *A;
  const double *E; /**< [k-cells] E = -A'. Default: 0. For a wave E = -u' */
  const double *B; /**< [(k+1)-cells] B. Default: dA */
} dvi_march_state;

/** Forms that a march can show. */
typedef enum dvi_march_form {
  DVI_FORM_A, /**< [k-cells] the potential, of waves u. Marches that do not need it have none */
  DVI_FORM_E, /**< [k-cells] -A', of waves -u' */
  DVI_FORM_B  /**< [(k+1)-cells] dA, of waves du */
} dvi_march_form;

/** Facts about a march. */
typedef struct dvi_march_facts {
  const char *method; /**< its name */
  double step;        /**< the step, or the shortest of asynchronous ones */
  double longest;     /**< the longest step */
  double bound;       /**< the step must be shorter than this, or each local one than its own */
  int64_t steps;      /**< steps since the start, or events of asynchronous ones */
  int64_t updates;    /**< updates of (k+1)-cells since the start, which cost time */
} dvi_march_facts;

/** Options of a recording. Zero means the default. */
typedef struct dvi_march_record_options {
  size_t size;  /**< sizeof(dvi_march_record_options) */
  double t_end; /**< end of the run, not before the march's time */
  /** Time between two rows, above 0. They stand at the start, each `every` later, and at t_end.
   *  Default: at the start and at t_end alone */
  double every;
  /** [time_count] the times of the rows in place of that, ascending, from the march's time to
   *  t_end. Owned by the caller */
  const double *times;
  int64_t time_count;
  /** Parts of a row, DVI_RECORD_A, _E, _B and _OBSERVABLES joined by |. Default:
   *  DVI_RECORD_OBSERVABLES */
  unsigned parts;
  const int *cell[3];    /**< [cell_count] by dvi_march_form, the cells of a part. Default: all */
  int64_t cell_count[3]; /**< by dvi_march_form */
  const int *observable; /**< [observable_count] those of a row. Default: all */
  int observable_count;
  /** The run ends at most 32 of the longest steps after this becomes not 0. May be NULL */
  const volatile int *cancel;
} dvi_march_record_options;

enum { DVI_LAWS_MAX = 8 };

/** A law of a field, as measured. */
typedef struct dvi_law {
  const char *name;
  double error; /**< beside the size of what the law is about */
  int is_exact; /**< not 0 if only roundings are left of the error */
} dvi_law;

enum { DVI_SCHEDULE_SIZE = 160 /**< characters of a schedule's description */ };

/** What is known of the stability of steps. */
typedef struct dvi_stability {
  int is_stable; /**< not 0 if the growth is not above 1 + resolution */
  /** The factor by which the amplitude of the field that grows fastest does so in a unit of time. 1
   *  if none grows */
  double growth;
  double resolution; /**< growths below 1 + resolution are not told from none */
  double period;     /**< the common period of all steps, 0 if there is none or too long a one */
  double span;       /**< the time for which fields were followed */
  /** Fields that were followed: twice the modes of a small field that are not static, all of them,
   *  and with losses those with a static E, too. A few of a large field, those that grow fastest
   *  from a start at random */
  int64_t followed;
  char schedule[DVI_SCHEDULE_SIZE]; /**< the steps in words */
} dvi_stability;

#ifdef __cplusplus
extern "C" {
#endif

/** Return the name of method i of marches, counted from 0, or NULL beyond the last one. */
const char *dvi_march_method_name(int i);

/** Create a march of a field.
 *
 *  @param options  NULL for the defaults
 *  @retval DVI_BAD_OPTION    there is no such method, or it has no such option
 *  @retval DVI_BAD_ARGUMENT  a step is not stable: dvi_last_error() has the bound and its place.
 *                            Or the field is not finished, or an argument is not as described
 *  @retval DVI_UNSUPPORTED   the method cannot advance such a field
 *  @retval DVI_NO_MEMORY     there is no memory */
dvi_status dvi_march_create(const dvi_field *field, const dvi_march_options *options,
                            dvi_march **march);

/** Release the march, and set the pointer to NULL. NULL is allowed. */
void dvi_march_destroy(dvi_march **march);

/** Start, or start again.
 *
 *  @retval DVI_BAD_ARGUMENT     an argument is missing
 *  @retval DVI_NOT_FINITE       a number is not finite. dvi_last_error() names its cell
 *  @retval DVI_CALLBACK_FAILED  a signal failed. The march stays as it was */
dvi_status dvi_march_start(dvi_march *march, const dvi_march_state *state);

/** Let all happen that happens up to the time t. The march's time is t afterwards.
 *
 *  @retval DVI_BAD_ARGUMENT     t is not finite, or before the march's time
 *  @retval DVI_BAD_STATE        the march has not been started
 *  @retval DVI_STEP_TOO_LARGE   the energy has grown beyond its band (avi, tents). The march stands
 *                               at the time when that was seen, and can go on: the band is wider
 *                               then
 *  @retval DVI_CALLBACK_FAILED  a signal failed. The march stands at the last good time
 *  @retval DVI_NOT_FINITE       a signal is not finite, or values are seen not to be. The march
 *                               stands at the last good time, or where values of leapfrog have
 *                               overflowed must be started anew */
dvi_status dvi_march_advance(dvi_march *march, double t);

/** Return the time. NaN before a start. */
double dvi_march_time(const dvi_march *march);

/** Return the number of values of a form, 0 if the march has no such form. */
int64_t dvi_march_size(const dvi_march *march, dvi_march_form form);

/** Give a form at the march's time, as a copy beside the state.
 *
 *  @param      count   number of cells, if `cell` is given
 *  @param      cell    [count] cells of the form's degree. NULL for all
 *  @param[out] values  [count] or [dvi_march_size]
 *  @retval DVI_BAD_ARGUMENT  an argument is missing, there is no such form or cell
 *  @retval DVI_BAD_STATE     the march has not been started
 *  @retval DVI_NOT_FINITE    a value has overflowed. dvi_last_error() names its cell */
dvi_status dvi_march_sample(const dvi_march *march, dvi_march_form form, int64_t count,
                            const int *cell, double *values);

/** Return the name of what can be observed, i counted from 0, such as "energy", or NULL beyond the
 *  last one. Owned by the march. */
const char *dvi_march_observable(const dvi_march *march, int i);

/** Observe the observable i at the march's time.
 *
 *  @retval DVI_BAD_ARGUMENT  there is no such observable
 *  @retval (others)          as dvi_march_sample */
dvi_status dvi_march_observe(const dvi_march *march, int i, double *value);

/** Collect facts about a march. */
void dvi_march_facts_of(const dvi_march *march, dvi_march_facts *facts);

/** Advance to t_end, and record what the march shows on the way.
 *
 *  The march moves as by dvi_march_advance, with the same bits. dvi_recording_part has the rows,
 *  and DVI_RECORD_T their times. The report (dvi_recording_report) counts steps as dvi_march_facts,
 *  and has no events. A run that is cancelled ends with a row where it stands, unless times are
 *  given.
 *
 *  @param[out] recording  owned by the caller, who may release the march before it. It has all rows
 *                         up to a failure of the march, too. NULL if nothing was recorded
 *  @retval DVI_BAD_ARGUMENT  a time is not finite, outside of the run or goes back, there is no
 *                            such part, cell or observable, or cells are chosen of a part that is
 *                            not recorded
 *  @retval DVI_BAD_SIZE      a row, or their number, is too large to be counted
 *  @retval DVI_UNSUPPORTED   the march has no such form
 *  @retval DVI_NO_MEMORY     there is no memory for the next row
 *  @retval (others)          as dvi_march_advance, dvi_march_sample and dvi_march_observe */
dvi_status dvi_march_record(dvi_march *march, const dvi_march_record_options *options,
                            dvi_recording **recording);

/** Write the state to a file. A march that is made in the same way and loads it goes on with the
 *  same bits. On shares of a mesh the state is that of the whole mesh (docs/fields/shares.md).
 *
 *  @retval DVI_IO_ERROR   the file could not be written. An old one stays
 *  @retval DVI_NO_MEMORY  there is no memory for the file */
dvi_status dvi_march_save(const dvi_march *march, const char *path);

/** Read a state from a file. On failure the march stays as it was.
 *
 *  @retval DVI_IO_ERROR  the file could not be read
 *  @retval DVI_BAD_FILE  it is no saved state, it is damaged, or it is of another march */
dvi_status dvi_march_load(dvi_march *march, const char *path);

/** Write the state to memory, with the bytes of dvi_march_save.
 *
 *  @param[out] bytes     [capacity] the state. NULL if only its size is wanted
 *  @param      capacity  size of the array in bytes
 *  @param[out] size      bytes that the state takes, also where the capacity is too small
 *  @retval DVI_BAD_SIZE  the capacity is too small. Nothing is written */
dvi_status dvi_march_save_memory(const dvi_march *march, void *bytes, size_t capacity,
                                 size_t *size);

/** Read a state that dvi_march_save_memory wrote, or the bytes of a file of dvi_march_save.
 *  Otherwise this is dvi_march_load. */
dvi_status dvi_march_load_memory(dvi_march *march, const void *bytes, size_t size);

/** Measure the laws of a field on a march that begins at random.
 *
 *  The laws are "energy", "gauss" (the charge), "divergence" (of B), "reciprocity" (the answer to
 *  an impulse at one place, seen at another one, is that of the exchanged places), "gauge" (of a
 *  gradient in A, E and B know nothing, in the norm of the energy and beside that of the terms of
 *  dA, which cancel) and "multisymplectic" (the form formula on a part of space and the time
 *  between, Marsden, Patrick and Shkoller 1998). Those that a field or a method cannot have are
 *  left out.
 *
 *  @param      steps  for which the field is followed, at least 2. Of asynchronous steps the
 *                     longest
 *  @param[out] law    [DVI_LAWS_MAX]
 *  @param[out] count  number of laws
 *  @retval (others)   as dvi_march_create and dvi_march_advance */
dvi_status dvi_field_laws(const dvi_field *field, const dvi_march_options *options, int steps,
                          dvi_law *law, int *count);

/** Find how fast the fastest growing field grows under the steps that a march would make.
 *
 *  Losses are counted, those of conductors and of absorbing walls. They hold growth down, and may
 *  also make a field grow that does not without them. Currents are left out. Up to 500 unknowns
 *  every mode is followed through a common period, in coordinates without static potentials, for
 *  which the matrix is close to orthogonal if nothing is lost. Of more unknowns, Arnoldi's method
 *  finds the largest eigenvalues (Saad 2011, ch. 6). Free steps may have no common period: their
 *  ratios are looked at as fractions with denominators up to 64.
 *  If these do not give a period below a thousand of the longest steps, a field that begins at
 *  random is followed for a long time. `resolution` says what such a search can have missed. So it
 *  is with tents, unless all vertices have equal steps.
 *
 *  @param[in]  options  those of the march, with the method avi or tents. NULL for those of avi
 *  @param[in]  span     time for which fields are followed at least, 0 for a default
 *  @param[out] report   unchanged on failure
 *  @retval DVI_UNSUPPORTED  the method has equal steps, which are stable below their bound
 *  @retval (others)         as dvi_march_create */
dvi_status dvi_field_stability(const dvi_field *field, const dvi_march_options *options,
                               double span, dvi_stability *report);

#ifdef __cplusplus
}
#endif
#endif
