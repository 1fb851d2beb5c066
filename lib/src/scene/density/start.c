/* The section initial: the fields and their rates at t = 0, as functions of position. A field that
 * is given as a function of time, too, has the rates of that. */
#include <math.h>
#include <string.h>

#include "scene/density/scene_density.h"
#include "scene/sections/sections.h"
#include "scene/terms/fault.h"

/* Split u' into the field's name and the mark of a rate. */
static const dvi__declared_field *field_of_key(const dvi_scene *scene, const char *text,
                                               bool *is_rate)
{
  char name[256];
  const size_t length = strlen(text);
  *is_rate = length > 1 && text[length - 1] == '\'';
  if (length >= sizeof name) return NULL;
  memcpy(name, text, length + 1);
  if (*is_rate) name[length - 1] = '\0';
  return dvi__field_named(scene, name);
}

static bool refuse_key(dvi_scene *scene, const dvi__tree *key)
{
  enum { FIELDS_MOST = DVI_COMPONENTS_MAX };
  const struct dvi__scene_density *s = scene->density;
  const char *name[FIELDS_MOST];
  char hint[256];
  for (int i = 0; i < s->fields; i++) name[i] = s->field[i].name;
  return dvi__scene_refuse(scene, key->span,
                           "the start has fields and their rates, as u', and no '%s'%s", key->text,
                           dvi__nearest_or_all(key->text, s->fields, name, hint, sizeof hint));
}

/* Tell if a start depends on time, and refuse rates beside it. */
static bool find_motion(dvi_scene *scene, const dvi__tree *section)
{
  struct dvi__scene_density *s = scene->density;
  for (int c = 0; c < s->jets.components; c++)
    s->start_moves = s->start_moves || (s->start[c] != NULL && s->start[c]->has_time);
  for (int i = 0; i < section->count && s->start_moves; i++) {
    bool is_rate;
    const dvi__declared_field *field = field_of_key(scene, section->key[i]->text, &is_rate);
    if (is_rate)
      return dvi__scene_refuse(scene, section->key[i]->span,
                               "a start that depends on t has rates; leave out the key %s'",
                               field->name);
  }
  return true;
}

bool dvi__density_read_start(dvi_scene *scene, const dvi__tree *section)
{
  struct dvi__scene_density *s = scene->density;
  const size_t components = (size_t)s->jets.components;
  if (!dvi__want_mapping(scene, section, "initial")) return false;
  if (s->jets.is_rotation) return dvi__rotations_read_start(scene, section);
  s->start = dvi__arena_take(&scene->arena, 2 * components, sizeof *s->start);
  if (s->start == NULL) return dvi__scene_no_memory(scene);
  s->start_rate = s->start + components;
  for (int i = 0; i < section->count; i++) {
    bool is_rate;
    const dvi__declared_field *field = field_of_key(scene, section->key[i]->text, &is_rate);
    if (field == NULL) return refuse_key(scene, section->key[i]);
    if (!dvi__local_read(scene, section->child[i], is_rate ? 0 : DVI__MENTIONS_T, "a start",
                         field->components, (is_rate ? s->start_rate : s->start) + field->first))
      return false;
  }
  return find_motion(scene, section);
}

typedef struct moment {
  const dvi__local *of;
  double t;
} moment;

static int value_at(int64_t count, const double *x, double *f, void *user)
{
  const moment *at = user;
  return dvi__local_value(at->of, count, at->t, x, f);
}

dvi_status dvi__density_interpolate(const struct dvi__scene_density *s, dvi__local *const *of,
                                    double t, double *U)
{
  dvi_status status = DVI_OK;
  for (int c = 0; c < s->jets.components && of != NULL && status == DVI_OK; c++) {
    moment at = {of[c], t};
    if (of[c] != NULL && of[c]->term != NULL)
      status = dvi_space_interpolate(s->space, value_at, &at, U + c * s->functions);
  }
  return status;
}

int dvi__density_start_rate(const struct dvi__scene_density *s, int component, int64_t count,
                            const double *x, double *rate)
{
  return s->start_moves ? dvi__local_rates(s->start[component], count, 0, x, rate, NULL)
                        : dvi__local_value(s->start_rate[component], count, 0, x, rate);
}

typedef struct start_component {
  const struct dvi__scene_density *s;
  int component;
} start_component;

static int rate_at(int64_t count, const double *x, double *f, void *user)
{
  const start_component *of = user;
  return dvi__density_start_rate(of->s, of->component, count, x, f);
}

dvi_status dvi__density_interpolate_rate(const struct dvi__scene_density *s, double *rate)
{
  dvi_status status = DVI_OK;
  for (int c = 0; c < s->jets.components && s->start != NULL && status == DVI_OK; c++) {
    start_component of = {s, c};
    status = dvi_space_interpolate(s->space, rate_at, &of, rate + c * s->functions);
  }
  return status;
}

/* ---- size ---- */

/* Above this an energy, a sum of squares of values and of slopes, may overflow. */
static const double largest = 1e140;

static int coordinate_at(int64_t count, const double *x, double *f, void *user)
{
  memcpy(f, x + *(const int *)user * count, (size_t)count * sizeof *f);
  return 0;
}

/* Write the place of a function as in " at x = 0.5, y = 1". Those of fourier have none. `room` is
 * [functions]. */
static void write_place(const struct dvi__scene_density *s, int64_t function, double *room,
                        char *text, size_t size)
{
  int64_t count;
  size_t used = 0;
  text[0] = '\0';
  if (dvi_space_boundary(s->space, "boundary", &count) == NULL) return;
  for (int d = 0; d < s->jets.dimension && used < size; d++, used = strlen(text))
    if (dvi_space_interpolate(s->space, coordinate_at, &d, room) == DVI_OK)
      (void)dvi__print(text + used, size - used, "%s%s = %.6g", d == 0 ? " at " : ", ",
                       s->jets.axis[d], room[function]);
}

/* Refuse coefficients that are too large, of the fields or of their rates. `U` is overwritten. */
static bool check_size(dvi_scene *scene, double *U, const char *mark)
{
  const struct dvi__scene_density *s = scene->density;
  char place[128];
  for (int64_t i = 0; i < s->jets.components * s->functions; i++) {
    const double value = U[i];
    if (!(fabs(value) > largest)) continue;
    write_place(s, i % s->functions, U, place, sizeof place);
    return dvi__complain(scene->complaint, DVI_NOT_FINITE,
                         dvi__tree_find(scene->tree, "initial")->span,
                         "the start of %s%s is %.6g%s, and its energy would overflow: %g at most",
                         s->component[i / s->functions], mark, value, place, largest);
  }
  return true;
}

bool dvi__density_start(dvi_scene *scene, double *U, double *rate)
{
  const struct dvi__scene_density *s = scene->density;
  dvi__fault_clear();
  dvi_status status = dvi__density_interpolate(s, s->start, 0, U);
  if (status == DVI_OK) status = dvi__density_interpolate_rate(s, rate);
  if (status != DVI_OK)
    return dvi__density_complain(scene, dvi__tree_find(scene->tree, "initial"), status);
  return check_size(scene, U, "") && check_size(scene, rate, "'");
}
