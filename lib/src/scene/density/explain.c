/* What was found and built, as lines of text. */
#include <dvi/number.h>
#include <stdarg.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "scene/density/scene_density.h"
#include "scene/sections/sections.h"

/* A text that is cut off at its size. */
typedef struct note {
  char *text;
  size_t size;
} note;

static void add(note *to, const char *format, ...) DVI__TEXT_PRINTF(2, 3);
static void add(note *to, const char *format, ...)
{
  const size_t used = strlen(to->text);
  va_list arguments;
  va_start(arguments, format);
  (void)dvi_number_vprint(to->text + used, to->size - used, format, arguments);
  va_end(arguments);
}

static void add_fields(const struct dvi__scene_density *s, note *to)
{
  add(to, "fields:");
  for (int i = 0; i < s->fields; i++) {
    const dvi__declared_field *field = s->field + i;
    add(to, "%s %s ", i > 0 ? "," : "", field->name);
    if (field->is_complex || !field->is_vector)
      add(to, "%s", field->is_complex ? "complex" : field->is_rotation ? "rotation" : "scalar");
    else
      add(to, "vector(%d)", field->components);
  }
  add(to, "\n");
}

static void add_parts(const struct dvi__scene_density *s, note *to)
{
  static const char *const name[] = {"kinetic", "quadratic", "potential", "one-form", "general"};
  int parts = 0;
  add(to, "density:");
  for (int class = 0; class < DVI__DENSITY_CLASSES; class ++) {
    if (s->part[class] == NULL) continue;
    add(to, "%s %s of %d summand%s", parts++ > 0 ? "," : "", name[class], s->summands[class],
        s->summands[class] == 1 ? "" : "s");
  }
  add(to, s->degree >= 0 ? "; a polynomial of degree %d in the fields\n" : "\n", s->degree);
}

/* Say how well the momentum along an axis can be kept. Sums of products of p functions to mode K
 * are exact with more than p K points, and the default of a space is right for p = 4. */
static void add_momentum(const struct dvi__scene_density *s, int d, note *to)
{
  const long modes = dvi__axis_option(s->axis[d].kind, "modes=", 0),
             points = dvi__axis_option(s->axis[d].kind, "points=", 0),
             needed = s->degree * modes + 1;
  add(to, "momentum along %s: ", s->jets.axis[d]);
  if (s->degree < 0)
    add(to, "kept to the error of the quadrature, for the density is no polynomial\n");
  else if (points == 0 || points >= needed)
    add(to, "kept to roundoff, for the points are enough for a density of degree %d\n", s->degree);
  else
    add(to, "not kept, for a density of degree %d with %ld modes needs points=%ld, not %ld\n",
        s->degree, modes, needed, points);
}

void dvi_scene_density_explain(const dvi_scene *scene, char *text, size_t size)
{
  note to = {text, size};
  if (text == NULL || size == 0) return;
  text[0] = '\0';
  if (scene == NULL || scene->density == NULL) return;
  const struct dvi__scene_density *s = scene->density;
  add_fields(s, &to);
  if (s->moving != NULL) dvi__moving_explain(scene, text + strlen(text), size - strlen(text));
  if (s->rotations != NULL) dvi__rotations_explain(scene, text + strlen(text), size - strlen(text));
  if (s->density == NULL) return;
  add_parts(s, &to);
  dvi_space_explain(s->space, text + strlen(text), size - strlen(text));
  if (text[strlen(text) - 1] != '\n') add(&to, "\n");
  dvi_density_explain(s->density, text + strlen(text), size - strlen(text));
  if (text[strlen(text) - 1] != '\n') add(&to, "\n");
  for (int d = 0; d < s->jets.dimension && s->mesh == NULL; d++)
    if ((s->placed_axes >> d & 1) == 0 &&
        strncmp(s->axis[d].kind, "fourier", strlen("fourier")) == 0)
      add_momentum(s, d, &to);
}

const dvi_density *dvi_scene_density(const dvi_scene *scene)
{
  return scene == NULL || scene->density == NULL ? NULL : scene->density->density;
}

const char *dvi_scene_component(const dvi_scene *scene, int i)
{
  return scene == NULL || scene->density == NULL || i < 0 || i >= dvi__components(scene)
             ? NULL
             : scene->density->component[i];
}
