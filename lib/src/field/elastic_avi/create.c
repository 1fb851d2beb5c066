/* Making the steps of a solid. */
#include <limits.h>
#include <math.h>

#include "core/memory.h"
#include "core/status.h"
#include "field/elastic_avi/borders.h"
#include "field/elastic_avi/layout.h"
#include "field/elastic_avi/parts.h"
#include "field/mesh/share.h"

static void destroy_view(dvi__solid_view *view)
{
  if (view == NULL) return;
  dvi__release(view->u);
  dvi__release(view->rate);
  dvi__release(view);
}

void dvi__solid_avi_destroy(dvi__solid_avi **avi)
{
  dvi__solid_avi *s = *avi;
  if (s == NULL) return;
  void *const memory[] = {s->cell,  s->node_kind, s->step,    s->decay,
                          s->block, s->kept,      s->cell_of, s->cell_start};
  for (size_t i = 0; i < sizeof memory / sizeof *memory; i++) dvi__release(memory[i]);
  destroy_view(s->view);
  dvi__solid_parts_destroy(&s->parts);
  dvi__solid_borders_destroy(&s->borders);
  dvi__release(s);
  *avi = NULL;
}

static dvi_status no_memory(const dvi__solid_avi *s)
{
  return dvi__fail(DVI_NO_MEMORY, "%s: no memory for %lld cells", s->method, (long long)s->cells);
}

static dvi_status allocate(dvi__solid_avi *s)
{
  const dvi_elastic *e = s->solid;
  const int64_t width = s->n + 1, numbers = s->vertices * s->n;
  int decays = 0;
  for (int i = 0; i < e->material_count; i++) decays |= e->materials[i].alpha > 0;
  s->cell = DVI_NEW(dvi__solid_cell, s->cells);
  s->node_kind = DVI_NEW(uint8_t, s->vertices);
  s->step = DVI_NEW(double, s->cells);
  s->cell_start = DVI_NEW(int64_t, s->vertices + 1);
  s->cell_of = DVI_NEW(int, s->cells *width);
  s->view = DVI_NEW(dvi__solid_view, 1);
  if (!s->cell || !s->node_kind || !s->step || !s->cell_start || !s->cell_of || !s->view)
    return no_memory(s);
  s->view->u = DVI_NEW(double, numbers);
  s->view->rate = DVI_NEW(double, numbers);
  if (!s->view->u || !s->view->rate) return no_memory(s);
  if (decays && (s->decay = DVI_NEW(double, s->vertices)) == NULL) return no_memory(s);
  return DVI_OK;
}

dvi_status dvi__solid_avi_create(const dvi_elastic *solid, const dvi__solid_request *request,
                                 dvi__solid_avi **avi)
{
  dvi__solid_plan plan;
  *avi = NULL;
  DVI_TRY(dvi__solid_plan_make(solid, request, &plan));
  dvi__solid_avi *s = DVI_NEW(dvi__solid_avi, 1);
  dvi_status status = dvi__agree(solid->mesh,
                                 s != NULL ? DVI_OK : dvi__fail(DVI_NO_MEMORY, "avi: no memory"));
  if (status != DVI_OK || s == NULL) {
    dvi__solid_plan_clear(&plan);
    dvi__release(s);
    return status;
  }
  *s = (dvi__solid_avi){.solid = solid,
                        .method = request->is_equal ? "verlet" : "avi",
                        .n = solid->n,
                        .vertices = solid->vertices,
                        .cells = solid->cells,
                        .is_free = request->is_free,
                        .is_equal = request->is_equal,
                        .is_linear = request->is_linear,
                        .classes = plan.classes,
                        .shortest = plan.shortest,
                        .longest = plan.longest,
                        .bound = plan.tightest,
                        .band = request->band > 0 ? request->band : 2,
                        .threads = request->threads};
  status = dvi__agree(solid->mesh, allocate(s));
  if (status == DVI_OK) status = dvi__solid_lay_out(&plan, s);
  if (status == DVI_OK && (s->is_free || s->threads > 1))
    status = dvi__solid_parts_create(&plan, s);
  dvi__solid_plan_clear(&plan);
  if (status == DVI_OK)
    *avi = s;
  else
    dvi__solid_avi_destroy(&s);
  return status;
}
