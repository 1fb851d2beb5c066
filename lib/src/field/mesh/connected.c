#include "field/mesh/connected.h"

int dvi__root_of(int *parent, int i)
{
  while (parent[i] != i) i = parent[i] = parent[parent[i]];
  return i;
}

int dvi__join(int *parent, int a, int b)
{
  const int first = dvi__root_of(parent, a), second = dvi__root_of(parent, b);
  parent[first > second ? first : second] = first < second ? first : second;
  return first != second;
}

void dvi__find_components(const dvi_mesh *mesh, int *root)
{
  for (int v = 0; v < mesh->count[0]; v++) root[v] = v;
  for (int64_t e = 0; e < mesh->count[1]; e++)
    (void)dvi__join(root, mesh->corner[1][2 * e], mesh->corner[1][2 * e + 1]);
  for (int v = 0; v < mesh->count[0]; v++) root[v] = dvi__root_of(root, v);
}
