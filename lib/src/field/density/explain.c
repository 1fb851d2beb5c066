/* What a field consists of, in words. */
#include <math.h>

#include "field/density/density.h"
#include "field/space/kind.h"

static void write_coordinates(dvi__note *p, const dvi_density *d)
{
  dvi__note_add(p, "%d component%s of %lld functions: %lld coordinates", d->components,
                d->components == 1 ? "" : "s", (long long)d->functions, (long long)d->unknowns);
  const int64_t rest = d->places - d->unknowns - d->moving;
  if (d->moving > 0)
    dvi__note_add(p, ", %lld value%s", (long long)d->moving,
                  d->moving == 1 ? " that moves" : "s that move");
  int64_t gauges = 0;
  for (int c = 0; c < d->components; c++) gauges += d->gauge[c];
  if (rest > gauges)
    dvi__note_add(p, ", %lld fixed value%s", (long long)(rest - gauges),
                  rest - gauges == 1 ? "" : "s");
  if (gauges > 0)
    dvi__note_add(p, ", %lld constant%s left out", (long long)gauges, gauges == 1 ? "" : "s");
  dvi__note_add(p, "\n");
}

static void write_mass(dvi__note *p, const dvi_density *d)
{
  if (d->mass.rows == 0) return;
  if (d->mass_scalar != 0)
    dvi__note_add(p, "mass: %.6g times the identity\n", d->mass_scalar);
  else
    dvi__note_add(p, "mass: %s, %lld entries\n", d->mass_is_diagonal ? "diagonal" : "sparse",
                  (long long)d->mass.start[d->mass.rows]);
  if (d->terms.vector_potential != NULL)
    dvi__note_add(p, "vector potential: of the values that move\n");
}

static void write_hessian(dvi__note *p, const dvi__integral *integral, const dvi__pattern *pattern)
{
  if (!integral->has_hessian)
    dvi__note_add(p, "no Hessian");
  else
    dvi__note_add(p, "Hessian of %lld entries",
                  (long long)dvi__integral_entries(integral, pattern));
}

static void write_growth(dvi__note *p, const dvi_density *d)
{
  double least = 0;
  if (dvi_density_least(d, &least) == DVI_OK && least < 0)
    dvi__note_add(p,
                  "potential 'quadratic' is not bounded from below: its least omega^2 is %.6g, "
                  "whose mode grows as exp(%.6g t)\n",
                  least, sqrt(-least));
}

static void write_potentials(dvi__note *p, const dvi_density *d)
{
  if (d->quadratic.parts > 0) {
    dvi__note_add(p, "potential 'quadratic': %d part%s, %lld entries", d->quadratic.parts,
                  d->quadratic.parts == 1 ? "" : "s", (long long)d->stiffness.start[d->unknowns]);
    if (d->fastest > 0) dvi__note_add(p, ", frequencies up to %.6g", d->fastest);
    dvi__note_add(p, "\n");
    write_growth(p, d);
  }
  for (int i = 0; i < d->potentials; i++) {
    const dvi__integral *potential = d->potential + i;
    dvi__note_add(p, "potential '%s'%s: ", potential->part[0]->name,
                  potential->less != NULL ? ", what varies of quadratic parts" : "");
    write_hessian(p, potential, &potential->patterns.qq);
    if (potential->has_ranges)
      dvi__note_add(p, ", gradients by ranges that reach %d", potential->reach);
    dvi__note_add(p, "\n");
  }
}

void dvi_density_explain(const dvi_density *density, char *text, size_t size)
{
  dvi__note p = {.text = text, .size = size};
  if (text == NULL || size == 0) return;
  text[0] = 0;
  if (density == NULL) return;
  write_coordinates(&p, density);
  write_mass(&p, density);
  if (density->lagrangian.parts > 0) {
    dvi__note_add(&p, "general Lagrangian of %d part%s: ", density->lagrangian.parts,
                  density->lagrangian.parts == 1 ? "" : "s");
    write_hessian(&p, &density->lagrangian, &density->lagrangian.patterns.qq);
    dvi__note_add(&p, "\n");
  }
  if (density->one_form.parts > 0)
    dvi__note_add(&p, "one-form: %s\n",
                  density->is_linear ? "constant gradients" : "gradients that vary");
  write_potentials(&p, density);
  for (int i = 0; i < density->translations; i++)
    dvi__note_add(&p, "watched: %s\n", density->translation[i].name);
}
