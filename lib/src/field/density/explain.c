/* What a field consists of, in words. */
#include <stdarg.h>
#include <stdio.h>

#include "core/status.h"
#include "field/density/density.h"

/* A text with an end. */
typedef struct page {
  char *text;
  size_t size, length;
} page;

DVI_PRINTF(2, 3) static void write(page *p, const char *format, ...)
{
  va_list arguments;
  if (p->length >= p->size) return;
  va_start(arguments, format);
  const int length = vsnprintf(p->text + p->length, p->size - p->length, format, arguments);
  va_end(arguments);
  if (length > 0) p->length += (size_t)length;
}

static void write_coordinates(page *p, const dvi_density *d)
{
  write(p, "%d component%s of %lld functions: %lld coordinates", d->components,
        d->components == 1 ? "" : "s", (long long)d->functions, (long long)d->unknowns);
  const int64_t rest = d->places - d->unknowns - d->moving;
  if (d->moving > 0) write(p, ", %lld values that move", (long long)d->moving);
  int64_t gauges = 0;
  for (int c = 0; c < d->components; c++) gauges += d->gauge[c];
  if (rest > gauges) write(p, ", %lld fixed values", (long long)(rest - gauges));
  if (gauges > 0) write(p, ", %lld constants left out", (long long)gauges);
  write(p, "\n");
}

static void write_mass(page *p, const dvi_density *d)
{
  if (d->mass.rows == 0) return;
  if (d->mass_scalar != 0)
    write(p, "mass: %.6g times the identity\n", d->mass_scalar);
  else
    write(p, "mass: %s, %lld entries\n", d->mass_is_diagonal ? "diagonal" : "sparse",
          (long long)d->mass.start[d->mass.rows]);
  if (d->moving > 0) write(p, "vector potential: of the values that move\n");
}

static void write_hessian(page *p, const dvi__integral *integral, const dvi__pattern *pattern)
{
  if (!integral->has_hessian)
    write(p, "no Hessian");
  else
    write(p, "Hessian of %lld entries", (long long)dvi__integral_entries(integral, pattern));
}

static void write_potentials(page *p, const dvi_density *d)
{
  if (d->quadratic.parts > 0) {
    write(p, "potential 'quadratic': %d part%s, %lld entries", d->quadratic.parts,
          d->quadratic.parts == 1 ? "" : "s", (long long)d->stiffness.start[d->unknowns]);
    if (d->fastest > 0) write(p, ", frequencies up to %.6g", d->fastest);
    write(p, "\n");
  }
  for (int i = 0; i < d->potentials; i++) {
    const dvi__integral *potential = d->potential + i;
    write(p, "potential '%s'%s: ", potential->part[0]->name,
          potential->less != NULL ? ", what varies of quadratic parts" : "");
    write_hessian(p, potential, &potential->patterns.qq);
    if (potential->has_ranges) write(p, ", gradients by ranges that reach %d", potential->reach);
    write(p, "\n");
  }
}

void dvi_density_explain(const dvi_density *density, char *text, size_t size)
{
  page p = {.text = text, .size = size};
  if (text == NULL || size == 0) return;
  text[0] = 0;
  if (density == NULL) return;
  write_coordinates(&p, density);
  write_mass(&p, density);
  if (density->lagrangian.parts > 0) {
    write(&p, "general Lagrangian of %d part%s: ", density->lagrangian.parts,
          density->lagrangian.parts == 1 ? "" : "s");
    write_hessian(&p, &density->lagrangian, &density->lagrangian.patterns.qq);
    write(&p, "\n");
  }
  if (density->one_form.parts > 0)
    write(&p, "one-form: %s\n", density->is_linear ? "constant gradients" : "gradients that vary");
  write_potentials(&p, density);
  for (int i = 0; i < density->translations; i++)
    write(&p, "watched: %s\n", density->translation[i].name);
}
