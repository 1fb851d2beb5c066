#include "frames/frames.h"

#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "cli/command.h"
#include "module/ranks.h"

enum { DIGITS = 12 };

static const char ending[] = ".pvd", ending_of_one[] = ".vtkhdf";

static bool ends_with(const char *path, const char *end)
{
  const size_t length = strlen(path), behind = strlen(end);
  return length > behind && strcmp(path + length - behind, end) == 0;
}

int frames_start(frame_list *frames, const char *scene, const dvi_mesh *mesh, const char *path)
{
  if (path == NULL) return DONE;
  if (!ends_with(path, ending) && !ends_with(path, ending_of_one))
    return usage_error("run: --pvd %s: the name ends in .pvd or .vtkhdf", path);
  if (mesh == NULL && ranks_is_first())
    return usage_error("run: --pvd is for fields on meshes, and %s has none", scene);
  frames->mesh = mesh;
  if (ranks_is_first() && ends_with(path, ending_of_one) && store_module(path) == NULL)
    return FAILED;
  frames->path = path;
  return DONE;
}

void frames_move(frame_list *frames, const dvi_mesh *mesh, const double *point)
{
  frames->mesh = mesh;
  frames->point = point;
}

bool frames_are_wanted(const frame_list *frames)
{
  return frames->path != NULL;
}

/* Tell if all processes write views of their shares together. Otherwise the first one, or the only
 * one, has all of them. */
static bool is_shared(const frame_list *frames)
{
  return frames->mesh != NULL && dvi_mesh_share_owners(frames->mesh, 0) != NULL;
}

/* Make room for one more file. */
static bool frames_grow(frame_list *frames)
{
  if (frames->count < frames->room) return true;
  const int room = 2 * frames->room + 16;
  double *time = realloc(frames->time, (size_t)room * sizeof *time);
  if (time != NULL) frames->time = time;
  char **name = time != NULL ? realloc(frames->name, (size_t)room * sizeof *name) : NULL;
  if (name != NULL) frames->name = name;
  if (name == NULL) {
    complain("out of memory");
    return false;
  }
  frames->room = room;
  return true;
}

/* Name the next file, from the folder of the list. */
static char *next_name(const frame_list *frames)
{
  const char *slash = strrchr(frames->path, '/'), *base = slash != NULL ? slash + 1 : frames->path;
  const size_t stem = strlen(base) - (sizeof ending - 1), size = stem + DIGITS + sizeof "_.vtu";
  char *name = malloc(size);
  if (name == NULL)
    complain("out of memory");
  else
    (void)snprintf(name, size, "%.*s_%06d.vtu", (int)stem, base, frames->count);
  return name;
}

/* List the next file. Returns its path, to be freed, or NULL without memory. */
static char *next_path(frame_list *frames, double t)
{
  char *name = frames_grow(frames) ? next_name(frames) : NULL;
  if (name == NULL) return NULL;
  const char *slash = strrchr(frames->path, '/');
  const int folder = slash != NULL ? (int)(slash - frames->path) + 1 : 0;
  char *path = malloc((size_t)folder + strlen(name) + 1);
  frames->time[frames->count] = t;
  frames->name[frames->count++] = name;
  if (path != NULL)
    (void)sprintf(path, "%.*s%s", folder, frames->path, name);
  else
    complain("out of memory");
  return path;
}

/* Write views as the next file of the list. */
static bool add_file(frame_list *frames, double t, int views, const dvi_view *view)
{
  char *path = next_path(frames, t);
  const int code = path != NULL ? DONE : FAILED;
  if ((is_shared(frames) ? ranks_agree(code) : code) != DONE) {
    free(path);
    return false;
  }
  const dvi_status status = stored_views_write(frames->mesh, frames->point, path, views, view);
  free(path);
  return status == DVI_OK || library_error(status) == DONE;
}

bool frames_add(frame_list *frames, double t, int views, const dvi_view *view)
{
  const frame_place place = {frames->path, frames->head, frames->point, t};
  bool good = true;
  if (is_shared(frames) || ranks_is_first())
    good = ends_with(frames->path, ending_of_one)
               ? stored_views_add(&frames->stored, &place, frames->mesh, views, view)
               : add_file(frames, t, views, view);
  return ranks_agree(good ? DONE : FAILED) == DONE;
}

bool frames_keep(frame_list *frames)
{
  if (frames->path == NULL) return true;
  if (ends_with(frames->path, ending_of_one))
    return stored_views_close(&frames->stored, frames->path);
  const dvi_status status = dvi_series_write(frames->path, frames->count, frames->time,
                                             (const char *const *)frames->name);
  return status == DVI_OK || library_error(status) == DONE;
}

void frames_clear(frame_list *frames)
{
  for (int i = 0; i < frames->count; i++) free(frames->name[i]);
  free(frames->name);
  free(frames->time);
  (void)stored_views_close(&frames->stored, frames->path);
}
