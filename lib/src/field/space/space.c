/* Function spaces: creation, sharing, and what they tell. */
#include "field/mesh/share.h"
#include "field/space/space.h"

#include <limits.h>
#include <math.h>
#include <string.h>

#include "core/memory.h"
#include "core/status.h"
#include "field/space/kind.h"

static const char *const coordinate[DVI_AXES_MAX] = {"x", "y", "z"};

/* ---- creation ---- */

dvi_status dvi__space_check_sizes(double functions, double points)
{
  if (functions <= INT_MAX && points <= INT_MAX) return DVI_OK;
  return dvi__fail(DVI_BAD_SIZE, "space: %.3g functions and %.3g points asked, %d possible",
                   functions, points, INT_MAX);
}

static dvi_status check_options(const dvi_space_options *options)
{
  if (options->size != sizeof *options)
    return dvi__fail(DVI_BAD_ARGUMENT, "space: set options.size to sizeof(dvi_space_options)");
  if (options->mesh != NULL && options->axes != 0)
    return dvi__fail(DVI_BAD_ARGUMENT, "space: %d axes with a mesh; give axes or a mesh",
                     options->axes);
  if (options->mesh == NULL && (options->axes < 1 || options->axes > DVI_AXES_MAX))
    return dvi__fail(DVI_BAD_ARGUMENT, "space: %d axes asked, 1 to %d possible without a mesh",
                     options->axes, DVI_AXES_MAX);
  if (options->mesh == NULL && options->axis == NULL)
    return dvi__fail(DVI_BAD_ARGUMENT, "space: the array of axes is NULL");
  return DVI_OK;
}

/* A domain of its own needs all axes to be of its kind. */
static dvi_status choose_domain(dvi_space *space)
{
  space->domain = &dvi__box;
  for (int d = 0; d < space->lines; d++) {
    const dvi__kind *kind = space->line[d].kind;
    if (kind->domain == NULL || space->lines < kind->domain_axes) continue;
    space->domain = kind->domain;
    for (int e = 0; e < space->lines; e++)
      if (space->line[e].kind != kind)
        return dvi__fail(DVI_UNSUPPORTED,
                         "space: axis %s is %s and axis %s is %s, which does not go together; take "
                         "one of these kinds for all axes",
                         space->line[d].name, kind->form.name, space->line[e].name,
                         space->line[e].kind->form.name);
  }
  return DVI_OK;
}

static dvi_status make_lines(const dvi_space_options *options, dvi_space *space)
{
  space->dimension = options->axes;
  for (int d = 0; d < options->axes; d++) {
    space->lines = d + 1;
    DVI_TRY(dvi__line_create(options, d, &space->line[d]));
    for (int e = 0; e < d; e++)
      if (strcmp(space->line[e].name, space->line[d].name) == 0)
        return dvi__fail(DVI_BAD_ARGUMENT, "space: axes %d and %d have the same name, %s", e, d,
                         space->line[d].name);
  }
  return choose_domain(space);
}

static dvi_status make_space(const dvi_space_options *options, dvi_space *space)
{
  if (options->mesh != NULL) {
    DVI_TRY(dvi__refuse_share(options->mesh, "space: functions on a mesh"));
    space->mesh = dvi_mesh_share(options->mesh);
    space->dimension = dvi_mesh_dimension(options->mesh);
    space->domain = &dvi__simplices;
  } else {
    DVI_TRY(make_lines(options, space));
  }
  return space->domain->create(options, space);
}

dvi_status dvi_space_create(const dvi_space_options *options, dvi_space **space)
{
  if (space == NULL) return dvi__fail(DVI_BAD_ARGUMENT, "space: the place for the space is NULL");
  *space = NULL;
  if (options == NULL) return dvi__fail(DVI_BAD_ARGUMENT, "space: the options are NULL");
  DVI_TRY(check_options(options));
  dvi_space *made = DVI_NEW(dvi_space, 1);
  if (made == NULL) return dvi__fail(DVI_NO_MEMORY, "space: no memory");
  atomic_init(&made->owners, 1);
  const dvi_status status = make_space(options, made);
  if (status == DVI_OK)
    *space = made;
  else
    dvi_space_destroy(&made);
  return status;
}

dvi_space *dvi_space_share(const dvi_space *space)
{
  dvi_space *shared = (dvi_space *)space;
  if (shared != NULL) atomic_fetch_add(&shared->owners, 1);
  return shared;
}

void dvi_space_destroy(dvi_space **space)
{
  if (space == NULL || *space == NULL) return;
  dvi_space *s = *space;
  *space = NULL;
  if (atomic_fetch_sub(&s->owners, 1) > 1) return;
  if (s->domain != NULL && s->domain->destroy != NULL) s->domain->destroy(s->own);
  for (int i = 0; i < s->parts; i++) dvi__release(s->part[i].function);
  dvi__release(s->part);
  dvi__release(s->x);
  dvi__release(s->weight);
  for (int d = 0; d < s->lines; d++) dvi__line_clear(&s->line[d]);
  dvi_mesh_destroy(&s->mesh);
  dvi__release(s);
}

/* ---- what it tells ---- */

int dvi_space_dimension(const dvi_space *space)
{
  return space != NULL ? space->dimension : 0;
}

const char *dvi_space_axis(const dvi_space *space, int d)
{
  if (space == NULL || d < 0 || d >= space->dimension) return NULL;
  return space->mesh != NULL ? coordinate[d] : space->line[d].name;
}

int64_t dvi_space_functions(const dvi_space *space)
{
  return space != NULL ? space->functions : 0;
}

int dvi_space_smoothness(const dvi_space *space, int d)
{
  return space != NULL && d >= 0 && d < space->dimension ? space->smoothness[d] : 0;
}

int64_t dvi_space_points(const dvi_space *space, const double **x, const double **weight)
{
  if (x != NULL) *x = space != NULL ? space->x : NULL;
  if (weight != NULL) *weight = space != NULL ? space->weight : NULL;
  return space != NULL ? space->points : 0;
}

const int *dvi_space_boundary(const dvi_space *space, const char *part, int64_t *count)
{
  if (count != NULL) *count = 0;
  if (space == NULL || part == NULL || count == NULL) return NULL;
  for (int i = 0; i < space->parts; i++) {
    if (strcmp(space->part[i].name, part) != 0) continue;
    *count = space->part[i].count;
    return space->part[i].function;
  }
  return NULL;
}

void dvi_space_explain(const dvi_space *space, char *text, size_t size)
{
  dvi__note note = {text, size, 0};
  if (text == NULL || size == 0) return;
  text[0] = '\0';
  if (space == NULL) return;
  space->domain->explain(space, &note);
}

int dvi__space_is_fourier(const dvi_space *space)
{
  return space->domain->matrix == NULL;
}

int dvi__space_is_nodal(const dvi_space *space)
{
  return space->is_nodal;
}

int64_t dvi__space_row_entries(const dvi_space *space)
{
  return space->row_entries;
}
