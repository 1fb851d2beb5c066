#include "shares/share.h"

#include <dvi/elastic.h>
#include <dvi/scene.h>
#include <math.h>
#include <stdbool.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "cli/command.h"
#include "csv/table.h"
#include "load/elastic.h"
#include "load/field.h"
#include "module/ranks.h"
#include "shares/blocks.h"
#include "shares/exchange.h"
#include "shares/stand_in.h"

enum { RANKS_SHOWN = 16, HOW_SIZE = 64, SENTENCE_SIZE = 512 };

static const char *const implicit[] = {"midpoint", "imex", "galerkin"};

enum { IMPLICIT = sizeof implicit / sizeof *implicit };

bool share_is_implicit(const char *method)
{
  const size_t length = strcspn(method, ":");
  for (int i = 0; i < IMPLICIT; i++)
    if (strlen(implicit[i]) == length && strncmp(method, implicit[i], length) == 0) return true;
  return false;
}

/* What there are several processes by, which can be left out. */
static const char *means(void)
{
  return ranks_count() > 1 ? "mpirun" : "--ranks";
}

/* What processes share of a scene: the words for its methods, and those for a remedy. */
typedef struct shared_methods {
  const char *all, *remedy;
} shared_methods;

/* Shares of waves have all implicit methods, and those of Maxwell's fields midpoint. */
static bool is_wave(const problem *scene)
{
  return dvi_scene_marches(scene->scene, "imex");
}

static shared_methods methods_of(const problem *scene)
{
  static const shared_methods of_solids = {"avi and verlet", "avi"}, of_grids = {"yee", "yee"},
                              of_waves = {"leapfrog, midpoint, imex and galerkin",
                                          "leapfrog, or with a potential midpoint"},
                              of_light = {"leapfrog, midpoint and, on grids, yee", "leapfrog"};
  if (elastic_of(scene) != NULL) return of_solids;
  if (dvi_scene_grid_only(scene->scene) != NULL) return of_grids;
  return is_wave(scene) ? of_waves : of_light;
}

/* Tell if processes share a method of a scene. */
static bool is_shared(const problem *scene, const char *method)
{
  if (method == NULL) return false;
  if (elastic_of(scene) != NULL) return dvi_scene_marches(scene->scene, method);
  if (strcmp(method, "leapfrog") == 0) return true;
  if (strcmp(method, "yee") == 0) return !is_wave(scene);
  return share_is_implicit(method) && dvi_scene_marches(scene->scene, method);
}

/* A method of the scene is a mistake of its text. */
static int refuse_method(const char *command, const problem *scene, const char *method,
                         int processes)
{
  const shared_methods known = methods_of(scene);
  char sentence[SENTENCE_SIZE], message[2 * SENTENCE_SIZE] = "";
  const char *asked = method != NULL ? method : scene->method;
  (void)snprintf(sentence, sizeof sentence,
                 "%s: %d processes share %s alone, %s%s; take %s, or leave %s out", command,
                 processes, known.all, asked != NULL ? "not " : "and no method is given",
                 asked != NULL ? asked : "", known.remedy, means());
  if (method != NULL || scene->method == NULL) return usage_error("%s", sentence);
  dvi_scene_tell(scene->scene, "method", sentence, message, sizeof message);
  return usage_error("%s", message);
}

int share_check(const char *command, const problem *scene, const char *method, int processes)
{
  const bool is_solid = scene->scene != NULL && elastic_of(scene) != NULL;
  if (scene->scene == NULL || !(is_solid || dvi_scene_marches(scene->scene, "leapfrog")))
    return usage_error("%s: %d processes share a scene of waves, of Maxwell's field or of a solid "
                       "on a mesh, and %s is none; leave %s out",
                       command, processes, scene->name, means());
  return is_shared(scene, method != NULL ? method : scene->method)
             ? DONE
             : refuse_method(command, scene, method, processes);
}

/* ---- the table ---- */

static const table_column columns[] = {
    {"rank", "%.0f"},       {"partitioner", ""},  {"cells", "%.0f"}, {"ghosts", "%.0f"},
    {"neighbours", "%.0f"}, {"messages", "%.0f"}, {"bytes", "%.0f"}, {NULL, NULL},
};

/* The rows of all processes, what they have together, and the least and the most of cells. */
typedef struct division_table {
  const exchange *what;
  result_table *rows;
  int count;
  double cells, messages, bytes, least, most;
} division_table;

/* A share is exchanged once for each component. Of single events nothing is known. */
static void add_share(division_table *table, const mesh_division *share)
{
  const bool is_known = table->what->kind != EXCHANGE_EVENTS;
  const double times = table->what->times, owned = (double)share->owned;
  table->least = table->count > 0 ? fmin(table->least, owned) : owned;
  table->most = fmax(table->most, owned);
  table->cells += owned;
  table->messages += times * share->messages_in;
  table->bytes += times * (double)share->bytes_in;
  table_number(table->rows, table->count++);
  table_text(table->rows, share->partitioner);
  table_number(table->rows, owned);
  table_number(table->rows, (double)share->ghosts);
  table_number(table->rows, share->neighbours);
  table_number(table->rows, is_known ? times * share->messages_in : (double)NAN);
  table_number(table->rows, is_known ? times * (double)share->bytes_in : (double)NAN);
}

static void print_sum(const division_table *table, const char *how)
{
  (void)printf("shares: %.0f %s among %d processes %s, %.0f to %.0f each, the most %.1f %% above "
               "the mean\n",
               table->cells, table->what->kind == EXCHANGE_PLANES ? "values of E and B" : "cells",
               table->count, how, table->least, table->most,
               100 * (table->most * table->count / table->cells - 1));
}

static int finish(division_table *table, const char *csv)
{
  bool good = table_good(table->rows);
  if (good && table->count <= RANKS_SHOWN) table_print(table->rows, stdout, 0, 0, table->count);
  if (good && table->count > RANKS_SHOWN)
    (void)printf("--csv FILE has the shares of all %d processes\n", table->count);
  if (good && csv != NULL) good = table_write(table->rows, csv);
  table_destroy(&table->rows);
  return good ? DONE : FAILED;
}

/* ---- blocks of grids ---- */

static int refuse_block(dvi_status status)
{
  if (status == DVI_UNSUPPORTED && strncmp(dvi_last_error(), "yee", 3) != 0)
    return usage_error("explain: processes share yee on grids alone, without probes of parts and a "
                       "start by A");
  return library_error(status);
}

static int measure_block(block_cutter *cutter, int rank, int processes, double h, block *found)
{
  dvi_march *march = NULL;
  dvi_status status = block_march(cutter, rank, processes, h, &march);
  if (status == DVI_OK) status = block_count(cutter, march, found);
  dvi_march_destroy(&march);
  return status == DVI_OK ? DONE : refuse_block(status);
}

static void add_block(division_table *table, const block *found)
{
  const mesh_division share = {.partitioner = "blocks",
                               .owned = found->values,
                               .ghosts = found->ghosts,
                               .bytes_in = found->ghosts * (int64_t)sizeof(double),
                               .messages_in = found->messages,
                               .neighbours = found->neighbours};
  add_share(table, &share);
}

/* Each process knows its own block, and gets those of the others. */
static int gather_blocks(const share_request *r, block_cutter *cutter, division_table *table,
                         exchange *what)
{
  block own = {0}, *all = calloc((size_t)ranks_count(), sizeof *all);
  int code = all != NULL ? measure_block(cutter, ranks_number(), ranks_count(), r->h, &own)
                         : library_error(DVI_NO_MEMORY);
  code = ranks_agree(code);
  if (code == DONE && !ranks_gather(&own, sizeof own, all)) code = FAILED;
  for (int k = 0; k < ranks_count() && all != NULL && code == DONE; k++) add_block(table, all + k);
  if (code == DONE) what->steps = own.together;
  free(all);
  return code;
}

static int foresee_blocks(const share_request *r, block_cutter *cutter, int processes,
                          division_table *table, exchange *what)
{
  block found = {0};
  int code = DONE;
  for (int k = 0; k < processes && code == DONE; k++) {
    code = measure_block(cutter, k, processes, r->h, &found);
    if (code != DONE) return code;
    add_block(table, &found);
    what->steps = found.together;
  }
  return code;
}

/* ---- shares of meshes ---- */

static dvi_status cut_share(const dvi_mesh *mesh, const int *owner, int parts,
                            const form_of_share *form, division_table *table)
{
  const dvi_ranks ranks = stand_in(table->count, parts);
  mesh_division division;
  dvi_mesh *share = NULL;
  dvi_status status = dvi_mesh_cut(mesh, owner, &ranks, &share);
  if (status == DVI_OK && !stand_in_count(share, form, ranks.rank, parts, &division))
    status = DVI_NO_MEMORY;
  if (status == DVI_OK) add_share(table, &division);
  dvi_mesh_destroy(&share);
  return status;
}

static int foresee_cuts(const dvi_mesh *mesh, int processes, const form_of_share *form,
                        division_table *table)
{
  int *owner = malloc((size_t)dvi_mesh_count(mesh, dvi_mesh_dimension(mesh)) * sizeof *owner);
  dvi_status status = owner != NULL ? ranks_partition(mesh, processes, owner) : DVI_NO_MEMORY;
  for (int r = 0; r < processes && status == DVI_OK; r++)
    status = cut_share(mesh, owner, processes, form, table);
  free(owner);
  return status == DVI_OK ? DONE : library_error(status);
}

/* Mark the unknowns of a field, of its mesh or its share, which a solution exchanges alone. */
static char *mark_unknowns(const dvi_field *field)
{
  int64_t unknowns;
  const int *cell = dvi_field_unknowns(field, &unknowns);
  char *marked = calloc((size_t)dvi_mesh_count(field_mesh(field), dvi_field_degree(field)), 1);
  for (int64_t i = 0; i < unknowns && marked != NULL; i++) marked[cell[i]] = 1;
  return marked;
}

static int foresee_mesh(const problem *scene, int processes, division_table *table)
{
  const dvi_field *field = dvi_scene_field(scene->scene);
  const dvi_mesh *mesh = field != NULL ? field_mesh(field) : dvi_elastic_mesh(elastic_of(scene));
  form_of_share form = {.degree = table->what->degree};
  char *unknown = NULL;
  if (table->what->kind == EXCHANGE_SOLUTION) {
    unknown = mark_unknowns(field);
    if (unknown == NULL) return library_error(DVI_NO_MEMORY);
    form.counts = unknown;
  }
  const int code = foresee_cuts(mesh, processes, &form, table);
  free(unknown);
  return code;
}

/* ---- processes that are there ---- */

/* Count what this process receives of the unknowns. */
static bool count_unknowns(const problem *scene, mesh_division *own)
{
  const dvi_field *field = dvi_scene_field(scene->scene);
  char *unknown = mark_unknowns(field);
  const form_of_share form = {
      .degree = dvi_field_degree(field), .counts = unknown, .by_share = true};
  const bool good = unknown != NULL &&
                    stand_in_count(field_mesh(field), &form, ranks_number(), ranks_count(), own);
  free(unknown);
  return good;
}

static int gather_unknowns(const problem *scene, division_table *table)
{
  mesh_division own = {0}, first = {0}, *all = calloc((size_t)ranks_count(), sizeof *all);
  int code = all != NULL && count_unknowns(scene, &own) ? DONE : library_error(DVI_NO_MEMORY);
  code = ranks_agree(code);
  if (code == DONE && !ranks_gather(&own, sizeof own, all)) code = FAILED;
  if (code == DONE) ranks_tell(0, table->what->degree, &first);
  for (int r = 0; r < ranks_count() && all != NULL && code == DONE; r++) {
    all[r].partitioner = first.partitioner; /* a name in this process */
    add_share(table, all + r);
  }
  free(all);
  return code;
}

static int gather_shares(const problem *scene, division_table *table)
{
  mesh_division share;
  if (table->what->kind == EXCHANGE_SOLUTION) return gather_unknowns(scene, table);
  for (int r = 0; r < ranks_count(); r++) {
    ranks_tell(r, table->what->degree, &share);
    add_share(table, &share);
  }
  return DONE;
}

/* ---- all of it ---- */

static bool begin(const problem *scene, const char *method, exchange *what, division_table *table)
{
  *what = exchange_of(scene, method);
  *table = (division_table){.what = what, .rows = table_create(columns)};
  if (table->rows == NULL) complain("out of memory");
  return table->rows != NULL;
}

static int tell(const division_table *table, const dvi_march *march, bool is_foreseen)
{
  char how[HOW_SIZE];
  const char *name = table_text_at(table->rows, 0, 1);
  if (table->what->kind == EXCHANGE_PLANES)
    (void)snprintf(how, sizeof how, "in blocks");
  else
    (void)snprintf(how, sizeof how, "by %s%s", name, is_foreseen ? " in one process" : "");
  print_sum(table, how);
  exchange_tell(table->what, march, table->bytes, table->messages);
  return DONE;
}

int share_tell(const share_request *request, const problem *scene, dvi_march *march)
{
  exchange what;
  division_table table;
  block_cutter *cutter = NULL;
  if (ranks_agree(begin(scene, request->method, &what, &table) ? DONE : FAILED) != DONE) {
    table_destroy(&table.rows);
    return FAILED;
  }
  int code = DONE;
  if (what.kind == EXCHANGE_PLANES) {
    code = ranks_agree(block_cutter_open(request->path, request->settings, &cutter));
    if (code == DONE) code = gather_blocks(request, cutter, &table, &what);
    block_cutter_close(&cutter);
  } else {
    code = gather_shares(scene, &table);
  }
  if (code == DONE) code = tell(&table, march, false);
  if (code == DONE) code = exchange_count(&what, march, table.bytes);
  if (code == DONE) return finish(&table, request->csv);
  table_destroy(&table.rows);
  return code;
}

int share_foresee(const share_request *request, const problem *scene, const dvi_march *march,
                  int processes)
{
  exchange what;
  division_table table;
  block_cutter *cutter = NULL;
  if (!begin(scene, request->method, &what, &table)) return FAILED;
  int code = DONE;
  if (what.kind == EXCHANGE_PLANES) {
    code = block_cutter_open(request->path, request->settings, &cutter);
    if (code == DONE) code = foresee_blocks(request, cutter, processes, &table, &what);
    block_cutter_close(&cutter);
  } else {
    code = foresee_mesh(scene, processes, &table);
  }
  if (code == DONE) code = tell(&table, march, true);
  if (code == DONE) return finish(&table, request->csv);
  table_destroy(&table.rows);
  return code;
}
