/* The section "avi" of a saved state: what identifies the steps, the clock, and all numbers. */
#include <math.h>
#include <string.h>

#include "core/hash.h"
#include "core/memory.h"
#include "core/status.h"
#include "field/avi/engine.h"

enum { VERSION = 1 };

typedef struct saved_clock {
  uint64_t hash;
  int64_t edges, faces, extras, nodes, is_queued;
  double t0, t, start_energy, allowed;
  int64_t slot, events, checks;
} saved_clock;

/* Of stars, steps and incidence. Currents are callbacks, whose profiles alone can be told apart. */
static uint64_t hash_of(const dvi__avi *avi)
{
  const size_t edges = (size_t)avi->edges, faces = (size_t)avi->faces;
  uint64_t hash = DVI__HASH_START;
  hash = dvi__hash(hash, edges * sizeof *avi->M1, avi->M1);
  hash = dvi__hash(hash, faces * sizeof *avi->M2, avi->M2);
  hash = dvi__hash(hash, faces * sizeof *avi->step, avi->step);
  hash = dvi__hash(hash, faces * (size_t)avi->width * sizeof *avi->facet, avi->facet);
  hash = dvi__hash(hash, edges * sizeof *avi->edge_name, avi->edge_name);
  for (int64_t i = 0; i < avi->extra_count; i++) {
    const dvi__avi_extra *extra = avi->extras + i;
    hash = dvi__hash(hash, sizeof extra->damping, &extra->damping);
    for (int k = extra->push; k < extra->push + extra->pushes; k++) {
      hash = dvi__hash(hash, sizeof avi->push[k].current, &avi->push[k].current);
      hash = dvi__hash(hash, sizeof avi->push[k].profile, &avi->push[k].profile);
    }
  }
  return hash;
}

static saved_clock clock_of(const dvi__avi *avi)
{
  return (saved_clock){.hash = hash_of(avi),
                       .edges = avi->edges,
                       .faces = avi->faces,
                       .extras = avi->extra_count,
                       .nodes = avi->nodes,
                       .is_queued = avi->is_queued,
                       .t0 = avi->t0,
                       .t = avi->t,
                       .start_energy = avi->start_energy,
                       .allowed = avi->allowed,
                       .slot = avi->slot,
                       .events = avi->events,
                       .checks = avi->checks};
}

/* ---- arrays ---- */

/* The arrays of a state one after the other. */
typedef struct state_array {
  void *content;
  size_t size;
} state_array;

enum { STATE_ARRAYS = 7 };

static void list_arrays(const dvi__avi *avi, state_array array[STATE_ARRAYS])
{
  const size_t of_edges = (size_t)avi->edges * sizeof(double),
               of_faces = (size_t)avi->faces * sizeof(double);
  const state_array list[STATE_ARRAYS] = {
      {avi->A, of_edges},
      {avi->D, of_edges},
      {avi->bias, of_faces},
      {avi->charge, (size_t)avi->nodes * sizeof(double)},
      {avi->extras, (size_t)avi->extra_count * sizeof *avi->extras},
      {avi->clock, avi->is_queued ? of_edges : 0},
      {avi->count, avi->is_queued ? (size_t)avi->faces * sizeof *avi->count : 0}};
  memcpy(array, list, sizeof list);
}

void dvi__avi_save(const dvi__avi *avi, dvi__sections_writer *writer)
{
  const saved_clock clock = clock_of(avi);
  state_array array[STATE_ARRAYS];
  list_arrays(avi, array);
  dvi__section_open(writer, "avi", VERSION);
  dvi__section_put(writer, &clock, sizeof clock);
  for (int i = 0; i < STATE_ARRAYS; i++)
    if (array[i].size > 0) dvi__section_put(writer, array[i].content, array[i].size);
}

static dvi_status check_clock(const dvi__avi *avi, const saved_clock *saved, const char *name)
{
  const saved_clock own = clock_of(avi);
  if (saved->hash == own.hash && saved->edges == own.edges && saved->faces == own.faces &&
      saved->extras == own.extras && saved->nodes == own.nodes && saved->is_queued == own.is_queued)
    return DVI_OK;
  return dvi__fail(DVI_BAD_FILE,
                   "%s: it is of %lld and %lld cells with other stars, steps or currents than "
                   "these %lld and %lld",
                   name, (long long)saved->edges, (long long)saved->faces, (long long)own.edges,
                   (long long)own.faces);
}

static void take_clock(dvi__avi *avi, const saved_clock *saved)
{
  avi->t0 = saved->t0;
  avi->t = saved->t;
  avi->start_energy = saved->start_energy;
  avi->allowed = saved->allowed;
  avi->slot = saved->slot;
  avi->events = saved->events;
  avi->checks = saved->checks;
  avi->view->t = (double)NAN;
}

dvi_status dvi__avi_load(dvi__avi *avi, const dvi__sections *sections)
{
  dvi__section section;
  saved_clock saved;
  state_array array[STATE_ARRAYS];
  size_t size = sizeof saved;
  list_arrays(avi, array);
  for (int i = 0; i < STATE_ARRAYS; i++) size += array[i].size;
  DVI_TRY(dvi__section_find(sections, "avi", VERSION, DVI__ANY_SIZE, &section));
  if (section.size < sizeof saved)
    return dvi__fail(DVI_BAD_FILE, "%s: the section avi has %zu bytes", sections->name,
                     section.size);
  memcpy(&saved, section.content, sizeof saved);
  DVI_TRY(check_clock(avi, &saved, sections->name));
  if (section.size != size)
    return dvi__fail(DVI_BAD_FILE, "%s: the section avi has %zu bytes, and %zu are needed",
                     sections->name, section.size, size);
  const unsigned char *content = section.content + sizeof saved;
  for (int i = 0; i < STATE_ARRAYS; i++) {
    if (array[i].size > 0) memcpy(array[i].content, content, array[i].size);
    content += array[i].size;
  }
  take_clock(avi, &saved);
  if (avi->is_queued) dvi__avi_order_events(avi);
  return DVI_OK;
}
