/* Schroedinger's equation of a scene for its own methods (dvi/schroedinger.h): marches that keep
 * the norm, stationary states and ground states.
 *
 * The equation has no data on the boundary. A scene with others has them in its density alone. */
#include <dvi/scene.h>
#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "scene/density/scene_density.h"
#include "scene/sections/sections.h"
#include "text/heap.h"

static int potential(int64_t count, double t, const double *x, double *V, void *user)
{
  return dvi__local_value(((const struct dvi__equation *)user)->potential, count, t, x, V);
}

static int interaction(int64_t count, const double *x, double *beta, void *user)
{
  return dvi__local_value(((const struct dvi__equation *)user)->interaction, count, 0, x, beta);
}

/* ---- what there is ---- */

const char *dvi__equation_refused(const dvi_scene *scene, const char **section)
{
  const struct dvi__scene_density *s = scene->density;
  for (int i = 0; i < s->conditions; i++) {
    const dvi_density_condition *c = s->condition + i;
    if (c->datum == NULL && !(c->robin > 0) && !(c->robin < 0)) continue;
    *section = "boundary";
    return "steps and states of Schroedinger's equation are for psi = 0 on the boundary, or for no "
           "flux through it; other conditions go with methods of one-forms, such as vprk";
  }
  if (!s->equation->interaction->has_time) return NULL;
  *section = "schroedinger";
  return "steps of Schroedinger's equation take an interaction that does not depend on time; such "
         "a one goes with methods of one-forms, such as vprk";
}

/* List the parts of the boundary where psi is fixed. */
static const char *list_fixed(dvi_scene *scene)
{
  const struct dvi__scene_density *s = scene->density;
  size_t size = sizeof "none";
  for (int i = 0; i < s->conditions; i++) size += strlen(s->condition[i].part) + 1;
  char *list = dvi__arena_take(&scene->arena, size, 1);
  if (list == NULL) return NULL;
  for (int i = 0; i < s->conditions; i++) {
    if (s->condition[i].kind != DVI_FIXED || s->condition[i].component != 0) continue;
    const size_t length = strlen(list);
    (void)dvi__print(list + length, size - length, "%s%s", length > 0 ? "," : "",
                     s->condition[i].part);
  }
  if (list[0] == '\0') (void)dvi__print(list, size, "none");
  return list;
}

static void make(dvi_scene *scene)
{
  const struct dvi__scene_density *s = scene->density;
  struct dvi__equation *e = s->equation;
  dvi_schroedinger_terms terms = {.size = sizeof terms,
                                  .space = s->space,
                                  .hbar = e->hbar,
                                  .mass = e->mass,
                                  .potential = potential,
                                  .depends_on_time = e->potential->has_time,
                                  .interaction_at = e->interaction->term != NULL ? interaction
                                                                                 : NULL,
                                  .user = e,
                                  .fixed = list_fixed(scene),
                                  .radial = e->radial};
  if (terms.fixed != NULL) (void)dvi_schroedinger_create(&terms, &e->made);
}

const dvi_schroedinger *dvi_scene_schroedinger(const dvi_scene *scene)
{
  const char *unread;
  if (scene == NULL || scene->density == NULL || scene->density->equation == NULL ||
      scene->density->moving != NULL)
    return NULL;
  dvi_scene *own = (dvi_scene *)scene;
  struct dvi__equation *e = own->density->equation;
  if (dvi__equation_refused(scene, &unread) != NULL) return NULL;
  dvi__ledger *const other = dvi__heap_charge(&own->ledger);
  (void)pthread_mutex_lock(&own->labels_mutex);
  if (e->made == NULL) make(own);
  (void)pthread_mutex_unlock(&own->labels_mutex);
  (void)dvi__heap_charge(other);
  return e->made;
}

bool dvi__equation_marches(const dvi_scene *scene, const char *method)
{
  const size_t length = strcspn(method, ":");
  const char *name;
  if (scene->density->equation == NULL) return false;
  for (int i = 0; (name = dvi_schroedinger_method_name(i)) != NULL; i++)
    if (strlen(name) == length && strncmp(name, method, length) == 0) return true;
  return false;
}

int dvi__equation_order(const char *method)
{
  const char *stages = strstr(method, "stages="), *order = strstr(method, "order=");
  if (order != NULL) return (int)strtol(order + strlen("order="), NULL, 10);
  if (stages != NULL) return 2 * (int)strtol(stages + strlen("stages="), NULL, 10);
  return strncmp(method, "gauss", strlen("gauss")) == 0 ? 4 : 2;
}

/* ---- marches and states ---- */

static dvi_status create(const dvi_scene *scene, const dvi_march_options *options,
                         dvi_march **march)
{
  const dvi_schroedinger *equation = dvi_scene_schroedinger(scene);
  const dvi_schroedinger_march_options own = {
      .size = sizeof own, .method = options->method, .step = options->step};
  return equation == NULL ? DVI_UNSUPPORTED : dvi_schroedinger_march(equation, &own, march);
}

dvi_status dvi__equation_march(const dvi_scene *scene, const dvi_march_options *options,
                               dvi_march **march)
{
  const struct dvi__scene_density *s = scene->density;
  double *psi = dvi__heap_take(2 * (size_t)s->functions, sizeof *psi);
  const dvi_march_state start = {.size = sizeof start, .A = psi};
  dvi_status status = psi == NULL ? DVI_NO_MEMORY : create(scene, options, march);
  if (status == DVI_OK) status = dvi__density_interpolate(s, s->start, 0, psi);
  if (status == DVI_OK) status = dvi_march_start(*march, &start);
  if (status != DVI_OK) dvi_march_destroy(march);
  dvi__heap_free(psi);
  return status;
}

/* Follow psi, which is scaled to norm 1 before, and give what its norm has changed. */
static dvi_status follow(dvi_march *march, double step, int steps, double *psi, double *change)
{
  const dvi_march_state start = {.size = sizeof start, .A = psi};
  double before = 0, after = 0;
  dvi_status status = dvi_march_start(march, &start);
  if (status == DVI_OK) status = dvi_march_observe(march, 0, &before);
  for (int64_t i = 0; i < dvi_march_size(march, DVI_FORM_A); i++) psi[i] /= sqrt(before);
  if (status == DVI_OK) status = dvi_march_start(march, &start);
  if (status == DVI_OK) status = dvi_march_observe(march, 0, &before);
  if (status == DVI_OK) status = dvi_march_advance(march, steps * step);
  if (status == DVI_OK) status = dvi_march_observe(march, 0, &after);
  *change = fabs(after - before);
  return status;
}

dvi_status dvi__equation_laws(const dvi_scene *scene, const dvi_march_options *options, int steps,
                              dvi_law *law, int *count)
{
  const int64_t size = 2 * scene->density->functions;
  dvi_march *march = NULL;
  double change = 0;
  double *psi = dvi__heap_take((size_t)size, sizeof *psi);
  for (int64_t i = 0; i < size && psi != NULL; i++)
    psi[i] = sin(1 + 12.9898 * (double)(i + 1) * (double)(i + 2)); /* looks random */
  dvi_status status = psi == NULL ? DVI_NO_MEMORY : create(scene, options, &march);
  if (status == DVI_OK) status = follow(march, options->step, steps, psi, &change);
  if (status == DVI_OK) {
    law[0] = (dvi_law){.name = "norm", .error = change, .is_exact = 1};
    *count = 1;
  }
  dvi_march_destroy(&march);
  dvi__heap_free(psi);
  return status;
}

double dvi_scene_ground_norm(const dvi_scene *scene)
{
  return scene != NULL && scene->density != NULL ? scene->density->ground : 0;
}

/* ---- the section solve ---- */

bool dvi__equation_check_ground(dvi_scene *scene)
{
  const char *section = NULL,
             *reason = scene->density->ground > 0 ? dvi__equation_refused(scene, &section) : NULL;
  return reason == NULL ||
         dvi__scene_refuse(scene, dvi__tree_find(scene->tree, section)->span, "%s", reason);
}

bool dvi__density_read_solve(dvi_scene *scene, const dvi__tree *section)
{
  static const char *const known[] = {"ground"};
  struct dvi__scene_density *s = scene->density;
  const bool is_word = section->kind == DVI__SCALAR && strcmp(section->text, "ground") == 0;
  if (s->equation == NULL && dvi__tree_find(scene->tree, "schroedinger") == NULL)
    return dvi__scene_refuse(scene, section->span,
                             "'solve' asks for a ground state, which is of 'schroedinger'; dvi "
                             "solve finds the static states of densities without being told");
  s->ground = 1;
  if (is_word) return true;
  if (section->kind != DVI__MAPPING || section->count != 1)
    return dvi__scene_refuse(scene, section->span,
                             "'solve' is 'ground', or '{ground: NORM}' for a norm other than 1");
  return dvi__want_keys(scene, section, "solve", 1, known) &&
         dvi__tree_number(scene, section->child[0], "the norm", &s->ground) &&
         (s->ground > 0 || dvi__scene_refuse(scene, section->child[0]->span,
                                             "the norm must be positive, and is %.17g", s->ground));
}
