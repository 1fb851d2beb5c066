/* The formats that can be written. */
#ifndef DVI_FIELD_MESH_FILE_WRITE_H
#define DVI_FIELD_MESH_FILE_WRITE_H
#include "field/mesh/file/shapes.h"
#include "field/mesh/file/sink.h"
#include "field/mesh/mesh.h"

/* Put a mesh of up to three dimensions and coordinates in a format. Only VTU has views. Surfaces
 * alone go into OFF and PLY. */
dvi_status dvi__write_msh(const dvi_mesh *mesh, int views, const dvi_view *view, dvi__sink *sink);
dvi_status dvi__write_off(const dvi_mesh *mesh, int views, const dvi_view *view, dvi__sink *sink);
dvi_status dvi__write_ply(const dvi_mesh *mesh, int views, const dvi_view *view, dvi__sink *sink);
dvi_status dvi__write_vtu(const dvi_mesh *mesh, int views, const dvi_view *view, dvi__sink *sink);

/* Put the coordinates of a vertex, three of them. */
void dvi__put_point(dvi__sink *sink, const dvi_mesh *mesh, int64_t vertex);

/* Give the vertices of a k-cell in their order in the mesh, but simplices of degree n so that all
 * have one orientation. */
void dvi__oriented_cell(const dvi_mesh *mesh, int k, int64_t cell, int *vertex);

#endif
