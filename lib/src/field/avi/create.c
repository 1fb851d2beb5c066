/* Making asynchronous steps, and their start. */
#include <limits.h>
#include <math.h>
#include <stdio.h>
#include <string.h>

#include "core/memory.h"
#include "core/status.h"
#include "field/avi/layout.h"

static void destroy_view(dvi__avi_view *view)
{
  if (view == NULL) return;
  dvi__release(view->made);
  dvi__release(view->A);
  dvi__release(view->D);
  dvi__release(view->B);
  dvi__release(view->worked);
  dvi__release(view->half);
  dvi__release(view->node_sum);
  dvi__release(view);
}

void dvi__avi_destroy(dvi__avi **avi)
{
  if (avi == NULL || *avi == NULL) return;
  dvi__avi *s = *avi;
  void *const memory[] = {
      s->edge_number, s->face_number, s->edge_name, s->face_name, s->facet, s->coface_start,
      s->coface,      s->M1,          s->inverse,   s->M2,        s->step,  s->kick,
      s->edge_class,  s->face_class,  s->extra,     s->extras,    s->push,  s->current,
      s->node,        s->node_open,   s->charge,    s->A,         s->D,     s->bias,
      s->impulse,     s->clock,       s->count,     s->next,      s->heap,  s->half};
  for (size_t i = 0; i < sizeof memory / sizeof *memory; i++) dvi__release(memory[i]);
  destroy_view(s->view);
  dvi__team_destroy(&s->team);
  dvi__release(s);
  *avi = NULL;
}

/* ---- checks ---- */

dvi__cell_name dvi__avi_name(const dvi__avi_terms *terms, int up, int64_t cell)
{
  dvi__cell_name name;
  if (terms->mesh != NULL) return dvi__name_cell(terms->mesh, terms->degree + up, cell);
  (void)snprintf(name.text, sizeof name.text, "%s %lld", up ? "face" : "edge", (long long)cell);
  return name;
}

static dvi_status check_edge(const dvi__avi_terms *terms, int64_t e)
{
  const dvi__cell_name name = dvi__avi_name(terms, 0, e);
  if (!(terms->M1[e] > 0) || isinf(terms->M1[e]))
    return dvi__fail(DVI_SINGULAR,
                     "avi: the star has the entry %g at %s, and needs finite ones above 0; repair "
                     "the mesh",
                     terms->M1[e], name.text);
  if (terms->damping != NULL && (!(terms->damping[e] >= 0) || isinf(terms->damping[e])))
    return dvi__fail(DVI_BAD_ARGUMENT, "avi: the damping is %g at %s; take none below 0",
                     terms->damping[e], name.text);
  for (int i = 0; i < terms->currents; i++)
    if (!isfinite(terms->current[i].profile[e]))
      return dvi__fail(DVI_NOT_FINITE, "avi: current %d is %g at %s", i,
                       terms->current[i].profile[e], name.text);
  return DVI_OK;
}

static dvi_status check(const dvi__avi_terms *terms)
{
  if (terms->edges > INT_MAX || terms->faces > INT_MAX || terms->edges < 1 || terms->faces < 1)
    return dvi__fail(DVI_BAD_SIZE, "avi: %lld and %lld cells; an int numbers them",
                     (long long)terms->edges, (long long)terms->faces);
  for (int64_t f = 0; f < terms->faces; f++)
    if (!isfinite(terms->M2[f]))
      return dvi__fail(DVI_NOT_FINITE, "avi: the star has the entry %g at %s", terms->M2[f],
                       dvi__avi_name(terms, 1, f).text);
  for (int64_t e = 0; e < terms->edges; e++)
    if (terms->is_fixed == NULL || !terms->is_fixed[e]) DVI_TRY(check_edge(terms, e));
  return DVI_OK;
}

/* ---- memory ---- */

static dvi_status no_memory(const dvi__avi *avi)
{
  return dvi__fail(DVI_NO_MEMORY, "avi: no memory for %lld and %lld cells", (long long)avi->edges,
                   (long long)avi->faces);
}

static dvi_status allocate_cells(dvi__avi *s)
{
  s->edge_number = DVI_NEW(int, s->edges);
  s->edge_name = DVI_NEW(int, s->edges);
  s->edge_class = DVI_NEW(int8_t, s->edges);
  s->face_number = DVI_NEW(int, s->faces);
  s->face_name = DVI_NEW(int, s->faces);
  s->face_class = DVI_NEW(int8_t, s->faces);
  s->facet = DVI_NEW(int, s->faces * s->width);
  s->coface_start = DVI_NEW(int64_t, s->edges + 1);
  const int is_made = s->edge_number && s->edge_name && s->edge_class && s->face_number &&
                      s->face_name && s->face_class && s->facet && s->coface_start;
  return is_made ? DVI_OK : no_memory(s);
}

static dvi_status allocate_numbers(dvi__avi *s)
{
  double **const of_edges[] = {&s->M1, &s->inverse, &s->A, &s->D};
  double **const of_faces[] = {&s->M2, &s->step, &s->kick, &s->bias, &s->impulse};
  for (size_t i = 0; i < sizeof of_edges / sizeof *of_edges; i++)
    if ((*of_edges[i] = DVI_NEW(double, s->edges)) == NULL) return no_memory(s);
  for (size_t i = 0; i < sizeof of_faces / sizeof *of_faces; i++)
    if ((*of_faces[i] = DVI_NEW(double, s->faces)) == NULL) return no_memory(s);
  return DVI_OK;
}

static dvi_status allocate_queue(dvi__avi *s)
{
  if (!s->is_queued) return DVI_OK;
  s->clock = DVI_NEW(double, s->edges);
  s->count = DVI_NEW(int64_t, s->faces);
  s->next = DVI_NEW(double, s->faces);
  s->heap = DVI_NEW(int, s->faces);
  return s->clock && s->count && s->next && s->heap ? DVI_OK : no_memory(s);
}

static dvi_status allocate_view(dvi__avi *s)
{
  dvi__avi_view *view = s->view = DVI_NEW(dvi__avi_view, 1);
  if (view == NULL) return no_memory(s);
  view->made = DVI_NEW(unsigned, s->edges + s->faces);
  view->A = DVI_NEW(double, s->edges);
  view->D = DVI_NEW(double, s->edges);
  view->B = DVI_NEW(double, s->faces);
  view->worked = DVI_NEW(double, s->extra_count);
  view->half = DVI_NEW(double, 2 * s->currents);
  view->node_sum = DVI_NEW(double, 2 * s->nodes);
  const int is_made = view->made && view->A && view->D && view->B && view->worked && view->half &&
                      view->node_sum;
  return is_made ? DVI_OK : no_memory(s);
}

static dvi_status allocate_currents(const dvi__avi_terms *terms, dvi__avi *s)
{
  const int intervals = s->classes > s->width ? s->classes : s->width;
  s->half = DVI_NEW(double, 2 * (int64_t)s->currents * intervals);
  s->current = DVI_NEW(dvi__avi_current, s->currents);
  if (s->half == NULL || s->current == NULL) return no_memory(s);
  for (int i = 0; i < s->currents; i++) s->current[i] = terms->current[i];
  return DVI_OK;
}

static dvi_status make(const dvi__avi_terms *terms, const dvi__avi_plan *plan, dvi__avi *s)
{
  DVI_TRY(allocate_cells(s));
  DVI_TRY(allocate_numbers(s));
  DVI_TRY(allocate_queue(s));
  DVI_TRY(allocate_currents(terms, s));
  DVI_TRY(dvi__avi_lay_out(terms, plan, s));
  DVI_TRY(allocate_view(s));
  return s->threads > 1 ? dvi__team_create(s->threads, &s->team) : DVI_OK;
}

dvi_status dvi__avi_create(const dvi__avi_terms *terms, dvi__avi **avi)
{
  dvi__avi_plan plan;
  *avi = NULL;
  DVI_TRY(check(terms));
  DVI_TRY(dvi__avi_plan_make(terms, &plan));
  dvi__avi *s = DVI_NEW(dvi__avi, 1);
  if (s == NULL) {
    dvi__avi_plan_clear(&plan);
    return dvi__fail(DVI_NO_MEMORY, "avi: no memory");
  }
  *s = (dvi__avi){.edges = terms->edges,
                  .faces = terms->faces,
                  .width = terms->width,
                  .classes = plan.classes,
                  .currents = terms->currents,
                  .nodes = terms->nodes,
                  .node_width = terms->node_width,
                  .shortest = plan.shortest,
                  .longest = plan.longest,
                  .bound = plan.tightest,
                  .band = terms->band > 0 ? terms->band : 2,
                  .is_queued = terms->is_free || terms->is_queued || terms->step != NULL,
                  .threads = terms->threads > 1 ? terms->threads : 1,
                  .t = (double)NAN};
  const dvi_status status = make(terms, &plan, s);
  dvi__avi_plan_clear(&plan);
  *avi = s;
  if (status != DVI_OK) dvi__avi_destroy(avi);
  return status;
}
