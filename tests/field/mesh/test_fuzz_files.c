/* Any bytes make a mesh, or no mesh and a sentence. */
#include <string.h>

#include "field/mesh/file/formats.h"
#include "support/mesh_files.h"
#include "support/scene/fuzz.h"

static const char *const tokens[] = {"$MeshFormat\n2.2 0 8\n$EndMeshFormat\n",
                                     "$MeshFormat\n4.1 0 8\n$EndMeshFormat\n",
                                     "$Nodes\n",
                                     "$EndNodes\n",
                                     "$Elements\n",
                                     "$EndElements\n",
                                     "$PhysicalNames\n1\n2 1 \"a\"\n",
                                     "$EndPhysicalNames\n",
                                     "$Entities\n",
                                     "$EndEntities\n",
                                     "$DviSpace\nboxes 2\n1 1\n0 3\n",
                                     "$EndDviSpace\n",
                                     "$X\n$EndX\n",
                                     "OFF\n",
                                     "ply\n",
                                     "format ascii 1.0\n",
                                     "format binary_little_endian 1.0\n",
                                     "element vertex 3\n",
                                     "element face 1\n",
                                     "property list uchar int vertex_indices\n",
                                     "property double x\n",
                                     "property float y\n",
                                     "end_header\n",
                                     " 0",
                                     " 1",
                                     " 2",
                                     " 3",
                                     " 4",
                                     " 5",
                                     " 15",
                                     " -1",
                                     " 10",
                                     " 20",
                                     " 1e300",
                                     " nan",
                                     " 1e400",
                                     " 1000000000",
                                     " 9223372036854775807",
                                     " 0.5",
                                     "\n",
                                     "#",
                                     "\"",
                                     "\x01",
                                     NULL};

/* What a file has stands in quotes, and is no new outcome. */
static unsigned hash_of_sentence(const char *sentence)
{
  const char *first = strchr(sentence, '"'), *last = strrchr(sentence, '"');
  if (first == NULL) return fuzz_hash(sentence);
  char before[1024] = "";
  memcpy(before, sentence, (size_t)(first - sentence));
  return fuzz_hash(before) * 31 + fuzz_hash(last);
}

static unsigned try_file(const char *text, size_t size)
{
  dvi_mesh *mesh = NULL;
  const dvi_status status = dvi__mesh_parse("f", (const unsigned char *)text, size, NULL, &mesh);
  fuzz_requires((status == DVI_OK) == (mesh != NULL));
  unsigned outcome = (unsigned)dvi_mesh_dimension(mesh);
  if (status != DVI_OK) {
    const char *sentence = dvi_last_error();
    fuzz_requires(sentence[0] == 'f' && strlen(sentence) > 8);
    outcome = hash_of_sentence(sentence);
  }
  dvi_mesh_destroy(&mesh);
  return outcome;
}

START_TEST(any_bytes_make_a_mesh_or_a_sentence)
{
  const char *corpus[MESH_FILES + 1] = {NULL};
  size_t size[MESH_FILES];
  for (int i = 0; i < MESH_FILES; i++) {
    const mesh_file file = file_of_square(i);
    corpus[i] = (const char *)file.at;
    size[i] = file.size;
  }
  ck_assert_int_gt(fuzz(&(fuzz_target){"mesh", corpus, tokens, try_file, size}), 0);
}
END_TEST

SUITE(fuzz_files)
{
  tcase_set_timeout(tests, fuzz_timeout());
  tcase_add_test(tests, any_bytes_make_a_mesh_or_a_sentence);
}
