#include "support/mesh_files.h"

#include <string.h>

#include "support/suite.h"

static const char msh2_text[] = "$MeshFormat\n"
                                "2.2 0 8\n"
                                "$EndMeshFormat\n"
                                "$PhysicalNames\n"
                                "1\n"
                                "1 3 \"left wall\"\n"
                                "$EndPhysicalNames\n"
                                "$Nodes\n"
                                "5\n"
                                "20 1 1 0\n"
                                "10 0 0 0\n"
                                "40 0 1e0 0\n"
                                "30 1.0 0 -0.0\n"
                                "50 9 9 9\n"
                                "$EndNodes\n"
                                "$Elements\n"
                                "4\n"
                                "1 15 2 0 1 50\n"
                                "7 1 2 3 1 40 10\n"
                                "9 2 2 5 1 10 20 40\n"
                                "8 2 2 0 1 10 30 20\n"
                                "$EndElements\n";

static const char msh4_text[] = "$MeshFormat\n"
                                "4.1 0 8\n"
                                "$EndMeshFormat\n"
                                "$Comments\n"
                                "$Nodes are below\n"
                                "$EndComments\n"
                                "$PhysicalNames\n"
                                "1\n"
                                "1 3 \"left wall\"\n"
                                "$EndPhysicalNames\n"
                                "$Entities\n"
                                "1 1 2 0\n"
                                "6 9 9 9 0\n"
                                "2 0 0 0 0 1 0 1 3 2 1 -2\n"
                                "1 0 0 0 1 1 0 0 0\n"
                                "4 0 0 0 1 1 0 1 -5 1 2\n"
                                "$EndEntities\n"
                                "$Nodes\n"
                                "3 5 10 50\n"
                                "0 6 0 1\n"
                                "50\n"
                                "9 9 9\n"
                                "1 2 1 2\n"
                                "40\n"
                                "10\n"
                                "0 1 0 0.5\n"
                                "0 0 0 0.25\n"
                                "2 1 0 2\n"
                                "20\n"
                                "30\n"
                                "1 1 0\n"
                                "1 0 0\n"
                                "$EndNodes\n"
                                "$Elements\n"
                                "4 4 1 9\n"
                                "0 6 15 1\n"
                                "1 50\n"
                                "1 2 1 1\n"
                                "7 40 10\n"
                                "2 4 2 1\n"
                                "9 10 20 40\n"
                                "2 1 2 1\n"
                                "8 10 30 20\n"
                                "$EndElements\n";

static const char off_text[] = "# a square\n"
                               "OFF 4 2 0 # points, faces, edges\n"
                               "0 0 0\n"
                               "1 1 0\n"
                               "1 0 0\n"
                               "\n"
                               "0 1 0\n"
                               "3 0 2 1\n"
                               "3 0 1 3 255 0 0\n";

static const char ply_text[] = "ply\n"
                               "format ascii 1.0\n"
                               "comment a square\n"
                               "element vertex 4\n"
                               "property uchar red\n"
                               "property float x\n"
                               "property float y\n"
                               "property list uchar short more\n"
                               "element face 2\n"
                               "property list uchar int vertex_indices\n"
                               "property int mark\n"
                               "element edge 1\n"
                               "property uint vertex1\n"
                               "end_header\n"
                               "1 0 0 0\n"
                               "2 1 1 1 5\n"
                               "3 1 0 2 6 7\n"
                               "4 0 1 0\n"
                               "3 0 2 1 -1\n"
                               "3 0 1 3 -2\n"
                               "7\n";

/* ---- binary files ---- */

typedef struct buffer {
  size_t size;
  unsigned char at[2048];
} buffer;

static void put_text(buffer *b, const char *text)
{
  ck_assert_uint_le(b->size + strlen(text), sizeof b->at);
  memcpy(b->at + b->size, text, strlen(text));
  b->size += strlen(text);
}

static void put_integers(buffer *b, int width, int count, const int *value)
{
  ck_assert_uint_le(b->size + (size_t)(width * count), sizeof b->at);
  for (int i = 0; i < count; i++)
    for (int k = 0; k < width; k++)
      b->at[b->size++] = (unsigned char)((long long)value[i] >> (8 * k) & 255);
}

static void put_reals(buffer *b, int count, const double *value)
{
  for (int i = 0; i < count; i++) {
    unsigned long long bits;
    memcpy(&bits, value + i, sizeof bits);
    const int half[] = {(int)(unsigned)(bits & 0xFFFFFFFFU), (int)(unsigned)(bits >> 32)};
    put_integers(b, 4, 2, half);
  }
}

#define INTS(...)                                        \
  4, sizeof((int[]){__VA_ARGS__}) / sizeof(int), (int[]) \
  {                                                      \
    __VA_ARGS__                                          \
  }
#define LONGS(...)                                       \
  8, sizeof((int[]){__VA_ARGS__}) / sizeof(int), (int[]) \
  {                                                      \
    __VA_ARGS__                                          \
  }
#define BYTES(...)                                       \
  1, sizeof((int[]){__VA_ARGS__}) / sizeof(int), (int[]) \
  {                                                      \
    __VA_ARGS__                                          \
  }
#define REALS(...)                                             \
  sizeof((double[]){__VA_ARGS__}) / sizeof(double), (double[]) \
  {                                                            \
    __VA_ARGS__                                                \
  }

static void put_head(buffer *b, const char *version)
{
  put_text(b, "$MeshFormat\n");
  put_text(b, version);
  put_text(b, " 1 8\n");
  put_integers(b, INTS(1));
  put_text(b, "\n$EndMeshFormat\n$PhysicalNames\n1\n1 3 \"left wall\"\n$EndPhysicalNames\n");
}

static void put_node(buffer *b, int tag, double x, double y, double z)
{
  put_integers(b, INTS(tag));
  put_reals(b, REALS(x, y, z));
}

static void make_msh2(buffer *b)
{
  put_head(b, "2.2");
  put_text(b, "$Nodes\n5\n");
  put_node(b, 20, 1, 1, 0);
  put_node(b, 10, 0, 0, 0);
  put_node(b, 40, 0, 1, 0);
  put_node(b, 30, 1, 0, 0);
  put_node(b, 50, 9, 9, 9);
  put_text(b, "\n$EndNodes\n$Elements\n4\n");
  put_integers(b, INTS(15, 1, 2, 1, 0, 1, 50));
  put_integers(b, INTS(1, 1, 2, 7, 3, 1, 40, 10));
  put_integers(b, INTS(2, 2, 2, 9, 5, 1, 10, 20, 40, 8, 0, 1, 10, 30, 20));
  put_text(b, "\n$EndElements\n");
}

static void put_entities(buffer *b)
{
  put_text(b, "$Entities\n");
  put_integers(b, LONGS(1, 1, 2, 0));
  put_integers(b, INTS(6));
  put_reals(b, REALS(9, 9, 9));
  put_integers(b, LONGS(0));
  put_integers(b, INTS(2));
  put_reals(b, REALS(0, 0, 0, 0, 1, 0));
  put_integers(b, LONGS(1));
  put_integers(b, INTS(3));
  put_integers(b, LONGS(2));
  put_integers(b, INTS(1, -2));
  put_integers(b, INTS(1));
  put_reals(b, REALS(0, 0, 0, 1, 1, 0));
  put_integers(b, LONGS(0, 0));
  put_integers(b, INTS(4));
  put_reals(b, REALS(0, 0, 0, 1, 1, 0));
  put_integers(b, LONGS(1));
  put_integers(b, INTS(-5));
  put_integers(b, LONGS(1));
  put_integers(b, INTS(2));
  put_text(b, "\n$EndEntities\n");
}

static void make_msh4(buffer *b)
{
  put_head(b, "4.1");
  put_entities(b);
  put_text(b, "$Nodes\n");
  put_integers(b, LONGS(3, 5, 10, 50));
  put_integers(b, INTS(0, 6, 0));
  put_integers(b, LONGS(1, 50));
  put_reals(b, REALS(9, 9, 9));
  put_integers(b, INTS(1, 2, 1));
  put_integers(b, LONGS(2, 40, 10));
  put_reals(b, REALS(0, 1, 0, 0.5, 0, 0, 0, 0.25));
  put_integers(b, INTS(2, 1, 0));
  put_integers(b, LONGS(2, 20, 30));
  put_reals(b, REALS(1, 1, 0, 1, 0, 0));
  put_text(b, "\n$EndNodes\n$Elements\n");
  put_integers(b, LONGS(4, 4, 1, 9));
  put_integers(b, INTS(0, 6, 15));
  put_integers(b, LONGS(1, 1, 50));
  put_integers(b, INTS(1, 2, 1));
  put_integers(b, LONGS(1, 7, 40, 10));
  put_integers(b, INTS(2, 4, 2));
  put_integers(b, LONGS(1, 9, 10, 20, 40));
  put_integers(b, INTS(2, 1, 2));
  put_integers(b, LONGS(1, 8, 10, 30, 20));
  put_text(b, "\n$EndElements\n");
}

static void put_vertex(buffer *b, int red, double x, double y)
{
  put_integers(b, BYTES(red));
  put_reals(b, REALS(x));
  put_integers(b, 2, 1, (int[]){(int)y});
}

static void make_ply(buffer *b)
{
  put_text(b, "ply\nformat binary_little_endian 1.0\nelement vertex 4\nproperty uchar red\n"
              "property double x\nproperty short y\nelement face 2\n"
              "property list uchar uint vertex_index\nproperty list ushort float more\n"
              "end_header\n");
  put_vertex(b, 1, 0, 0);
  put_vertex(b, 2, 1, 1);
  put_vertex(b, 3, 1, 0);
  put_vertex(b, 4, 0, 1);
  put_integers(b, BYTES(3));
  put_integers(b, INTS(0, 2, 1));
  put_integers(b, BYTES(0, 0));
  put_integers(b, BYTES(3));
  put_integers(b, INTS(0, 1, 3));
  put_integers(b, BYTES(1, 0));
  put_integers(b, INTS(0x3F800000));
}

static mesh_file of_buffer(const char *format, void (*make)(buffer *b), buffer *b, size_t spare,
                           int has_parts)
{
  if (b->size == 0) make(b);
  return (mesh_file){format, b->at, b->size, spare, has_parts};
}

static mesh_file of_text(const char *format, const char *text, size_t spare, int has_parts)
{
  return (mesh_file){format, (const unsigned char *)text, strlen(text), spare, has_parts};
}

mesh_file file_of_square(int i)
{
  static buffer msh2, msh4, ply;
  switch (i) {
  case MSH2_TEXT: return of_text("msh", msh2_text, 1, 1);
  case MSH4_TEXT: return of_text("msh", msh4_text, 1, 1);
  case OFF_TEXT: return of_text("off", off_text, strlen(" 255 0 0\n"), 0);
  case PLY_TEXT: return of_text("ply", ply_text, 1, 0);
  case MSH2_BINARY: return of_buffer("msh", make_msh2, &msh2, 1, 1);
  case MSH4_BINARY: return of_buffer("msh", make_msh4, &msh4, 1, 1);
  default: return of_buffer("ply", make_ply, &ply, 0, 0);
  }
}
