/* Files that a scene names: in its own folder or below, so that whoever runs a scene of another
 * person knows what it can read. */
#define _XOPEN_SOURCE 700 /* realpath */
#include <dvi/method.h>
#include <errno.h>
#include <limits.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "scene/sections/sections.h"

/* How many characters of a scene's path are its folder and the stroke behind it; 0: it is here. */
static int folder_size(const char *path)
{
  const char *slash = strrchr(path, '/');
  return slash != NULL ? (int)(slash - path) + 1 : 0;
}

/* Of two paths without links. */
static bool lies_below(const char *folder, const char *file)
{
  const size_t size = strcmp(folder, "/") == 0 ? 0 : strlen(folder);
  return strncmp(folder, file, size) == 0 && file[size] == '/';
}

static bool check_place(dvi_scene *scene, dvi__span span, const char *given, const char *path)
{
  char real_folder[PATH_MAX], real_file[PATH_MAX];
  const char *folder = dvi__arena_text(&scene->arena, path,
                                       (size_t)folder_size(scene->source.name));
  if (folder == NULL) return dvi__scene_no_memory(scene);
  if (realpath(folder[0] != '\0' ? folder : ".", real_folder) == NULL ||
      realpath(path, real_file) == NULL)
    return dvi__scene_refuse(scene, span, "the file '%s' cannot be read: %s", path,
                             strerror(errno));
  if (lies_below(real_folder, real_file)) return true;
  return dvi__scene_refuse(
      scene, span,
      "the file '%s' is not in the scene's folder or below; put it there, or give --method", given);
}

bool dvi__scene_place_file(dvi_scene *scene, dvi__span span, const char **method)
{
  size_t length;
  const char *name = scene->source.name, *named = dvi_method_file(*method, &length);
  if (named == NULL) return true;
  const int head = (int)(named - *method), folder = folder_size(name);
  const size_t room = strlen(*method) + (size_t)folder + 1;
  const char *given = dvi__arena_text(&scene->arena, named, length);
  char *path = dvi__arena_take(&scene->arena, room, 1),
       *placed = dvi__arena_take(&scene->arena, room, 1);
  if (given == NULL || path == NULL || placed == NULL) return dvi__scene_no_memory(scene);
  if (given[0] == '/')
    return dvi__scene_refuse(
        scene, span, "the file '%s' is named from the root; name it from the scene's folder",
        given);
  if (memchr(name, ',', (size_t)folder) != NULL)
    return dvi__scene_refuse(
        scene, span, "no method takes the file '%s' from a folder with a comma; rename the folder",
        given);
  (void)snprintf(path, room, "%.*s%s", folder, name, given);
  (void)snprintf(placed, room, "%.*s%s%s", head, *method, path, named + length);
  *method = placed;
  return check_place(scene, span, given, path);
}
