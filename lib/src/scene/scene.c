/* The public functions of scenes, for reading, questions, names, and the end. */
#include <errno.h>
#include <limits.h>
#include <math.h>
#include <stdio.h>
#include <string.h>

#include "scene/terms/callbacks.h"
#include "scene/terms/factors.h"
#include "text/heap.h"
#include "scene/sections/sections.h"
#include "scene/start.h"

enum { SIZE_MAX_OF_FILE = 1 << 20 };

/* ---- reading ---- */

/* Return 1 if the time occurs in a function. */
static int term_has_time(const dvi__scene_term *term)
{
  for (int k = 0; k < dvi__function_kernel_count(term->function); k++) {
    const dvi__kernel *kernel = dvi__function_kernel(term->function, k);
    for (int i = 0; i < kernel->input_count; i++)
      if (!kernel->input[i].is_data && kernel->input[i].block == DVI__TIME) return 1;
  }
  return 0;
}

/* Find if any function has the time. An autonomous system has no rates. */
static void find_time(dvi_scene *scene)
{
  if (scene->density != NULL || dvi__is_elastic(scene)) return; /* whose own terms say so */
  int timed = scene->field != NULL && !scene->terms.autonomous;
  for (const dvi__scene_term *term = scene->functions; term != NULL; term = term->next)
    timed = timed || (term->role != DVI__ROLE_AUXILIARY && term_has_time(term));
  scene->terms.autonomous = !timed;
  if (timed) return;
  scene->lagrangian.rate_batch = NULL;
  scene->vector_potential.rate = NULL;
  for (int k = 0; k < scene->terms.holonomic_count; k++) scene->holonomics[k].rate = NULL;
  for (int k = 0; k < scene->terms.contact_count; k++) scene->contacts[k].rate = NULL;
  for (int k = 0; k < scene->terms.potential_count; k++)
    ((dvi_potential *)scene->terms.potentials)[k].rate_batch = NULL;
}

/* Return the section that a system is refused for. Of all terms only damping may be declared where
 * its own section does not refuse it. */
static const dvi__tree *section_to_blame(const dvi_scene *scene, dvi_status status)
{
  return status == DVI_UNSUPPORTED && scene->terms.damping > 0
             ? dvi__tree_find(scene->tree, "damping")
             : dvi__motion_section(scene);
}

static bool scene_make_system(dvi_scene *scene)
{
  find_time(scene);
  scene->terms.dimension = dvi__has_factors(scene) ? 0 : scene->n;
  if (scene->terms.potential_count == 0) scene->terms.potentials = NULL;
  if (scene->terms.symmetry_count == 0) scene->terms.symmetries = NULL;
  if (scene->terms.invariant_count == 0) scene->terms.invariants = NULL;
  const dvi_status status = dvi_system_create(&scene->terms, &scene->system);
  if (status == DVI_BAD_ARGUMENT && dvi__has_factors(scene) && !dvi__inertias_are_of_bodies(scene))
    return false;
  return status == DVI_OK ||
         dvi__complain(scene->complaint, status, section_to_blame(scene, status)->span, "%s",
                       dvi_last_error());
}

static bool show_parameters(dvi_scene *scene)
{
  scene->shown = dvi__arena_take(&scene->arena, (size_t)scene->parameter_count + 1,
                                 sizeof *scene->shown);
  if (scene->shown == NULL) return dvi__scene_no_memory(scene);
  for (int i = 0; i < scene->parameter_count; i++) {
    const dvi__parameter *p = &scene->parameter[i];
    scene->shown[i] = (dvi_scene_parameter){.name = p->name,
                                            .value = p->settable ? p->value[0] : (double)NAN,
                                            .settable = p->settable,
                                            .start_only = p->used_in == DVI__IN_START,
                                            .is_made = p->source != NULL && p->is != NULL};
  }
  return true;
}

static bool list_unused(dvi_scene *scene)
{
  const size_t most = (size_t)scene->parameter_count + (size_t)scene->definition_count;
  scene->unused = dvi__arena_take(&scene->arena, most + 1, sizeof *scene->unused);
  if (scene->unused == NULL) return dvi__scene_no_memory(scene);
  for (int i = 0; i < scene->parameter_count; i++)
    if (scene->parameter[i].used_in == 0)
      scene->unused[scene->unused_count++] = scene->parameter[i].name;
  for (int i = 0; i < scene->definition_count; i++)
    if (!scene->definition[i].used)
      scene->unused[scene->unused_count++] = scene->definition[i].name;
  return true;
}

static void find_bodies(dvi_scene *scene)
{
  const dvi__coordinate *x = scene->coordinate;
  if (scene->coordinate_count == 1 && x->kind == DVI__LINES && x->shape.rank == 1 &&
      (x->q.components == 2 || x->q.components == 3))
    scene->bodies = x->size;
}

static bool read_scene(dvi_scene *scene)
{
  if (!dvi__tree_read(&scene->source, &scene->arena, scene->complaint, &scene->tree)) return false;
  if (!dvi__scene_read_tree(scene)) return false;
  if (!dvi__is_of_field(scene) && (!scene_make_system(scene) || !dvi__scene_complete_start(scene)))
    return false;
  find_bodies(scene);
  return show_parameters(scene) && list_unused(scene);
}

/* Fill in a scene. Its texts are copied. */
static dvi_status scene_fill(dvi_scene *scene, const char *name, const char *text, size_t length,
                             dvi__scene_settings *settings, dvi__complaint *complaint)
{
  const char *name_copy = dvi__arena_text(&scene->arena, name, strlen(name)),
             *copy = dvi__arena_text(&scene->arena, text, length);
  scene->complaint = complaint;
  scene->source = (dvi__source){.name = name_copy != NULL ? name_copy : name,
                                .text = copy != NULL ? copy : text,
                                .size = length};
  complaint->source = &scene->source;
  settings->used = dvi__arena_take(&scene->arena, (size_t)settings->count + 1, 1);
  if (name_copy == NULL || copy == NULL || settings->used == NULL) {
    (void)dvi__complain_of_memory(complaint);
    return complaint->status;
  }
  scene->settings = settings;
  const bool read = read_scene(scene);
  scene->settings = NULL;
  const dvi_status status = complaint->status;
  complaint->source = NULL;
  scene->complaint = NULL;
  return read ? DVI_OK : status != DVI_OK ? status : DVI_NO_MEMORY;
}

static dvi_status write_failure(char *message, size_t size, dvi_status status, const char *name)
{
  if (message != NULL && size > 0)
    (void)snprintf(message, size, "%s: %s", name, dvi_status_meaning(status));
  return status;
}

static bool are_there(int count, const char *const *text)
{
  if (count < 0 || (count > 0 && text == NULL)) return false;
  for (int i = 0; i < count; i++)
    if (text[i] == NULL) return false;
  return true;
}

static dvi_status parse(const char *name, const char *text, size_t length,
                        const dvi_scene_division *division, int setting_count,
                        const char *const *settings, dvi_scene **scene, char *message, size_t size)
{
  if (scene == NULL) return DVI_BAD_ARGUMENT;
  *scene = NULL;
  if (message != NULL && size > 0) message[0] = '\0';
  if (name == NULL || text == NULL || !are_there(setting_count, settings))
    return write_failure(message, size, DVI_BAD_ARGUMENT, "scene");
  dvi_scene *made = dvi__heap_take(1, sizeof *made);
  if (made == NULL || pthread_mutex_init(&made->labels_mutex, NULL) != 0) {
    dvi__heap_free(made);
    return write_failure(message, size, DVI_NO_MEMORY, name);
  }
  made->division = division;
  dvi__scene_settings outer = {.count = setting_count, .text = settings};
  dvi__complaint complaint = {.message = message, .size = message != NULL ? size : 0};
  dvi__ledger *const other = dvi__heap_charge(&made->ledger);
  const dvi_status status = scene_fill(made, name, text, length, &outer, &complaint);
  (void)dvi__heap_charge(other);
  made->division = NULL;
  if (status == DVI_OK) {
    *scene = made;
    return DVI_OK;
  }
  dvi_scene_destroy(&made);
  if (message != NULL && size > 0 && message[0] == '\0')
    return write_failure(message, size, status, name);
  return status;
}

dvi_status dvi_scene_parse(const char *name, const char *text, size_t length, int setting_count,
                           const char *const *settings, dvi_scene **scene, char *message,
                           size_t size)
{
  return parse(name, text, length, NULL, setting_count, settings, scene, message, size);
}

/* Read the text of a file, and one character more than is allowed if it is longer. The caller frees
 * the text. */
static dvi_status read_file(const char *path, char **text, size_t *length)
{
  errno = 0;
  FILE *file = fopen(path, "rb");
  if (file == NULL) return DVI_IO_ERROR;
  *text = dvi__heap_take(SIZE_MAX_OF_FILE + 1, 1);
  *length = *text != NULL ? fread(*text, 1, SIZE_MAX_OF_FILE + 1, file) : 0;
  const int failed = ferror(file);
  (void)fclose(file);
  return *text == NULL ? DVI_NO_MEMORY : failed ? DVI_IO_ERROR : DVI_OK;
}

static dvi_status read_path(const char *path, const dvi_scene_division *division, int setting_count,
                            const char *const *settings, dvi_scene **scene, char *message,
                            size_t size)
{
  char *text = NULL;
  size_t length = 0;
  if (scene == NULL) return DVI_BAD_ARGUMENT;
  *scene = NULL;
  if (path == NULL) return write_failure(message, size, DVI_BAD_ARGUMENT, "scene");
  dvi_status status = read_file(path, &text, &length);
  if (status == DVI_OK)
    status = parse(path, text, length, division, setting_count, settings, scene, message, size);
  else if (status == DVI_IO_ERROR && message != NULL && size > 0)
    (void)snprintf(message, size, "cannot read '%s': %s", path, strerror(errno));
  else
    (void)write_failure(message, size, status, path);
  dvi__heap_free(text);
  return status;
}

dvi_status dvi_scene_read(const char *path, int setting_count, const char *const *settings,
                          dvi_scene **scene, char *message, size_t size)
{
  return read_path(path, NULL, setting_count, settings, scene, message, size);
}

/* Write a sentence about a part of the text, or about all of it. */
static void tell(const dvi_scene *scene, const dvi__tree *about, const char *sentence,
                 char *message, size_t size)
{
  dvi__complaint complaint = {.source = &scene->source, .message = message, .size = size};
  (void)dvi__complain(&complaint, DVI_BAD_FILE, about != NULL ? about->span : DVI__NOWHERE, "%s",
                      sentence);
}

dvi_status dvi_scene_read_share(const char *path, const dvi_scene_division *division,
                                int setting_count, const char *const *settings, dvi_scene **scene,
                                char *message, size_t size)
{
  if (scene != NULL) *scene = NULL;
  if (division == NULL || division->size != sizeof *division ||
      (division->divide == NULL && division->read == NULL))
    return write_failure(message, size, DVI_BAD_ARGUMENT, "scene");
  dvi_status status = read_path(path, division, setting_count, settings, scene, message, size);
  if (status != DVI_OK || division->divide == NULL || dvi__is_share(*scene) ||
      dvi__has_divided_grid(*scene))
    return status;
  tell(*scene, dvi__motion_section(*scene),
       "several processes share fields of waves, Maxwell's and solids on meshes, and this scene "
       "has none: run it in one process",
       message, size);
  dvi_scene_destroy(scene);
  return DVI_UNSUPPORTED;
}

void dvi_scene_destroy(dvi_scene **scene)
{
  if (scene == NULL || *scene == NULL) return;
  dvi_scene *own = *scene;
  *scene = NULL;
  dvi_system_destroy(&own->system);
  dvi__scene_field_clear(own);
  dvi__scene_density_clear(own);
  dvi_joints_destroy(&own->joints);
  for (dvi__scene_term *term = own->functions; term != NULL; term = term->next)
    dvi__function_destroy(&term->function);
  pthread_mutex_destroy(&own->labels_mutex);
  dvi__arena_free(&own->label_arena);
  dvi__arena_free(&own->arena);
  dvi__heap_free(own);
}

/* ---- questions ---- */

/* Not every use of a field needs its mechanical system, whose mass may have to be factored. */
static void make_system_of_field(dvi_scene *scene)
{
  dvi__complaint unheard = {.source = &scene->source};
  dvi__ledger *const other = dvi__heap_charge(&scene->ledger);
  (void)pthread_mutex_lock(&scene->labels_mutex);
  scene->complaint = &unheard;
  if (scene->system == NULL) (void)scene_make_system(scene);
  scene->complaint = NULL;
  (void)pthread_mutex_unlock(&scene->labels_mutex);
  (void)dvi__heap_charge(other);
}

const dvi_system *dvi_scene_system(const dvi_scene *scene)
{
  if (scene == NULL || dvi__is_share(scene)) return NULL;
  if (dvi__is_of_field(scene) && scene->q != NULL) make_system_of_field((dvi_scene *)scene);
  return scene->system;
}

const dvi_system_terms *dvi_scene_terms(const dvi_scene *scene)
{
  return scene == NULL ? NULL : &scene->terms;
}

void dvi_scene_start(const dvi_scene *scene, const double **q, const double **v, const double **p)
{
  *q = scene != NULL ? scene->q : NULL;
  *v = scene != NULL ? scene->v : NULL;
  *p = scene != NULL ? scene->p : NULL;
}

int dvi_scene_bodies(const dvi_scene *scene)
{
  return scene == NULL ? 0 : scene->bodies;
}

const dvi_scene_plan *dvi_scene_plan_of(const dvi_scene *scene)
{
  return scene == NULL ? NULL : &scene->plan;
}

int dvi_scene_file_of(const dvi_scene *scene, int i, dvi_scene_file *file)
{
  const int parts = scene != NULL ? scene->source.part_count : 0;
  if (scene == NULL || i < 0 || i >= (parts > 0 ? parts : 1)) return 0;
  const dvi__source *source = &scene->source;
  const dvi__source_part whole = {.name = source->name, .size = source->size},
                         *part = parts > 0 ? &source->part[i] : &whole;
  *file = (dvi_scene_file){part->name, source->text + part->first, part->size};
  return 1;
}

const dvi_scene_parameter *dvi_scene_parameter_at(const dvi_scene *scene, int i)
{
  return scene == NULL || i < 0 || i >= scene->parameter_count ? NULL : &scene->shown[i];
}

const char *dvi_scene_unused(const dvi_scene *scene, int i)
{
  return scene == NULL || i < 0 || i >= scene->unused_count ? NULL : scene->unused[i];
}

void dvi_scene_tell(const dvi_scene *scene, const char *section, const char *sentence,
                    char *message, size_t size)
{
  if (scene != NULL) tell(scene, dvi__tree_find(scene->tree, section), sentence, message, size);
}

const dvi_scene_event *dvi_scene_event_at(const dvi_scene *scene, int i)
{
  return scene == NULL || i < 0 || i >= scene->event_count ? NULL : &scene->event[i];
}

const dvi_scene_range *dvi_scene_range_at(const dvi_scene *scene, int i)
{
  return scene == NULL || i < 0 || i >= scene->range_count ? NULL : &scene->range[i];
}

const dvi_controls *dvi_scene_controls(const dvi_scene *scene)
{
  return scene == NULL || scene->controls.force == NULL ? NULL : &scene->controls;
}

const char *dvi_scene_control(const dvi_scene *scene, int i)
{
  return scene == NULL || i < 0 || i >= scene->control_count ? NULL : scene->control_name[i];
}

int dvi_scene_end_of(const dvi_scene *scene, dvi_scene_end *end)
{
  if (scene == NULL || scene->final_q == NULL) return 0;
  *end = (dvi_scene_end){scene->final_q, scene->final_p, scene->free_q, scene->free_p};
  return 1;
}

/* Add operations, of which -1 was never derived. */
static void add_operations(int operations, int *all)
{
  if (operations >= 0) *all = operations + (*all > 0 ? *all : 0);
}

static void add_facts(const dvi__scene_term *term, dvi_scene_facts *facts)
{
  dvi__function_counters counters;
  dvi__function_count(term->function, &counters);
  add_operations(counters.value_operations, &facts->value_operations);
  add_operations(counters.gradient_operations, &facts->gradient_operations);
  add_operations(counters.second_operations, &facts->hessian_operations);
  facts->hessian_entries += counters.second_entries;
  facts->value_points += counters.value_points;
  facts->gradient_points += counters.gradient_points;
  facts->hessian_points += counters.second_points;
  for (int k = 0; k < dvi__function_kernel_count(term->function); k++) {
    const dvi__kernel *kernel = dvi__function_kernel(term->function, k);
    facts->kernels++;
    facts->elements += kernel->elements;
    facts->nodes += kernel->root + 1;
  }
}

void dvi_scene_facts_of(const dvi_scene *scene, dvi_scene_facts *facts)
{
  *facts = (dvi_scene_facts){
      .value_operations = -1, .gradient_operations = -1, .hessian_operations = -1};
  if (scene == NULL) return;
  facts->form = scene->form;
  facts->mass = scene->mass;
  for (const dvi__scene_term *term = scene->functions; term != NULL; term = term->next)
    if (term->role == DVI__ROLE_MOTION) add_facts(term, facts);
  for (int k = 0; k < scene->terms.potential_count; k++)
    facts->quadratic_potentials += scene->terms.potentials[k].quadratic;
}
