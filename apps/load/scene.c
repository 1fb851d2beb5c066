/* Problems from scene files. The subcommands treat them as problems of the catalogue. */
#include "load/scene.h"

#include "load/density.h"
#include "load/elastic.h"
#include "load/field.h"

#include <dvi/scene.h>
#include <errno.h>
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/stat.h>
#include <unistd.h>

#include "cli/command.h"
#include "csv/balance.h"
#include "entry.h"
#include "cli/file.h"
#include "module/ranks.h"

/* The message of a scene's error has its line and a caret below the line. */
enum { MESSAGE_SIZE = 2048 };

/* Limit of the characters of a scene, as docs/scenes.md states it. */
enum { TEXT_MAX = 1 << 20 };

enum { KINK_SIZE = 512 };

/* Steps of an order study that begins at the scene's own step. */
enum { STUDY_STEPS = 200 };

bool scene_is_path(const char *name)
{
  const char *dot = strrchr(name, '.');
  return dot != NULL && (strcmp(dot, ".yaml") == 0 || strcmp(dot, ".yml") == 0);
}

static void destroy_scene(problem *made)
{
  dvi_scene *scene = made->scene;
  dvi_scene_destroy(&scene);
}

static void copy_labels(const dvi_scene *scene, problem *made)
{
  for (int i = 0; i < made->nq; i++)
    (void)snprintf(made->coordinate[i], PROBLEM_LABEL_SIZE, "%s", dvi_scene_coordinate(scene, i));
  for (int i = 0; i < made->nv; i++)
    (void)snprintf(made->momentum[i], PROBLEM_LABEL_SIZE, "%s", dvi_scene_momentum(scene, i));
  for (int i = 0; i < made->nv && made->velocity != NULL; i++)
    (void)snprintf(made->velocity[i], PROBLEM_LABEL_SIZE, "%s", dvi_scene_velocity(scene, i));
}

static void copy_start(const dvi_scene *scene, problem *made)
{
  const double *q, *v, *p;
  dvi_scene_start(scene, &q, &v, &p);
  memcpy(made->q, q, (size_t)made->nq * sizeof *q);
  memcpy(made->v, v, (size_t)made->nv * sizeof *v);
  memcpy(made->p, p, (size_t)made->nv * sizeof *p);
}

/* Copy the parameters that can be set, in the catalogue's form. */
static bool copy_parameters(const dvi_scene *scene, problem *made)
{
  const dvi_scene_parameter *p;
  int count = 0;
  while (dvi_scene_parameter_at(scene, count) != NULL) count++;
  problem_parameter *list = problem_allocate(made, (size_t)count + 1, sizeof *list);
  if (list == NULL) return false;
  made->parameter = list;
  for (int i = 0; (p = dvi_scene_parameter_at(scene, i)) != NULL; i++)
    if (p->settable)
      *list++ = (problem_parameter){.name = p->name,
                                    .value = p->value,
                                    .least = -HUGE_VAL,
                                    .most = HUGE_VAL,
                                    .start_only = p->start_only,
                                    .help = "of the scene"};
  return true;
}

static bool describe_scene(dvi_scene *scene, problem *made)
{
  const dvi_scene_plan *plan = dvi_scene_plan_of(scene);
  made->scene = scene;
  made->close = destroy_scene;
  made->terms = dvi_scene_terms(scene);
  made->bodies = dvi_scene_bodies(scene);
  made->summary = plan->title != NULL ? plan->title : "a scene";
  made->method = plan->method;
  made->every = plan->every;
  made->column_count = plan->column_count;
  made->column = plan->column;
  made->h = plan->h;
  made->t_end = plan->t_end;
  made->order_h = plan->h;
  made->order_t_end = STUDY_STEPS * plan->h < plan->t_end ? STUDY_STEPS * plan->h : plan->t_end;
  return copy_parameters(scene, made);
}

/* Tell if a scene is a density without rates. */
static bool is_static(const dvi_scene *scene)
{
  dvi_scene_facts facts;
  dvi_scene_facts_of(scene, &facts);
  return dvi_scene_density(scene) != NULL && strcmp(facts.form, "static") == 0;
}

int scene_complete(problem *made)
{
  dvi_scene *scene = made->scene;
  if (scene == NULL || made->system != NULL) return DONE;
  if (is_static(scene))
    return usage_error("the density of %s has no rates, so that nothing moves; dvi solve finds its "
                       "static state",
                       made->name);
  /* nothing here changes the system */
  made->system = (dvi_system *)dvi_scene_system(scene);
  if (made->system == NULL) return library_error(DVI_BAD_ARGUMENT);
  bool good = problem_room_of(made, dvi_system_nq(made->system), dvi_system_nv(made->system), 1) ==
              DVI_OK;
  if (good && made->terms->factors != NULL)
    good = (made->velocity = problem_names(made, made->nv)) != NULL;
  if (good) {
    copy_labels(scene, made);
    copy_start(scene, made);
    return DONE;
  }
  complain("out of memory");
  return FAILED;
}

/* Return the name of a scene, such as cart for "scenes/cart.yaml". */
static const char *scene_name(problem *made, const char *path)
{
  const char *slash = strrchr(path, '/'), *start = slash != NULL ? slash + 1 : path;
  const size_t length = (size_t)(strrchr(start, '.') - start);
  char *name = problem_allocate(made, length + 1, 1);
  return name != NULL ? memcpy(name, start, length) : NULL;
}

static problem *problem_of_scene(dvi_scene *scene, const char *path)
{
  problem *made = calloc(1, sizeof *made);
  if (made == NULL) {
    dvi_scene_destroy(&scene);
    return NULL;
  }
  if (!describe_scene(scene, made) || (made->name = scene_name(made, path)) == NULL)
    problem_destroy(&made);
  return made;
}

/* Return the exit code of reading a scene, and make the problem. */
static int scene_exit_code(const char *path, dvi_status status, const char *message,
                           dvi_scene *read, problem **scene)
{
  *scene = NULL;
  if (status != DVI_OK) {
    complain("%s", message);
    return status == DVI_NO_MEMORY || status == DVI_IO_ERROR ? FAILED : USAGE;
  }
  *scene = problem_of_scene(read, path);
  if (*scene == NULL) complain("out of memory");
  return *scene != NULL ? DONE : FAILED;
}

/* Make the system of a scene that has been read. */
static int with_system(int code, problem **scene)
{
  if (code == DONE) code = scene_complete(*scene);
  if (code != DONE) problem_destroy(scene);
  return code;
}

/* Recognise a folder, which can be opened but not read. */
static bool is_folder(const char *path)
{
  struct stat there;
  return stat(path, &there) == 0 && S_ISDIR(there.st_mode);
}

static int refuse_folder(const char *path)
{
  return usage_error(
      "'%s' is a folder, and no scene: that is a file; dvi init NAME.yaml writes one", path);
}

int scene_open_share(const char *path, const words *settings, const dvi_scene_division *division,
                     problem **scene)
{
  char message[MESSAGE_SIZE] = "";
  dvi_scene *read = NULL;
  *scene = NULL;
  if (is_folder(path)) return refuse_folder(path);
  const dvi_status status = division != NULL ? dvi_scene_read_share(path, division, settings->count,
                                                                    settings->word, &read, message,
                                                                    sizeof message)
                                             : dvi_scene_read(path, settings->count, settings->word,
                                                              &read, message, sizeof message);
  return scene_exit_code(path, status, message, read, scene);
}

int scene_open(const char *path, const words *settings, problem **scene)
{
  const dvi_scene_division shared = {.size = sizeof shared,
                                     .divide = ranks_divide,
                                     .read = ranks_read,
                                     .grid = ranks_grid()},
                           whole = {.size = sizeof whole, .read = ranks_read_whole};
  return scene_open_share(path, settings, ranks_count() > 1 ? &shared : &whole, scene);
}

int scene_parse(const char *path, const scene_text *text, const words *settings, problem **scene)
{
  char message[MESSAGE_SIZE] = "";
  dvi_scene *read = NULL;
  const dvi_status status = dvi_scene_parse(path, text->text, text->length, settings->count,
                                            settings->word, &read, message, sizeof message);
  return with_system(scene_exit_code(path, status, message, read, scene), scene);
}

/* Read one character more than a scene may have, so that dvi_scene_parse can refuse it. */
int scene_load(const char *path, scene_text *text)
{
  *text = (scene_text){.text = NULL};
  if (is_folder(path)) return refuse_folder(path);
  text->text = malloc(TEXT_MAX + 1);
  if (text->text == NULL) {
    complain("out of memory");
    return FAILED;
  }
  errno = 0;
  FILE *stream = fopen(path, "r");
  if (stream != NULL) text->length = fread(text->text, 1, TEXT_MAX + 1, stream);
  const bool good = stream != NULL && !ferror(stream);
  if (!good) complain("cannot read '%s': %s", path, strerror(errno));
  if (stream != NULL) (void)fclose(stream);
  return good ? DONE : FAILED;
}

int scene_spared(const char *command, const char *path, int count, const named_file *files)
{
  for (int i = 0; i < count && scene_is_path(path); i++) {
    const char *out = files[i].path;
    if (out == NULL || strcmp(out, "-") == 0) continue;
    if (file_same(path, out))
      return usage_error("%s: --%s %s would write over the scene", command, files[i].option, out);
    if (scene_is_path(out) && access(out, F_OK) == 0)
      return usage_error("%s: --%s %s would write over another scene", command, files[i].option,
                         out);
  }
  return DONE;
}

void scene_warn(const char *command, const problem *scene)
{
  char kink[KINK_SIZE];
  if (dvi_scene_kink(scene->scene, kink, sizeof kink) >= 0) complain("%s: %s", command, kink);
  density_warn_growth(command, scene);
}

static void print_operations(const char *of, int operations, long points)
{
  if (operations < 0)
    (void)printf("%s not derived", of);
  else
    (void)printf("%s %d (%ld point%s)", of, operations, points, points == 1 ? "" : "s");
}

static int count_fast_potentials(const dvi_system_terms *terms)
{
  int count = 0;
  for (int k = 0; k < terms->potential_count; k++) count += terms->potentials[k].fast != 0;
  return count;
}

void scene_tell(const problem *scene)
{
  dvi_scene_facts facts;
  if (scene->scene == NULL) return;
  dvi_scene_facts_of(scene->scene, &facts);
  (void)printf("scene: %s", facts.form);
  if (facts.mass != NULL) (void)printf(", mass %s", facts.mass);
  if (facts.quadratic_potentials > 0)
    (void)printf(", quadratic potentials %d", facts.quadratic_potentials);
  if (count_fast_potentials(scene->terms) > 0)
    (void)printf(", fast potentials %d", count_fast_potentials(scene->terms));
  if (dvi_scene_component(scene->scene, 0) != NULL) {
    (void)printf("\n");
    density_tell(scene);
    return;
  }
  if (elastic_of(scene) != NULL) {
    (void)printf("\n");
    elastic_tell(scene);
    return;
  }
  if (dvi_scene_field(scene->scene) != NULL) {
    (void)printf("\n");
    field_tell(dvi_scene_field(scene->scene));
    return;
  }
  (void)printf("; %d kernel%s, %ld element%s, %d nodes\n", facts.kernels,
               facts.kernels == 1 ? "" : "s", facts.elements, facts.elements == 1 ? "" : "s",
               facts.nodes);
  print_operations("operations a point: value", facts.value_operations, facts.value_points);
  print_operations(", gradient", facts.gradient_operations, facts.gradient_points);
  print_operations(", Hessian", facts.hessian_operations, facts.hessian_points);
  if (facts.hessian_operations >= 0)
    (void)printf(", %ld entr%s", facts.hessian_entries, facts.hessian_entries == 1 ? "y" : "ies");
  (void)printf("\n");
  char kept[KINK_SIZE];
  if (dvi_scene_kink(scene->scene, kept, sizeof kept) >= 0) (void)printf("kink: %s\n", kept);
  if (!has_balances(scene) && dvi_scene_invariance(scene->scene, kept, sizeof kept) > 0)
    (void)printf("invariant under %s\n", kept);
}
