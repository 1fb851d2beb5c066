/* Writing a mesh: which format is wanted, and whether it can hold the mesh. */
#include "field/mesh/file/write.h"

#include <limits.h>
#include <math.h>
#include <string.h>

#include "field/mesh/share.h"

/* A format, with what it can hold. */
typedef struct format {
  const char *end, *name, *whole; /* the last one for sentences about shares */
  int is_surface;                 /* nothing but cells of two dimensions */
  int has_periods, has_views;
  dvi_status (*write)(const dvi_mesh *mesh, int views, const dvi_view *view, dvi__sink *sink);
} format;
static const format formats[] = {
    {".msh", "MSH", "mesh file: MSH", 0, 1, 0, dvi__write_msh},
    {".off", "OFF", "mesh file: OFF", 1, 0, 0, dvi__write_off},
    {".ply", "PLY", "mesh file: PLY", 1, 0, 0, dvi__write_ply},
    {".vtu", "VTU", "mesh file: VTU", 0, 1, 1, dvi__write_vtu},
};
enum { FORMATS = sizeof formats / sizeof *formats };

/* ---- shared by the formats ---- */

void dvi__put_point(dvi__sink *sink, const dvi_mesh *mesh, int64_t vertex)
{
  for (int axis = 0; axis < 3; axis++)
    dvi__put_real(sink, axis > 0 ? ' ' : '\n',
                  axis < mesh->space ? mesh->point[vertex * mesh->space + axis] : 0);
}

void dvi__oriented_cell(const dvi_mesh *mesh, int k, int64_t cell, int *vertex)
{
  const int corners = dvi__corners(mesh->kind, k);
  if (k == 0)
    *vertex = (int)cell;
  else
    memcpy(vertex, mesh->corner[k] + cell * corners, (size_t)corners * sizeof *vertex);
  if (k < mesh->n || mesh->kind != DVI_SIMPLICES || mesh->orientation == NULL) return;
  if (mesh->orientation[cell] > 0) return;
  const int last = vertex[k];
  vertex[k] = vertex[k - 1];
  vertex[k - 1] = last;
}

/* ---- checks ---- */

static int ends_with(const char *text, const char *end)
{
  const size_t length = strlen(text), behind = strlen(end);
  return length > behind && strcmp(text + length - behind, end) == 0;
}

static dvi_status find_format(const char *path, const format **found)
{
  for (int i = 0; i < FORMATS; i++)
    if (ends_with(path, formats[i].end)) {
      *found = formats + i;
      return DVI_OK;
    }
  return dvi__fail(DVI_BAD_OPTION,
                   "cannot tell the format of %.300s: its name must end with .msh, .off, .ply or "
                   ".vtu",
                   path);
}

static int repeats_itself(const dvi_mesh *mesh)
{
  int i = 0;
  while (i < mesh->space && mesh->period[i] == 0) i++;
  return i < mesh->space;
}

static dvi_status check_mesh(const format *f, const dvi_mesh *mesh)
{
  if (mesh->n > 3 || mesh->space > 3)
    return dvi__fail(DVI_UNSUPPORTED,
                     "%s cannot hold a mesh of dimension %d in %d coordinates, but 3 at most",
                     f->name, mesh->n, mesh->space);
  if (f->is_surface && mesh->n != 2)
    return dvi__fail(DVI_UNSUPPORTED,
                     "%s cannot hold a mesh of dimension %d, but only surfaces: take .msh or .vtu",
                     f->name, mesh->n);
  if (!f->has_periods && repeats_itself(mesh))
    return dvi__fail(DVI_UNSUPPORTED,
                     "%s cannot hold a mesh in a space that repeats itself: take .msh or .vtu",
                     f->name);
  return f->has_views ? DVI_OK : dvi__refuse_share(mesh, f->whole);
}

static int has_control_characters(const char *name)
{
  for (; *name != 0; name++)
    if ((unsigned char)*name < ' ') return 1;
  return 0;
}

static dvi_status check_view(const dvi_mesh *mesh, const dvi_view *view, int i)
{
  const dvi_view *v = view + i;
  if (v->name == NULL || v->name[0] == 0 || has_control_characters(v->name))
    return dvi__fail(DVI_BAD_ARGUMENT, "view %d: a name of printable characters is needed", i);
  for (int j = 0; j < i; j++)
    if (strcmp(view[j].name, v->name) == 0 && view[j].degree == v->degree)
      return dvi__fail(DVI_BAD_ARGUMENT, "there are two views with the name \"%.64s\"", v->name);
  if (v->values == NULL || v->components < 1)
    return dvi__fail(DVI_BAD_ARGUMENT, "view \"%.64s\": needs values, with 1 component or more",
                     v->name);
  if (v->degree != 0 && v->degree != mesh->n)
    return dvi__fail(
        DVI_BAD_ARGUMENT,
        "view \"%.64s\": the degree is %d, and must be 0 for vertices, or %d for cells", v->name,
        v->degree, mesh->n);
  return DVI_OK;
}

static dvi_status check_views(const format *f, const dvi_mesh *mesh, int views,
                              const dvi_view *view)
{
  if (views < 0 || (views > 0 && view == NULL))
    return dvi__fail(DVI_BAD_ARGUMENT, "%d views, but none is given", views);
  if (views > 0 && !f->has_views)
    return dvi__fail(DVI_UNSUPPORTED, "%s cannot hold views: take .vtu", f->name);
  for (int i = 0; i < views; i++) DVI_TRY(check_view(mesh, view, i));
  return DVI_OK;
}

static dvi_status check(const dvi_mesh *mesh, const char *path, int views, const dvi_view *view,
                        const format **f)
{
  if (path == NULL) return dvi__fail(DVI_BAD_ARGUMENT, "mesh file: a mesh and a path are needed");
  DVI_TRY(find_format(path, f));
  DVI_TRY(check_mesh(*f, mesh));
  return check_views(*f, mesh, views, view);
}

/* The first one of several processes writes the whole mesh. */
dvi_status dvi_mesh_write(const dvi_mesh *mesh, const char *path, int views, const dvi_view *view)
{
  const format *f = NULL;
  dvi__sink sink = {.at = NULL};
  if (mesh == NULL) return dvi__fail(DVI_BAD_ARGUMENT, "mesh file: a mesh and a path are needed");
  DVI_TRY(dvi__agree(mesh, check(mesh, path, views, view, &f)));
  dvi_status status = dvi__is_first(mesh) ? dvi__sink_begin(&sink, path) : DVI_OK;
  status = dvi__agree(mesh, status);
  if (status == DVI_OK && f != NULL) status = f->write(mesh, views, view, &sink);
  return dvi__agree(mesh, dvi__sink_finish(&sink, status));
}

static dvi_status check_points(const dvi_mesh *mesh, const double *point)
{
  if (point == NULL) return dvi__fail(DVI_BAD_ARGUMENT, "mesh file: points are needed");
  for (int64_t i = 0; i < mesh->count[0] * mesh->space; i++)
    if (!isfinite(point[i]))
      return dvi__fail(DVI_BAD_ARGUMENT, "mesh file: a coordinate of vertex %lld is %g",
                       (long long)dvi__whole_number(mesh, 0, i / mesh->space), point[i]);
  return DVI_OK;
}

dvi_status dvi_mesh_write_moved(const dvi_mesh *mesh, const double *point, const char *path,
                                int views, const dvi_view *view)
{
  if (mesh == NULL) return dvi__fail(DVI_BAD_ARGUMENT, "mesh file: a mesh and a path are needed");
  DVI_TRY(dvi__agree(mesh, check_points(mesh, point)));
  dvi_mesh moved = *mesh;
  moved.point = (double *)point;
  return dvi_mesh_write(&moved, path, views, view);
}

/* ---- series ---- */

static dvi_status check_series(const char *path, int64_t count, const double *time,
                               const char *const *file)
{
  if (path == NULL || count < 0 || (count > 0 && (time == NULL || file == NULL)))
    return dvi__fail(DVI_BAD_ARGUMENT, "series: a path, times and files are needed");
  if (!ends_with(path, ".pvd"))
    return dvi__fail(DVI_BAD_OPTION, "the name of a series, %.300s, must end with .pvd", path);
  for (int64_t i = 0; i < count; i++) {
    if (!isfinite(time[i]))
      return dvi__fail(DVI_BAD_ARGUMENT, "series: time %lld is %g, and must be finite",
                       (long long)i, time[i]);
    if (file[i] == NULL || file[i][0] == 0 || has_control_characters(file[i]))
      return dvi__fail(DVI_BAD_ARGUMENT, "series: file %lld needs a name of printable characters",
                       (long long)i);
  }
  return DVI_OK;
}

dvi_status dvi_series_write(const char *path, int64_t count, const double *time,
                            const char *const *file)
{
  dvi__sink sink = {.at = NULL};
  DVI_TRY(check_series(path, count, time, file));
  const dvi_status begun = dvi__sink_begin(&sink, path);
  dvi__put(&sink, "<?xml version=\"1.0\"?>\n"
                  "<VTKFile type=\"Collection\" version=\"0.1\" byte_order=\"LittleEndian\">\n"
                  "  <Collection>\n");
  for (int64_t i = 0; i < count; i++) {
    dvi__put(&sink, "    <DataSet timestep=");
    dvi__put_real(&sink, '"', time[i]);
    dvi__put(&sink, "\" group=\"\" part=\"0\" file=\"");
    dvi__put_xml(&sink, file[i]);
    dvi__put(&sink, "\"/>\n");
  }
  dvi__put(&sink, "  </Collection>\n</VTKFile>\n");
  return dvi__sink_finish(&sink, begun);
}
