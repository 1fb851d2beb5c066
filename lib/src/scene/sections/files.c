/* Files that a scene names. They must lie in its own folder or below, so that a user of another
 * person's scene knows what it can read. */
#define _XOPEN_SOURCE 700 /* realpath */
#include <dvi/method.h>
#include <errno.h>
#include <limits.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/stat.h>

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

static bool check_place(dvi_scene *scene, dvi__span span, const char *named_file, const char *path,
                        const char *remedy)
{
  char real_folder[PATH_MAX], real_file[PATH_MAX];
  const char *folder = dvi__arena_text(&scene->arena, scene->source.name,
                                       (size_t)folder_size(scene->source.name));
  if (folder == NULL) return dvi__scene_no_memory(scene);
  if (realpath(folder[0] != '\0' ? folder : ".", real_folder) == NULL ||
      realpath(path, real_file) == NULL)
    return dvi__scene_refuse(scene, span, "the file '%s' cannot be read: %s", path,
                             strerror(errno));
  if (lies_below(real_folder, real_file)) return true;
  return dvi__scene_refuse(scene, span,
                           "the file '%s' is not in the scene's folder or below; put it there%s",
                           named_file, remedy);
}

static bool refuse_root(dvi_scene *scene, dvi__span span, const char *named_file)
{
  return named_file[0] != '/' ||
         dvi__scene_refuse(scene, span,
                           "the file '%s' is named from the root; name it from the scene's folder",
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
  if (!refuse_root(scene, span, named_file)) return false;
  if (memchr(name, ',', (size_t)folder) != NULL)
    return dvi__scene_refuse(
        scene, span, "no method takes the file '%s' from a folder with a comma; rename the folder",
        named_file);
  (void)snprintf(path, room, "%.*s%s", folder, name, named_file);
  (void)snprintf(placed, room, "%.*s%s%s", head, *method, path, named + length);
  *method = placed;
  return check_place(scene, span, named_file, path, ", or give --method");
}

/* ---- components ---- */

static bool is_named_as_scene(const char *name)
{
  const char *dot = strrchr(name, '.');
  return dot != NULL && (strcmp(dot, ".yaml") == 0 || strcmp(dot, ".yml") == 0);
}

/* Return true if a name leads upwards, by a part that is two points. */
static bool leads_up(const char *name)
{
  for (const char *at = strstr(name, ".."); at != NULL; at = strstr(at + 1, ".."))
    if ((at == name || at[-1] == '/') && (at[2] == '/' || at[2] == '\0')) return true;
  return false;
}

static bool is_plain_file(const char *path)
{
  struct stat there;
  return stat(path, &there) == 0 && S_ISREG(there.st_mode);
}

/* Find a file from the folder of the file in which its name stands. */
static bool place_beside(dvi_scene *scene, dvi__span span, const char *named_file,
                         const char **path)
{
  const char *includes = dvi__source_name(&scene->source, span.first);
  const int folder = folder_size(includes);
  const size_t room = strlen(named_file) + (size_t)folder + 1;
  char *placed = dvi__arena_take(&scene->arena, room, 1);
  if (placed == NULL) return dvi__scene_no_memory(scene);
  (void)snprintf(placed, room, "%.*s%s", folder, includes, named_file);
  *path = placed;
  if (!refuse_root(scene, span, named_file)) return false;
  if (leads_up(named_file))
    return dvi__scene_refuse(scene, span,
                             "the file '%s' is named by way of '..'; such files lie in the folder "
                             "of the scene or below",
                             named_file);
  if (!check_place(scene, span, named_file, placed, "")) return false;
  return is_plain_file(placed) ||
         dvi__scene_refuse(scene, span, "'%s' is no file that can be read", named_file);
}

bool dvi__scene_place_component(dvi_scene *scene, dvi__span span, const char *named_file,
                                const char **path)
{
  if (named_file[0] == '/' || leads_up(named_file) || is_named_as_scene(named_file))
    return place_beside(scene, span, named_file, path);
  return dvi__scene_refuse(scene, span, "'%s' is no scene: its name ends in .yaml or .yml",
                           named_file);
}

bool dvi__scene_place_mesh(dvi_scene *scene, dvi__span span, const char *named_file,
                           const char **path)
{
  return place_beside(scene, span, named_file, path);
}
