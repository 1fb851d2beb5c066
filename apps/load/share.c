#include "load/share.h"

#include <dvi/scene.h>
#include <stdbool.h>
#include <stdio.h>
#include <string.h>

#include "cli/command.h"
#include "csv/table.h"
#include "load/field.h"
#include "module/ranks.h"

enum { RANKS_SHOWN = 16 };

int share_check(const char *command, const problem *scene, const char *method, bool takes_solids)
{
  const bool is_solid = takes_solids && scene->scene != NULL &&
                        dvi_scene_elastic(scene->scene) != NULL;
  if (scene->scene == NULL || !(is_solid || dvi_scene_marches(scene->scene, "leapfrog")))
    return usage_error("%s: %d processes share a scene of waves%s Maxwell's field%s on a mesh, and "
                       "%s is none; leave mpirun out",
                       command, ranks_count(), takes_solids ? ", of" : " or of",
                       takes_solids ? " or of a solid" : "", scene->name);
  if (method == NULL) method = scene->method;
  /* shares of waves have midpoint, too */
  const bool is_wave = !is_solid && dvi_scene_marches(scene->scene, "midpoint");
  if (method != NULL &&
      (is_solid ? dvi_scene_marches(scene->scene, method)
                : strcmp(method, "leapfrog") == 0 || (is_wave && strcmp(method, "midpoint") == 0)))
    return DONE;
  return usage_error("%s: %d processes share %s alone, not %s; give --method %s, or leave mpirun "
                     "out",
                     command, ranks_count(),
                     is_solid  ? "avi and verlet"
                     : is_wave ? "leapfrog and midpoint"
                               : "leapfrog",
                     method != NULL ? method : "another method", is_solid ? "avi" : "leapfrog");
}

static const table_column columns[] = {
    {"rank", "%.0f"},       {"partitioner", ""},  {"cells", "%.0f"}, {"ghosts", "%.0f"},
    {"neighbours", "%.0f"}, {"messages", "%.0f"}, {"bytes", "%.0f"}, {NULL, NULL},
};

/* What all processes have together, and the least and the most of cells. */
typedef struct division_sum {
  int64_t cells, ghosts, messages, bytes;
  int64_t least, most;
} division_sum;

static void add_share(division_sum *sum, const mesh_division *share)
{
  if (sum->cells == 0 || share->owned < sum->least) sum->least = share->owned;
  if (share->owned > sum->most) sum->most = share->owned;
  sum->cells += share->owned;
  sum->ghosts += share->ghosts;
  sum->messages += share->messages_in;
  sum->bytes += share->bytes_in;
}

static void add_row(result_table *rows, int rank, const mesh_division *share)
{
  table_number(rows, rank);
  table_text(rows, share->partitioner);
  table_number(rows, (double)share->owned);
  table_number(rows, (double)share->ghosts);
  table_number(rows, share->neighbours);
  table_number(rows, share->messages_in);
  table_number(rows, (double)share->bytes_in);
}

static void print_sum(const division_sum *sum, const char *partitioner, int degree)
{
  const int ranks = ranks_count();
  (void)printf("shares: %lld cells among %d processes by %s, %lld to %lld each, the most %.1f %% "
               "above the mean\n",
               (long long)sum->cells, ranks, partitioner, (long long)sum->least,
               (long long)sum->most, 100 * ((double)sum->most * ranks / (double)sum->cells - 1));
  (void)printf("a step: all processes receive the values of others %s once, %lld bytes in %lld "
               "messages together\n",
               degree == 0 ? "at vertices" : "on edges", (long long)sum->bytes,
               (long long)sum->messages);
}

static int finish(result_table *rows, const char *csv)
{
  bool good = table_good(rows);
  if (good && ranks_count() <= RANKS_SHOWN) table_print(rows, stdout, 0, 0, ranks_count());
  if (good && ranks_count() > RANKS_SHOWN)
    (void)printf("--csv FILE has the shares of all %d processes\n", ranks_count());
  if (good && csv != NULL) good = table_write(rows, csv);
  table_destroy(&rows);
  return good ? DONE : FAILED;
}

int share_tell(const problem *scene, const char *csv)
{
  const int degree = dvi_field_degree(dvi_scene_field(scene->scene));
  result_table *rows = table_create(columns);
  division_sum sum = {0};
  mesh_division share = {.partitioner = ""};
  for (int r = 0; r < ranks_count(); r++) {
    ranks_tell(r, degree, &share);
    add_share(&sum, &share);
    add_row(rows, r, &share);
  }
  print_sum(&sum, share.partitioner, degree);
  return finish(rows, csv);
}
