/* The damping S of an electromagnetic field, whose current is S E. Conductors give M_k with the
 * conductivity as its factor. An absorbing wall gives the star of the boundary itself,
 *
 *     S_s = sqrt(eps/mu) |*s cut with K's boundary| / |s|,
 *
 * so that tangential H and E are those of a wave that leaves at a right angle (Mur 1981, first
 * order; Monk 2003, sec. 1.4.3). */
#include <math.h>
#include <string.h>

#include "core/memory.h"
#include "core/status.h"
#include "field/forms/star.h"
#include "field/mesh/complex.h"
#include "field/mesh/share.h"
#include "field/model/field.h"

static const double roundoff = 1e-14; /* of an entry, beside the largest one */

/* ---- the boundary as a mesh of its own ---- */

/* The facets of absorbing walls. */
typedef struct rim {
  const dvi_field *field;
  int64_t facets, points;
  char *is_absorbing; /* [facets of the mesh] */
  int *vertex;        /* [facets*corners] numbers of the rim's points */
  int *origin;        /* [points] vertices of the mesh */
  int *number;        /* [vertices of the mesh] points of the rim, or -1 */
  double *point, *admittance;
  dvi_mesh *mesh;
  dvi_star *star;
} rim;

static void clear_rim(rim *r)
{
  dvi_star_destroy(&r->star);
  dvi_mesh_destroy(&r->mesh);
  dvi__release(r->is_absorbing);
  dvi__release(r->vertex);
  dvi__release(r->origin);
  dvi__release(r->number);
  dvi__release(r->point);
  dvi__release(r->admittance);
}

/* Mark the facets of a wall that lie on the boundary. */
static dvi_status mark_wall(rim *r, const dvi_wall *wall)
{
  int64_t count, found = 0;
  const dvi_mesh *mesh = r->field->mesh;
  const int *facet = dvi_mesh_part_cells(mesh, wall->part, mesh->n - 1, &count);
  for (int64_t i = 0; i < count; i++) {
    if (!dvi__is_outer(mesh, facet[i])) continue;
    r->is_absorbing[facet[i]] = 1;
    found += dvi__owns(mesh, mesh->n - 1, facet[i]);
  }
  DVI_TRY(dvi__count_all(mesh, 1, &found));
  if (found > 0) return DVI_OK;
  return dvi__fail(DVI_BAD_ARGUMENT,
                   "maxwell: the absorbing wall on part \"%s\" has no facet of the boundary",
                   wall->part);
}

double dvi__admittance(const dvi_field *field, int64_t cell)
{
  const double *eps = field->star->factor[field->degree],
               *nu = field->star->factor[field->degree + 1];
  return sqrt((eps != NULL ? eps[cell] : 1) * (nu != NULL ? nu[cell] : 1));
}

static dvi_status allocate(rim *r)
{
  const dvi_mesh *mesh = r->field->mesh;
  const int64_t facets = mesh->count[mesh->n - 1], vertices = mesh->count[0];
  r->is_absorbing = DVI_NEW(char, facets);
  r->vertex = DVI_NEW(int, facets *dvi__corners(mesh->kind, mesh->n - 1));
  r->admittance = DVI_NEW(double, facets);
  r->origin = DVI_NEW(int, vertices);
  r->number = DVI_NEW(int, vertices);
  r->point = DVI_NEW(double, vertices * mesh->space);
  if (r->is_absorbing && r->vertex && r->admittance && r->origin && r->number && r->point)
    return DVI_OK;
  return dvi__fail(DVI_NO_MEMORY, "maxwell: no memory for absorbing walls");
}

/* The rim's points keep the order of the mesh's vertices, so that cells keep their orientation. */
static void take_points(rim *r)
{
  const dvi_mesh *mesh = r->field->mesh;
  const int corners = dvi__corners(mesh->kind, mesh->n - 1);
  const int *corner = mesh->corner[mesh->n - 1];
  for (int64_t f = 0; f < mesh->count[mesh->n - 1]; f++)
    for (int c = 0; c < corners && r->is_absorbing[f]; c++)
      r->number[corner != NULL ? corner[f * corners + c] : f] = 1;
  for (int64_t v = 0; v < mesh->count[0]; v++) {
    if (!r->number[v]) continue;
    r->origin[r->points] = (int)v;
    memcpy(r->point + r->points * mesh->space, mesh->point + v * mesh->space,
           (size_t)mesh->space * sizeof(double));
    r->number[v] = (int)r->points++;
  }
}

static void take_facets(rim *r)
{
  const dvi_mesh *mesh = r->field->mesh;
  const int corners = dvi__corners(mesh->kind, mesh->n - 1);
  for (int64_t f = 0; f < mesh->count[mesh->n - 1]; f++) {
    if (!r->is_absorbing[f]) continue;
    for (int c = 0; c < corners; c++)
      r->vertex[r->facets * corners + c] =
          r->number[mesh->n > 1 ? mesh->corner[mesh->n - 1][f * corners + c] : f];
    r->admittance[r->facets++] = dvi__admittance(r->field, mesh->coface[2 * f]);
  }
}

static dvi_status make_rim(rim *r)
{
  const dvi_mesh *mesh = r->field->mesh;
  take_points(r);
  take_facets(r);
  if (mesh->n == 1) return DVI_OK;
  const dvi_mesh_terms terms = {.size = sizeof terms,
                                .kind = mesh->kind,
                                .dimension = mesh->n - 1,
                                .space = mesh->space,
                                .points = r->points,
                                .point = r->point,
                                .cells = r->facets,
                                .vertex = r->vertex,
                                .metric = mesh->metric,
                                .period = mesh->period};
  DVI_TRY(dvi_mesh_create(&terms, &r->mesh));
  const double *factor[DVI__DEGREES] = {NULL};
  factor[r->field->degree] = r->admittance;
  const dvi_star_options options = {
      .size = sizeof options, .kind = r->field->star->kind, .factor = factor};
  return dvi_star_create(r->mesh, &options, &r->star);
}

/* ---- its matrix among the unknowns ---- */

/* Give the cell of the mesh that a k-cell of the rim is, and its sign. */
static int64_t cell_of(const rim *r, int64_t cell, int *sign)
{
  const dvi_mesh *mesh = r->field->mesh;
  const int k = r->field->degree, corners = dvi__corners(mesh->kind, k);
  int vertex[DVI__CORNERS];
  *sign = 1;
  if (k == 0) return r->origin[cell];
  for (int c = 0; c < corners; c++) vertex[c] = r->origin[r->mesh->corner[k][cell * corners + c]];
  const int64_t found = dvi__complex_find(mesh, k, vertex);
  *sign = dvi__relative_orientation(mesh->kind, k, vertex, mesh->corner[k] + found * corners);
  return found;
}

/* Make the matrix that restricts the unknowns to the k-cells of the rim. */
static dvi_status make_restriction(const rim *r, int64_t rows, dvi__csr *restriction)
{
  int64_t entries = 0;
  DVI_TRY(dvi__csr_allocate(rows, r->field->unknowns, rows, restriction));
  for (int64_t i = 0; i < rows; i++) {
    int sign;
    const int number = r->field->number[cell_of(r, i, &sign)];
    restriction->start[i] = entries;
    if (number < 0) continue;
    restriction->column[entries] = number;
    restriction->value[entries++] = sign;
  }
  restriction->start[rows] = entries;
  return DVI_OK;
}

/* In one dimension the rim consists of points, whose star is 1. */
static dvi_status star_of_rim(const rim *r, dvi_matrix *S)
{
  if (r->star != NULL) return dvi_star_matrix(r->star, r->field->degree, S);
  *S = (dvi_matrix){
      .rows = r->points, .columns = r->points, .symmetric = 1, .width = 1, .value = r->admittance};
  return DVI_OK;
}

static dvi_status make_wall_matrix(const rim *r, dvi__csr *damping)
{
  dvi_matrix S;
  dvi__csr restriction = {0};
  DVI_TRY(star_of_rim(r, &S));
  DVI_TRY(make_restriction(r, S.rows, &restriction));
  const dvi_matrix P = dvi__csr_view(&restriction, 0);
  const dvi_status status = dvi__csr_square(&P, &S, damping);
  dvi__csr_clear(&restriction);
  return status;
}

/* A share without walls has no losses there, but it has the matrix of those that have. */
static dvi_status make_rim_matrix(rim *r, dvi__csr *damping)
{
  const dvi_mesh *mesh = r->field->mesh;
  if (memchr(r->is_absorbing, 1, (size_t)mesh->count[mesh->n - 1]) == NULL)
    return dvi__csr_allocate(r->field->unknowns, r->field->unknowns, 0, damping);
  DVI_TRY(make_rim(r));
  return make_wall_matrix(r, damping);
}

static dvi_status make_walls(dvi_field *field, const dvi_maxwell_terms *terms, dvi__csr *damping)
{
  rim r = {.field = field};
  int count = 0;
  for (int i = 0; i < terms->walls; i++) count += terms->wall[i].kind == DVI_ABSORBING;
  if (count == 0) return DVI_OK;
  dvi_status status = dvi__agree(field->mesh, allocate(&r));
  for (int i = 0; i < terms->walls && status == DVI_OK; i++)
    if (terms->wall[i].kind == DVI_ABSORBING) status = mark_wall(&r, terms->wall + i);
  if (status == DVI_OK) status = dvi__agree(field->mesh, make_rim_matrix(&r, damping));
  clear_rim(&r);
  return status;
}

/* ---- conductors ---- */

static dvi_status check_conductivity(const dvi_field *field, const double *sigma, int64_t *cells)
{
  *cells = 0;
  for (int64_t c = 0; c < field->mesh->count[field->mesh->n]; c++) {
    if (!(sigma[c] >= 0) || !isfinite(sigma[c])) {
      const dvi__cell_name name = dvi__name_cell(field->mesh, field->mesh->n, c);
      return dvi__fail(DVI_BAD_ARGUMENT,
                       "maxwell: the conductivity is %g in %s; 0 or more is "
                       "possible",
                       sigma[c], name.text);
    }
    *cells += sigma[c] != 0;
  }
  return DVI_OK;
}

static dvi_status make_conductors(dvi_field *field, const double *sigma, dvi__csr *damping)
{
  dvi__csr S = {0};
  int64_t conductors;
  DVI_TRY(dvi__agree(field->mesh, check_conductivity(field, sigma, &conductors)));
  DVI_TRY(dvi__count_all(field->mesh, 1, &conductors));
  if (conductors == 0) return DVI_OK;
  DVI_TRY(dvi__star_with_factor(field->star, field->degree, sigma, &S));
  const dvi_matrix view = dvi__csr_view(&S, 1);
  const dvi_status status = dvi__field_select(field, &view, damping);
  dvi__csr_clear(&S);
  return status;
}

/* ---- both ---- */

/* The pieces of circumcentric dual cells in conductors and walls have signs, even where the whole
 * dual cells are positive. Entries that are roundings of zero count as zero. */
static dvi_status check_damping(dvi_field *field)
{
  dvi__csr *S = &field->damping;
  double most = 0;
  if (!field->is_damped || !field->mass_is_diagonal) return DVI_OK;
  for (int64_t e = 0; e < S->start[S->rows]; e++)
    if (dvi__owns(field->mesh, field->degree, field->unknown[S->column[e]]))
      most = fmax(most, S->value[e]);
  DVI_TRY(dvi__largest_of_all(field->mesh, 1, &most));
  for (int64_t e = 0; e < S->start[S->rows]; e++) {
    if (S->value[e] >= 0) continue;
    if (S->value[e] < -roundoff * most &&
        dvi__owns(field->mesh, field->degree, field->unknown[S->column[e]])) {
      const dvi__cell_name name = dvi__name_cell(field->mesh, field->degree,
                                                 field->unknown[S->column[e]]);
      return dvi__fail(DVI_SINGULAR,
                       "maxwell: the losses have the entry %g at %s, so that fields would grow: "
                       "take a Whitney star%s, repair the mesh (dvi mesh tells how), or other "
                       "points",
                       S->value[e], name.text, field->mesh->share != NULL ? " in one process" : "");
    }
    S->value[e] = 0;
  }
  return DVI_OK;
}

static dvi_status make_damping(dvi_field *field, const dvi_maxwell_terms *terms)
{
  dvi__csr walls = {0}, conductors = {0};
  dvi_status status = make_walls(field, terms, &walls);
  if (status == DVI_OK && terms->conductivity != NULL)
    status = make_conductors(field, terms->conductivity, &conductors);
  const dvi_matrix a = dvi__csr_view(&walls, 1), b = dvi__csr_view(&conductors, 1);
  field->is_damped = walls.start != NULL || conductors.start != NULL;
  if (status == DVI_OK && walls.start != NULL && conductors.start != NULL) {
    status = dvi__csr_sum(&a, &b, &field->damping);
  } else if (status == DVI_OK) {
    field->damping = walls.start != NULL ? walls : conductors;
    return status;
  }
  dvi__csr_clear(&walls);
  dvi__csr_clear(&conductors);
  return status;
}

dvi_status dvi__maxwell_make_damping(dvi_field *field, const dvi_maxwell_terms *terms)
{
  DVI_TRY(dvi__agree(field->mesh, make_damping(field, terms)));
  return check_damping(field);
}
