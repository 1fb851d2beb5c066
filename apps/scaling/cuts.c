#include "scaling/cuts.h"

#include <dvi/maxwell.h>
#include <math.h>
#include <stdlib.h>

#include "cli/command.h"
#include "load/field.h"
#include "shares/stand_in.h"
#include "module/ranks.h"

enum { TRIES = 8 /* parts with the largest surface that are cut out of all */ };

/* ---- the largest part ---- */

/* Count the facets of each part that another one has, too. */
static dvi_status count_surfaces(const dvi_mesh *mesh, const int *owner, int64_t *surface)
{
  const int n = dvi_mesh_dimension(mesh);
  dvi_matrix d;
  const dvi_status status = dvi_mesh_incidence(mesh, n - 1, &d);
  int *first = status == DVI_OK ? malloc((size_t)d.columns * sizeof *first) : NULL;
  if (first == NULL) return status != DVI_OK ? status : DVI_NO_MEMORY;
  for (int64_t f = 0; f < d.columns; f++) first[f] = -1;
  for (int64_t i = 0; i < d.rows * d.width; i++) {
    const int own = owner[i / d.width];
    int *other = first + d.column[i];
    if (*other >= 0 && *other != own) {
      surface[own]++;
      surface[*other]++;
    }
    *other = own;
  }
  free(first);
  return DVI_OK;
}

static int take_largest(int parts, int64_t *surface)
{
  int largest = 0;
  for (int p = 1; p < parts; p++)
    if (surface[p] > surface[largest]) largest = p;
  surface[largest] = -1;
  return largest;
}

/* Cut out the parts with the largest surface, find the most that one of them has, and keep the
 * largest share. */
static dvi_status cut_largest(const dvi_mesh *mesh, int degree, const int *owner, int64_t *surface,
                              mesh_cut *cut, dvi_mesh **largest)
{
  const int parts = (int)cut->parts;
  const form_of_share form = {.degree = degree};
  dvi_status status = count_surfaces(mesh, owner, surface);
  for (int i = 0; i < parts && i < TRIES && status == DVI_OK; i++) {
    const dvi_ranks ranks = stand_in(take_largest(parts, surface), parts);
    const double before = cut->share;
    dvi_mesh *share = NULL;
    mesh_division division = {.owned = 0};
    status = dvi_mesh_cut(mesh, owner, &ranks, &share);
    if (status == DVI_OK && !stand_in_count(share, &form, ranks.rank, parts, &division))
      status = DVI_NO_MEMORY;
    cut->share = fmax(cut->share, (double)(division.owned + division.ghosts));
    cut->bytes = fmax(cut->bytes, (double)division.bytes_in);
    cut->messages = fmax(cut->messages, division.messages_in);
    if (cut->share > before) {
      dvi_mesh *smaller = *largest;
      *largest = share;
      share = smaller;
    }
    dvi_mesh_destroy(&share);
  }
  return status;
}

/* ---- a march ---- */

/* Make a field without losses and sources, and start it. On a share ghosts get no values, which
 * leaves a smaller field with the bounds of the whole one: a tenth of the bound is stable, and a
 * step of any length takes as long. */
static dvi_status make_march(const dvi_star *star, int degree, dvi_field **field, dvi_march **march)
{
  const dvi_wave_terms wave = {.size = sizeof wave, .star = star};
  const dvi_maxwell_terms maxwell = {.size = sizeof maxwell, .star = star};
  const dvi_march_options options = {.size = sizeof options, .fraction = 0.1};
  const dvi_march_state start = {.size = sizeof start};
  dvi_status status = degree == 0 ? dvi_wave_create(&wave, field)
                                  : dvi_maxwell_create(&maxwell, field);
  if (status == DVI_OK) status = dvi_march_create(*field, &options, march);
  if (status == DVI_OK) status = dvi_march_start(*march, &start);
  return status;
}

static int time_march(const timed_request *request, const dvi_mesh *mesh, int degree,
                      dvi_study_spread *seconds)
{
  dvi_star *star = NULL;
  dvi_field *field = NULL;
  timed_march timed = {.march = NULL};
  dvi_march_facts facts;
  dvi_status status = dvi_star_create(mesh, NULL, &star);
  if (status == DVI_OK) status = make_march(star, degree, &field, &timed.march);
  int code = status == DVI_OK ? DONE : library_error(status);
  if (code == DONE) {
    dvi_march_facts_of(timed.march, &facts);
    timed.h = facts.step;
    code = timed_steps(request, &timed, 1, seconds);
  }
  timed_close(&timed);
  dvi_field_destroy(&field);
  dvi_star_destroy(&star);
  return code;
}

/* Give the share that has been cut, in place of the scene's mesh. */
static dvi_status take_share(const dvi_mesh *mesh, dvi_mesh **share, void *user)
{
  dvi_mesh **cut = user;
  (void)mesh;
  *share = *cut;
  *cut = NULL;
  return DVI_OK;
}

static dvi_status take_share_of_file(const char *path, dvi_mesh **share, void *user)
{
  (void)path;
  return take_share(NULL, share, user);
}

/* March the share of a solid from rest. Ghosts stay there. */
static int time_solid(const timed_request *request, const timed_march *whole, dvi_mesh **share,
                      dvi_study_spread *seconds)
{
  const dvi_scene_division division = {
      .size = sizeof division, .divide = take_share, .read = take_share_of_file, .user = share};
  const dvi_march_state rest = {.size = sizeof rest};
  timed_request same = *request;
  timed_march timed;
  same.h = whole->h;
  int code = timed_open(&same, &division, &timed);
  const dvi_status status = code == DONE ? dvi_march_start(timed.march, &rest) : DVI_OK;
  if (status != DVI_OK) code = library_error(status);
  if (code == DONE) code = timed_steps(request, &timed, 1, seconds);
  timed_close(&timed);
  return code;
}

/* ---- blocks of a grid ---- */

/* In the first of s steps together s-1 planes of each neighbour are updated, and none in the last
 * one. */
mesh_cut cut_of_block(const block *found, int parts)
{
  const double s = found->together, ghosts = (double)found->ghosts;
  return (mesh_cut){.parts = parts,
                    .share = (double)found->values + ghosts * (s - 1) / (2 * s),
                    .bytes = 8 * ghosts / s,
                    .messages = found->messages / s};
}

static int time_block(const timed_request *request, const timed_march *whole, block_cutter *cutter,
                      cut_run *run)
{
  const int parts = (int)run->cut.parts;
  const double mean = timed_values(whole) / parts;
  block found = {0};
  timed_march timed = {.h = whole->h};
  dvi_status status = block_march(cutter, parts / 2, parts, whole->h, &timed.march);
  if (status == DVI_BAD_ARGUMENT) { /* there are not as many planes */
    run->cut.parts = 0;
    return DONE;
  }
  if (status == DVI_OK) status = block_count(cutter, timed.march, &found);
  int code = status == DVI_OK ? DONE : library_error(status);
  if (code == DONE) {
    run->cut = cut_of_block(&found, parts);
    run->cut.share = fmax(run->cut.share, mean); /* the last block has the last nodes, too */
    code = timed_steps(request, &timed, 1, &run->seconds);
  }
  timed_close(&timed);
  return code;
}

static int cut_block(const timed_request *request, const timed_march *whole, cut_run *run)
{
  block_cutter *cutter;
  int code = block_cutter_open(request->scene, request->settings, &cutter);
  if (code == DONE) code = time_block(request, whole, cutter, run);
  block_cutter_close(&cutter);
  return code;
}

/* ---- cuts ---- */

static int cut_and_time(const timed_request *request, const timed_march *whole, int *owner,
                        int64_t *surface, cut_run *run)
{
  const dvi_mesh *mesh = timed_mesh(whole);
  const int degree = timed_degree(whole), times = timed_times(whole);
  dvi_mesh *share = NULL;
  dvi_status status = ranks_partition(mesh, (int)run->cut.parts, owner);
  if (status == DVI_OK) status = cut_largest(mesh, degree, owner, surface, &run->cut, &share);
  run->cut.bytes *= times;
  run->cut.messages *= times;
  const int code = status != DVI_OK             ? library_error(status)
                   : whole->kind == TIMED_SOLID ? time_solid(request, whole, &share, &run->seconds)
                                                : time_march(request, share, degree, &run->seconds);
  dvi_mesh_destroy(&share);
  return code;
}

static int cut_mesh(const timed_request *request, const timed_march *whole, cut_run *run)
{
  const dvi_mesh *mesh = timed_mesh(whole);
  const int64_t cells = dvi_mesh_count(mesh, dvi_mesh_dimension(mesh));
  int *owner = malloc((size_t)cells * sizeof *owner);
  int64_t *surface = calloc((size_t)run->cut.parts, sizeof *surface);
  const int code = owner != NULL && surface != NULL
                       ? cut_and_time(request, whole, owner, surface, run)
                       : library_error(DVI_NO_MEMORY);
  free(owner);
  free(surface);
  return code;
}

static int time_whole(const timed_request *request, const timed_march *whole, cut_run *run)
{
  if (whole->kind == TIMED_GRID) {
    run->cut.share = timed_values(whole);
    return timed_steps(request, whole, 1, &run->seconds);
  }
  const dvi_mesh *mesh = timed_mesh(whole);
  run->cut.share = (double)dvi_mesh_count(mesh, dvi_mesh_dimension(mesh));
  return whole->kind == TIMED_SOLID ? timed_steps(request, whole, 1, &run->seconds)
                                    : time_march(request, mesh, timed_degree(whole), &run->seconds);
}

int cut_run_measure(const timed_request *request, const timed_march *whole, int parts, cut_run *run)
{
  *run = (cut_run){.cut = {.parts = parts}};
  if (parts == 1) return time_whole(request, whole, run);
  return whole->kind == TIMED_GRID ? cut_block(request, whole, run) : cut_mesh(request, whole, run);
}
