/* The formats that can be read. */
#ifndef DVI_FIELD_MESH_FILE_FORMATS_H
#define DVI_FIELD_MESH_FILE_FORMATS_H
#include "field/mesh/file/raw.h"

/* Read a whole file of the format into an empty raw mesh. */
dvi_status dvi__read_msh(dvi__reader *r, dvi__raw *raw);
dvi_status dvi__read_off(dvi__reader *r, dvi__raw *raw);
dvi_status dvi__read_ply(dvi__reader *r, dvi__raw *raw);

/* Read a mesh from the bytes of a file, as dvi_mesh_read does. The path serves for messages. */
dvi_status dvi__mesh_parse(const char *path, const unsigned char *byte, size_t size,
                           const dvi_mesh_read_options *options, dvi_mesh **mesh);

#endif
