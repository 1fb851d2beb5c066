#define _POSIX_C_SOURCE 200809L
#include "load/open_mesh.h"

#include <math.h>
#include <stdio.h>
#include <string.h>
#include <unistd.h>

#include "cli/command.h"
#include "cli/numbers.h"
#include "cli/spelling.h"
#include "module/ranks.h"
#include "module/store.h"

enum { HINT_SIZE = 96 };

static bool is_generator(const char *name)
{
  for (int i = 0; dvi_mesh_generator_name(i) != NULL; i++)
    if (strcmp(dvi_mesh_generator_name(i), name) == 0) return true;
  return false;
}

/* Read up to four numbers above `least` with commas between them. Returns DONE, or complains. */
static int read_list(const char *command, const char *key, const char *text, double least,
                     double list[4])
{
  char copy[256];
  if (text == NULL) return DONE;
  (void)snprintf(copy, sizeof copy, "%s", text);
  int count = 0;
  for (char *item = copy, *next; item != NULL; item = next) {
    next = strchr(item, ',');
    if (next != NULL) *next++ = '\0';
    if (count == 4 || strlen(text) >= sizeof copy || !parse_number(item, &list[count++]))
      return usage_error("%s: --%s %s: one to four numbers are wanted, with commas between them",
                         command, key, text);
    if (!(list[count - 1] > least))
      return usage_error("%s: --%s %s: %g is not above %g", command, key, text, list[count - 1],
                         least);
  }
  return DONE;
}

/* Read whole numbers from `least` on. */
static int read_whole_list(const char *command, const char *key, const char *text, int least,
                           int whole[4])
{
  double list[4] = {0, 0, 0, 0};
  const int code = read_list(command, key, text, least - 1, list);
  for (int i = 0; i < 4 && code == DONE; i++) {
    if (list[i] != floor(list[i]) || fabs(list[i]) > 1e9)
      return usage_error("%s: --%s %s: %g is no whole number", command, key, text, list[i]);
    whole[i] = (int)list[i];
  }
  return code;
}

static int generate(const char *command, const mesh_sizes *r, const char *name, dvi_mesh **mesh)
{
  dvi_generator_options options = {.size = sizeof options};
  int code = read_whole_list(command, "cells", r->cells, 1, options.cells);
  if (code == DONE) code = read_whole_list(command, "periodic", r->periodic, 0, options.periodic);
  if (code == DONE) code = read_list(command, "size", r->size, 0, options.extent);
  if (code == DONE) code = read_list(command, "origin", r->origin, -INFINITY, options.origin);
  if (code == DONE) code = read_list(command, "grading", r->grading, 0, options.grading);
  if (code != DONE) return code;
  const dvi_status status = dvi_mesh_generate(name, &options, mesh);
  return status == DVI_OK ? DONE : library_error(status);
}

static const char *generator_at(int k, const void *list)
{
  (void)list;
  return dvi_mesh_generator_name(k);
}

int open_mesh(const char *command, const mesh_sizes *r, const char *name, dvi_mesh **mesh)
{
  if (is_generator(name)) return generate(command, r, name, mesh);
  if (r->cells || r->size || r->origin || r->grading || r->periodic)
    return usage_error("%s: '%s' is no generator, and a file takes no --cells, --size and so on",
                       command, name);
  if (strchr(name, '.') == NULL && access(name, F_OK) != 0) {
    char hint[HINT_SIZE];
    return usage_error("%s: '%s' is neither a file nor a generator%s", command, name,
                       suggestion(name, generator_at, NULL, hint, sizeof hint));
  }
  if (store_is_wanted(name)) return ranks_read_mesh(name, mesh);
  const dvi_status status = dvi_mesh_read(name, NULL, mesh);
  return status == DVI_OK ? DONE : library_error(status);
}
