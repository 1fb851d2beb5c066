#define _XOPEN_SOURCE 700
#include "scaling/ranks_bench.h"

#include <errno.h>
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

#include "bench/machine.h"
#include "cli/command.h"
#include "load/field.h"
#include "module/ranks.h"
#include "scaling/cores.h"
#include "scaling/halo.h"
#include "scaling/ranks_report.h"
#include "scaling/triad.h"
#include "scaling/whole.h"
#include "shares/stand_in.h"
#include "study/clock.h"

enum {
  PARTS_MAX = 128,   /* of a cut */
  FINER = 8,         /* parts of the next one for each */
  CELLS_LEAST = 100, /* of a part */
  STARTED_MOST = 4,  /* processes that are started without mpirun */
  MESSAGES = 1000,   /* small ones that are timed at once */
  SMALL = 8,         /* bytes of a message */
  LARGE = 1 << 20,
  FIRST_WORDS = 5, /* of a command line of mpirun */
  TEXT_SIZE = 256,
  NUMBER_TEXT = 32
};

/* ---- the start ---- */

static int choose_processes(const rank_counts *asked)
{
  const int most = cores_count() < STARTED_MOST ? cores_count() : STARTED_MOST;
  int processes = 2;
  for (int i = 0; i < asked->count; i++)
    if (asked->number[i] <= most) processes = (int)fmax(processes, asked->number[i]);
  return processes;
}

int ranks_bench_start(const ranks_request *request, int argc, char **argv)
{
  rank_counts asked;
  char count[NUMBER_TEXT], self[] = "dvi", *path = NULL;
  int code = rank_counts_read(request->scaled, &asked);
  if (code == DONE) code = ranks_check_module();
  if (code != DONE) return code;
  char **word = calloc((size_t)argc + FIRST_WORDS + 1, sizeof *word);
  if (word == NULL) return library_error(DVI_NO_MEMORY);
  path = realpath("/proc/self/exe", NULL);
  (void)snprintf(count, sizeof count, "%d", choose_processes(&asked));
  char *const first[FIRST_WORDS] = {"mpirun", "-np", count, path != NULL ? path : self, "bench"};
  memcpy(word, first, sizeof first);
  memcpy(word + FIRST_WORDS, argv, (size_t)argc * sizeof *argv);
  (void)fflush(stdout);
  (void)execvp("mpirun", word);
  complain("bench: cannot start processes by mpirun: %s; measurements of ranks need MPI",
           strerror(errno));
  free(word);
  free(path);
  return FAILED;
}

/* ---- one process alone ---- */

static int measure_cuts(ranks_bench *b, const timed_march *timed)
{
  int code = cut_run_measure(&b->request->timed, timed, 1, b->cut);
  b->cuts = 1;
  for (int parts = 2; parts <= PARTS_MAX && parts * CELLS_LEAST <= b->whole.cells && code == DONE;
       parts *= FINER) {
    code = cut_run_measure(&b->request->timed, timed, parts, b->cut + b->cuts);
    if (b->cut[b->cuts].cut.parts < parts) break;
    b->cuts++;
  }
  return code;
}

/* One process alone reads all of a file in parts, too. */
static int measure_alone(ranks_bench *b)
{
  const dvi_scene_division parts = {
      .size = sizeof parts, .divide = stand_in_keep, .read = ranks_read};
  timed_march timed;
  int code = timed_open(&b->request->timed, b->is_in_parts ? &parts : NULL, &timed);
  if (code == DONE) code = whole_count(&timed, &b->whole);
  if (code == DONE) code = timed_steps(&b->request->timed, &timed, 1, &b->whole.seconds);
  if (code == DONE) code = measure_cuts(b, &timed);
  timed_close(&timed);
  if (code == DONE && b->whole.kind == TIMED_GRID) code = whole_foresee(b);
  return code;
}

/* ---- processes that share ---- */

/* Find the value of the parameter for one rank, in the settings or the scene. */
static int find_base(ranks_bench *b, const problem *scene)
{
  const ranks_request *r = b->request;
  const size_t length = strlen(r->weak);
  const problem_parameter *k = scene->parameter;
  for (int i = 0; i < r->timed.settings->count; i++) {
    const char *word = r->timed.settings->word[i];
    if (strncmp(word, r->weak, length) == 0 && word[length] == '=' &&
        parse_number(word + length + 1, &b->base))
      return DONE;
  }
  while (k->name != NULL && strcmp(k->name, r->weak) != 0) k++;
  if (k->name == NULL)
    return usage_error("bench: --weak %s: %s has no such parameter", r->weak, scene->name);
  b->base = k->value;
  return DONE;
}

/* Divide the mesh, and note what the whole one holds. */
static dvi_status divide(const dvi_mesh *mesh, dvi_mesh **share, void *user)
{
  double *heap = user;
  *heap = machine_heap() - *heap;
  return ranks_divide(mesh, share, NULL);
}

/* No process has the whole mesh of a file. */
static dvi_status read_parts(const char *path, dvi_mesh **share, void *user)
{
  double *heap = user;
  *heap = (double)NAN;
  return ranks_read(path, share, NULL);
}

static double agreements_so_far(void)
{
  mesh_traffic traffic;
  ranks_received(&traffic);
  return (double)traffic.agreements;
}

/* Time steps, and count agreements in them. */
static int time_shared(const timed_request *request, const timed_march *timed, const block *own,
                       shared_run *run)
{
  const double began = dvi_march_time(timed->march), agreements = agreements_so_far();
  const int code = timed_steps(request, timed, run->ranks, &run->seconds);
  if (code != DONE) return code;
  run->agreements = (agreements_so_far() - agreements) /
                    round((dvi_march_time(timed->march) - began) / timed->h);
  return halo_time(timed, own, request->rounds, run);
}

static int measure_shared(ranks_bench *b, const timed_request *request, shared_run *run)
{
  double heap = machine_heap();
  const dvi_scene_division division = {.size = sizeof division,
                                       .divide = divide,
                                       .read = read_parts,
                                       .user = &heap,
                                       .grid = ranks_grid()};
  timed_march timed;
  block own = {.together = 1};
  int code = timed_open(request, &division, &timed);
  if (code == DONE) code = halo_find(request, &timed, run, &own);
  if (code == DONE) {
    run->is_oversubscribed = ranks_on_machine() > b->cores;
    if (!run->is_weak) b->mesh_bytes = timed.kind == TIMED_GRID ? (double)NAN : heap;
    if (!run->is_weak && b->request->weak != NULL) code = find_base(b, timed.scene);
  }
  if (code == DONE) code = time_shared(request, &timed, &own, run);
  timed_close(&timed);
  return code;
}

/* ---- a mesh that grows ---- */

static int measure_weak(ranks_bench *b, double cells, shared_run *run)
{
  static const double tolerance = 0.05; /* of the number of cells, which are whole */
  words settings = {.count = 0};
  timed_request grown = b->request->timed;
  char text[TEXT_SIZE];
  const size_t length = strlen(b->request->weak);
  for (int i = 0; i < grown.settings->count; i++) {
    const char *word = grown.settings->word[i];
    if (strncmp(word, b->request->weak, length) != 0 || word[length] != '=')
      settings.word[settings.count++] = word;
  }
  if (settings.count == WORDS_MAX) return usage_error("bench: too many settings for --weak");
  (void)snprintf(text, sizeof text, "%s=%.17g", b->request->weak, b->base * run->ranks);
  settings.word[settings.count++] = text;
  grown.settings = &settings;
  const int code = measure_shared(b, &grown, run);
  if (code == DONE && fabs(run->plane - run[-1].plane) > tolerance * run->plane)
    return usage_error("bench: --weak %s: the planes of the last axis grow, along which ranks have "
                       "slabs of a longer grid; take a parameter that makes this axis longer alone",
                       b->request->weak);
  if (code != DONE || fabs(run->cells / (cells * run->ranks) - 1) < tolerance) return code;
  return usage_error(
      "bench: --weak %s: with %s the mesh has %.0f cells, and not %d times %.0f; the "
      "cells must grow in proportion",
      b->request->weak, text, run->cells, run->ranks, cells);
}

/* ---- the machine ---- */

static int measure_network(ranks_bench *b)
{
  char *bytes = calloc(LARGE, 1);
  b->latency = b->bandwidth = (double)NAN;
  b->is_one_machine = ranks_on_machine() == 2;
  if (bytes == NULL) return library_error(DVI_NO_MEMORY);
  const double small = ranks_ping(bytes, SMALL, MESSAGES), large = ranks_ping(bytes, LARGE, 30);
  free(bytes);
  if (!(small > 0) || !(large > small)) {
    complain("bench: messages between processes could not be timed");
    return FAILED;
  }
  b->latency = small;
  b->bandwidth = LARGE / (large - small);
  return DONE;
}

/* Measure what a message takes in a refresh, by a mesh so small that its bytes do not count. */
static int measure_message(ranks_bench *b)
{
  const dvi_generator_options line = {.size = sizeof line, .cells = {16}};
  double values[17] = {0}, least = INFINITY;
  dvi_mesh *mesh = NULL, *share = NULL;
  dvi_status status = dvi_mesh_generate("interval", &line, &mesh);
  if (status == DVI_OK) status = ranks_divide(mesh, &share, NULL);
  for (long round = 0; round <= b->request->timed.rounds && status == DVI_OK; round++) {
    const double began = elapsed_now();
    for (int i = 0; i < MESSAGES && status == DVI_OK; i++) status = ranks_refresh(0, values);
    least = fmin(least, (elapsed_now() - began) / MESSAGES);
  }
  dvi_mesh_destroy(&share);
  dvi_mesh_destroy(&mesh);
  b->refresh = least;
  return status == DVI_OK ? DONE : library_error(status);
}

/* Measure on the first processes, while the others sleep. Returns the exit code of all of them. */
static int with(int ranks, int (*measure)(ranks_bench *b, int ranks), ranks_bench *b)
{
  const bool works = ranks_among(ranks);
  if (works) cores_keep(ranks_number());
  return ranks_rest(works ? measure(b, ranks) : DONE);
}

static int alone(ranks_bench *b, int ranks)
{
  (void)ranks;
  return measure_alone(b);
}

static int network(ranks_bench *b, int ranks)
{
  (void)ranks;
  const int code = measure_message(b);
  return code == DONE ? measure_network(b) : code;
}

static int triad(ranks_bench *b, int ranks)
{
  triad_run *run = b->triad + b->triads;
  *run = (triad_run){ranks, (double)NAN};
  if (ranks_on_machine() > b->cores) return DONE; /* turns would not be told from bandwidth */
  run->bandwidth = triad_together(ranks, b->request->timed.rounds);
  return isfinite(run->bandwidth) ? DONE : FAILED;
}

static int shared(ranks_bench *b, int ranks)
{
  shared_run *run = b->run + b->shared;
  *run = (shared_run){.ranks = ranks};
  return measure_shared(b, &b->request->timed, run);
}

/* The run before it has the mesh of one rank. */
static int weak(ranks_bench *b, int ranks)
{
  shared_run *run = b->run + b->shared;
  *run = (shared_run){.ranks = ranks, .is_weak = true};
  return measure_weak(b, run[-1].cells, run);
}

/* ---- all of it ---- */

/* Give the i-th number of ranks to be measured, 0 beyond the last one. Without any there is the
 * number of processes. */
static int measured_ranks(const rank_counts *asked, int i)
{
  int found = 0;
  for (int k = 0; k < asked->count; k++)
    if (asked->number[k] >= 2 && asked->number[k] <= ranks_count() && found++ == i)
      return (int)asked->number[k];
  return found == 0 && i == 0 ? ranks_count() : 0;
}

static int measure_all(ranks_bench *b)
{
  int code = with(1, alone, b), ranks;
  for (int i = 0; i < SHARED_MAX && (ranks = measured_ranks(&b->asked, i)) > 0; i++) {
    if (code == DONE) code = with(ranks, shared, b);
    b->shared++;
    if (code == DONE && b->request->weak != NULL) code = with(ranks, weak, b);
    b->shared += b->request->weak != NULL;
  }
  if (code == DONE) code = with(2, network, b);
  if (code == DONE) code = with(1, triad, b);
  b->triads++;
  for (int i = 0; i < SHARED_MAX && (ranks = measured_ranks(&b->asked, i)) > 0; i++) {
    if (code == DONE) code = with(ranks, triad, b);
    b->triads++;
  }
  return code;
}

int ranks_bench_run(const ranks_request *request)
{
  ranks_bench b = {.request = request,
                   .cores = cores_count(),
                   .is_in_parts = timed_is_in_parts(&request->timed)};
  int code = ranks_agree(rank_counts_read(request->scaled, &b.asked));
  if (code == DONE) code = measure_all(&b);
  if (code == DONE && ranks_is_first()) code = ranks_report(&b);
  return code;
}
