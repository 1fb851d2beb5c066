/* Reading meshes: one mesh in all formats, cut files, wrong files, and options. */
#include <dvi/mesh.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "core/memory.h"
#include "field/mesh/file/formats.h"
#include "support/comma.h"
#include "support/files.h"
#include "support/mesh_files.h"
#include "support/suite.h"

static dvi_status parse(const void *at, size_t size, const dvi_mesh_read_options *options,
                        dvi_mesh **mesh)
{
  return dvi__mesh_parse("m", at, size, options, mesh);
}

static dvi_mesh *parsed(const char *text, const dvi_mesh_read_options *options)
{
  dvi_mesh *mesh = NULL;
  ck_assert_msg(parse(text, strlen(text), options, &mesh) == DVI_OK, "%s", dvi_last_error());
  return mesh;
}

/* ---- the square ---- */

static void check_part(const dvi_mesh *mesh, int i, const char *name, int degree, int cell)
{
  int64_t count;
  ck_assert_str_eq(dvi_mesh_part_name(mesh, i), name);
  ck_assert_int_eq(dvi_mesh_part_degree(mesh, i), degree);
  ck_assert_int_eq(*dvi_mesh_part_cells(mesh, name, degree, &count), cell);
  ck_assert_int_eq(count, 1);
}

static void check_square(const dvi_mesh *mesh, int has_parts)
{
  static const double point[] = {0, 0, 1, 1, 1, 0, 0, 1};
  static const int triangle[] = {0, 1, 2, 0, 1, 3};
  ck_assert_int_eq(dvi_mesh_dimension(mesh), 2);
  ck_assert_int_eq(dvi_mesh_space(mesh), 2);
  ck_assert_int_eq(dvi_mesh_count(mesh, 0), 4);
  ck_assert_int_eq(dvi_mesh_count(mesh, 2), 2);
  for (int i = 0; i < 8; i++) ck_assert_double_eq(dvi_mesh_points(mesh)[i], point[i]);
  ck_assert_mem_eq(dvi_mesh_vertices(mesh, 2, NULL), triangle, sizeof triangle);
  ck_assert_int_eq(dvi_mesh_orientation(mesh)[0], -1);
  ck_assert_int_eq(dvi_mesh_orientation(mesh)[1], 1);
  if (has_parts) {
    check_part(mesh, 2, "group 5", 2, 1);
    check_part(mesh, 3, "left wall", 1, 2);
  }
  ck_assert_ptr_null(dvi_mesh_part_name(mesh, has_parts ? 4 : 2));
}

START_TEST(all_formats_have_the_same_mesh)
{
  const mesh_file file = file_of_square(_i);
  dvi_mesh *mesh;
  const char *path = path_in_folder("square");
  write_bytes(path, file.at, file.size);
  ck_assert_msg(dvi_mesh_read(path, NULL, &mesh) == DVI_OK, "%s", dvi_last_error());
  check_square(mesh, file.has_parts);
  dvi_mesh_destroy(&mesh);
  const dvi_mesh_read_options options = {.size = sizeof options, .format = file.format};
  ck_assert_int_eq(dvi_mesh_read(path, &options, &mesh), DVI_OK);
  check_square(mesh, file.has_parts);
  dvi_mesh_destroy(&mesh);
}
END_TEST

/* The memory ends with the part of the file, so that sanitizers see a byte read behind it. */
START_TEST(a_cut_file_is_refused_unless_nothing_needed_is_cut)
{
  const mesh_file file = file_of_square(_i);
  for (size_t size = 0; size < file.size; size++) {
    dvi_mesh *mesh;
    unsigned char *part = malloc(size > 0 ? size : 1);
    memcpy(part, file.at, size);
    const dvi_status status = parse(part, size, NULL, &mesh);
    if (size + file.spare >= file.size) {
      ck_assert_msg(status == DVI_OK, "%s", dvi_last_error());
      check_square(mesh, file.has_parts);
      dvi_mesh_destroy(&mesh);
    } else {
      ck_assert_msg(status == DVI_BAD_FILE, "%zu bytes give %d", size, (int)status);
      ck_assert_ptr_null(mesh);
      ck_assert(strncmp(dvi_last_error(), "m:", 2) == 0 && strlen(dvi_last_error()) > 20);
    }
    free(part);
  }
}
END_TEST

START_TEST(a_file_is_read_or_memory_is_missing)
{
  const mesh_file file = file_of_square(_i);
  dvi_mesh *mesh = NULL;
  for (long successes = 0; mesh == NULL; successes++) {
    dvi__fail_allocations_after(successes);
    const dvi_status status = parse(file.at, file.size, NULL, &mesh);
    dvi__fail_allocations_after(-1);
    ck_assert_int_eq(status, mesh != NULL ? DVI_OK : DVI_NO_MEMORY);
  }
  check_square(mesh, file.has_parts);
  dvi_mesh_destroy(&mesh);
}
END_TEST

START_TEST(numbers_are_the_same_with_a_decimal_comma)
{
  const mesh_file file = file_of_square(MSH2_TEXT);
  dvi_mesh *mesh = NULL;
  set_comma_locale();
  const dvi_status status = parse(file.at, file.size, NULL, &mesh);
  set_point_locale();
  ck_assert_int_eq(status, DVI_OK);
  check_square(mesh, 1);
  dvi_mesh_destroy(&mesh);
}
END_TEST

/* ---- wrong files: the first occurrence of some words is replaced by others ---- */

static const struct {
  int file;
  const char *from, *to, *words;
} refusals[] = {
    {MSH2_TEXT, "$MeshFormat", "solid", "m:1: found \"solid\" where $MeshFormat (MSH), OFF or ply"},
    {MSH2_TEXT, "2.2", "4.0", "m:2: the file has version \"4.0\" of the format: only 2.2"},
    {MSH2_TEXT, "0 8", "0 4", "m:2: the size of numbers is 4, and must be 8"},
    {MSH2_TEXT, "0 8", "1 8", "m: byte 20: found the bytes of"},
    {MSH2_TEXT, "\"left", "left", "m:6: expected a name in quotes"},
    {MSH2_TEXT, "wall\"", "wall", "m:6: a name has no quote at its end"},
    {MSH2_TEXT, "left wall", "", "m:6: a group has an empty name"},
    {MSH2_TEXT, "left wall", "l\tw", "m:6: a group's name has the control character 9"},
    {MSH2_TEXT, "left wall", "boundary",
     "m:6: a group has the name \"boundary\", which every mesh"},
    {MSH2_TEXT, "left wall", "group 5", "m: mesh: there are two parts with the name \"group 5\""},
    {MSH2_TEXT, "1 3 \"", "4 3 \"", "m:6: the dimension of a group is 4, and must be 0 to 3"},
    {MSH2_TEXT, "1 3 \"", "1 4 \"", "m:6: the group 4 of dimension 1, \"left wall\", has no elem"},
    {MSH2_TEXT, "1\n1 3 \"left", "2\n1 3 \"right\" 1 3 \"left",
     "m:6: the group 3 of dimension 1 has"},
    {MSH2_TEXT, "1\n1 3", "1000000000\n1 3", "m:5: 1000000000 names are announced, but"},
    {MSH2_TEXT, "\n5\n", "\n1000000000\n",
     "m:9: 1000000000 points are announced, but the file has"},
    {MSH2_TEXT, "\n5\n", "\n6\n",
     "m:15: found \"$EndNodes\" where the number of a point is expected"},
    {MSH2_TEXT, "\n5\n", "\n4\n", "m:14: found \"50\" where $EndNodes is expected"},
    {MSH2_TEXT, "\n5\n", "\n-5\n", "m:9: the number of points is -5, and must be at least 0"},
    {MSH2_TEXT, "\n5\n", "\n5.5\n", "m:9: found \"5.5\" where the number of points is expected"},
    {MSH2_TEXT, "40 0", "10 0", "m:12: a second point has the tag 10"},
    {MSH2_TEXT, "40 0", "-40 0", "m:12: the number of a point is -40, and must be at least 1"},
    {MSH2_TEXT, "1e0", "nan", "m:12: found \"nan\" where a coordinate is expected"},
    {MSH2_TEXT, "1e0", "1e400", "m:12: a coordinate is inf, and must be finite"},
    {MSH2_TEXT, "1e0", "1,0", "m:12: found \"1,0\" where a coordinate is expected"},
    {MSH2_TEXT, "$Elements\n4", "$Elements\n1000000000",
     "m:17: 1000000000 elements are announced, but the file has only 82 bytes more"},
    {MSH2_TEXT, "9 2 2", "9 6 2", "m:20: element type 6 is a prism"},
    {MSH2_TEXT, "9 2 2", "9 9 2", "m:20: element type 9 is a triangle of higher order"},
    {MSH2_TEXT, "9 2 2", "9 99 2", "m:20: element type 99 is not known"},
    {MSH2_TEXT, "9 2 2", "9 -1 2", "m:20: element type -1 is not known"},
    {MSH2_TEXT, "9 2 2", "8 2 2", "m:21: a second element has the tag 8"},
    {MSH2_TEXT, "9 2 2 5 1", "9 3 1 5 30",
     "m:20: the file has triangles and quadrangles: a mesh has cells of one kind only"},
    {MSH2_TEXT, "10 20 40", "10 20 45", "m:20: a triangle has the point 45, and there is no such"},
    {MSH2_TEXT, "10 30 20", "10 30 30", "m: mesh: triangle 0 is degenerate"},
    {MSH2_TEXT, "10 20 40", "10 20 30",
     "m:20: the triangle 9 has the same points as the triangle 8"},
    {MSH2_TEXT, "10 30 20", "10 30 50 7", "m:21: found \"7\""},
    {MSH2_TEXT, "40 10\n", "40 50\n",
     "m:19: a line in a group has the point 50, which no triangle"},
    {MSH2_TEXT, "40 10\n", "40 30\n",
     "m: mesh: part \"left wall\" has edge 0 with the vertices 3, 2"},
    {MSH2_TEXT, "$EndElements\n", "$EndElements\n$Nodes\n0\n$EndNodes\n",
     "m:23: there is a second section $Nodes"},
    {MSH2_TEXT, "$Nodes\n5", "$Elements\n0\n$EndElements\n$Nodes\n5",
     "m:8: $Elements comes before $N"},
    {MSH2_TEXT, "$Nodes\n5", "Nodes\n5",
     "m:8: found \"Nodes\" where a section like $Nodes is expect"},
    {MSH2_TEXT, "$Nodes\n5", "$Knots\n5", "m:8: the section \"$Knots\" has no end \"$EndKnots\""},
    {MSH2_TEXT, "$Nodes\n5", "$Nodes all\n5", "m:8: found \"all\" behind the name of a section"},
    {MSH4_TEXT, "$Comments", "$PartitionedEntities", "m:4: the mesh is partitioned"},
    {MSH4_TEXT, "1 1 2 0", "1 1 1000000000 0", "m:12: 1000000000 entities are announced"},
    {MSH4_TEXT, "1 -5 1 2", "2 5 -5 1 2", "m:16: the entity 4 of dimension 2 is in a group twice"},
    {MSH4_TEXT, "1 -5 1 2", "65 1", "m:16: the number of groups of an entity is 65, and must be 0"},
    {MSH4_TEXT, "4 0 0 0", "1 0 0 0", "m:16: a second entity of dimension 2 has the number 1"},
    {MSH4_TEXT, "2 4 2 1", "2 7 2 1", "m:40: $Entities has no entity 7 of dimension 2"},
    {MSH4_TEXT, "2 4 2 1", "2 4 1 1", "m:40: an entity of dimension 2 has lines"},
    {MSH4_TEXT, "2 4 2 1", "2 4 2 1000000000", "m:40: 1000000000 elements are announced"},
    {MSH4_TEXT, "3 5 10", "3 4 10", "m:32: 4 points are announced, and the blocks have 5"},
    {MSH4_TEXT, "3 5 10", "1000000000 5 10", "m:19: 1000000000 blocks are announced"},
    {MSH4_TEXT, "4 4 1 9", "4 5 1 9", "m:43: 5 elements are announced, and the blocks have 4"},
    {MSH4_TEXT, "4 4 1 9", "4 1000000000 1 9", "m:35: 1000000000 elements are announced"},
    {MSH4_TEXT, "2 1 0 2", "2 1 0 1000000000", "m:28: 1000000000 points are announced"},
    {MSH4_TEXT, "9 10 20", "9223372036854775808 10 20",
     "m:41: found \"9223372036854775808\" where the number of an element is expected"},
    {OFF_TEXT, "OFF", "OFF BINARY", "m:2: binary OFF cannot be read: save the file as text"},
    {OFF_TEXT, "4 2 0", "4 1000000000 0", "m:2: 1000000000 faces are announced, but the file has"},
    {OFF_TEXT, "4 2 0", "4 1 0",
     "m:9: found \"3\" behind the last face, where the file should end"},
    {OFF_TEXT, "4 2 0", "4 3 0", "the file ends where the number of a face's corners is expected"},
    {OFF_TEXT, "3 0 2 1", "3 0 2 4", "m:8: a triangle has the point 4, and there is no such point"},
    {OFF_TEXT, "3 0 2 1", "3 0 2 -1", "m:8: a corner of a face is -1, and must be at least 0"},
    {OFF_TEXT, "3 0 2 1", "5 0 2 1 3 4", "m:8: a face has 5 corners: only triangles and quadrang"},
    {OFF_TEXT, "3 0 2 1", "4 0 2 1 3", "m:8: the file has triangles and quadrangles"},
    {OFF_TEXT, "3 0 1 3", "3 0 2 1", "m: mesh: triangle 1 (vertices 0 1 2) is given twice"},
    {OFF_TEXT, "4 2 0 #", "4 0 0\n1 1 1 0 0 0 1 2 3 1 2 4 #", "m:4: found \"0\" behind the last"},
    {PLY_TEXT, "ascii", "binary_big_endian", "m:2: the format is \"binary_big_endian\", and only"},
    {PLY_TEXT, "1.0", "2.0", "m:2: found \"2.0\" where 1.0 is expected"},
    {PLY_TEXT, "float x", "half x", "m:6: found \"half\" where the type of a property is expected"},
    {PLY_TEXT, "float x", "float X", "has no element vertex with the properties x and y"},
    {PLY_TEXT, "float y", "float x", "m:7: the element \"vertex\" has a second property \"x\""},
    {PLY_TEXT, "element face", "element vertex", "m:9: there is a second element \"vertex\""},
    {PLY_TEXT, "element face", "element facet", "has no element face with a list vertex_indices"},
    {PLY_TEXT, "face 2", "face 1000000000", "1000000000 elements are announced"},
    {PLY_TEXT, "comment a square\n", "property int x\n",
     "m:3: a property comes before all elements"},
    {PLY_TEXT, "comment", "commend",
     "m:3: found \"commend\" where element, property or end_header"},
    {PLY_TEXT, "list uchar int", "list float int", "m:10: the length of a list is no integer"},
    {PLY_TEXT, "3 0 2 1", "2 0 2", "m:19: a face has 2 corners: only triangles and quadrangles"},
    {PLY_TEXT, "3 0 2 1", "3 0 2 9",
     "m:19: a triangle has the point 9, and there is no such point"},
    {PLY_TEXT, "2 1 1 1 5", "2 nan 1 1 5", "m:16: found \"nan\" where a coordinate is expected"},
    {PLY_TEXT, "2 1 1 1 5", "2 1 1 -1 5", "m:16: a list has the length -1"},
    {MSH2_BINARY, "\x01", "\x02", "m: byte 20: found the bytes of 2 where those of 1 are expected"},
    {MSH2_BINARY, "$Nodes\n5", "$Nodes\n1000000000", "points are announced, but the file has only"},
    {MSH4_BINARY, "$EndNodes", "$EndNode_", "m: byte 683: found \"$EndNode_\" where $EndNodes"},
    {PLY_BINARY, "face 2", "face 3", "the file ends where the length of a list is expected"},
    {PLY_BINARY, "face 2", "face 1000000000",
     "1000000000 elements are announced, but the file has"},
};

static const unsigned char *find(mesh_file file, const char *words)
{
  const size_t length = strlen(words);
  for (size_t i = 0; i + length <= file.size; i++)
    if (memcmp(file.at + i, words, length) == 0) return file.at + i;
  ck_abort_msg("the file has no \"%s\"", words);
  return NULL;
}

START_TEST(wrong_files_are_refused_with_their_places)
{
  unsigned char text[4096];
  dvi_mesh *mesh;
  const mesh_file file = file_of_square(refusals[_i].file);
  const char *to = refusals[_i].to;
  const size_t before = (size_t)(find(file, refusals[_i].from) - file.at), put = strlen(to),
               behind = before + strlen(refusals[_i].from);
  memcpy(text, file.at, before);
  memcpy(text + before, to, put);
  memcpy(text + before + put, file.at + behind, file.size - behind);
  const dvi_status status = parse(text, before + put + file.size - behind, NULL, &mesh);
  ck_assert_ptr_null(mesh);
  check_words(refusals[_i].words);
  ck_assert_int_eq(status, strstr(refusals[_i].words, "m: mesh:") != NULL ? DVI_BAD_ARGUMENT
                                                                          : DVI_BAD_FILE);
}
END_TEST

/* Some bytes behind known words are replaced. */
static void check_patched(int i, const char *behind, size_t skip, const void *put, size_t count,
                          const char *words)
{
  unsigned char copy[4096];
  dvi_mesh *mesh;
  const mesh_file file = file_of_square(i);
  memcpy(copy, file.at, file.size);
  const size_t at = (size_t)(find(file, behind) - file.at) + strlen(behind) + skip;
  memcpy(copy + at, put, count);
  ck_assert_int_eq(parse(copy, file.size, NULL, &mesh), DVI_BAD_FILE);
  ck_assert_ptr_null(mesh);
  check_words(words);
}

START_TEST(wrong_binary_numbers_are_refused_with_their_places)
{
  static const unsigned char nan_bytes[] = {0, 0, 0, 0, 0, 0, 0xF8, 0x7F};
  static const unsigned char swapped[] = {0, 0, 0, 1}, big[] = {0, 0xCA, 0x9A, 0x3B, 0, 0, 0, 0};
  static const unsigned char minus[] = {255, 255, 255, 255, 255, 255, 255, 255};
  check_patched(MSH4_BINARY, "4.1 1 8\n", 0, swapped, 4, "m: byte 20: the file is big-endian, and");
  check_patched(MSH4_BINARY, "$Nodes\n", 8, big, 8, "1000000000 points are announced, but the");
  check_patched(MSH4_BINARY, "$Nodes\n", 8, minus, 8, "the number of points is -1");
  check_patched(MSH4_BINARY, "$Elements\n", 0, big, 8, "1000000000 blocks are announced, but the");
  check_patched(MSH4_BINARY, "$Entities\n", 0, big, 8, "1000000000 entities are announced, but");
  check_patched(MSH2_BINARY, "$Nodes\n5\n", 4, nan_bytes, 8, "a coordinate is nan, and must be f");
  check_patched(MSH2_BINARY, "$Elements\n4\n", 4, big, 4, "the number of elements in a block is");
  check_patched(MSH2_BINARY, "$Elements\n4\n", 0, swapped, 4, "element type 16777216 is not known");
  check_patched(PLY_BINARY, "end_header\n", 1, nan_bytes, 8, "a coordinate is nan, and must be f");
  check_patched(PLY_BINARY, "end_header\n", 45, minus, 4, "the point 4294967295, and there is no");
}
END_TEST

/* ---- other meshes ---- */

/* A box whose sides have other orders in the file than in the mesh. */
START_TEST(boxes_have_their_corners_in_bit_order)
{
  static const int box[] = {0, 1, 3, 2, 4, 5, 7, 6};
  int64_t count;
  dvi_mesh *mesh = parsed("$MeshFormat\n2.2 0 8\n$EndMeshFormat\n$PhysicalNames\n2\n0 1 \"top\"\n"
                          "2 1 \"side\"\n$EndPhysicalNames\n$Nodes\n8\n1 0 0 0\n2 2 0 0\n3 2 3 0\n"
                          "4 0 3 0\n5 0 0 4\n6 2 0 4\n7 2 3 4\n8 0 3 4\n$EndNodes\n$Elements\n3\n"
                          "1 5 2 0 1 1 2 3 4 5 6 7 8\n2 3 2 1 1 5 6 7 8\n3 15 2 1 1 7\n"
                          "$EndElements\n",
                          NULL);
  ck_assert_int_eq(dvi_mesh_kind(mesh), DVI_BOXES);
  ck_assert_mem_eq(dvi_mesh_vertices(mesh, 3, NULL), box, sizeof box);
  ck_assert_int_eq(dvi_mesh_orientation(mesh)[0], 1);
  const int *side = dvi_mesh_part_cells(mesh, "side", 0, &count);
  ck_assert(count == 4 && side[0] == 4 && side[3] == 7);
  ck_assert_int_eq(*dvi_mesh_part_cells(mesh, "top", 0, &count), 6);
  dvi_mesh_destroy(&mesh);
}
END_TEST

START_TEST(a_skew_box_is_refused_with_the_file)
{
  static const char text[] = "OFF 4 1 4\n0 0 0\n1 0 0\n2 1 0\n1 1 0\n4 0 1 2 3\n";
  dvi_mesh *mesh;
  ck_assert_int_eq(parse(text, strlen(text), NULL, &mesh), DVI_BAD_ARGUMENT);
  check_words("m: mesh: rectangle 0 (vertices 0 1 3 2) is not rectangular");
}
END_TEST

static const char lines[] = "$MeshFormat\n2.2 0 8\n$EndMeshFormat\n$Nodes\n4\n1 0 0 0\n2 1 0 0\n"
                            "3 2 0 0\n4 7 7 7\n$EndNodes\n$Elements\n2\n1 1 0 1 2\n2 1 0 2 3\n"
                            "$EndElements\n";

START_TEST(space_has_the_coordinates_that_points_need)
{
  static const double metric[] = {1, -1};
  const dvi_mesh_read_options three = {.size = sizeof three, .space = 3},
                              five = {.size = sizeof five, .space = 5},
                              plane = {.size = sizeof plane, .space = 2, .metric = metric};
  dvi_mesh *mesh = parsed(lines, NULL);
  ck_assert_int_eq(dvi_mesh_space(mesh), 1);
  ck_assert_int_eq(dvi_mesh_count(mesh, 0), 3);
  dvi_mesh_destroy(&mesh);
  mesh = parsed(lines, &three);
  ck_assert_int_eq(dvi_mesh_space(mesh), 3);
  dvi_mesh_destroy(&mesh);
  mesh = parsed(lines, &five);
  ck_assert_double_eq(dvi_mesh_points(mesh)[10], 2);
  ck_assert_double_eq(dvi_mesh_points(mesh)[14], 0);
  dvi_mesh_destroy(&mesh);
  mesh = parsed(lines, &plane);
  dvi_mesh_destroy(&mesh);
}
END_TEST

START_TEST(space_keeps_coordinates_that_are_not_zero)
{
  static const char text[] = "OFF 3 1 0\n0 0 0\n1 0 0\n0 1 0.5\n3 0 1 2\n";
  const dvi_mesh_read_options plane = {.size = sizeof plane, .space = 2};
  dvi_mesh *mesh = parsed(text, NULL);
  ck_assert_int_eq(dvi_mesh_space(mesh), 3);
  dvi_mesh_destroy(&mesh);
  ck_assert_int_eq(parse(text, strlen(text), &plane, &mesh), DVI_BAD_FILE);
  check_words("m:4: the coordinate z of the point 2 is 0.5, but 2 coordinates are wanted");
}
END_TEST

START_TEST(a_period_closes_a_line)
{
  static const double period[] = {3};
  static const char closed[] =
      "$MeshFormat\n2.2 0 8\n$EndMeshFormat\n$Nodes\n3\n1 0 0 0\n2 1 0 0\n3 2 0 0\n$EndNodes\n"
      "$Elements\n3\n1 1 0 1 2\n2 1 0 2 3\n3 1 0 3 1\n$EndElements\n";
  const dvi_mesh_read_options options = {.size = sizeof options, .space = 1, .period = period};
  int64_t betti[2];
  dvi_mesh *mesh = parsed(closed, &options);
  ck_assert_int_eq(dvi_mesh_betti(mesh, betti), DVI_OK);
  ck_assert(betti[0] == 1 && betti[1] == 1);
  dvi_mesh_destroy(&mesh);
}
END_TEST

/* Gmsh writes an element in two groups twice into version 2.2. */
START_TEST(a_cell_in_two_groups_is_one_cell)
{
  static const char head[] = "$MeshFormat\n2.2 0 8\n$EndMeshFormat\n$Nodes\n4\n1 0 0 0\n2 1 0 0\n"
                             "3 0 1 0\n4 1 1 0\n$EndNodes\n$Elements\n3\n1 2 1 4 1 2 3\n"
                             "2 2 1 4 2 4 3\n";
  char text[400];
  int64_t count;
  (void)snprintf(text, sizeof text, "%s3 2 1 6 2 3 1\n$EndElements\n", head);
  dvi_mesh *mesh = parsed(text, NULL);
  ck_assert_int_eq(dvi_mesh_count(mesh, 2), 2);
  (void)dvi_mesh_part_cells(mesh, "group 4", 2, &count);
  ck_assert_int_eq(count, 2);
  ck_assert_int_eq(*dvi_mesh_part_cells(mesh, "group 6", 2, &count), 0);
  ck_assert_int_eq(count, 1);
  dvi_mesh_destroy(&mesh);
  (void)snprintf(text, sizeof text, "%s3 2 1 4 2 3 1\n$EndElements\n", head);
  ck_assert_int_eq(parse(text, strlen(text), NULL, &mesh), DVI_BAD_FILE);
  check_words("m:15: a triangle is given twice in the group 4");
}
END_TEST

START_TEST(unnamed_groups_of_two_degrees_have_two_names)
{
  int64_t count;
  dvi_mesh *mesh = parsed("$MeshFormat\n2.2 0 8\n$EndMeshFormat\n$Nodes\n3\n1 0 0 0\n2 1 0 0\n"
                          "3 0 1 0\n$EndNodes\n$Elements\n2\n1 2 1 4 1 2 3\n2 1 1 4 2 3\n"
                          "$EndElements\n",
                          NULL);
  ck_assert_ptr_nonnull(dvi_mesh_part_cells(mesh, "group 4", 2, &count));
  ck_assert_int_eq(*dvi_mesh_part_cells(mesh, "group 4 of degree 1", 1, &count), 2);
  dvi_mesh_destroy(&mesh);
}
END_TEST

START_TEST(sides_of_another_kind_are_refused)
{
  static const char text[] = "$MeshFormat\n2.2 0 8\n$EndMeshFormat\n$Nodes\n5\n1 0 0 0\n2 1 0 0\n"
                             "3 0 1 0\n4 0 0 1\n5 1 1 0\n$EndNodes\n$Elements\n2\n1 4 0 1 2 3 4\n"
                             "2 3 1 4 1 2 5 3\n$EndElements\n";
  dvi_mesh *mesh;
  ck_assert_int_eq(parse(text, strlen(text), NULL, &mesh), DVI_BAD_FILE);
  check_words("m:15: a quadrangle is in a group, but the cells of the mesh are tetrahedra");
}
END_TEST

START_TEST(a_file_without_cells_is_refused)
{
  static const char text[] = "$MeshFormat\n2.2 0 8\n$EndMeshFormat\n$Nodes\n1\n1 0 0 0\n$EndNodes\n"
                             "$Elements\n1\n1 15 0 1\n$EndElements\n";
  dvi_mesh *mesh;
  ck_assert_int_eq(parse(text, strlen(text), NULL, &mesh), DVI_BAD_FILE);
  check_words("m:12: the file has no cells: it needs lines, triangles");
}
END_TEST

START_TEST(entities_come_before_elements)
{
  static const char text[] = "$MeshFormat\n4.1 0 8\n$EndMeshFormat\n$Nodes\n0 0 0 0\n$EndNodes\n"
                             "$Elements\n0 0 0 0\n$EndElements\n$Entities\n";
  dvi_mesh *mesh;
  ck_assert_int_eq(parse(text, strlen(text), NULL, &mesh), DVI_BAD_FILE);
  check_words("m:10: $Entities comes behind $Elements");
}
END_TEST

START_TEST(the_section_of_libdvi_is_checked)
{
  static const struct {
    const char *space, *words;
  } bad[] = {{"cubes 2", "m:5: found \"cubes\" where simplices or boxes are expected"},
             {"boxes 4", "m:5: the number of coordinates is 4, and must be 1 to 3"},
             {"boxes 1 x", "m:5: found \"x\" where the metric of an axis is expected"},
             {"boxes 1 1 nan", "m:5: found \"nan\" where the period of an axis is expected"}};
  for (int i = 0; i < 4; i++) {
    char text[200];
    dvi_mesh *mesh;
    (void)snprintf(text, sizeof text, "$MeshFormat\n4.1 0 8\n$EndMeshFormat\n$DviSpace\n%s\n",
                   bad[i].space);
    ck_assert_int_eq(parse(text, strlen(text), NULL, &mesh), DVI_BAD_FILE);
    check_words(bad[i].words);
  }
}
END_TEST

START_TEST(a_file_without_elements_is_refused)
{
  static const char text[] = "$MeshFormat\n4.1 0 8\n$EndMeshFormat\n$Nodes\n0 0 0 0\n$EndNodes\n";
  dvi_mesh *mesh;
  ck_assert_int_eq(parse(text, strlen(text), NULL, &mesh), DVI_BAD_FILE);
  check_words("the file has no section $Elements");
}
END_TEST

/* ---- arguments ---- */

static const struct {
  dvi_mesh_read_options options;
  dvi_status status;
  const char *words;
} bad_options[] = {
    {{.size = 1}, DVI_BAD_ARGUMENT, "set options.size to sizeof(dvi_mesh_read_options)"},
    {{.size = sizeof(dvi_mesh_read_options), .format = "stl"}, DVI_BAD_OPTION, "no format \"stl\""},
    {{.size = sizeof(dvi_mesh_read_options), .format = "off"}, DVI_BAD_FILE, "where OFF is expect"},
    {{.size = sizeof(dvi_mesh_read_options), .space = 9},
     DVI_BAD_OPTION,
     "space is 9, and must be"},
    {{.size = sizeof(dvi_mesh_read_options), .space = -1}, DVI_BAD_OPTION, "space is -1"},
    {{.size = sizeof(dvi_mesh_read_options), .space = 1}, DVI_BAD_FILE, "the coordinate y of the"},
    {{.size = sizeof(dvi_mesh_read_options), .period = (double[]){1}},
     DVI_BAD_OPTION,
     "a metric and periods need `space`"},
};

START_TEST(bad_options_are_refused)
{
  const mesh_file file = file_of_square(MSH2_TEXT);
  dvi_mesh *mesh;
  ck_assert_int_eq(parse(file.at, file.size, &bad_options[_i].options, &mesh),
                   bad_options[_i].status);
  ck_assert_ptr_null(mesh);
  check_words(bad_options[_i].words);
}
END_TEST

START_TEST(missing_files_are_refused)
{
  dvi_mesh *mesh;
  ck_assert_int_eq(dvi_mesh_read(path_in_folder("none"), NULL, &mesh), DVI_IO_ERROR);
  check_words("cannot open");
  ck_assert_int_eq(dvi_mesh_read(path_in_folder(""), NULL, &mesh), DVI_IO_ERROR);
  check_words("cannot read");
  ck_assert_int_eq(dvi_mesh_read(NULL, NULL, &mesh), DVI_BAD_ARGUMENT);
  ck_assert_int_eq(dvi_mesh_read("m", NULL, NULL), DVI_BAD_ARGUMENT);
}
END_TEST

SUITE(files)
{
  tcase_add_checked_fixture(tests, make_folder, remove_folder);
  tcase_add_loop_test(tests, all_formats_have_the_same_mesh, 0, MESH_FILES);
  tcase_add_loop_test(tests, a_cut_file_is_refused_unless_nothing_needed_is_cut, 0, MESH_FILES);
  tcase_add_loop_test(tests, a_file_is_read_or_memory_is_missing, 0, MESH_FILES);
  tcase_add_test(tests, numbers_are_the_same_with_a_decimal_comma);
  tcase_add_loop_test(tests, wrong_files_are_refused_with_their_places, 0,
                      sizeof refusals / sizeof *refusals);
  tcase_add_test(tests, wrong_binary_numbers_are_refused_with_their_places);
  tcase_add_test(tests, boxes_have_their_corners_in_bit_order);
  tcase_add_test(tests, a_skew_box_is_refused_with_the_file);
  tcase_add_test(tests, space_has_the_coordinates_that_points_need);
  tcase_add_test(tests, space_keeps_coordinates_that_are_not_zero);
  tcase_add_test(tests, a_period_closes_a_line);
  tcase_add_test(tests, a_cell_in_two_groups_is_one_cell);
  tcase_add_test(tests, unnamed_groups_of_two_degrees_have_two_names);
  tcase_add_test(tests, sides_of_another_kind_are_refused);
  tcase_add_test(tests, a_file_without_cells_is_refused);
  tcase_add_test(tests, entities_come_before_elements);
  tcase_add_test(tests, the_section_of_libdvi_is_checked);
  tcase_add_test(tests, a_file_without_elements_is_refused);
  tcase_add_loop_test(tests, bad_options_are_refused, 0, sizeof bad_options / sizeof *bad_options);
  tcase_add_test(tests, missing_files_are_refused);
}
