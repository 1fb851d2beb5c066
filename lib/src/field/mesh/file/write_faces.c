/* OFF and PLY as text: points and faces. */
#include "field/mesh/file/write.h"

static void put_points(const dvi_mesh *mesh, dvi__sink *sink)
{
  for (int64_t v = 0; v < mesh->count[0]; v++) dvi__put_point(sink, mesh, v);
}

static void put_faces(const dvi_mesh *mesh, dvi__sink *sink)
{
  const dvi__shape shape = dvi__shape_of(mesh->kind, 2);
  const int corners = dvi__shape_facts_of[shape].corners;
  int vertex[DVI__CORNERS];
  for (int64_t c = 0; c < mesh->count[2]; c++) {
    dvi__oriented_cell(mesh, 2, c, vertex);
    dvi__put(sink, "\n%d", corners);
    for (int i = 0; i < corners; i++) dvi__put(sink, " %d", vertex[dvi__corner_in_file(shape, i)]);
  }
  dvi__put(sink, "\n");
}

dvi_status dvi__write_off(const dvi_mesh *mesh, int views, const dvi_view *view, dvi__sink *sink)
{
  (void)views;
  (void)view;
  dvi__put(sink, "OFF\n%lld %lld 0", (long long)mesh->count[0], (long long)mesh->count[2]);
  put_points(mesh, sink);
  put_faces(mesh, sink);
  return DVI_OK;
}

dvi_status dvi__write_ply(const dvi_mesh *mesh, int views, const dvi_view *view, dvi__sink *sink)
{
  (void)views;
  (void)view;
  dvi__put(sink, "ply\nformat ascii 1.0\nelement vertex %lld\n", (long long)mesh->count[0]);
  dvi__put(sink, "property double x\nproperty double y\nproperty double z\n");
  dvi__put(sink, "element face %lld\nproperty list uchar int vertex_indices\nend_header",
           (long long)mesh->count[2]);
  put_points(mesh, sink);
  put_faces(mesh, sink);
  return DVI_OK;
}
