/* Checkpoints: all data that the next step depends on, in sections with hashes (march/sections.h).
 *
 * Callbacks cannot be saved, but the system is recognised by hashes of its declared terms, and by
 * the values of its callbacks at the saved state (fingerprint.h), which other parameters would
 * change. The method is recognised by its keys, of which all but the name of a file are hashed, and
 * by data that no key contains, a tableau's coefficients or a program's own functions.
 *
 *     method       hashes of the keys and data that determine the steps, then the specification
 *     system       dimension, hashes of the declared terms, fingerprint at the state
 *     clock        times with their compensations, last step, number of steps
 *     pacing       kind of steps in another time, density, energy of the start, monitor
 *     state        q, p and their compensations, now and before the last step
 *     memory       the method's numbers from step to step
 *     balances     invariants at the start and what forces supplied, if balances are kept
 *     held         contact that is held closed, or -1, if any may be */
#include <inttypes.h>
#include <limits.h>
#include <math.h>
#include <stdio.h>
#include <string.h>

#include "core/hash.h"
#include "core/memory.h"
#include "core/status.h"
#include "integrator/fingerprint.h"
#include "integrator/held.h"
#include "integrator/hits.h"
#include "march/sections.h"
#include "march/whole_file.h"
#include "num/finite.h"
#include "system/evaluate/dynamics.h"

/* The system's hashes got those of forces with version 2. */
enum { SECTION_VERSION = 1, SYSTEM_VERSION = 2 };

typedef struct method_section {
  uint64_t steps, fingerprint; /* as in dvi__stepper */
} method_section;

typedef struct system_section {
  int64_t n;
  dvi__declared declared;
  dvi__fingerprint fingerprint;
} system_section;

typedef struct clock_section {
  double t, t_compensation, last_t, last_t_compensation, last_h;
  int64_t steps;
} clock_section;

typedef struct pacing_section {
  int64_t pacing;
  double density, energy;
  char monitor[DVI__MONITOR_NAME];
} pacing_section;

/* A checkpoint in memory. The pointers point into the sections' bytes. */
typedef struct checkpoint {
  dvi__sections sections;
  method_section method;
  const char *specification;
  system_section system;
  clock_section clock;
  pacing_section pacing;
  const double *numbers; /* q, p and compensations of `now`, then of `last` */
  const double *memory;
  const double *balances; /* invariants at the start, supplies of `now`, then of `last`, or NULL */
} checkpoint;

static int64_t pacing_of(const dvi_integrator *I)
{
  return I->monitored != NULL ? I->monitored->pacing : DVI_STEPS_OF_TIME;
}

static size_t state_size(const dvi_integrator *I)
{
  return 4 * (size_t)I->system->n * sizeof(double);
}

/* ---- save ---- */

static void put_method(const dvi_integrator *I, dvi__sections_writer *w)
{
  const method_section method = {.steps = I->stepper.steps, .fingerprint = I->stepper.fingerprint};
  dvi__section_open(w, "method", SECTION_VERSION);
  dvi__section_put(w, &method, sizeof method);
  dvi__section_put(w, I->stepper.specification, strlen(I->stepper.specification) + 1);
}

/* Fill the system's section. A fingerprint that cannot be evaluated is NaN, and not compared. */
static dvi_status fill_system(const dvi_integrator *I, system_section *system)
{
  const dvi__moment now = {I->now.t, I->last_h, I->now.q, I->now.p, I->last.q, I->last.p};
  *system = (system_section){.n = I->system->n, .declared = I->system->declared};
  const dvi_status status = dvi__fingerprint_take(I, &now, &system->fingerprint);
  return status == DVI_NO_MEMORY ? status : DVI_OK;
}

/* Write both states. The compensations of the state before the last step serve no step to come, and
 * may be gone. Zeros stand for them. */
static void put_states(const dvi_integrator *I, dvi__sections_writer *w)
{
  static const double zeros[512] = {0};
  const size_t half = state_size(I) / 2;
  dvi__section_open(w, "state", SECTION_VERSION);
  dvi__section_put(w, I->now.q, half);
  dvi__section_put(w, I->now.q_compensation, half);
  dvi__section_put(w, I->last.q, half);
  for (size_t left = half, part; left > 0; left -= part) {
    part = left < sizeof zeros ? left : sizeof zeros;
    dvi__section_put(w, zeros, part);
  }
}

static void put_clock(const dvi_integrator *I, dvi__sections_writer *w)
{
  const clock_section clock = {.t = I->now.t,
                               .t_compensation = I->now.t_compensation,
                               .last_t = I->last.t,
                               .last_t_compensation = I->last.t_compensation,
                               .last_h = I->last_h,
                               .steps = I->counters.steps};
  dvi__section_open(w, "clock", SECTION_VERSION);
  dvi__section_put(w, &clock, sizeof clock);
}

static void put_pacing(const dvi_integrator *I, dvi__sections_writer *w)
{
  pacing_section pacing = {.pacing = pacing_of(I), .density = I->now.density};
  if (I->monitored != NULL) {
    pacing.energy = I->monitored->energy;
    memcpy(pacing.monitor, I->monitored->name, sizeof pacing.monitor);
  }
  dvi__section_open(w, "pacing", SECTION_VERSION);
  dvi__section_put(w, &pacing, sizeof pacing);
}

static dvi_status checkpoint_pack(const dvi_integrator *I, dvi__sections_writer *w)
{
  const size_t memory = I->stepper.memory_count * sizeof(double);
  system_section system;
  DVI_TRY(fill_system(I, &system));
  dvi__sections_start(w, 2 * state_size(I) + memory + strlen(I->stepper.specification) + 2048);
  put_method(I, w);
  dvi__section_open(w, "system", SYSTEM_VERSION);
  dvi__section_put(w, &system, sizeof system);
  put_clock(I, w);
  put_pacing(I, w);
  put_states(I, w);
  dvi__section_open(w, "memory", SECTION_VERSION);
  dvi__section_put(w, I->stepper.memory, memory);
  if (I->balances > 0) {
    dvi__section_open(w, "balances", SECTION_VERSION);
    dvi__section_put(w, I->at_start, I->balances * sizeof(double));
    dvi__section_put(w, I->now.supplied, 2 * I->balances * sizeof(double));
    dvi__section_put(w, I->last.supplied, 2 * I->balances * sizeof(double));
  }
  if (dvi__bodies_may_hold(I)) {
    const int64_t held = dvi__bodies_held(I);
    dvi__section_open(w, "held", SECTION_VERSION);
    dvi__section_put(w, &held, sizeof held);
  }
  return dvi__sections_finish(w);
}

static dvi_status check_saved(const dvi_integrator *I, const void *place)
{
  if (I == NULL || place == NULL)
    return dvi__fail(DVI_BAD_ARGUMENT, "checkpoint: an argument is NULL");
  if (I->started) return DVI_OK;
  return dvi__fail(DVI_BAD_STATE,
                   "checkpoint: the integrator has no state yet; call dvi_integrator_start first");
}

dvi_status dvi_integrator_save(const dvi_integrator *I, const char *path)
{
  dvi__sections_writer w;
  DVI_TRY(check_saved(I, path));
  DVI_TRY(checkpoint_pack(I, &w));
  const dvi_status status = dvi__write_whole(path, w.bytes, w.size);
  dvi__release(w.bytes);
  return status == DVI_OK ? DVI_OK : dvi__fail_in(status, "checkpoint");
}

dvi_status dvi_integrator_save_memory(const dvi_integrator *I, void *bytes, size_t capacity,
                                      size_t *size)
{
  dvi__sections_writer w;
  DVI_TRY(check_saved(I, size));
  DVI_TRY(checkpoint_pack(I, &w));
  const size_t needed = *size = w.size;
  if (bytes != NULL && needed <= capacity) memcpy(bytes, w.bytes, needed);
  dvi__release(w.bytes);
  if (bytes == NULL || needed <= capacity) return DVI_OK;
  return dvi__fail(DVI_BAD_SIZE, "checkpoint: %zu bytes of room; %zu are needed", capacity, needed);
}

/* ---- restore: checks of method and system ---- */

/* Test whether a part of a specification, "key=value" or a name, determines the steps. */
static int key_determines_steps(const dvi__method *method, const char *part)
{
  const size_t length = strcspn(part, "=:,");
  for (int k = 0; k < dvi__key_count(method); k++) {
    const dvi__key *key = &method->keys[k];
    if (strlen(key->name) == length && strncmp(key->name, part, length) == 0)
      return key->least != DVI__SAID && key->least != DVI__FILE;
  }
  return 1;
}

/* Find the first part that determines the steps and differs between two specifications. */
static void find_difference(const dvi__method *method, const char *at[2], int length[2])
{
  for (;;) {
    length[0] = (int)strcspn(at[0], ":,");
    length[1] = (int)strcspn(at[1], ":,");
    const int same = length[0] == length[1] && memcmp(at[0], at[1], (size_t)length[0]) == 0;
    if ((!same && key_determines_steps(method, at[1])) || at[0][length[0]] == 0 ||
        at[1][length[1]] == 0)
      return;
    at[0] += length[0] + 1, at[1] += length[1] + 1;
  }
}

static dvi_status check_saved_method(const dvi_integrator *I, const checkpoint *c)
{
  if (c->method.steps != I->stepper.steps) {
    const char *here = I->stepper.specification, *at[2] = {c->specification, here};
    int length[2];
    find_difference(I->stepper.method, at, length);
    return dvi__fail(DVI_BAD_FILE, "%s: %.*s there, %.*s here: written by %s, not by %s",
                     c->sections.name, length[0], at[0], length[1], at[1], c->specification, here);
  }
  if (c->method.fingerprint == I->stepper.fingerprint) return DVI_OK;
  return dvi__fail(DVI_BAD_FILE, "%s: written with other %s, by %s", c->sections.name,
                   I->stepper.fingerprinted, c->specification);
}

static const char *pacing_name(int64_t pacing)
{
  return pacing == DVI_STEPS_OF_TIME    ? "of time"
         : pacing == DVI_TIME_TRANSFORM ? "in another time, by "
                                        : "controlled by ";
}

static dvi_status check_time(const dvi_integrator *I, const checkpoint *c)
{
  const char *monitor = I->monitored != NULL ? I->monitored->name : "";
  if (c->pacing.pacing == pacing_of(I) &&
      strncmp(c->pacing.monitor, monitor, sizeof c->pacing.monitor) == 0)
    return DVI_OK;
  return dvi__fail(DVI_BAD_FILE, "%s: of steps %s%.*s, not of steps %s%s", c->sections.name,
                   pacing_name(c->pacing.pacing), (int)sizeof c->pacing.monitor, c->pacing.monitor,
                   pacing_name(pacing_of(I)), monitor);
}

static dvi_status check_declared(const dvi_integrator *I, const checkpoint *c)
{
  if (c->system.n != I->system->n)
    return dvi__fail(DVI_BAD_FILE, "%s: %" PRId64 " coordinates, not %d", c->sections.name,
                     c->system.n, I->system->n);
  const char *difference = dvi__declared_difference(&c->system.declared, &I->system->declared);
  if (difference == NULL) return DVI_OK;
  return dvi__fail(DVI_BAD_FILE, "%s: of a system that declares other %s", c->sections.name,
                   difference);
}

/* Evaluate the fingerprint at the saved state, with the saved energy of the start, on which a
 * monitor may depend. */
static dvi_status take_fingerprint(const dvi_integrator *I, const checkpoint *c,
                                   dvi__fingerprint *here)
{
  const size_t n = (size_t)I->system->n;
  const double *now = c->numbers, *last = now + 4 * n,
               before = I->monitored != NULL ? I->monitored->energy : 0;
  const dvi__moment at = {c->clock.t, c->clock.last_h, now, now + n, last, last + n};
  if (I->monitored != NULL) dvi__monitored_time_set_energy(I->monitored, c->pacing.energy);
  const dvi_status status = dvi__fingerprint_take(I, &at, here);
  if (I->monitored != NULL) dvi__monitored_time_set_energy(I->monitored, before);
  return status;
}

static dvi_status check_system(const dvi_integrator *I, const checkpoint *c)
{
  dvi__fingerprint here;
  const dvi_status taken = take_fingerprint(I, c, &here);
  if (taken != DVI_OK && !isnan(c->system.fingerprint.lagrangian.value))
    return dvi__fail_in(DVI_BAD_FILE,
                        "%s: of another system or other parameters; at its state this one fails",
                        c->sections.name);
  const dvi_status status = dvi__fingerprint_compare(&c->system.fingerprint, &here);
  return status == DVI_OK ? DVI_OK : dvi__fail_in(status, "%s", c->sections.name);
}

static dvi_status check_space(const dvi_integrator *I, const checkpoint *c)
{
  const dvi__method *method = I->stepper.method;
  if (method->recognizes == NULL || method->recognizes(&I->stepper, c->memory)) return DVI_OK;
  return dvi__fail(DVI_BAD_FILE, "%s: of another function space of the same name",
                   c->sections.name);
}

/* ---- restore: sections ---- */

static dvi_status find_fixed(const dvi__sections *sections, const char *name, uint32_t version,
                             void *content, size_t size)
{
  dvi__section found;
  DVI_TRY(dvi__section_find(sections, name, version, size, &found));
  memcpy(content, found.content, size);
  return DVI_OK;
}

/* Refuse the state of a march. */
static dvi_status refuse_march(const dvi__sections *sections)
{
  if (dvi__sections_have(sections, "method") || !dvi__sections_have(sections, "forms"))
    return DVI_OK;
  return dvi__fail(
      DVI_BAD_FILE,
      "%s: it is the state of a march of a field, and of no integrator. Processes that "
      "share a mesh (mpirun) write it with implicit methods, too, and 2 or more of them "
      "go on from it",
      sections->name);
}

static dvi_status find_method(checkpoint *c)
{
  dvi__section found;
  DVI_TRY(refuse_march(&c->sections));
  DVI_TRY(dvi__section_find(&c->sections, "method", SECTION_VERSION, DVI__ANY_SIZE, &found));
  if (found.size <= sizeof c->method || found.content[found.size - 1] != 0)
    return dvi__fail(DVI_BAD_FILE, "%s: section 'method' has no specification", c->sections.name);
  memcpy(&c->method, found.content, sizeof c->method);
  c->specification = (const char *)found.content + sizeof c->method;
  return DVI_OK;
}

/* Find the numbers of a section. They are aligned as the bytes are. */
static dvi_status find_numbers(const checkpoint *c, const char *name, size_t count,
                               const double **numbers)
{
  dvi__section found;
  DVI_TRY(dvi__section_find(&c->sections, name, SECTION_VERSION, count * sizeof(double), &found));
  *numbers = (const double *)(const void *)found.content;
  return DVI_OK;
}

/* Take the equations with the contact that the checkpoint holds. */
static dvi_status choose_held(dvi_integrator *I, const checkpoint *c)
{
  int64_t held;
  if (!dvi__bodies_may_hold(I)) return DVI_OK;
  DVI_TRY(find_fixed(&c->sections, "held", SECTION_VERSION, &held, sizeof held));
  if (held < -1 || held > INT_MAX || (held >= 0 && !dvi_integrator_may_hold(I, (int)held)))
    return dvi__fail(DVI_BAD_FILE, "%s: damaged, it holds contact %" PRId64, c->sections.name,
                     held);
  dvi__bodies_choose(I, (int)held);
  return DVI_OK;
}

/* Read and check all sections. Method and system are compared first, because they determine the
 * count of the other sections' numbers, with the contact that is held. */
static dvi_status open_checkpoint(dvi_integrator *I, checkpoint *c)
{
  const size_t numbers = 8 * (size_t)I->system->n, balances = 5 * I->balances;
  DVI_TRY(find_method(c));
  DVI_TRY(check_saved_method(I, c));
  DVI_TRY(find_fixed(&c->sections, "system", SYSTEM_VERSION, &c->system, sizeof c->system));
  DVI_TRY(check_declared(I, c));
  DVI_TRY(choose_held(I, c));
  DVI_TRY(find_fixed(&c->sections, "pacing", SECTION_VERSION, &c->pacing, sizeof c->pacing));
  DVI_TRY(check_time(I, c));
  DVI_TRY(find_fixed(&c->sections, "clock", SECTION_VERSION, &c->clock, sizeof c->clock));
  DVI_TRY(find_numbers(c, "state", numbers, &c->numbers));
  DVI_TRY(find_numbers(c, "memory", I->stepper.memory_count, &c->memory));
  if (balances > 0) DVI_TRY(find_numbers(c, "balances", balances, &c->balances));
  if (!isfinite(c->clock.t) || dvi__first_not_finite(numbers, c->numbers) >= 0 ||
      (balances > 0 && dvi__first_not_finite(balances, c->balances) >= 0))
    return dvi__fail(DVI_BAD_FILE, "%s: damaged, its state is not finite", c->sections.name);
  DVI_TRY(check_system(I, c));
  return check_space(I, c);
}

static void take_balances(dvi_integrator *I, const double *balances)
{
  const size_t size = I->balances * sizeof(double);
  memcpy(I->at_start, balances, size);
  memcpy(I->now.supplied, balances + I->balances, 2 * size);
  memcpy(I->last.supplied, balances + 3 * I->balances, 2 * size);
}

static void checkpoint_take_over(dvi_integrator *I, const checkpoint *c)
{
  const clock_section *clock = &c->clock;
  I->now.t = clock->t;
  I->now.t_compensation = clock->t_compensation;
  I->last.t = clock->last_t;
  I->last.t_compensation = clock->last_t_compensation;
  I->last_h = clock->last_h;
  I->now.density = c->pacing.density;
  I->now.side = 0;
  if (I->monitored != NULL) dvi__monitored_time_set_energy(I->monitored, c->pacing.energy);
  I->counters.steps = (long)clock->steps;
  const size_t half = state_size(I) / 2, numbers = 2 * (size_t)I->system->n;
  memcpy(I->now.q, c->numbers, half);
  memcpy(I->now.q_compensation, c->numbers + numbers, half);
  memcpy(I->last.q, c->numbers + 2 * numbers, half);
  if (c->balances != NULL) take_balances(I, c->balances);
  memcpy(I->stepper.memory, c->memory, I->stepper.memory_count * sizeof(double));
  I->started = 1;
}

/* The rank of constraints is found again, for multipliers that are asked for before a step. */
static dvi_status take_over(dvi_integrator *I, const checkpoint *c)
{
  checkpoint_take_over(I, c);
  dvi__hits_forget(I);
  const dvi__state_constraint *constraint = I->system->dynamics->constraint;
  return constraint != NULL && constraint->has_rank ? dvi__integrator_find_side(I) : DVI_OK;
}

/* Restore from sections whose reading has this status. */
static dvi_status restore_checkpoint(dvi_integrator *I, checkpoint *c, dvi_status status)
{
  const int held = dvi__bodies_held(I);
  if (status == DVI_OK) status = open_checkpoint(I, c);
  if (status != DVI_OK) dvi__bodies_choose(I, held);
  if (status == DVI_OK) status = take_over(I, c);
  dvi__sections_clear(&c->sections);
  return status;
}

dvi_status dvi_integrator_restore(dvi_integrator *I, const char *path)
{
  checkpoint c = {.specification = NULL};
  char name[1024];
  if (I == NULL || path == NULL)
    return dvi__fail(DVI_BAD_ARGUMENT, "checkpoint: an argument is NULL");
  (void)snprintf(name, sizeof name, "checkpoint %s", path);
  c.sections.name = name;
  const dvi_status status = dvi__sections_read(path, &c.sections);
  return restore_checkpoint(I, &c, status);
}

/* Restore from a copy, which is aligned as numbers must be. The caller's bytes may have any
 * alignment. */
dvi_status dvi_integrator_restore_memory(dvi_integrator *I, const void *bytes, size_t size)
{
  checkpoint c = {.specification = NULL};
  if (I == NULL || bytes == NULL)
    return dvi__fail(DVI_BAD_ARGUMENT, "checkpoint: an argument is NULL");
  c.sections.own = dvi__duplicate(bytes, size, 1);
  if (c.sections.own == NULL)
    return dvi__fail(DVI_NO_MEMORY, "checkpoint: no memory for %zu bytes", size);
  return restore_checkpoint(
      I, &c, dvi__sections_check(&c.sections, "checkpoint in memory", c.sections.own, size));
}
