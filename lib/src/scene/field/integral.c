/* An integral of a function of the position and of the field's value,
 *
 *     sum over vertices of w_v f(x_v, u_v),
 *
 * where w_v is the share of the vertex in the cells of a part. It is the vertex's dual cell with
 * the circumcentric star, so that the integral of a free field moves uniformly, and an equal part
 * of each cell with the other stars. */
#include <string.h>

#include "scene/field/scene_field.h"
#include "scene/sections/sections.h"
#include "text/heap.h"

struct dvi__field_integral {
  const dvi_field *field;
  dvi__place *function;
  const char *part;
  const dvi__tree *tree;
  int64_t vertices;
  const double *point;
  double *weight, *fixed; /* [vertices] */
  int *unknown;           /* [vertices] number among the unknowns, or -1 */
};

/* An integral of a state q. */
typedef struct state {
  const dvi__field_integral *integral;
  const double *q;
} state;

static int term_at(int64_t v, double *term, void *user)
{
  const state *of = user;
  const dvi__field_integral *a = of->integral;
  const double u = a->unknown[v] >= 0 ? of->q[a->unknown[v]] : a->fixed[v];
  double f = 0;
  const int failed = a->weight[v] == 0 ? 0
                                       : dvi__place_of_value(
                                             a->function, a->point + v * a->function->space, u, &f);
  *term = a->weight[v] * f;
  return failed;
}

int dvi__field_integral_value(double t, const double *q, const double *p, double *value, void *user)
{
  state of = {user, q};
  (void)t, (void)p;
  return dvi__field_sum_value(of.integral->field, 0, NULL, term_at, &of, value);
}

bool dvi__field_integral_read(dvi_scene *scene, const dvi__tree *tree, const dvi__tree *over,
                              dvi__field_integral **integral)
{
  dvi__field_integral *a = dvi__arena_take(&scene->arena, 1, sizeof *a);
  if (a == NULL) return dvi__scene_no_memory(scene);
  if (over != NULL && !dvi__want_text(scene, over, "a part of the mesh")) return false;
  a->part = over != NULL ? over->text : "all";
  a->tree = tree;
  if (!dvi__has_part_of_cells(scene->field->mesh, a->part))
    return dvi__refuse_part(scene, over != NULL ? over->span : tree->span, a->part, true);
  *integral = a;
  return dvi__place_read(scene, tree, DVI__OF_VALUE, "an integral", &a->function);
}

/* The shares are the masses of a material that only the part has. */
static dvi_status weigh(const dvi_mesh *mesh, dvi_star_kind kind, dvi__field_integral *a,
                        double *density)
{
  const double *const factor[DVI_MESH_DIMENSION_MAX + 1] = {density};
  const dvi_star_options options = {.size = sizeof options,
                                    .kind = kind == DVI_CIRCUMCENTRIC ? DVI_CIRCUMCENTRIC
                                                                      : DVI_BARYCENTRIC,
                                    .factor = factor};
  int64_t count;
  const int *cell = dvi_mesh_part_cells(mesh, a->part, dvi_mesh_dimension(mesh), &count);
  for (int64_t i = 0; i < count; i++) density[cell[i]] = 1;
  dvi_star *star = NULL;
  dvi_matrix M;
  dvi_status status = dvi_star_create(mesh, &options, &star);
  if (status == DVI_OK) status = dvi_star_matrix(star, 0, &M);
  if (status == DVI_OK) memcpy(a->weight, M.value, (size_t)a->vertices * sizeof *a->weight);
  dvi_star_destroy(&star);
  return status;
}

bool dvi__field_integral_make(dvi_scene *scene, dvi__field_integral *a)
{
  const struct dvi__scene_field *f = scene->field;
  int64_t unknowns;
  const int *unknown = dvi_field_unknowns(f->field, &unknowns);
  a->field = f->field;
  a->vertices = dvi_mesh_count(f->mesh, 0);
  a->point = dvi_mesh_points(f->mesh);
  a->weight = dvi__arena_take(&scene->arena, 2 * (size_t)a->vertices, sizeof *a->weight);
  a->unknown = dvi__arena_take(&scene->arena, (size_t)a->vertices, sizeof *a->unknown);
  double *density = dvi__heap_take((size_t)dvi_mesh_count(f->mesh, dvi_mesh_dimension(f->mesh)),
                                   sizeof *density);
  const bool complete = a->weight != NULL && a->unknown != NULL && density != NULL;
  dvi_status status = DVI_OK;
  if (complete) {
    a->fixed = a->weight + a->vertices;
    (void)dvi_field_lift(f->field, scene->zeros, a->fixed);
    for (int64_t v = 0; v < a->vertices; v++) a->unknown[v] = -1;
    for (int64_t i = 0; i < unknowns; i++) a->unknown[unknown[i]] = (int)i;
    status = weigh(f->mesh, f->kind, a, density);
  }
  dvi__heap_free(density);
  if (!complete) return dvi__scene_no_memory(scene);
  return status == DVI_OK ||
         dvi__complain(scene->complaint, status, a->tree->span, "%s", dvi_last_error());
}
