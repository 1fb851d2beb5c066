#include "watch/line_values.h"

#include <stdlib.h>
#include <string.h>

#include "cli/command.h"
#include "module/ranks.h"

static bool is_own(const line_values *line, int64_t vertex)
{
  return dvi_mesh_share_owners(line->mesh, 0)[vertex] == ranks_number();
}

/* Make room for the messages, each of which is as long as the longest one. */
static bool make_room(line_values *line)
{
  int own = 0, all = 0;
  for (int64_t v = 0; v < dvi_mesh_count(line->mesh, 0); v++) own += is_own(line, v);
  line->numbers = 1 + 2 * (size_t)ranks_largest(own);
  line->own = calloc(line->numbers, sizeof *line->own);
  line->all = calloc(line->numbers * (size_t)ranks_count(), sizeof *line->all);
  const bool good = line->own != NULL && line->all != NULL;
  if (!good) complain("out of memory");
  if (ranks_agree(good ? DONE : FAILED) != DONE || line->own == NULL || line->all == NULL)
    return false;
  line->own[0] = own;
  if (!ranks_gather(line->own, line->numbers * sizeof *line->own, line->all)) return false;
  for (int r = 0; r < ranks_count(); r++) all += (int)line->all[(size_t)r * line->numbers];
  line->vertices = all;
  return true;
}

bool line_values_start(line_values *line, const dvi_mesh *mesh)
{
  *line = (line_values){.mesh = mesh, .vertices = dvi_mesh_count(mesh, 0)};
  return dvi_mesh_share_owners(mesh, 0) == NULL || make_room(line);
}

void line_values_clear(line_values *line)
{
  free(line->own);
  free(line->all);
}

bool line_values_gather(line_values *line, const double *value, double *whole)
{
  const int64_t *number = dvi_mesh_share_numbers(line->mesh, 0);
  if (line->own == NULL) {
    memcpy(whole, value, (size_t)line->vertices * sizeof *whole);
    return true;
  }
  double *next = line->own + 1;
  for (int64_t v = 0; v < dvi_mesh_count(line->mesh, 0); v++) {
    if (!is_own(line, v)) continue;
    *next++ = (double)number[v];
    *next++ = value[v];
  }
  if (!ranks_gather(line->own, line->numbers * sizeof *line->own, line->all)) return false;
  for (int r = 0; r < ranks_count(); r++) {
    const double *given = line->all + (size_t)r * line->numbers;
    for (size_t i = 0; i < (size_t)given[0]; i++)
      whole[(int64_t)given[1 + 2 * i]] = given[2 + 2 * i];
  }
  return true;
}
