#include "cli/outputs.h"

#include <stdbool.h>
#include <stddef.h>
#include <string.h>

#include "cli/command.h"
#include "cli/file.h"

static bool names_file(const named_file *file)
{
  return file->path != NULL && strcmp(file->path, "-") != 0;
}

int outputs_distinct(const char *command, int count, const named_file *files)
{
  for (int i = 0; i < count; i++)
    for (int j = i + 1; j < count; j++)
      if (names_file(&files[i]) && names_file(&files[j]) && file_same(files[i].path, files[j].path))
        return usage_error("%s: --%s %s and --%s %s are the same file", command, files[i].option,
                           files[i].path, files[j].option, files[j].path);
  return DONE;
}

int outputs_plot(const char *command, const char *option, const char *path)
{
  static const char ending[] = ".svg";
  const size_t length = path != NULL ? strlen(path) : 0;
  if (path == NULL ||
      (length >= strlen(ending) && strcmp(path + length - strlen(ending), ending) == 0))
    return DONE;
  return usage_error("%s: --%s %s: plots are SVG files; give a name that ends in .svg", command,
                     option, path);
}
