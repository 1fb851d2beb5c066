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
  if (timed->kind == TIMED_GRID) { /* a step reads and writes each value once */
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

/* ---- blocks of a grid ---- */

enum {
  LOOKED_AT = 4 /* of many blocks: some in the middle, one of which is inside, and the last */
};

/* Find the most that one of the blocks has. It has 0 parts if there are not as many. */
static dvi_status foresee(block_cutter *cutter, int ranks, double h, mesh_cut *most)
{
  *most = (mesh_cut){.parts = ranks};
  for (int i = 0; i < LOOKED_AT && i < ranks; i++) {
    const int inside = ranks / 2 + i < ranks ? ranks / 2 + i : i;
    dvi_march *march = NULL;
    block found = {0};
    dvi_status status = block_march(cutter, i == 0 ? ranks - 1 : inside, ranks, h, &march);
    if (status == DVI_BAD_ARGUMENT) {
      most->parts = 0;
      return DVI_OK;
    }
    if (status == DVI_OK) status = block_count(cutter, march, &found);
    dvi_march_destroy(&march);
    if (status != DVI_OK) return status;
    const mesh_cut cut = cut_of_block(&found, ranks);
    most->share = fmax(most->share, cut.share);
    most->bytes = fmax(most->bytes, cut.bytes);
    most->messages = fmax(most->messages, cut.messages);
  }
  return DVI_OK;
}

int whole_foresee(ranks_bench *b)
{
  const timed_request *r = &b->request->timed;
  block_cutter *cutter;
  int code = block_cutter_open(r->scene, r->settings, &cutter);
  dvi_status status = code == DONE ? foresee(cutter, 2, r->h, &b->beside) : DVI_OK;
  for (int i = 0; i < b->asked.count && code == DONE && status == DVI_OK; i++) {
    const double ranks = b->asked.number[i];
    b->foreseen[i] = (mesh_cut){.parts = 0};
    if (ranks <= 1 || ranks > INT_MAX) continue;
    status = foresee(cutter, (int)ranks, r->h, b->foreseen + i);
    if (b->foreseen[i].parts <= 0) break;
  }
  if (status != DVI_OK) code = library_error(status);
  block_cutter_close(&cutter);
  return code;
}
