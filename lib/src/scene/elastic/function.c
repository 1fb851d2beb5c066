/* Functions of a place of a solid, and the names that stand for it. */
#include <string.h>

#include "scene/elastic/scene_elastic.h"
#include "scene/elaborate/elaborate.h"
#include "scene/elaborate/shape.h"
#include "scene/sections/sections.h"
#include "scene/terms/callbacks.h"

enum { BLOCK = 32 };

/* ---- names ---- */

static bool add_name(dvi_scene *scene, const char *name, dvi__span span, int rank, int size)
{
  const int first = scene->n;
  scene->n += size;
  return dvi__add_lines(scene, name, span, rank, first, size);
}

/* An expression in the making. NULL once there was no memory. */
typedef dvi__expression *part;

static part join(dvi_scene *scene, dvi__form form, int count, const part *of)
{
  part made = dvi__arena_take(&scene->arena, 1, sizeof *made);
  part *list = dvi__arena_take(&scene->arena, (size_t)count + 1, sizeof *list);
  bool good = made != NULL && list != NULL;
  for (int k = 0; k < count && good; k++) good = of[k] != NULL;
  if (!good) return NULL;
  if (count > 0) memcpy(list, of, (size_t)count * sizeof *list);
  *made = (dvi__expression){.form = form, .span = DVI__NOWHERE, .count = count, .part = list};
  return made;
}

static part number(dvi_scene *scene, double value)
{
  part made = join(scene, DVI__FORM_NUMBER, 0, NULL);
  if (made != NULL) made->number = value;
  return made;
}

static part two(dvi_scene *scene, dvi__form form, part a, part b)
{
  const part of[] = {a, b};
  return join(scene, form, 2, of);
}

/* The entry F[i,j], counted from 0. In a plane F is that of space with F[3,3] = 1. */
static part entry(dvi_scene *scene, int i, int j)
{
  const int n = scene->field->space;
  if (i >= n || j >= n) return number(scene, i == j);
  part name = join(scene, DVI__FORM_NAME, 0, NULL);
  if (name != NULL) name->name = "F";
  const part of[] = {name, number(scene, i + 1), number(scene, j + 1)};
  return join(scene, DVI__FORM_INDEX, 3, of);
}

static part cofactor(dvi_scene *scene, int i, int j)
{
  const int a = (i + 1) % 3, b = (i + 2) % 3, c = (j + 1) % 3, d = (j + 2) % 3;
  return two(scene, DVI__FORM_SUBTRACT,
             two(scene, DVI__FORM_MULTIPLY, entry(scene, a, c), entry(scene, b, d)),
             two(scene, DVI__FORM_MULTIPLY, entry(scene, a, d), entry(scene, b, c)));
}

static part determinant(dvi_scene *scene)
{
  part sum = number(scene, 0);
  for (int j = 0; j < 3; j++)
    sum = two(scene, DVI__FORM_ADD, sum,
              two(scene, DVI__FORM_MULTIPLY, entry(scene, 0, j), cofactor(scene, 0, j)));
  return sum;
}

/* The sum of the squares of all entries, or of all cofactors. */
static part squares(dvi_scene *scene, part (*of)(dvi_scene *scene, int i, int j))
{
  part sum = number(scene, 0);
  for (int k = 0; k < 9; k++)
    sum = two(scene, DVI__FORM_ADD, sum,
              two(scene, DVI__FORM_MULTIPLY, of(scene, k / 3, k % 3), of(scene, k / 3, k % 3)));
  return sum;
}

/* Define I1 = tr C, I2 = (I1^2 - tr C^2)/2 and J = det F, with C = F^T F. */
static bool define_invariants(dvi_scene *scene, dvi__span span)
{
  static const char *const name[] = {"I1", "I2", "J"};
  const part is[] = {squares(scene, entry), squares(scene, cofactor), determinant(scene)};
  scene->definition = dvi__arena_take(&scene->arena, 3, sizeof *scene->definition);
  if (scene->definition == NULL) return dvi__scene_no_memory(scene);
  for (int i = 0; i < 3; i++) {
    if (is[i] == NULL) return dvi__scene_no_memory(scene);
    scene->definition[scene->definition_count++] = (dvi__definition){.name = name[i],
                                                                     .span = span,
                                                                     .is = is[i],
                                                                     .shape = {0, 1, 1},
                                                                     .mentions = DVI__MENTIONS_Q,
                                                                     .used = 1};
    if (!dvi__names_add(&scene->names, &scene->arena, scene->complaint, name[i], span,
                        DVI__DEFINITION, i))
      return false;
  }
  return true;
}

/* A parameter would take the name of what an energy is made of. */
static bool check_names(dvi_scene *scene)
{
  static const char *const taken[] = {"x", "y", "z", "normal", "F", "I1", "I2", "J"};
  for (int i = 0; i < scene->parameter_count; i++)
    for (size_t k = 0; k < sizeof taken / sizeof *taken; k++)
      if (strcmp(scene->parameter[i].name, taken[k]) == 0)
        return dvi__scene_refuse(scene, scene->parameter[i].span,
                                 "'%s' is a name of a solid's place or strain; choose another name",
                                 taken[k]);
  return true;
}

bool dvi__elastic_name_place(dvi_scene *scene, const dvi__tree *section)
{
  static const char *const axis[] = {"x", "y", "z"};
  const int n = scene->field->space;
  if (!check_names(scene)) return false;
  scene->coordinate = dvi__arena_take(&scene->arena, (size_t)n + 2, sizeof *scene->coordinate);
  scene->zeros = dvi__arena_take(&scene->arena, 2 * (size_t)DVI__SOLID_PLACE, sizeof *scene->zeros);
  if (scene->coordinate == NULL || scene->zeros == NULL) return dvi__scene_no_memory(scene);
  for (int i = 0; i < n && i < DVI__SOLID_AXES; i++)
    if (!add_name(scene, axis[i], section->span, 0, 1)) return false;
  if (!add_name(scene, "normal", section->span, 1, n) ||
      !add_name(scene, "F", section->span, 2, n * n))
    return false;
  scene->coordinate[n + 1].shape = (dvi__shape){2, n, n};
  scene->nv = scene->velocities = scene->n;
  return define_invariants(scene, section->span);
}

/* ---- reading ---- */

/* Refuse an input that such a function may not have, and find if there is the time. */
static bool check_inputs(dvi_scene *scene, const dvi__tree *tree, unsigned may, const char *where,
                         const dvi__kernel *kernel, bool *has_time)
{
  const int n = scene->field->space;
  for (int i = 0; i < kernel->input_count; i++) {
    const dvi__kernel_input *input = kernel->input + i;
    if (input->is_data) continue;
    *has_time = *has_time || input->block == DVI__TIME;
    if (input->block != DVI__COORDINATES) continue;
    const int number = dvi__input_number(input, 0);
    if (number >= 2 * n && (may & DVI__SOLID_ENERGY) == 0)
      return dvi__scene_refuse(scene, tree->span,
                               "%s is no function of F, I1, I2 and J; a stored energy is", where);
    if (number < 2 * n && (may & DVI__SOLID_ENERGY) != 0)
      return dvi__scene_refuse(scene, tree->span,
                               "a stored energy is a function of F, I1, I2 and J alone; parts of "
                               "the mesh may have materials of their own");
    if (number >= n && number < 2 * n && (may & DVI__SOLID_NORMAL) == 0)
      return dvi__scene_refuse(scene, tree->span, "%s has no normal; a traction has one", where);
  }
  return true;
}

static bool make_component(dvi__context *c, dvi__node node, const dvi__tree *tree, unsigned may,
                           dvi__solid_function *f, int i)
{
  dvi_scene *scene = c->scene;
  dvi__scene_term *term;
  dvi__kernels list = {0};
  const bool good = dvi__kernels_add_node(c, node, &list) &&
                    dvi__kernels_function(scene, &list, 0, &term);
  dvi__kernels_free(&list);
  if (!good) return false;
  term->role = DVI__ROLE_AUXILIARY;
  for (int k = 0; k < dvi__function_kernel_count(term->function); k++)
    if (!check_inputs(scene, tree, may, c->where, dvi__function_kernel(term->function, k),
                      &f->has_time))
      return false;
  return dvi__make_potential(scene, "solid", term, f->component + i);
}

bool dvi__solid_function_read(dvi_scene *scene, const dvi__tree *tree, unsigned may, int count,
                              const char *where, dvi__solid_function **function)
{
  const dvi__expression *e;
  dvi__context c;
  dvi__solid_function *f = *function = dvi__arena_take(&scene->arena, 1, sizeof *f);
  const unsigned mentions = DVI__MENTIONS_Q | ((may & DVI__SOLID_TIME) != 0 ? DVI__MENTIONS_T : 0);
  if (f == NULL) return dvi__scene_no_memory(scene);
  f->n = scene->field->space;
  f->count = count;
  if (!dvi__tree_expression(scene, tree, &e) || !dvi__context_make(&c, scene, mentions, where))
    return false;
  const dvi__value value = dvi__elaborate(&c, e);
  bool good = !dvi__failed(value) &&
              dvi__want_shape(&c, tree->span, value.shape, (dvi__shape){count > 1, count, 1});
  for (int i = 0; i < count && good; i++)
    good = make_component(&c, dvi__value_at(value, i), tree, may, f, i);
  dvi__context_free(&c);
  return good;
}

/* ---- evaluation ---- */

static void fill_place(const dvi__solid_function *f, const double *X, const double *normal,
                       double *place)
{
  const size_t axes = (size_t)f->n;
  memset(place, 0, DVI__SOLID_PLACE * sizeof *place);
  memcpy(place, X, axes * sizeof *place);
  if (normal != NULL) memcpy(place + axes, normal, axes * sizeof *place);
}

int dvi__solid_function_value(const dvi__solid_function *f, double t, const double *X,
                              const double *normal, double *value)
{
  double place[DVI__SOLID_PLACE];
  int failed = 0;
  fill_place(f, X, normal, place);
  for (int i = 0; i < f->count && failed == 0; i++)
    failed = f->component[i].value_batch(1, &t, place, value + i, f->component[i].user);
  return failed;
}

int dvi__solid_function_rate(const dvi__solid_function *f, double t, const double *X, double *rate)
{
  double place[DVI__SOLID_PLACE];
  int failed = 0;
  fill_place(f, X, NULL, place);
  for (int i = 0; i < f->count && failed == 0; i++)
    failed = f->component[i].rate_batch(1, &t, place, rate + i, f->component[i].user);
  return failed;
}

/* ---- energies ---- */

/* Where the entry (row, column) stands in the values of the pattern, or -1. */
static int place_of(const dvi_pattern *pattern, int numbers, int row, int column)
{
  if (pattern->start == NULL) return column * numbers + row;
  for (int e = pattern->start[column]; e < pattern->start[column + 1]; e++)
    if (pattern->row[e] == row) return e;
  return -1;
}

/* Put the second derivatives by entries of F, of points from `from` on, row by row of the lower
 * triangle. */
static void put_second(const dvi__solid_function *f, int some, const double *values, int64_t count,
                       int64_t from, double *Hessian)
{
  const int entries = f->n * f->n, first = 2 * f->n, numbers = first + entries;
  for (int a = 0, k = 0; a < entries; a++)
    for (int b = 0; b <= a; b++, k++) {
      const int place = place_of(&f->component[0].qq, numbers, first + a, first + b);
      double *to = Hessian + k * count + from;
      if (place < 0)
        memset(to, 0, (size_t)some * sizeof *to);
      else
        memcpy(to, values + (ptrdiff_t)place * some, (size_t)some * sizeof *to);
    }
}

/* Evaluate so few points that there is room for them. */
static int energy_of_block(const dvi__solid_function *f, int some, int64_t count, int64_t from,
                           const double *F, double *W, double *P, double *Hessian)
{
  static const double time[BLOCK];
  const int entries = f->n * f->n, first = 2 * f->n;
  const dvi_potential *of = f->component;
  double place[DVI__SOLID_PLACE * BLOCK] = {0};
  int failed = 0;
  for (int e = 0; e < entries; e++)
    memcpy(place + (ptrdiff_t)(first + e) * some, F + e * count + from,
           (size_t)some * sizeof *place);
  if (W != NULL) failed = of->value_batch(some, time, place, W + from, of->user);
  if (P != NULL && failed == 0) {
    double slope[DVI__SOLID_PLACE * BLOCK];
    failed = of->gradient_batch(some, time, place, slope, of->user);
    for (int e = 0; e < entries && failed == 0; e++)
      memcpy(P + e * count + from, slope + (ptrdiff_t)(first + e) * some, (size_t)some * sizeof *P);
  }
  if (Hessian != NULL && failed == 0) {
    double second[DVI__SOLID_PLACE * DVI__SOLID_PLACE * BLOCK];
    failed = of->hessian_batch(some, time, place, second, of->user);
    if (failed == 0) put_second(f, some, second, count, from, Hessian);
  }
  return failed;
}

int dvi__solid_energy(int64_t count, const double *F, double *W, double *P, double *Hessian,
                      void *user)
{
  const dvi__solid_function *f = user;
  int failed = 0;
  for (int64_t from = 0; from < count && failed == 0; from += BLOCK)
    failed = energy_of_block(f, (int)(count - from < BLOCK ? count - from : BLOCK), count, from, F,
                             W, P, Hessian);
  return failed;
}
