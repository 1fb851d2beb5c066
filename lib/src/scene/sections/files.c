/* Files that a scene names. They must lie in its own folder or below, so that a user of another
 * person's scene knows what it can read. */
#define _XOPEN_SOURCE 700 /* realpath */
#include <dvi/method.h>
#include <errno.h>
#include <limits.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "scene/sections/sections.h"

/* Return how many characters of a scene's path are its folder and the stroke behind it. 0 is the
 * current folder. */
static int folder_size(const char *path)
{
  const char *slash = strrchr(path, '/');
  return slash != NULL ? (int)(slash - path) + 1 : 0;
}

/* Return true if a file is below a folder. Both are paths without links. */
static bool lies_below(const char *folder, const char *file)
{
  const size_t size = strcmp(folder, "/") == 0 ? 0 : strlen(folder);
  return strncmp(folder, file, size) == 0 && file[size] == '/';
}

static bool check_place(dvi_scene *scene, dvi__span span, const char *named_file, const char *path)
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
      "the file '%s' is not in the scene's folder or below; put it there, or give --method",
      named_file);
}

bool dvi__scene_place_file(dvi_scene *scene, dvi__span span, const char **method)
{
  size_t length;
  const char *name = scene->source.name, *named = dvi_method_file(*method, &length);
  if (named == NULL) return true;
  const int head = (int)(named - *method), folder = folder_size(name);
  const size_t room = strlen(*method) + (size_t)folder + 1;
  const char *named_file = dvi__arena_text(&scene->arena, named, length);
  char *path = dvi__arena_take(&scene->arena, room, 1),
       *placed = dvi__arena_take(&scene->arena, room, 1);
  if (named_file == NULL || path == NULL || placed == NULL) return dvi__scene_no_memory(scene);
  if (named_file[0] == '/')
    return dvi__scene_refuse(
        scene, span, "the file '%s' is named from the root; name it from the scene's folder",
        named_file);
  if (memchr(name, ',', (size_t)folder) != NULL)
    return dvi__scene_refuse(
        scene, span, "no method takes the file '%s' from a folder with a comma; rename the folder",
        named_file);
  (void)snprintf(path, room, "%.*s%s", folder, name, named_file);
  (void)snprintf(placed, room, "%.*s%s%s", head, *method, path, named + length);
  *method = placed;
  return check_place(scene, span, named_file, path);
}
