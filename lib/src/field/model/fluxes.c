/* The flux b through the boundary. Vertex v gets
 *
 *     b_v = integral over K's boundary, cut with the dual cell of v, of the flux
 *
 * with a circumcentric star. The boundary's part of a dual cell consists of the simplices of the
 * circumcentres of flags v = s_0 < s_1 < .. < facet, with the signs of field/forms/circumcentric.c.
 * With the other stars it is b_v = integral of the flux times the function of v that is linear in
 * the cells. A flux that is constant in each facet is integrated exactly, so that functions that
 * are linear in space solve their problem exactly. */
#include <math.h>
#include <stdio.h>

#include "core/status.h"
#include "field/forms/gram.h"
#include "field/forms/rule.h"
#include "field/forms/star.h"
#include "field/mesh/normal.h"
#include "field/mesh/share.h"
#include "field/mesh/volume.h"
#include "field/model/field.h"

/* A facet of the boundary, and where its flux goes. */
typedef struct facet {
  const dvi_field *field;
  const dvi_condition *condition;
  const dvi__rule *rule;
  int64_t number;
  int m, corners;           /* degree */
  int vertex[DVI__CORNERS]; /* of the corners */
  dvi__placed placed;       /* corners relative to the first one */
  double origin[DVI_MESH_SPACE_MAX], normal[DVI_MESH_SPACE_MAX];
  double *b; /* [vertices] */
} facet;

/* ---- geometry ---- */

static void place_facet(facet *f, int64_t number)
{
  const dvi_mesh *mesh = f->field->mesh;
  f->number = number;
  f->m = mesh->n - 1;
  f->corners = dvi__corners(mesh->kind, f->m);
  for (int c = 0; c < f->corners; c++)
    f->vertex[c] = f->m > 0 ? mesh->corner[f->m][number * f->corners + c] : (int)number;
  f->placed = (dvi__placed){.corners = 1, .space = mesh->space, .metric = mesh->metric};
  if (f->m > 0) dvi__place_cell(mesh, f->m, number, &f->placed);
  for (int l = 0; l < mesh->space; l++)
    f->origin[l] = mesh->point[(int64_t)f->vertex[0] * mesh->space + l];
  dvi__facet_normal(mesh, number, mesh->coface[2 * number], f->normal);
}

/* ---- integrals ---- */

/* Evaluate the flux at a place relative to the first corner. */
static dvi_status evaluate(const facet *f, const double *place, double *flux)
{
  double x[DVI_MESH_SPACE_MAX];
  char what[96];
  for (int l = 0; l < f->placed.space; l++) x[l] = f->origin[l] + place[l];
  const int failed = f->condition->datum(x, f->normal, flux, f->condition->user);
  (void)snprintf(what, sizeof what, "flux on part \"%.40s\"", f->condition->part);
  return dvi__field_check_datum(f->field, what, failed, *flux, f->m, f->number);
}

/* A panel is a simplex or a box with a corner and edges, on which shares of the flux go to the
 * vertices at its corners, or all of it goes to one vertex. */
typedef struct panel {
  dvi_cell_kind kind;
  int m;
  double corner[DVI_MESH_SPACE_MAX], edge[DVI_MESH_DIMENSION_MAX][DVI_MESH_SPACE_MAX];
  double size; /* Jacobian of the map from the rule's cell, with a sign */
  int vertex;  /* which gets all, or -1 */
} panel;

/* The share of corner c is its barycentric coordinate, or a product along the axes of a box. */
static double share_of(const panel *p, int c, const double *s)
{
  double share = 1;
  if (p->kind == DVI_BOXES) {
    for (int i = 0; i < p->m; i++) share *= c >> i & 1 ? s[i] : 1 - s[i];
    return share;
  }
  if (c > 0) return s[c - 1];
  for (int i = 0; i < p->m; i++) share -= s[i];
  return share;
}

static dvi_status add_panel(const facet *f, const panel *p)
{
  const int points = dvi__rule_count(p->m);
  for (int point = 0; point < points; point++) {
    double s[DVI_MESH_DIMENSION_MAX], place[DVI_MESH_SPACE_MAX], flux;
    const double weight = p->size * dvi__rule_point(f->rule, p->kind, p->m, point, s);
    for (int l = 0; l < f->placed.space; l++) {
      place[l] = p->corner[l];
      for (int i = 0; i < p->m; i++) place[l] += s[i] * p->edge[i][l];
    }
    DVI_TRY(evaluate(f, place, &flux));
    if (p->vertex >= 0) f->b[p->vertex] += weight * flux;
    for (int c = 0; c < f->corners && p->vertex < 0; c++)
      f->b[f->vertex[c]] += weight * flux * share_of(p, c, s);
  }
  return DVI_OK;
}

/* ---- the whole facet, with shares ---- */

static double factorial(int m)
{
  return m > 1 ? m * factorial(m - 1) : 1;
}

static panel whole_panel(const facet *f)
{
  const dvi_mesh *mesh = f->field->mesh;
  panel p = {.kind = mesh->kind, .m = f->m, .vertex = -1};
  p.size = dvi__cell_volume(mesh, f->m, f->number);
  if (mesh->kind == DVI_SIMPLICES) p.size *= factorial(f->m);
  for (int i = 0; i < f->m; i++) {
    const double *end = f->placed.x[mesh->kind == DVI_BOXES ? 1 << i : i + 1];
    for (int l = 0; l < mesh->space; l++) p.edge[i][l] = end[l];
  }
  return p;
}

/* ---- circumcentric pieces ---- */

/* The piece of a corner is the part of a box that is next to it. */
static dvi_status add_box_pieces(const facet *f)
{
  const panel whole = whole_panel(f);
  for (int c = 0; c < f->corners; c++) {
    panel p = whole;
    p.size = ldexp(whole.size, -f->m);
    p.vertex = f->vertex[c];
    for (int l = 0; l < f->placed.space; l++) {
      p.corner[l] = f->placed.x[c][l];
      for (int i = 0; i < f->m; i++)
        p.edge[i][l] = c >> i & 1 ? -0.5 * whole.edge[i][l] : 0.5 * whole.edge[i][l];
    }
    DVI_TRY(add_panel(f, &p));
  }
  return DVI_OK;
}

/* A flag from the facet down to a face: circumcentres from below, and the product of the signed
 * distances between them. */
typedef struct flag {
  double centre[DVI_MESH_DIMENSION_MAX][DVI_MESH_SPACE_MAX];
  double product;
} flag;

static dvi_status add_flag(const facet *f, const flag *g, int corner)
{
  panel p = {.kind = DVI_SIMPLICES, .m = f->m, .size = g->product, .vertex = f->vertex[corner]};
  for (int l = 0; l < f->placed.space; l++) {
    p.corner[l] = f->placed.x[corner][l];
    for (int i = 0; i < f->m; i++) p.edge[i][l] = g->centre[i + 1][l] - p.corner[l];
  }
  return add_panel(f, &p);
}

/* Go on from the face with these corners to all flags below it. */
static dvi_status descend(const facet *f, flag *g, int mask)
{
  int corner[DVI__SIMPLEX_CORNERS] = {0}, k = -1;
  dvi__simplex face;
  const double product = g->product;
  for (int c = 0; c < f->corners; c++)
    if (mask >> c & 1) corner[++k] = c;
  if (k == 0) return add_flag(f, g, corner[0]);
  dvi__simplex_of(&f->placed, k, corner, &face);
  for (int l = 0; l < f->placed.space; l++) {
    g->centre[k][l] = 0;
    for (int j = 0; j <= k; j++) g->centre[k][l] += face.centre[j] * f->placed.x[corner[j]][l];
  }
  for (int j = 0; j <= k; j++) {
    g->product = product * face.centre[j] / sqrt(face.square[j]);
    DVI_TRY(descend(f, g, mask & ~(1 << corner[j])));
  }
  g->product = product;
  return DVI_OK;
}

static dvi_status add_facet(const facet *f)
{
  const dvi_star *star = f->field->star;
  if (star->kind == DVI_CIRCUMCENTRIC && star->mesh->kind == DVI_SIMPLICES) {
    flag g = {.product = 1};
    return descend(f, &g, (1 << f->corners) - 1);
  }
  if (star->kind == DVI_CIRCUMCENTRIC) return add_box_pieces(f);
  const panel whole = whole_panel(f);
  return add_panel(f, &whole);
}

/* ---- conditions ---- */

/* A part of n-cells stands for its facets on the boundary. Facets inside are an error elsewhere. */
static dvi_status check_facets(const dvi_mesh *mesh, const char *part)
{
  int64_t here;
  const int *number = dvi_mesh_part_cells(mesh, part, mesh->n - 1, &here);
  const int64_t count = dvi__part_total(mesh, part, mesh->n - 1),
                cells = dvi__part_total(mesh, part, mesh->n);
  int64_t outside = 0;
  for (int64_t i = 0; i < here; i++)
    outside += dvi__is_outer(mesh, number[i]) && dvi__owns(mesh, mesh->n - 1, number[i]);
  DVI_TRY(dvi__count_all(mesh, 1, &outside));
  if (outside > 0 && (outside == count || cells > 0)) return DVI_OK;
  return dvi__fail(DVI_BAD_ARGUMENT,
                   "field: a flux is given on part \"%s\", of whose %lld cells of degree %d "
                   "%lld are of the boundary: give it on a part of the boundary",
                   part, (long long)count, mesh->n - 1, (long long)outside);
}

static dvi_status add_condition(const dvi_field *field, const dvi_condition *condition,
                                const dvi__rule *rule, double *b)
{
  const dvi_mesh *mesh = field->mesh;
  int64_t count;
  facet f = {.field = field, .condition = condition, .rule = rule, .b = b};
  const int *number = dvi_mesh_part_cells(mesh, condition->part, mesh->n - 1, &count);
  for (int64_t i = 0; i < count; i++) {
    if (!dvi__is_outer(mesh, number[i])) continue;
    place_facet(&f, number[i]);
    DVI_TRY(add_facet(&f));
  }
  return DVI_OK;
}

dvi_status dvi__field_add_fluxes(const dvi_field *field, const dvi_wave_terms *terms, double *b)
{
  dvi__rule rule;
  DVI_TRY(dvi__rule_make(&rule));
  for (int i = 0; i < terms->conditions; i++)
    if (terms->condition[i].kind == DVI_FREE && terms->condition[i].datum != NULL) {
      DVI_TRY(check_facets(field->mesh, terms->condition[i].part));
      DVI_TRY(dvi__agree(field->mesh, add_condition(field, terms->condition + i, &rule, b)));
    }
  return DVI_OK;
}
