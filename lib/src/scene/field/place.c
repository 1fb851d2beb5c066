/* Functions of a place: of its position, of the normal there, of the value of the field. */
#include <string.h>

#include "scene/field/scene_field.h"
#include "scene/sections/sections.h"
#include "scene/terms/callbacks.h"

enum { BLOCK = 32 };

/* ---- reading ---- */

/* Refuse an input that such a function may not have. */
static bool inputs_are_right(dvi_scene *scene, const dvi__tree *tree, unsigned may,
                             const char *where, const dvi__kernel *kernel)
{
  const int space = scene->field->space;
  for (int i = 0; i < kernel->input_count; i++) {
    if (kernel->input[i].is_data || kernel->input[i].block != DVI__COORDINATES) continue;
    const int number = dvi__input_number(&kernel->input[i], 0);
    if (number == 2 * space && (may & DVI__OF_VALUE) == 0)
      return dvi__scene_refuse(scene, tree->span, "%s is a function of position, without u", where);
    if (number >= space && number < 2 * space && (may & DVI__OF_NORMAL) == 0)
      return dvi__scene_refuse(scene, tree->span, "%s has no normal; a flux has one", where);
  }
  return true;
}

static bool read_function(dvi_scene *scene, const dvi__tree *tree, unsigned may, const char *where,
                          dvi__scene_term **term)
{
  const dvi__expression *e;
  dvi__kernels list = {0};
  const bool good = dvi__tree_expression(scene, tree, &e) &&
                    dvi__kernels_add(scene, DVI__MENTIONS_Q, where, e, 0, &list) &&
                    dvi__kernels_function(scene, &list, 0, term);
  dvi__kernels_free(&list);
  for (int k = 0; good && k < dvi__function_kernel_count((*term)->function); k++)
    if (!inputs_are_right(scene, tree, may, where, dvi__function_kernel((*term)->function, k)))
      return false;
  if (good) (*term)->role = DVI__ROLE_AUXILIARY;
  return good;
}

bool dvi__place_read(dvi_scene *scene, const dvi__tree *tree, unsigned may, const char *where,
                     dvi__place **place)
{
  *place = dvi__arena_take(&scene->arena, 1, sizeof **place);
  if (*place == NULL) return dvi__scene_no_memory(scene);
  (*place)->space = scene->field->space;
  return read_function(scene, tree, may, where, &(*place)->term);
}

/* ---- evaluation ---- */

int dvi__place_value(const dvi__place *place, const double *x, const double *normal, double *value)
{
  double q[DVI__PLACE_NUMBERS] = {0};
  memcpy(q, x, (size_t)place->space * sizeof *q);
  if (normal != NULL) memcpy(q + place->space, normal, (size_t)place->space * sizeof *q);
  return dvi__term_value(0, q, NULL, value, place->term);
}

int dvi__place_of_value(const dvi__place *place, const double *x, double u, double *value)
{
  double q[DVI__PLACE_NUMBERS] = {0};
  memcpy(q, x, (size_t)place->space * sizeof *q);
  q[2 * place->space] = u;
  return dvi__term_value(0, q, NULL, value, place->term);
}

int dvi__place_datum(const double *x, const double *normal, double *datum, void *user)
{
  return dvi__place_value(user, x, normal, datum);
}

int dvi__place_source(const double *x, double *value, void *user)
{
  return dvi__place_value(user, x, NULL, value);
}

/* ---- vectors ---- */

bool dvi__place_vector_read(dvi_scene *scene, const dvi__tree *tree, int count, const char *where,
                            dvi__place_vector **vector)
{
  const bool is_list = tree->kind == DVI__SEQUENCE;
  *vector = dvi__arena_take(&scene->arena, 1, sizeof **vector);
  if (*vector == NULL) return dvi__scene_no_memory(scene);
  (*vector)->count = count;
  if ((is_list ? tree->count : 1) != count || tree->kind == DVI__MAPPING)
    return dvi__scene_refuse(scene, tree->span, "%s has %d component%s here, as in '%s'", where,
                             count, count == 1 ? "" : "s",
                             count == 1   ? "sin(x)"
                             : count == 2 ? "[sin(y), 0]"
                                          : "[sin(y), 0, 0]");
  for (int i = 0; i < count; i++)
    if (!dvi__place_read(scene, is_list ? tree->child[i] : tree, 0, where, (*vector)->place + i))
      return false;
  return true;
}

int dvi__place_vector_value(const double *x, double *value, void *user)
{
  const dvi__place_vector *vector = user;
  int failed = 0;
  for (int i = 0; i < vector->count && failed == 0; i++)
    failed = dvi__place_value(vector->place[i], x, NULL, value + i);
  return failed;
}

/* ---- a potential ---- */

/* The points of a block, component by component. */
typedef struct block {
  int count, numbers;
  double t[BLOCK], q[DVI__PLACE_NUMBERS * BLOCK];
} block;

static void fill_block(const struct dvi__scene_field *field, int count, const double *x,
                       const double *u, block *b)
{
  const int space = field->space;
  memset(b, 0, sizeof *b);
  b->count = count;
  for (int i = 0; i < count; i++) {
    for (int l = 0; l < space; l++) b->q[l * count + i] = x[i * space + l];
    b->q[2 * space * count + i] = u[i];
  }
}

static int first_derivative(const struct dvi__scene_field *field, const block *b, double *V_u)
{
  double gradient[DVI__PLACE_NUMBERS * BLOCK];
  const dvi_potential *V = &field->potential;
  const int failed = V->gradient_batch(b->count, b->t, b->q, gradient, V->user);
  if (failed == 0)
    memcpy(V_u, gradient + 2 * field->space * b->count, (size_t)b->count * sizeof *V_u);
  return failed;
}

static int second_derivative(const struct dvi__scene_field *field, const block *b, double *V_uu)
{
  double values[DVI__PLACE_NUMBERS * DVI__PLACE_NUMBERS * BLOCK];
  const dvi_potential *V = &field->potential;
  if (field->u_u < 0) {
    memset(V_uu, 0, (size_t)b->count * sizeof *V_uu);
    return 0;
  }
  const int failed = V->hessian_batch(b->count, b->t, b->q, values, V->user);
  if (failed == 0) memcpy(V_uu, values + field->u_u * b->count, (size_t)b->count * sizeof *V_uu);
  return failed;
}

static int density(int64_t count, const double *x, const double *u, double *V, double *V_u,
                   double *V_uu, void *user)
{
  const struct dvi__scene_field *field = user;
  block b;
  int failed = 0;
  for (int64_t i = 0; i < count && failed == 0; i += BLOCK) {
    fill_block(field, (int)(count - i < BLOCK ? count - i : BLOCK), x + i * field->space, u + i,
               &b);
    if (V != NULL)
      failed = field->potential.value_batch(b.count, b.t, b.q, V + i, field->potential.user);
    if (V_u != NULL && failed == 0) failed = first_derivative(field, &b, V_u + i);
    if (V_uu != NULL && failed == 0) failed = second_derivative(field, &b, V_uu + i);
  }
  return failed;
}

/* Find the entry of V_uu in the pattern, which is that of all numbers of a place. */
static void find_second(struct dvi__scene_field *field)
{
  const dvi_pattern *qq = &field->potential.qq;
  const int u = 2 * field->space, numbers = u + 1;
  field->u_u = -1;
  if (qq->start == NULL) {
    field->u_u = u * numbers + u;
    return;
  }
  for (int e = qq->start[u]; e < qq->start[u + 1]; e++)
    if (qq->row[e] == u) field->u_u = e;
}

bool dvi__place_potential(dvi_scene *scene, const dvi__tree *tree)
{
  struct dvi__scene_field *field = scene->field;
  dvi__scene_term *term;
  if (!read_function(scene, tree, DVI__OF_VALUE, "a potential", &term) ||
      !dvi__make_potential(scene, "density", term, &field->potential))
    return false;
  find_second(field);
  field->density = (dvi_field_potential){.density = density, .user = field};
  return true;
}
