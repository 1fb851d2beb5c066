#define _XOPEN_SOURCE 700
#include "view/rerun.h"

#include <dirent.h>
#include <dvi/scene.h>
#include <errno.h>
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

#include "cli/command.h"
#include "load/density.h"
#include "load/open.h"
#include "load/open_march.h"
#include "load/scene.h"

enum { NUMBER = 40, ARGUMENTS = 24 };

static int no_memory(void)
{
  complain("out of memory");
  return FAILED;
}

/* ---- files ---- */

static int make_folder(view_files *files)
{
  const char *place = getenv("TMPDIR");
  const int length = snprintf(files->folder, sizeof files->folder, "%s/dvi-view-XXXXXX",
                              place != NULL && place[0] != '\0' ? place : "/tmp");
  if (length >= (int)sizeof files->folder || mkdtemp(files->folder) == NULL) {
    complain("view: cannot make a folder for the run in '%s': %s",
             place != NULL && place[0] != '\0' ? place : "/tmp", strerror(errno));
    files->folder[0] = '\0';
    return FAILED;
  }
  (void)snprintf(files->rows, sizeof files->rows, "%s/rows.csv", files->folder);
  (void)snprintf(files->grids, sizeof files->grids, "%s/field.pvd", files->folder);
  return DONE;
}

void view_files_remove(view_files *files)
{
  DIR *folder = files->folder[0] != '\0' ? opendir(files->folder) : NULL;
  const struct dirent *entry;
  while (folder != NULL && (entry = readdir(folder)) != NULL)
    (void)unlinkat(dirfd(folder), entry->d_name, 0);
  if (folder != NULL) (void)closedir(folder);
  if (files->folder[0] != '\0') (void)rmdir(files->folder);
  files->folder[0] = '\0';
}

/* ---- rows ---- */

/* Return after how many steps of length h a row is due. */
static long interval(const view_rerun *run, double span, double h)
{
  const double steps = fabs(span / h);
  return steps > (double)run->frames && steps < 9e15 ? (long)ceil(steps / (double)run->frames) : 1;
}

static int interval_of_march(const view_rerun *run, const problem *scene, double t_end, long *every)
{
  const dvi_march_options options = {.size = sizeof options,
                                     .method = run->method,
                                     .step = isnan(run->h) ? 0 : run->h,
                                     .span = t_end,
                                     .threads = 1};
  dvi_march *march = NULL;
  dvi_march_facts facts;
  const int code = open_march(scene, &options, &march);
  if (code != DONE) return code;
  dvi_march_facts_of(march, &facts);
  *every = interval(run, t_end, facts.longest);
  dvi_march_destroy(&march);
  return DONE;
}

/* Find the interval of rows. A method that chooses its steps has a row for each. */
static int find_interval(const view_rerun *run, problem *scene, long *every)
{
  const double t_end = isnan(run->t_end) ? scene->t_end : run->t_end;
  const char *method = run->method;
  *every = 1;
  if (scene->scene != NULL && dvi_scene_marches(scene->scene, method))
    return t_end > 0 ? interval_of_march(run, scene, t_end, every) : DONE;
  int code = scene_complete(scene);
  if (code == DONE) code = open_wish("view", scene, &method);
  dvi_integrator *integrator = NULL;
  if (code == DONE) code = open_integrator(scene, method, &integrator);
  if (code != DONE) return code;
  const double h = isnan(run->h) ? scene->h : run->h;
  if (!dvi_integrator_chooses_steps(integrator) && fabs(h) > 0) *every = interval(run, t_end, h);
  dvi_integrator_destroy(&integrator);
  return DONE;
}

/* ---- columns ---- */

static bool is_listed(const char *list, const char *name)
{
  const size_t length = strlen(name);
  for (const char *at = strstr(list, name); at != NULL; at = strstr(at + 1, name))
    if ((at == list || at[-1] == ',') && (at[length] == ',' || at[length] == '\0')) return true;
  return false;
}

/* List the coordinates, the momentum of a single one, the invariants, and what the scene shows. */
static char *list_columns(const problem *scene)
{
  const int invariants = dvi_system_invariant_count(scene->system);
  size_t room = 2;
  for (int i = 0; i < scene->nq; i++) room += strlen(scene->coordinate[i]) + 1;
  for (int i = 0; i < invariants; i++)
    room += strlen(dvi_system_invariant_name(scene->system, i)) + 1;
  for (int i = 0; i < scene->column_count; i++) room += strlen(scene->column[i]) + 1;
  char *list = calloc(room + strlen(scene->momentum[0]), 1), *end = list;
  if (list == NULL) return NULL;
  for (int i = 0; i < scene->nq; i++)
    end += sprintf(end, "%s%s", i > 0 ? "," : "", scene->coordinate[i]);
  char *const others = end;
  if (scene->nq == 1) end += sprintf(end, ",%s", scene->momentum[0]);
  for (int i = 0; i < invariants; i++)
    end += sprintf(end, ",%s", dvi_system_invariant_name(scene->system, i));
  for (int i = 0; i < scene->column_count; i++) {
    bool known = strcmp(scene->column[i], "t") == 0 || is_listed(others, scene->column[i]);
    for (int k = 0; k < scene->nq && !known; k++)
      known = strcmp(scene->coordinate[k], scene->column[i]) == 0;
    if (!known) end += sprintf(end, ",%s", scene->column[i]);
  }
  return list;
}

/* ---- the run ---- */

/* The words of a command line of dvi run. */
typedef struct line {
  int count;
  const char *word[ARGUMENTS + 2 * WORDS_MAX];
} line;

static void add_words(line *l, const char *name, const char *value)
{
  l->word[l->count++] = name;
  l->word[l->count++] = value;
}

static int call_run(const view_rerun *run, const view_files *files, long every, const char *columns)
{
  char h[NUMBER], t_end[NUMBER], interval[NUMBER];
  line l = {.count = 1, .word = {run->name}};
  (void)snprintf(h, sizeof h, "%.17g", run->h);
  (void)snprintf(t_end, sizeof t_end, "%.17g", run->t_end);
  (void)snprintf(interval, sizeof interval, "%ld", every);
  add_words(&l, "--out", files->rows);
  add_words(&l, "--every", interval);
  if (run->method != NULL) add_words(&l, "--method", run->method);
  if (!isnan(run->h)) add_words(&l, "--h", h);
  if (!isnan(run->t_end)) add_words(&l, "--t-end", t_end);
  if (files->has_grids) add_words(&l, "--pvd", files->grids);
  if (columns != NULL) add_words(&l, "--columns", columns);
  for (int i = 0; i < run->settings->count; i++) add_words(&l, "--set", run->settings->word[i]);
  return run_command(l.count, (char **)l.word);
}

int view_run_scene(const view_rerun *run, problem *scene, view_files *files)
{
  long every;
  *files = (view_files){.has_grids = scene->scene != NULL &&
                                     (has_field(scene) || dvi_scene_moving(scene->scene) != NULL ||
                                      dvi_scene_grid_only(scene->scene) != NULL)};
  int code = find_interval(run, scene, &every);
  if (code == DONE) code = make_folder(files);
  if (code != DONE) return code;
  char *columns = files->has_grids ? NULL : list_columns(scene);
  if (columns == NULL && !files->has_grids) return no_memory();
  code = call_run(run, files, every, columns);
  free(columns);
  return code;
}
