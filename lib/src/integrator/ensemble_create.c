/* Creation of an ensemble: blocks of members that share a system, and an integrator for each thread
 * or for each block. */
#include <string.h>

#include "core/memory.h"
#include "core/status.h"
#include "integrator/ensemble_struct.h"
#include "space/user_basis.h"

enum { THREADS_MOST = 1024, BLOCK_MOST = 65536 };

/* Limits of the number of members side by side. A block and the work of an iteration should fit in
 * the second-level cache. A block has enough members to fill vectors, and few enough to give every
 * thread work. Byte code takes half as long again with 8 members of 18 coordinates as with 32,
 * callbacks in C as long. */
enum { SIDE_BY_SIDE_LEAST = 8, SIDE_BY_SIDE_MOST = 64, NUMBERS_SIDE_BY_SIDE = 12800 };

static const dvi_system *system_of(const dvi_system *system, const dvi_ensemble_options *o,
                                   int member)
{
  return o->systems != NULL ? o->systems[member] : system;
}

static dvi_status check_systems(const dvi_ensemble_options *o)
{
  for (int k = 0; k < o->members; k++) {
    if (o->systems[k] == NULL)
      return dvi__fail(DVI_BAD_ARGUMENT, "ensemble: the system of member %d is NULL", k);
    const dvi_status status = o->systems[k] != o->systems[0]
                                  ? dvi__system_alike(o->systems[0], o->systems[k])
                                  : DVI_OK;
    if (status != DVI_OK)
      return dvi__fail_in(status, "ensemble: the system of member %d is not like that of member 0",
                          k);
  }
  return DVI_OK;
}

static dvi_status ensemble_check(const dvi_system *system, const char *method,
                                 const dvi_ensemble_options *o)
{
  if (method == NULL || o == NULL)
    return dvi__fail(DVI_BAD_ARGUMENT, "ensemble: the method or the options are NULL");
  if (o->members < 1)
    return dvi__fail(DVI_BAD_SIZE, "ensemble: %d members asked, 1 or more are possible",
                     o->members);
  if (o->threads < 0 || o->threads > THREADS_MOST)
    return dvi__fail(DVI_BAD_SIZE, "ensemble: %d threads asked, 1 to %d are possible (0: 1)",
                     o->threads, THREADS_MOST);
  if (o->block < 0 || o->block > BLOCK_MOST)
    return dvi__fail(DVI_BAD_SIZE, "ensemble: blocks of %d asked, 1 to %d are possible (0: chosen)",
                     o->block, BLOCK_MOST);
  if ((system == NULL) == (o->systems == NULL))
    return dvi__fail(DVI_BAD_ARGUMENT, "ensemble: %s; give one system, or options.systems",
                     system == NULL ? "there is no system"
                                    : "two ways to name the systems are used");
  if (o->shapes != NULL) DVI_TRY(dvi__shapes_check(o->shapes));
  return o->systems != NULL ? check_systems(o) : DVI_OK;
}

/* ---- integrators ---- */

void dvi__worker_bind(dvi__worker *w, const dvi__block *block)
{
  const dvi_system *system = block->system;
  if (block->integrator != NULL) w->integrator = block->integrator;
  if (w->scene == NULL) return;
  w->scene->potentials = system->potentials;
  w->scene->forces = system->forces;
  w->scene->vector = system->vector;
  w->scene->holonomics = system->holonomics;
  w->scene->nonholonomics = system->nonholonomics;
  w->scene->lagrangian = system->lagrangian;
  w->scene->constraint = system->constraint;
  w->scene->symmetries = system->symmetries;
  w->scene->invariants = system->invariants;
}

/* Add one integrator to the ensemble. */
static dvi_status add_integrator(dvi_ensemble *e, const dvi_system *system, const char *method,
                                 const dvi_shapes *shapes)
{
  dvi_integrator **place = &e->integrators[e->integrator_count];
  const dvi_integrator_options options = {
      .size = sizeof options, .method = method, .shapes = shapes};
  DVI_TRY(dvi_integrator_create_with(system, &options, place));
  e->integrator_count++;
  if (system->contact_count > 0)
    return dvi__fail(DVI_UNSUPPORTED,
                     "ensemble: the system declares contacts, whose hits no two members have at "
                     "one time; use single integrators");
  if (dvi_integrator_chooses_steps(*place))
    return dvi__fail(DVI_UNSUPPORTED,
                     "ensemble: %s chooses its steps, so that members would part in time; use "
                     "single integrators",
                     (*place)->stepper.method->name);
  (*place)->counters.allocations = 0; /* the ensemble counts those of its creation */
  (*place)->started = 1;              /* once the ensemble is */
  return DVI_OK;
}

/* Decide whether different systems share the threads' integrators. A first integrator says whether
 * its stepper is bound to the system. Threads' integrators are made for a copy of a system, which
 * takes the terms of each block's system. The patterns of Hessians, if the method needs them, must
 * be complete before the copy. */
static dvi_status look_at_systems(dvi_ensemble *e, const char *method,
                                  const dvi_ensemble_options *o)
{
  DVI_TRY(add_integrator(e, o->systems[0], method, o->shapes));
  const int late = e->integrators[0]->stepper.late_hessians;
  e->bound = e->integrators[0]->stepper.bound;
  if (e->bound) return DVI_OK;
  dvi_integrator_destroy(&e->integrators[--e->integrator_count]);
  for (int k = 0; k < o->members && (late || o->systems[0]->qq.start != NULL); k++)
    DVI_TRY(dvi__system_complete_patterns(o->systems[k]));
  for (int i = 0; i < e->threads; i++) {
    e->workers[i].scene = dvi__duplicate(o->systems[0], 1, sizeof *o->systems[0]);
    if (e->workers[i].scene == NULL) return dvi__fail(DVI_NO_MEMORY, "ensemble: no memory");
  }
  return DVI_OK;
}

/* Make an integrator for each thread. The work of creation is counted once, for any number of
 * threads. */
static dvi_status add_those_of_threads(dvi_ensemble *e, const dvi_system *system,
                                       const char *method, const dvi_shapes *shapes)
{
  for (int i = 0; i < e->threads; i++) {
    dvi__worker *w = &e->workers[i];
    DVI_TRY(add_integrator(e, w->scene != NULL ? w->scene : system, method, shapes));
    w->integrator = e->integrators[i];
    if (i > 0) w->integrator->counters = (dvi_counters){0};
  }
  return DVI_OK;
}

/* Make an integrator for each block. The first integrator exists already. Systems with the same
 * declarations give integrators with memories of one length. */
static dvi_status add_those_of_blocks(dvi_ensemble *e, const char *method, const dvi_shapes *shapes)
{
  dvi_integrator **all = DVI_NEW(dvi_integrator *, e->block_count);
  if (all == NULL)
    return dvi__fail(DVI_NO_MEMORY, "ensemble: no memory for %d integrators", e->block_count);
  all[0] = e->integrators[0];
  dvi__release(e->integrators);
  e->integrators = all;
  for (int k = 0; k < e->block_count; k++) {
    dvi__block *block = &e->blocks[k];
    const dvi_status status = k > 0 ? add_integrator(e, block->system, method, shapes) : DVI_OK;
    if (status != DVI_OK) return dvi__fail_in(status, "ensemble: member %d", block->first);
    block->integrator = e->integrators[k];
  }
  return DVI_OK;
}

/* ---- workers ---- */

static int has_lanes(const dvi_ensemble *e)
{
  return e->integrators[0]->stepper.lanes != NULL;
}

/* Allocate the work arrays of a block's step. */
static dvi_status worker_allocate(const dvi_ensemble *e, dvi__worker *w)
{
  dvi__members *m = &w->members;
  const size_t capacity = (size_t)e->capacity;
  w->point[0] = DVI_NEW(double, e->n);
  w->point[1] = DVI_NEW(double, e->n);
  if (w->point[0] == NULL || w->point[1] == NULL)
    return dvi__fail(DVI_NO_MEMORY, "ensemble: no memory");
  if (!has_lanes(e)) return DVI_OK;
  w->numbers = DVI_NEW(double, e->state_numbers *capacity);
  w->ahead = DVI_NEW(long, capacity);
  w->absence = DVI_NEW(int, capacity);
  m->left = DVI_NEW(char, capacity);
  m->residuals = DVI_NEW(long, capacity);
  m->gradients = DVI_NEW(long, capacity);
  m->fixed = DVI_NEW(long, capacity);
  m->simplified = DVI_NEW(long, capacity);
  m->jacobians = DVI_NEW(long, capacity);
  m->hessians = DVI_NEW(long, capacity);
  if (w->numbers && w->ahead && w->absence && m->left && m->residuals && m->gradients && m->fixed &&
      m->simplified && m->jacobians && m->hessians)
    return DVI_OK;
  return dvi__fail(DVI_NO_MEMORY, "ensemble: no memory for %d members side by side", e->capacity);
}

static void clear_worker(dvi__worker *w)
{
  dvi__release(w->scene);
  dvi__release(w->numbers);
  dvi__release(w->ahead);
  dvi__release(w->absence);
  dvi__release(w->members.left);
  dvi__release(w->members.residuals);
  dvi__release(w->members.gradients);
  dvi__release(w->members.fixed);
  dvi__release(w->members.simplified);
  dvi__release(w->members.jacobians);
  dvi__release(w->members.hessians);
  dvi__release(w->point[0]);
  dvi__release(w->point[1]);
}

static dvi_status make_workers(dvi_ensemble *e, const dvi_system *system, const char *method,
                               const dvi_ensemble_options *o)
{
  e->workers = DVI_NEW(dvi__worker, e->threads);
  e->integrators = DVI_NEW(dvi_integrator *, e->threads);
  if (e->workers == NULL || e->integrators == NULL)
    return dvi__fail(DVI_NO_MEMORY, "ensemble: no memory for %d threads", e->threads);
  if (o->systems != NULL) DVI_TRY(look_at_systems(e, method, o));
  return e->bound ? DVI_OK : add_those_of_threads(e, system, method, o->shapes);
}

/* ---- blocks ---- */

static int smaller_count(int a, int b)
{
  return a < b ? a : b;
}

/* Choose the members of a block, so that every thread has a share in whole vectors. If each block
 * has its own integrator, a block is a thread's whole share. */
static int choose_capacity(const dvi_ensemble *e, const dvi_ensemble_options *o)
{
  if (o->block > 0) return smaller_count(o->block, o->members);
  const int share = (o->members - 1) / e->threads + 1;
  if (e->bound) return share;
  const int room = (int)(NUMBERS_SIDE_BY_SIDE / e->state_numbers) / 8 * 8;
  const int chosen = room > SIDE_BY_SIDE_LEAST ? smaller_count(room, SIDE_BY_SIDE_MOST)
                                               : SIDE_BY_SIDE_LEAST;
  return share < chosen ? smaller_count((share - 1) / 8 * 8 + 8, o->members) : chosen;
}

/* Count the blocks, and write them if `blocks` is not NULL. */
static int cut_blocks(const dvi_ensemble *e, const dvi_system *system,
                      const dvi_ensemble_options *o, dvi__block *blocks)
{
  int count = 0;
  for (int first = 0, end; first < o->members; first = end, count++) {
    const dvi_system *of = system_of(system, o, first);
    for (end = first + 1;
         end < o->members && end - first < e->capacity && system_of(system, o, end) == of;)
      end++;
    if (blocks != NULL)
      blocks[count] = (dvi__block){.first = first,
                                   .count = end - first,
                                   .system = of,
                                   .numbers = e->numbers + (size_t)first * e->member_numbers};
  }
  return count;
}

/* Allocate the members' numbers, the largest array, first, so that too many members are refused at
 * once. */
static dvi_status make_members(dvi_ensemble *e)
{
  const size_t n = (size_t)e->n;
  e->state_numbers = DVI__MEMBER_Q + 4 * n + e->integrators[0]->stepper.memory_count;
  e->member_numbers = e->state_numbers + DVI__MEMBER_LAST + (e->system_is_general ? n : 0);
  e->numbers = DVI_NEW(double, (size_t)e->members * e->member_numbers);
  if (e->numbers != NULL) return DVI_OK;
  return dvi__fail(DVI_NO_MEMORY, "ensemble: no memory for %d members, %zu bytes each", e->members,
                   e->member_numbers * sizeof(double));
}

/* Prepare the lanes. If members are stepped one after the other, each member is a block of its own,
 * so that its numbers are contiguous. */
static dvi_status make_lanes(dvi_ensemble *e, const dvi_ensemble_options *o)
{
  e->capacity = choose_capacity(e, o);
  for (int i = 0; i < e->integrator_count; i++)
    DVI_TRY(dvi__stepper_prepare_lanes(&e->integrators[i]->stepper, e->capacity));
  if (!has_lanes(e) && !e->bound && o->block == 0) e->capacity = 1;
  for (int i = 0; i < e->threads; i++) DVI_TRY(worker_allocate(e, &e->workers[i]));
  return DVI_OK;
}

static dvi_status make_blocks(dvi_ensemble *e, const dvi_system *system,
                              const dvi_ensemble_options *o)
{
  e->block_count = cut_blocks(e, system, o, NULL);
  e->blocks = DVI_NEW(dvi__block, e->block_count);
  e->status = DVI_NEW(dvi_status, e->members);
  if (e->blocks == NULL || e->status == NULL)
    return dvi__fail(DVI_NO_MEMORY, "ensemble: no memory for %d members", e->members);
  (void)cut_blocks(e, system, o, e->blocks);
  return DVI_OK;
}

static dvi_status ensemble_assemble(dvi_ensemble *e, const dvi_system *system, const char *method,
                                    const dvi_ensemble_options *o)
{
  DVI_TRY(make_workers(e, system, method, o));
  DVI_TRY(make_members(e));
  DVI_TRY(make_lanes(e, o));
  DVI_TRY(make_blocks(e, system, o));
  if (e->bound) DVI_TRY(add_those_of_blocks(e, method, o->shapes));
  return dvi__team_create(e->threads, &e->team);
}

dvi_status dvi_ensemble_create(const dvi_system *system, const char *method,
                               const dvi_ensemble_options *options, dvi_ensemble **ensemble)
{
  if (ensemble == NULL) return dvi__fail(DVI_BAD_ARGUMENT, "ensemble: no place for the result");
  *ensemble = NULL;
  DVI_TRY(ensemble_check(system, method, options));
  const long before = dvi__allocation_count();
  dvi_ensemble *e = DVI_NEW(dvi_ensemble, 1);
  if (e == NULL) return dvi__fail(DVI_NO_MEMORY, "ensemble: no memory");
  e->members = options->members;
  e->threads = smaller_count(options->threads > 0 ? options->threads : 1, options->members);
  e->n = system_of(system, options, 0)->n;
  e->system_is_general = system_of(system, options, 0)->lagrangian != NULL;
  const dvi_status status = ensemble_assemble(e, system, method, options);
  e->allocations = dvi__allocation_count() - before;
  if (status != DVI_OK) dvi_ensemble_destroy(&e);
  *ensemble = e;
  return status;
}

void dvi_ensemble_destroy(dvi_ensemble **ensemble)
{
  if (ensemble == NULL || *ensemble == NULL) return;
  dvi_ensemble *e = *ensemble;
  dvi__team_destroy(&e->team);
  /* A worker owns the copy of the system that its integrators evaluate. */
  for (int i = 0; i < e->integrator_count; i++) dvi_integrator_destroy(&e->integrators[i]);
  for (int i = 0; i < e->threads && e->workers != NULL; i++) clear_worker(&e->workers[i]);
  dvi__release(e->integrators);
  dvi__release(e->workers);
  dvi__release(e->blocks);
  dvi__release(e->numbers);
  dvi__release(e->status);
  dvi__release(e);
  *ensemble = NULL;
}
