/* OFF (Geomview): the numbers of points, faces and edges, the points, then each face as the number
 * of its corners and these corners. What follows them in a line is a colour. */
#include <string.h>

#include "field/mesh/file/formats.h"

/* Return the shape of a face by the number of its corners, or DVI__SHAPES. */
static dvi__shape shape_of_face(int64_t corners)
{
  static const dvi__shape shape[] = {DVI__SHAPES, DVI__POINT, DVI__LINE, DVI__TRIANGLE,
                                     DVI__QUADRANGLE};
  return corners <= 4 ? shape[corners] : DVI__SHAPES;
}

static dvi_status read_head(dvi__reader *r, int64_t *points, int64_t *faces)
{
  dvi__word word;
  int64_t edges;
  DVI_TRY(dvi__expect_word(r, "OFF"));
  const size_t behind = r->at;
  DVI_TRY(dvi__read_word(r, "the number of points", &word));
  if (strcmp(word.text, "BINARY") == 0)
    return dvi__reject(r, r->mark, "binary OFF cannot be read: save the file as text");
  r->at = behind;
  DVI_TRY(dvi__read_text_integer(r, "the number of points", 0, INT32_MAX, points));
  DVI_TRY(dvi__claim(r, "points", *points, 6, 6));
  DVI_TRY(dvi__read_text_integer(r, "the number of faces", 0, INT32_MAX, faces));
  DVI_TRY(dvi__claim(r, "faces", *faces, 4, 4));
  return dvi__read_text_integer(r, "the number of edges", 0, INT64_MAX, &edges);
}

static dvi_status read_face(dvi__reader *r, dvi__raw *raw, int64_t face)
{
  int64_t count, corner[DVI__SHAPE_CORNERS];
  DVI_TRY(dvi__read_text_integer(r, "the number of a face's corners", 1, INT32_MAX, &count));
  const size_t place = r->mark;
  const dvi__shape shape = shape_of_face(count);
  if (shape == DVI__SHAPES)
    return dvi__reject(r, place,
                       "a face has %lld corners: only triangles and quadrangles can be read",
                       (long long)count);
  for (int64_t c = 0; c < count; c++)
    DVI_TRY(dvi__read_text_integer(r, "a corner of a face", 0, INT32_MAX, corner + c));
  DVI_TRY(dvi__raw_add_element(raw, shape, face, place, corner));
  dvi__skip_line(r);
  return DVI_OK;
}

dvi_status dvi__read_off(dvi__reader *r, dvi__raw *raw)
{
  int64_t points = 0, faces = 0;
  dvi__word word;
  double x[3];
  r->comment = '#';
  DVI_TRY(read_head(r, &points, &faces));
  for (int64_t i = 0; i < points; i++) {
    for (int axis = 0; axis < 3; axis++) DVI_TRY(dvi__read_real(r, "a coordinate", x + axis));
    DVI_TRY(dvi__raw_add_point(raw, i, r->mark, x));
  }
  for (int64_t i = 0; i < faces; i++) DVI_TRY(read_face(r, raw, i));
  if (!dvi__skip_blanks(r)) return DVI_OK;
  DVI_TRY(dvi__read_word(r, "the end of the file", &word));
  return dvi__reject(r, r->mark, "found \"%s\" behind the last face, where the file should end",
                     word.text);
}
