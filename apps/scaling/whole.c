#include "scaling/whole.h"

#include <limits.h>
#include <math.h>

#include "cli/command.h"
#include "load/field.h"

const char *whole_name(const whole_run *whole)
{
  return whole->kind == TIMED_GRID ? "grid" : "mesh";
}

const char *whole_unit(const whole_run *whole)
{
  return whole->kind == TIMED_GRID ? "values of E and B" : "cells";
}

/* ---- what a step moves ---- */

/* A step without losses moves, if each number comes from memory once, of the (k+1)-cells the
 * numbers of their facets in both directions, weights and H, and E of the k-cells. */
static int count_field(const timed_march *timed, whole_run *whole)
{
  const dvi_mesh *mesh = timed_mesh(timed);
  dvi_matrix d;
  const dvi_status status = dvi_mesh_incidence(mesh, timed_degree(timed), &d);
  if (status != DVI_OK) return library_error(status);
  const double faces = (double)d.rows, edges = (double)d.columns, width = d.width;
  whole->bytes = faces * (8 * width + 32) + 36 * edges;
  whole->flops = faces * (3 * width + 2) + 2 * edges;
  whole->state_bytes = 8 * (faces + edges);
  return DONE;
}

/* The steps of a solid read two lines of the cache for each cell, and read and write one for each
 * node. */
static void count_solid(const timed_march *timed, whole_run *whole)
{
  enum { LINE = 64 };
  const dvi_mesh *mesh = timed_mesh(timed);
  const double nodes = (double)dvi_mesh_count(mesh, 0);
  whole->bytes = 2 * LINE * (whole->cells + nodes);
  whole->state_bytes = 8 * nodes * (2 * dvi_mesh_dimension(mesh) + 1);
}

static void count_mesh(const timed_march *timed, whole_run *whole)
{
  const dvi_mesh *mesh = timed_mesh(timed);
  const int n = dvi_mesh_dimension(mesh);
  whole->dimension = n;
  whole->cells = (double)dvi_mesh_count(mesh, n);
  for (int i = 0; i <= n; i++)
    whole->numbered = fmax(whole->numbered, (double)dvi_mesh_count(mesh, i));
}

int whole_count(const timed_march *timed, whole_run *whole)
{
  *whole = (whole_run){.kind = timed->kind, .method = timed->method, .flops = (double)NAN};
  if (timed->kind == TIMED_GRID) { /* slabs; a step reads and writes each value once */
    whole->dimension = 1;
    whole->cells = timed_values(timed);
    whole->bytes = 16 * whole->cells;
    whole->state_bytes = 8 * whole->cells;
    return DONE;
  }
  count_mesh(timed, whole);
  if (timed->kind == TIMED_FIELD) return count_field(timed, whole);
  count_solid(timed, whole);
  return DONE;
}

/* ---- slabs ---- */

int whole_most_slabs(ranks_bench *b)
{
  const timed_request *r = &b->request->timed;
  slab_cutter *cutter;
  const int code = slab_cutter_open(r->scene, r->settings, &cutter);
  b->most_ranks = 1;
  for (int i = 0; i < b->asked.count && code == DONE; i++) {
    dvi_march *march = NULL;
    const double ranks = b->asked.number[i];
    const bool fits = ranks <= INT_MAX && slab_march(cutter, 0, (int)ranks, r->h, &march) == DVI_OK;
    dvi_march_destroy(&march);
    if (!fits) break;
    b->most_ranks = ranks;
  }
  slab_cutter_close(&cutter);
  return code;
}
