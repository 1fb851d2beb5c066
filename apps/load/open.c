#include "load/open.h"

#include <dvi/scene.h>
#include <stdio.h>
#include <string.h>
#include <sys/stat.h>
#include <unistd.h>

#include "csv/balance.h"
#include "cli/command.h"
#include "cli/spelling.h"
#include "load/density.h"
#include "load/elastic.h"

enum { MESSAGE_SIZE = 1024, WORD_SIZE = 64, HINT_SIZE = 128 };

static const char *problem_name_at(int k, const void *list)
{
  (void)list;
  return k < problem_count() ? problem_name(k) : NULL;
}

static const char *parameter_name_at(int k, const void *list)
{
  return ((const problem_parameter *)list)[k].name;
}

static const char *method_name_at(int k, const void *list)
{
  (void)list;
  return dvi_method_name(k);
}

/* Marches come first, of a scene with a field. */
static const char *march_name_at(int k, const void *list)
{
  int marches = 0;
  while (dvi_march_method_name(marches) != NULL) marches++;
  return k < marches ? dvi_march_method_name(k) : method_name_at(k - marches, list);
}

/* List the keys of the method whose index is *list. A composition hands keys on to its base, so the
 * keys of all methods follow. */
static const char *key_name_at(int k, const void *list)
{
  const int method = *(const int *)list;
  if (k < dvi_method_key_count(method)) return dvi_method_key_name(method, k);
  k -= dvi_method_key_count(method);
  for (int i = 0; i < dvi_method_count(); i++) {
    if (k < dvi_method_key_count(i)) return dvi_method_key_name(i, k);
    k -= dvi_method_key_count(i);
  }
  return NULL;
}

static bool is_known_word(const char *word, word_at known, const void *list)
{
  const char *candidate;
  for (int k = 0; (candidate = known(k, list)) != NULL; k++)
    if (strcmp(candidate, word) == 0) return true;
  return false;
}

/* Copy the text before any of the stop characters. Returns the text after that character, or NULL
 * at the end. */
static const char *take_word(const char *text, const char *stops, char *word)
{
  const size_t length = strcspn(text, stops);
  (void)snprintf(word, WORD_SIZE, "%.*s", (int)length, text);
  return text[length] != '\0' ? text + length + 1 : NULL;
}

/* Return whether a setting has the form name=value with that name. */
static bool is_value_of(const char *setting, const char *name)
{
  const size_t length = strlen(name);
  return strncmp(setting, name, length) == 0 && setting[length] == '=';
}

static void hint_at_setting(const words *settings, const problem_parameter *parameters, char *hint)
{
  char word[WORD_SIZE];
  hint[0] = '\0';
  for (int i = 0; i < settings->count && hint[0] == '\0'; i++) {
    (void)take_word(settings->word[i], "=", word);
    if (!is_known_word(word, parameter_name_at, parameters))
      (void)suggestion(word, parameter_name_at, parameters, hint, HINT_SIZE);
  }
}

/* Look for a scene whose name is given without its ending. */
static bool scene_beside(const char *name, char *hint)
{
  char path[HINT_SIZE / 2];
  if (snprintf(path, sizeof path, "%s.yaml", name) >= (int)sizeof path || access(path, R_OK) != 0)
    return false;
  (void)snprintf(hint, HINT_SIZE, " (did you mean '%s'?)", path);
  return true;
}

/* Refuse an unknown name. It is most often a slip, but it may be the name of a file. */
static int refuse_problem_name(const char *name)
{
  char hint[HINT_SIZE];
  struct stat there;
  if (stat(name, &there) == 0)
    return usage_error("'%s' is a %s, and no scene: that is a YAML file whose name ends in .yaml "
                       "or .yml; dvi init NAME.yaml writes one",
                       name, S_ISDIR(there.st_mode) ? "folder" : "file of another kind");
  return usage_error(
      "unknown problem '%s'%s; see dvi list problems", name,
      scene_beside(name, hint) ? hint : suggestion(name, problem_name_at, NULL, hint, sizeof hint));
}

void grid_sentence(const problem *scene, bool in_run, char *text, size_t size)
{
  static const struct {
    const char *reason, *what, *remedy;
  } list[] = {{"size", "so large a grid",
               "take fewer cells, or write 'method: leapfrog' in the scene, which makes a mesh"},
              {"flux", "a flux through a box", "leave it out"},
              {"wave", "a plane wave", "take a current"},
              {"cpml", "cpml", "take 'absorbing'"},
              {"bloch", "bloch", "take 'periodic'"}};
  const char *reason = dvi_scene_grid_only(scene->scene);
  size_t i = 0;
  while (strcmp(list[i].reason, reason) != 0) i++;
  if (in_run)
    (void)snprintf(text, size, "%s only 'method: yee' takes, in dvi run; for others %s",
                   list[i].what, list[i].remedy);
  else
    (void)snprintf(text, size, "this command needs a mesh, and with %s there is none: %s",
                   list[i].what, list[i].remedy);
}

int refuse_grid(problem **scene, bool in_run)
{
  char sentence[MESSAGE_SIZE];
  grid_sentence(*scene, in_run, sentence, sizeof sentence);
  const int code = usage_error("%s: %s", (*scene)->name, sentence);
  problem_destroy(scene);
  return code;
}

int open_problem(const char *name, const words *settings, problem **scene)
{
  int code = open_any(name, settings, scene);
  if (code != DONE || *scene == NULL) return code;
  if (dvi_scene_grid_only((*scene)->scene) != NULL) return refuse_grid(scene, false);
  code = scene_complete(*scene);
  if (code != DONE) problem_destroy(scene);
  return code;
}

int open_any(const char *name, const words *settings, problem **scene)
{
  char message[MESSAGE_SIZE] = "";
  char hint[HINT_SIZE];
  *scene = NULL;
  if (scene_is_path(name)) return scene_open(name, settings, scene);
  const int index = problem_find(name);
  if (index < 0) return refuse_problem_name(name);
  const dvi_status status = problem_create(name, settings->count, settings->word, scene, message,
                                           sizeof message);
  if (status == DVI_OK) return DONE;
  if (status != DVI_BAD_OPTION && message[0] == '\0') return library_error(status);
  hint_at_setting(settings, problem_parameters(index), hint);
  complain("%s%s", message, hint);
  return status == DVI_BAD_OPTION ? USAGE : FAILED;
}

int open_text(const char *name, const scene_text *text, const words *settings, problem **scene)
{
  return text->text == NULL ? open_problem(name, settings, scene)
                            : scene_parse(name, text, settings, scene);
}

int open_shaped(const char *name, const words *settings, bool one_point, problem **scene)
{
  const int code = open_problem(name, settings, scene);
  if (code != DONE || !one_point || *scene == NULL) return code;
  if ((*scene)->scene != NULL) {
    problem_destroy(scene);
    return usage_error("--one-point: %s is a scene, and those evaluate batches", name);
  }
  const dvi_status status = problem_one_point(*scene);
  if (status == DVI_OK) return DONE;
  problem_destroy(scene);
  return library_error(status);
}

/* Name a method for an example. */
static const char *example_method(const problem *scene)
{
  if (density_of(scene) != NULL) return scene->terms->one_form != NULL ? "vprk" : "verlet";
  if (elastic_of(scene) != NULL) return "avi";
  return dvi_scene_field(scene->scene) != NULL ? "leapfrog" : "galerkin:degree=4";
}

int open_wish(const char *command, const problem *scene, const char **method)
{
  if (*method == NULL) *method = scene->method;
  if (*method != NULL) return DONE;
  return usage_error("%s: --method is missing, for example --method %s; see dvi list methods",
                     command, example_method(scene));
}

int refuse_noise(const char *command, const problem *scene)
{
  return scene->terms->noise == NULL
             ? DONE
             : usage_error("%s: %s has noise, and its path no error that could be measured; leave "
                           "out its noise, or compare averages of runs with several steps",
                           command, scene->name);
}

const char *start_setting(const problem *scene, const words *settings)
{
  for (int i = 0; i < settings->count; i++)
    for (const problem_parameter *k = scene->parameter; k->name != NULL; k++)
      if (k->start_only && is_value_of(settings->word[i], k->name)) return settings->word[i];
  return NULL;
}

static int method_index(const char *name)
{
  for (int i = 0; i < dvi_method_count(); i++)
    if (strcmp(dvi_method_name(i), name) == 0) return i;
  return -1;
}

/* Hint at a colon if the keys stand after a blank. */
static bool hint_at_colon(const char *method, char *hint)
{
  char name[WORD_SIZE];
  const char *keys = take_word(method, " ", name);
  if (keys == NULL || method_index(name) < 0) return false;
  (void)snprintf(hint, HINT_SIZE, " (did you mean '%s:%.*s'?)", name, (int)strcspn(keys, " "),
                 keys);
  return true;
}

static void hint_at_method(const char *method, word_at known, char *hint)
{
  char word[WORD_SIZE];
  if (hint_at_colon(method, hint)) return;
  const char *rest = take_word(method, ":", word);
  const int index = method_index(word);
  hint[0] = '\0';
  if (index < 0) (void)suggestion(word, known, NULL, hint, HINT_SIZE);
  while (index >= 0 && rest != NULL && hint[0] == '\0') {
    char pair[WORD_SIZE];
    rest = take_word(rest, ",", pair);
    (void)take_word(pair, "=", word);
    if (!is_known_word(word, key_name_at, &index))
      (void)suggestion(word, key_name_at, &index, hint, HINT_SIZE);
  }
}

static int open_one_monitor(const problem *scene, const char *asked, const char *specification,
                            dvi_monitor *monitor)
{
  if (dvi_monitor_read(specification, monitor) != DVI_OK)
    return usage_error("--%s %s: %s", asked, specification, dvi_last_error());
  /* factors exclude any monitor, and the library refuses it */
  if (monitor->kind != DVI_MONITOR_DISTANCE || scene->velocity != NULL) return DONE;
  if (scene->bodies == 0)
    return usage_error("--%s %s: %s has no bodies whose distances could be measured; see arclength "
                       "and acceleration",
                       asked, specification, scene->name);
  const int dimension = scene->nq / scene->bodies;
  if ((monitor->bodies != 0 && monitor->bodies != scene->bodies) ||
      (monitor->dimension != 0 && monitor->dimension != dimension))
    return usage_error("--%s %s: %s is bodies=%d,dimension=%d; leave the keys out", asked,
                       specification, scene->name, scene->bodies, dimension);
  monitor->bodies = scene->bodies;
  return DONE;
}

int refuse_march(const problem *scene, const char *method)
{
  if (!dvi_scene_marches(scene->scene, method)) return DONE;
  return usage_error(
      "%s is a march of a field, for dvi run, check, explain, order, and bench without --scale; "
      "a mechanical method such as %s is wanted here",
      method, elastic_of(scene) != NULL ? "galerkin:degree=2" : "verlet");
}

/* Refuse a method, with its place in the scene or on the command line. */
static int refuse_method(const problem *scene, const char *method)
{
  char hint[HINT_SIZE], sentence[MESSAGE_SIZE], message[2 * MESSAGE_SIZE];
  const bool is_solid = elastic_of(scene) != NULL,
             has_field = is_solid || dvi_scene_field(scene->scene) != NULL;
  if (refuse_march(scene, method) != DONE) return USAGE;
  hint_at_method(method, has_field && !is_solid ? march_name_at : method_name_at, hint);
  const char *error = dvi_last_error(), *list = strstr(error, "; there are galerkin");
  const bool said = strstr(error, "did you mean") != NULL, names = has_field && list != NULL;
  (void)snprintf(sentence, sizeof sentence, "%s: %.*s%s%s", method,
                 names ? (int)(list - error) : (int)strlen(error), error,
                 !names ? ""
                 : is_solid
                     ? "; solids have avi and verlet, and take other mechanical methods, see "
                       "dvi list methods"
                     : "; fields have leapfrog, yee on boxes, bossavit-kettunen, avi and tents, "
                       "and take mechanical methods, see dvi list methods",
                 said ? "" : hint);
  if (scene->scene == NULL || method != scene->method) return usage_error("--method %s", sentence);
  dvi_scene_tell(scene->scene, "method", sentence, message, sizeof message);
  return usage_error("%s", message);
}

/* Return the exit code for the status of an integrator's creation. */
static int open_exit_code(dvi_status status, const problem *scene, const char *method)
{
  if (status == DVI_UNSUPPORTED && elastic_of(scene) != NULL && method != scene->method &&
      strstr(dvi_last_error(), "a fast potential") != NULL)
    return usage_error("--method %s: a solid has a fast part of its energy if the scene says so: "
                       "write 'method: %s' there",
                       method, method);
  if (status != DVI_BAD_OPTION) return status == DVI_OK ? DONE : library_error(status);
  return refuse_method(scene, method);
}

int open_integrator(const problem *scene, const char *method, dvi_integrator **integrator)
{
  return open_exit_code(create_balanced(scene, method, integrator), scene, method);
}

int open_monitor(const problem *scene, const pacing *how, dvi_monitor *monitor)
{
  if (how->transform != NULL)
    return open_one_monitor(scene, "time-transform", how->transform, monitor);
  return how->control != NULL ? open_one_monitor(scene, "step-control", how->control, monitor)
                              : DONE;
}

dvi_status create_paced(const problem *scene, const char *method, const pacing *how,
                        const dvi_monitor *monitor, dvi_integrator **integrator)
{
  dvi_integrator_options options = {
      .size = sizeof options, .method = method, .balances = has_balances(scene)};
  if (how->transform != NULL) options.pacing = DVI_TIME_TRANSFORM;
  if (how->transform == NULL && how->control != NULL) options.pacing = DVI_STEP_CONTROL;
  if (options.pacing != DVI_STEPS_OF_TIME) options.monitor = monitor;
  return dvi_integrator_create_with(scene->system, &options, integrator);
}

int open_paced(const problem *scene, const char *method, const pacing *how,
               dvi_integrator **integrator)
{
  dvi_monitor monitor = {0};
  *integrator = NULL;
  const int code = open_monitor(scene, how, &monitor);
  return code == DONE
             ? open_exit_code(create_paced(scene, method, how, &monitor, integrator), scene, method)
             : code;
}
