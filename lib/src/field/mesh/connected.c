#include "field/mesh/connected.h"

/* Return the first vertex of a set, and shorten the ways to it. */
static int root_of(int *parent, int v)
{
  while (parent[v] != v) v = parent[v] = parent[parent[v]];
  return v;
}

static void join(int *parent, int a, int b)
{
  const int first = root_of(parent, a), second = root_of(parent, b);
  parent[first > second ? first : second] = first < second ? first : second;
}

void dvi__find_components(const dvi_mesh *mesh, int *root)
{
  for (int v = 0; v < mesh->count[0]; v++) root[v] = v;
  for (int64_t e = 0; e < mesh->count[1]; e++)
    join(root, mesh->corner[1][2 * e], mesh->corner[1][2 * e + 1]);
  for (int v = 0; v < mesh->count[0]; v++) root[v] = root_of(root, v);
}
