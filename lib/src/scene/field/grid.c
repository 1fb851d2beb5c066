/* An electromagnetic field on a grid of boxes, which yee advances without a mesh. */
#include <dvi/yee.h>
#include <math.h>
#include <string.h>

#include "scene/field/boxes.h"
#include "scene/field/maxwell.h"
#include "scene/sections/sections.h"
#include "text/heap.h"

/* What the terms of yee point to, while a march is made. */
typedef struct draft {
  const struct dvi__scene_field *field;
  const struct dvi__scene_maxwell *maxwell;
  dvi_yee_terms terms;
  dvi_yee_current *current;
  dvi_yee_dipole *dipole;
  dvi_yee_wave *wave;
  dvi_yee_probe *probe;
  dvi_yee_flux *flux;
  double *node[3], *E, *B;
} draft;

/* ---- axes ---- */

static double node_at(const dvi_generator_options *grid, int axis, int i)
{
  const double extent = grid->extent[axis] > 0 ? grid->extent[axis] : 1,
               grading = grid->grading[axis] > 0 ? grid->grading[axis] : 1;
  return grid->origin[axis] + extent * pow((double)i / grid->cells[axis], grading);
}

static dvi_status set_nodes(draft *d, int axis)
{
  const dvi_generator_options *grid = &d->field->grid;
  const int cells = grid->cells[axis];
  const double grading = grid->grading[axis];
  dvi_yee_axis *to = d->terms.axis + axis;
  to->cells = cells;
  to->lower = node_at(grid, axis, 0);
  to->upper = node_at(grid, axis, cells);
  if (grading == 0 || grading == 1) return DVI_OK;
  double *node = d->node[axis] = dvi__heap_take((size_t)cells + 1, sizeof *node);
  if (node == NULL) return DVI_NO_MEMORY;
  for (int i = 0; i <= cells; i++) node[i] = node_at(grid, axis, i);
  to->node = node;
  return DVI_OK;
}

static void set_end(const dvi__scene_wall *wall, dvi_yee_axis *axis, int end)
{
  static const dvi_yee_boundary kind[] = {[DVI__WALL_PMC] = DVI_YEE_PMC,
                                          [DVI__WALL_PEC] = DVI_YEE_PEC,
                                          [DVI__WALL_ABSORBING] = DVI_YEE_ABSORBING,
                                          [DVI__WALL_PERIODIC] = DVI_YEE_PERIODIC,
                                          [DVI__WALL_CPML] = DVI_YEE_CPML,
                                          [DVI__WALL_BLOCH] = DVI_YEE_BLOCH};
  axis->end[end].kind = kind[wall->word];
  if (wall->word == DVI__WALL_CPML) axis->end[end].layers = (int)wall->number;
  if (wall->word == DVI__WALL_BLOCH) axis->phase = wall->number;
}

/* Where nothing is said, the wall is a magnetic one, as on a mesh, or the grid repeats itself. */
static void set_walls(draft *d)
{
  const struct dvi__scene_maxwell *m = d->maxwell;
  for (int a = 0; a < d->field->dimension; a++)
    for (int end = 0; end < 2; end++) {
      dvi_yee_axis *axis = d->terms.axis + a;
      axis->end[end].kind = DVI_YEE_PMC;
      for (int i = 0; i < m->walls; i++)
        if (strcmp(m->wall[i].part, "boundary") == 0 ||
            strcmp(m->wall[i].part, dvi__grid_side[2 * a + end]) == 0)
          set_end(m->wall + i, axis, end);
      if (d->field->grid.periodic[a]) axis->end[end].kind = DVI_YEE_PERIODIC;
    }
}

/* ---- components ---- */

/* Give the axis of space of component i of E or B. A lone component lies across the grid. */
static int axis_of(const draft *d, bool is_B, int i)
{
  const int count = is_B ? d->maxwell->B : d->maxwell->E;
  if (count > 1) return i;
  return d->field->dimension == 1 && !is_B ? 1 : 2;
}

static void spread(const draft *d, bool is_B, const double *component, double *vector)
{
  const int count = is_B ? d->maxwell->B : d->maxwell->E;
  for (int i = 0; i < count; i++) vector[axis_of(d, is_B, i)] = component[i];
}

/* ---- media, sources, probes ---- */

static void set_media(draft *d)
{
  for (int i = 0; i < d->maxwell->materials; i++) {
    const dvi__scene_material *material = d->maxwell->material + i;
    dvi_yee_medium *const medium[] = {&d->terms.eps, &d->terms.mu, &d->terms.sigma};
    for (int k = 0; k < DVI__QUANTITIES; k++)
      if (material->place[k] != NULL)
        *medium[k] = (dvi_yee_medium){.at = dvi__place_source, .user = material->place[k]};
  }
}

static void add_dipole(draft *d, const dvi__scene_source *source, int component)
{
  dvi_yee_dipole *dipole = d->dipole + d->terms.dipoles++;
  dvi__signal *signal = source->signal[component];
  *dipole = (dvi_yee_dipole){.signal = signal->is_moment ? dvi__signal_factor : dvi__signal_value,
                             .is_moment = signal->is_moment,
                             .user = signal};
  memcpy(dipole->at, source->point, sizeof dipole->at);
  dipole->along[axis_of(d, false, component)] = 1;
}

static void add_wave(draft *d, const dvi__scene_source *source)
{
  dvi_yee_wave *wave = d->wave + d->terms.waves++;
  *wave = (dvi_yee_wave){.signal = dvi__signal_value, .user = source->signal[0]};
  memcpy(wave->lower, source->lower, sizeof wave->lower);
  memcpy(wave->upper, source->upper, sizeof wave->upper);
  memcpy(wave->direction, source->direction, sizeof wave->direction);
  memcpy(wave->polarization, source->polarization, sizeof wave->polarization);
}

static void set_sources(draft *d)
{
  for (int i = 0; i < d->maxwell->sources; i++) {
    const dvi__scene_source *source = d->maxwell->source + i;
    if (source->wave != NULL) add_wave(d, source);
    if (source->density != NULL)
      d->current[d->terms.currents++] = (dvi_yee_current){.density = dvi__place_vector_value,
                                                          .density_user = source->density,
                                                          .signal = dvi__signal_value,
                                                          .signal_user = source->signal[0]};
    for (int axis = 0; axis < d->maxwell->E && source->at != NULL; axis++)
      add_dipole(d, source, axis);
  }
  d->terms.current = d->current;
  d->terms.dipole = d->dipole;
  d->terms.wave = d->wave;
}

static void set_probes(draft *d)
{
  for (int i = 0; i < d->maxwell->probes; i++) {
    const dvi__scene_probe *from = d->maxwell->probe + i;
    if (from->has_box) {
      dvi_yee_flux *flux = d->flux + d->terms.fluxes++;
      *flux = (dvi_yee_flux){.name = from->name};
      memcpy(flux->lower, from->lower, sizeof flux->lower);
      memcpy(flux->upper, from->upper, sizeof flux->upper);
    } else {
      const bool is_B = *from->of == 'B';
      dvi_yee_probe *probe = d->probe + d->terms.probes++;
      *probe = (dvi_yee_probe){.name = from->name, .form = is_B ? DVI_FORM_B : DVI_FORM_E};
      memcpy(probe->at, from->at, sizeof probe->at);
      spread(d, is_B, from->along, probe->along);
    }
  }
  d->terms.probe = d->probe;
  d->terms.flux = d->flux;
}

/* ---- a march ---- */

static void clear(draft *d)
{
  void *const memory[] = {d->current, d->dipole, d->wave,    d->probe,   d->flux,
                          d->E,       d->B,      d->node[0], d->node[1], d->node[2]};
  for (size_t i = 0; i < sizeof memory / sizeof *memory; i++) dvi__heap_free(memory[i]);
}

static dvi_status set_terms(draft *d, const dvi_march_options *options)
{
  const size_t sources = (size_t)d->maxwell->sources + 1, probes = (size_t)d->maxwell->probes + 1;
  d->terms = (dvi_yee_terms){.size = sizeof d->terms,
                             .axes = d->field->dimension,
                             .degree = d->maxwell->is_scalar ? 0 : 1,
                             .step = options->step,
                             .fraction = options->fraction,
                             .span = options->span,
                             .threads = options->threads,
                             .ranks = d->field->ranks};
  d->current = dvi__heap_take(sources, sizeof *d->current);
  d->dipole = dvi__heap_take(3 * sources, sizeof *d->dipole);
  d->wave = dvi__heap_take(sources, sizeof *d->wave);
  d->probe = dvi__heap_take(probes, sizeof *d->probe);
  d->flux = dvi__heap_take(probes, sizeof *d->flux);
  if (!d->current || !d->dipole || !d->wave || !d->probe || !d->flux) return DVI_NO_MEMORY;
  for (int a = 0; a < d->field->dimension; a++)
    if (set_nodes(d, a) != DVI_OK) return DVI_NO_MEMORY;
  set_walls(d);
  set_media(d);
  set_sources(d);
  set_probes(d);
  return DVI_OK;
}

/* With a phase a march has two numbers for each cell. The imaginary ones, the second half, start at
 * 0. */
static dvi_status integrate(draft *d, const dvi_march *march, dvi_march_form form,
                            dvi__place_vector *vector, double **values)
{
  if (vector == NULL) return DVI_OK;
  *values = dvi__heap_take((size_t)dvi_march_size(march, form), sizeof **values);
  if (*values == NULL) return DVI_NO_MEMORY;
  return dvi_yee_integrate(&d->terms, form, dvi__place_vector_value, vector, *values);
}

dvi_status dvi__grid_march(const dvi_scene *scene, const dvi_march_options *options,
                           dvi_march **march)
{
  draft d = {.field = scene->field, .maxwell = scene->field->maxwell};
  dvi_status status = set_terms(&d, options);
  if (status == DVI_OK) status = dvi_yee_create(&d.terms, march);
  if (status == DVI_OK) status = integrate(&d, *march, DVI_FORM_E, d.maxwell->of_E, &d.E);
  if (status == DVI_OK) status = integrate(&d, *march, DVI_FORM_B, d.maxwell->of_B, &d.B);
  const dvi_march_state state = {.size = sizeof state, .E = d.E, .B = d.B};
  if (status == DVI_OK) status = dvi_march_start(*march, &state);
  if (status != DVI_OK) dvi_march_destroy(march);
  clear(&d);
  return status;
}

/* ---- vectors in the boxes ---- */

dvi_status dvi__grid_vectors(const dvi_scene *scene, const dvi_march *march, dvi_march_form form,
                             double *vector)
{
  draft d = {.field = scene->field, .maxwell = scene->field->maxwell};
  const dvi_march_options none = {.size = sizeof none};
  dvi_status status = dvi__boxes_agree(d.field->ranks, set_terms(&d, &none));
  if (status == DVI_OK)
    status = dvi__boxes_vectors(&d.terms, scene->field->mesh, march, form, vector);
  clear(&d);
  return status;
}

/* ---- the section ---- */

/* Return how many layers absorb at an end of an axis. */
static int layers_at(const struct dvi__scene_maxwell *m, int side)
{
  int layers = 0;
  for (int i = 0; i < m->walls; i++)
    if (m->wall[i].word == DVI__WALL_CPML && (strcmp(m->wall[i].part, "boundary") == 0 ||
                                              strcmp(m->wall[i].part, dvi__grid_side[side]) == 0))
      layers = (int)m->wall[i].number;
  return layers;
}

static bool is_on_grid(dvi_scene *scene, dvi__span span, const char *what, const double *x)
{
  const dvi_generator_options *grid = &scene->field->grid;
  for (int a = 0; a < scene->field->dimension; a++) {
    const double lower = node_at(grid, a, 0), upper = node_at(grid, a, grid->cells[a]);
    if (!(x[a] >= lower && x[a] <= upper))
      return dvi__scene_refuse(scene, span, "%s is at %c = %g, outside of the grid from %g to %g",
                               what, "xyz"[a], x[a], lower, upper);
  }
  return true;
}

static bool check_source(dvi_scene *scene, const dvi__scene_source *source)
{
  if (source->at != NULL) return is_on_grid(scene, source->span, "the dipole", source->point);
  return source->wave == NULL ||
         (is_on_grid(scene, source->span, "a corner of the wave", source->lower) &&
          is_on_grid(scene, source->span, "a corner of the wave", source->upper));
}

/* A rectangle has one coordinate twice. */
static bool check_place(dvi_scene *scene, const dvi__scene_probe *probe)
{
  if (!probe->has_box) return is_on_grid(scene, probe->span, "the probe", probe->at);
  for (int a = 0; a < scene->field->dimension; a++)
    if (probe->lower[a] > probe->upper[a])
      return dvi__scene_refuse(scene, probe->span,
                               "the flux goes from %c = %g to %g, which is not upwards", "xyz"[a],
                               probe -> lower[a], probe -> upper[a]);
  return is_on_grid(scene, probe->span, "a corner of the flux", probe->lower) &&
         is_on_grid(scene, probe->span, "a corner of the flux", probe->upper);
}

/* Refuse a probe in absorbing layers, where the field is none of Maxwell's any more. */
static bool is_clear_of_layers(dvi_scene *scene, const dvi__scene_probe *probe)
{
  const struct dvi__scene_field *f = scene->field;
  for (int a = 0; a < f->dimension; a++) {
    const int cells = f->grid.cells[a], first = layers_at(f->maxwell, 2 * a),
              last = cells - layers_at(f->maxwell, 2 * a + 1);
    if (first >= last) return true; /* yee refuses such layers, too */
    const double lower = node_at(&f->grid, a, first), upper = node_at(&f->grid, a, last),
                 rounding = 1e-9 * (upper - lower),
                 from = probe->has_box ? probe->lower[a] : probe->at[a],
                 to = probe->has_box ? probe->upper[a] : probe->at[a];
    if (from < lower - rounding || to > upper + rounding)
      return dvi__scene_refuse(scene, probe->span,
                               "'%s' lies in absorbing layers, without which %c goes from %g to %g",
                               probe->name, "xyz"[a], lower, upper);
  }
  return true;
}

/* A grid has parts neither for a flux nor for an energy. */
static bool check_probe(dvi_scene *scene, const dvi__scene_probe *probe)
{
  const char *only = scene->field->maxwell->grid_only;
  if (probe->part == NULL) return check_place(scene, probe) && is_clear_of_layers(scene, probe);
  return only != NULL ? dvi__scene_refuse(scene, probe->span,
                                          "a grid has no parts, and with '%s' there is a grid; "
                                          "write 'flux: {from: [..], to: [..]}'",
                                          only)
                      : dvi__scene_refuse(scene, probe->span,
                                          "so large a grid has no parts; write 'flux: {from: [..], "
                                          "to: [..]}', or 'method: leapfrog', which makes a mesh");
}

bool dvi__grid_make(dvi_scene *scene)
{
  const struct dvi__scene_maxwell *m = scene->field->maxwell;
  if (scene->field->kind != DVI_CIRCUMCENTRIC)
    return dvi__scene_refuse(scene, dvi__tree_find(scene->tree, "star")->span,
                             "yee has no star: leave it out, or take leapfrog");
  for (int i = 0; i < m->sources; i++)
    if (!check_source(scene, m->source + i)) return false;
  for (int i = 0; i < m->probes; i++)
    if (!check_probe(scene, m->probe + i)) return false;
  if (m->of_A != NULL)
    return dvi__scene_refuse(scene, dvi__tree_find(scene->tree, "initial")->span,
                             "a grid starts from E and B, not from A");
  scene->form = "separable";
  return true;
}
