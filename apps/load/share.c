#include "load/share.h"

#include <dvi/scene.h>
#include <stdbool.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "cli/command.h"
#include "csv/table.h"
#include "load/field.h"
#include "load/stand_in.h"
#include "module/ranks.h"

enum { RANKS_SHOWN = 16, HOW_SIZE = 64 };

static const char *const implicit[] = {"midpoint", "imex", "galerkin"};

enum { IMPLICIT = sizeof implicit / sizeof *implicit };

/* Tell if shares of a scene's field march by a method. Those of waves have implicit ones. */
static bool marches(const problem *scene, const char *method)
{
  const size_t length = strcspn(method, ":");
  if (strcmp(method, "leapfrog") == 0) return true;
  for (int i = 0; i < IMPLICIT; i++)
    if (strlen(implicit[i]) == length && strncmp(method, implicit[i], length) == 0)
      return dvi_scene_marches(scene->scene, method);
  return false;
}

int share_check(const char *command, const problem *scene, const char *method, bool takes_all)
{
  const bool is_solid = takes_all && scene->scene != NULL &&
                        dvi_scene_elastic(scene->scene) != NULL;
  if (scene->scene == NULL || !(is_solid || dvi_scene_marches(scene->scene, "leapfrog")))
    return usage_error("%s: %d processes share a scene of waves%s Maxwell's field%s on a mesh, and "
                       "%s is none; leave mpirun out",
                       command, ranks_count(), takes_all ? ", of" : " or of",
                       takes_all ? " or of a solid" : "", scene->name);
  if (method == NULL) method = scene->method;
  if (takes_all && !is_solid && method != NULL && strcmp(method, "yee") == 0) return DONE;
  const bool is_field = !is_solid && dvi_scene_marches(scene->scene, "midpoint"),
             is_wave = is_field && dvi_scene_marches(scene->scene, "imex");
  if (method != NULL &&
      (is_solid ? dvi_scene_marches(scene->scene, method) : marches(scene, method)))
    return DONE;
  return usage_error("%s: %d processes share %s alone, not %s; give --method %s, or leave mpirun "
                     "out",
                     command, ranks_count(),
                     is_solid    ? "avi and verlet"
                     : is_wave   ? "leapfrog, midpoint, imex and galerkin"
                     : is_field  ? "leapfrog, midpoint and, on grids, yee"
                     : takes_all ? "leapfrog and yee"
                                 : "leapfrog",
                     method != NULL ? method : "another method", is_solid ? "avi" : "leapfrog");
}

static const table_column columns[] = {
    {"rank", "%.0f"},       {"partitioner", ""},  {"cells", "%.0f"}, {"ghosts", "%.0f"},
    {"neighbours", "%.0f"}, {"messages", "%.0f"}, {"bytes", "%.0f"}, {NULL, NULL},
};

/* The rows of all processes, what they have together, and the least and the most of cells. */
typedef struct division_table {
  result_table *rows;
  int count;
  int64_t cells, messages, bytes;
  int64_t least, most;
} division_table;

static void add_share(division_table *table, const mesh_division *share)
{
  if (table->count == 0 || share->owned < table->least) table->least = share->owned;
  if (share->owned > table->most) table->most = share->owned;
  table->cells += share->owned;
  table->messages += share->messages_in;
  table->bytes += share->bytes_in;
  table_number(table->rows, table->count++);
  table_text(table->rows, share->partitioner);
  table_number(table->rows, (double)share->owned);
  table_number(table->rows, (double)share->ghosts);
  table_number(table->rows, share->neighbours);
  table_number(table->rows, share->messages_in);
  table_number(table->rows, (double)share->bytes_in);
}

static void print_sum(const division_table *table, const char *how, int degree)
{
  const int count = table->count;
  (void)printf(
      "shares: %lld cells among %d processes %s, %lld to %lld each, the most %.1f %% above "
      "the mean\n",
      (long long)table->cells, count, how, (long long)table->least, (long long)table->most,
      100 * ((double)table->most * count / (double)table->cells - 1));
  (void)printf("a step: all processes receive the values of others %s once, %lld bytes in %lld "
               "messages together\n",
               degree == 0 ? "at vertices" : "on edges", (long long)table->bytes,
               (long long)table->messages);
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

int share_tell(const problem *scene, const char *csv)
{
  const int degree = dvi_field_degree(dvi_scene_field(scene->scene));
  division_table table = {.rows = table_create(columns)};
  mesh_division share = {.partitioner = ""};
  char how[HOW_SIZE];
  for (int r = 0; r < ranks_count(); r++) {
    ranks_tell(r, degree, &share);
    add_share(&table, &share);
  }
  (void)snprintf(how, sizeof how, "by %s", share.partitioner);
  print_sum(&table, how, degree);
  return finish(&table, csv);
}

/* ---- processes that are not there ---- */

static dvi_status cut_share(const dvi_mesh *mesh, const int *owner, int degree, int parts,
                            division_table *table)
{
  const dvi_ranks ranks = stand_in(table->count, parts);
  mesh_division division;
  dvi_mesh *share = NULL;
  dvi_status status = dvi_mesh_cut(mesh, owner, &ranks, &share);
  if (status == DVI_OK && !stand_in_count(share, degree, ranks.rank, parts, &division))
    status = DVI_NO_MEMORY;
  if (status == DVI_OK) add_share(table, &division);
  dvi_mesh_destroy(&share);
  return status;
}

int share_foresee(const problem *scene, int processes, const char *csv)
{
  const dvi_field *field = dvi_scene_field(scene->scene);
  const dvi_mesh *mesh = field_mesh(field);
  const int degree = dvi_field_degree(field);
  division_table table = {.rows = table_create(columns)};
  int *owner = malloc((size_t)dvi_mesh_count(mesh, dvi_mesh_dimension(mesh)) * sizeof *owner);
  dvi_status status = owner != NULL ? ranks_partition(mesh, processes, owner) : DVI_NO_MEMORY;
  for (int r = 0; r < processes && status == DVI_OK; r++)
    status = cut_share(mesh, owner, degree, processes, &table);
  free(owner);
  if (status == DVI_OK) {
    char how[HOW_SIZE];
    (void)snprintf(how, sizeof how, "by %s in one process", ranks_partitioner());
    print_sum(&table, how, degree);
    return finish(&table, csv);
  }
  table_destroy(&table.rows);
  return library_error(status);
}
