/* Cells are stored in the order in which they act: the faces and edges that are due in a slot of
 * the classes are the first ones, so that a slot is three loops over beginnings of arrays. An edge
 * gathers the pushes of its faces in the order of their numbers, which is that of the events. In a
 * class the cells keep the mesh's order, and with it what that has of locality. */
#include "field/avi/layout.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "core/memory.h"
#include "core/status.h"

static dvi_status no_memory(const dvi__avi *avi)
{
  return dvi__fail(DVI_NO_MEMORY, "avi: no memory for %lld and %lld cells", (long long)avi->edges,
                   (long long)avi->faces);
}

/* ---- faces ---- */

typedef struct timed_face {
  double step;
  int face;
} timed_face;

static int compare_faces(const void *first, const void *second)
{
  const timed_face *a = first, *b = second;
  if (a->step != b->step) return a->step < b->step ? -1 : 1;
  return a->face < b->face ? -1 : 1;
}

static dvi_status number_faces(const dvi__avi_plan *plan, dvi__avi *avi)
{
  timed_face *order = DVI_NEW(timed_face, avi->faces);
  if (order == NULL) return no_memory(avi);
  for (int64_t f = 0; f < avi->faces; f++) order[f] = (timed_face){plan->step[f], (int)f};
  qsort(order, (size_t)avi->faces, sizeof *order, compare_faces);
  for (int64_t i = 0; i < avi->faces; i++) {
    const int f = order[i].face;
    avi->face_name[i] = f;
    avi->face_number[f] = (int)i;
    avi->face_class[i] = (int8_t)plan->face_class[f];
    if (isinf(order[i].step)) continue;
    avi->step[i] = order[i].step;
    avi->active_faces = i + 1;
    avi->class[plan->face_class[f]].faces = i + 1;
  }
  for (int c = 1; c < avi->classes; c++)
    if (avi->class[c].faces == 0) avi->class[c].faces = avi->class[c - 1].faces;
  dvi__release(order);
  return DVI_OK;
}

/* ---- edges ---- */

static int is_extra(const dvi__avi_terms *terms, int64_t e)
{
  int pushes = 0;
  for (int i = 0; i < terms->currents; i++) pushes += terms->current[i].profile[e] != 0;
  return pushes > 0 || (terms->damping != NULL && terms->damping[e] != 0);
}

/* The class of an edge is that of its shortest face, fixed ones count as another class behind. */
static void classify_edges(const dvi__avi_terms *terms, const dvi__avi_plan *plan, int *place)
{
  for (int64_t e = 0; e < terms->edges; e++) place[e] = plan->classes;
  for (int64_t f = 0; f < terms->faces; f++)
    for (int c = 0; c < terms->width && isfinite(plan->step[f]); c++) {
      int *class = place + terms->facet[f * terms->width + c];
      if (plan->face_class[f] < *class) *class = plan->face_class[f];
    }
  for (int64_t e = 0; e < terms->edges; e++)
    if (terms->is_fixed != NULL && terms->is_fixed[e]) place[e] = plan->classes;
  for (int64_t e = 0; e < terms->edges; e++)
    place[e] = 2 * place[e] + (place[e] < plan->classes && is_extra(terms, e));
}

/* Sort by place, in the order of the user's numbers. */
static void sort_edges(const int *place, dvi__avi *avi)
{
  int64_t begin[2 * DVI__AVI_CLASSES + 3] = {0};
  for (int64_t e = 0; e < avi->edges; e++) begin[place[e] + 1]++;
  for (int p = 0; p < 2 * DVI__AVI_CLASSES + 2; p++) begin[p + 1] += begin[p];
  for (int c = 0; c < avi->classes; c++) {
    avi->class[c].first = begin[2 * c];
    avi->class[c].extra = begin[2 * c + 1];
    avi->class[c].end = begin[2 * c + 2];
    avi->extra_count += begin[2 * c + 2] - begin[2 * c + 1];
  }
  avi->free_edges = begin[2 * avi->classes];
  for (int64_t e = 0; e < avi->edges; e++) {
    const int64_t i = begin[place[e]]++;
    avi->edge_name[i] = (int)e;
    avi->edge_number[e] = (int)i;
    avi->edge_class[i] = (int8_t)(place[e] / 2);
  }
}

static dvi_status number_edges(const dvi__avi_terms *terms, const dvi__avi_plan *plan,
                               dvi__avi *avi)
{
  int *place = DVI_NEW(int, avi->edges);
  if (place == NULL) return no_memory(avi);
  classify_edges(terms, plan, place);
  sort_edges(place, avi);
  dvi__release(place);
  return DVI_OK;
}

/* ---- what belongs to whom ---- */

static int code_of(int number, int sign)
{
  return sign > 0 ? number : ~number;
}

static void lay_out_facets(const dvi__avi_terms *terms, dvi__avi *avi)
{
  for (int64_t i = 0; i < avi->faces; i++)
    for (int c = 0; c < avi->width; c++) {
      const int64_t entry = (int64_t)avi->face_name[i] * avi->width + c;
      avi->facet[i * avi->width + c] = code_of(avi->edge_number[terms->facet[entry]],
                                               terms->sign[entry]);
    }
}

static dvi_status lay_out_cofaces(dvi__avi *avi)
{
  int64_t *const start = avi->coface_start;
  for (int64_t i = 0; i < avi->active_faces * avi->width; i++) {
    const int e = dvi__avi_number(avi->facet[i]);
    if (e < avi->free_edges) start[e + 1]++;
  }
  for (int64_t e = 0; e < avi->free_edges; e++) start[e + 1] += start[e];
  avi->coface = DVI_NEW(int, start[avi->free_edges]);
  if (avi->coface == NULL) return no_memory(avi);
  for (int64_t i = 0; i < avi->active_faces * avi->width; i++) {
    const int e = dvi__avi_number(avi->facet[i]);
    if (e < avi->free_edges)
      avi->coface[start[e]++] = code_of((int)(i / avi->width), avi->facet[i] < 0 ? -1 : 1);
  }
  for (int64_t e = avi->free_edges; e > 0; e--) start[e] = start[e - 1];
  start[0] = 0;
  return DVI_OK;
}

static void lay_out_stars(const dvi__avi_terms *terms, dvi__avi *avi)
{
  for (int64_t e = 0; e < avi->free_edges; e++) {
    avi->M1[e] = terms->M1[avi->edge_name[e]];
    avi->inverse[e] = 1 / avi->M1[e];
  }
  for (int64_t f = 0; f < avi->faces; f++) {
    avi->M2[f] = terms->M2[avi->face_name[f]];
    avi->kick[f] = avi->M2[f] * avi->step[f];
  }
}

/* ---- dampings and currents ---- */

static void lay_out_pushes(const dvi__avi_terms *terms, dvi__avi *avi)
{
  int count = 0, extras = 0;
  for (int64_t e = 0; e < avi->edges; e++) {
    const int name = avi->edge_name[e];
    avi->extra[e] = -1;
    if (e >= avi->free_edges || !is_extra(terms, name)) continue;
    avi->extra[e] = extras;
    dvi__avi_extra *extra = avi->extras + extras++;
    extra->damping = terms->damping != NULL ? terms->damping[name] : 0;
    extra->push = count;
    for (int i = 0; i < terms->currents; i++)
      if (terms->current[i].profile[name] != 0)
        avi->push[count++] = (dvi__avi_push){i, terms->current[i].profile[name]};
    extra->pushes = count - extra->push;
    avi->class[avi->edge_class[e]].pushes += extra->pushes;
  }
}

static dvi_status lay_out_extras(const dvi__avi_terms *terms, dvi__avi *avi)
{
  if (avi->extra_count == 0) return DVI_OK;
  int64_t pushes = 0;
  for (int64_t e = 0; e < avi->edges; e++)
    for (int i = 0; i < terms->currents; i++) pushes += terms->current[i].profile[e] != 0;
  avi->extra = DVI_NEW(int, avi->edges);
  avi->extras = DVI_NEW(dvi__avi_extra, avi->extra_count);
  avi->push = DVI_NEW(dvi__avi_push, pushes);
  if (!avi->extra || !avi->extras || !avi->push) return no_memory(avi);
  lay_out_pushes(terms, avi);
  return DVI_OK;
}

/* ---- nodes ---- */

static dvi_status lay_out_nodes(const dvi__avi_terms *terms, dvi__avi *avi)
{
  if (avi->nodes == 0) return DVI_OK;
  avi->node = DVI_NEW(int, avi->edges * avi->node_width);
  avi->node_open = DVI_NEW(int8_t, avi->nodes);
  avi->charge = DVI_NEW(double, avi->nodes);
  if (!avi->node || !avi->node_open || !avi->charge) return no_memory(avi);
  for (int64_t e = 0; e < avi->edges; e++)
    for (int c = 0; c < avi->node_width; c++) {
      const int64_t entry = (int64_t)avi->edge_name[e] * avi->node_width + c;
      const int node = terms->node[entry];
      avi->node[e * avi->node_width + c] = code_of(node, terms->node_sign[entry]);
      if (e >= avi->free_edges) avi->node_open[node] = 1;
    }
  return DVI_OK;
}

dvi_status dvi__avi_lay_out(const dvi__avi_terms *terms, const dvi__avi_plan *plan, dvi__avi *avi)
{
  DVI_TRY(number_faces(plan, avi));
  DVI_TRY(number_edges(terms, plan, avi));
  lay_out_facets(terms, avi);
  lay_out_stars(terms, avi);
  DVI_TRY(lay_out_cofaces(avi));
  DVI_TRY(lay_out_extras(terms, avi));
  return lay_out_nodes(terms, avi);
}
