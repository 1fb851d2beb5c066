#include "load/open_march.h"

#include <dvi/scene.h>
#include <stdbool.h>
#include <stdio.h>
#include <string.h>

#include "cli/command.h"
#include "load/field.h"
#include "load/open.h"

enum { MESSAGE_SIZE = 2048 };

/* Return the section of the scene that a sentence of the library is about, or NULL. A step and a
 * method that the options have are not the scene's. */
static const char *section_of(const char *sentence, const dvi_march_options *options)
{
  static const struct {
    const char *word, *section;
  } list[] = {{"eps =", "materials"},
              {"mu =", "materials"},
              {"sigma =", "materials"},
              {"function of eps", "materials"},
              {"function of mu", "materials"},
              {"function of sigma", "materials"},
              {"dipole", "sources"},
              {"wave", "sources"},
              {"signal", "sources"},
              {"current", "sources"},
              {"a source", "sources"},
              {"probe", "probes"},
              {"flux ", "probes"},
              {"layers", "boundary"},
              {"phase", "boundary"},
              {"repeats", "boundary"},
              {"conductors", "boundary"},
              {"ascend", "mesh"},
              {"the start", "initial"},
              {"the step ", "step"},
              {"common step", "step"},
              {"fraction", "step"},
              {" option", "method"},
              {" is for ", "method"},
              {"simplices of", "method"},
              {"the star", "star"}};
  for (size_t i = 0; i < sizeof list / sizeof *list; i++) {
    if (strstr(sentence, list[i].word) == NULL) continue;
    const bool is_step = strcmp(list[i].section, "step") == 0,
               is_method = strcmp(list[i].section, "method") == 0;
    if ((is_step && (options->step > 0 || options->fraction > 0)) ||
        (is_method && options->method != NULL))
      return NULL;
    return list[i].section;
  }
  return NULL;
}

static bool is_yee_on_mesh(const problem *scene, const char *method)
{
  const dvi_field *field = dvi_scene_field(scene->scene);
  return method != NULL && strcmp(method, "yee") == 0 && field != NULL &&
         dvi_mesh_kind(field_mesh(field)) == DVI_BOXES;
}

/* What the scene asks for is a mistake of the scene's text. */
static int refuse(dvi_status status, const problem *scene, const dvi_march_options *options)
{
  char message[MESSAGE_SIZE] = "";
  const char *sentence = dvi_last_error(), *section = section_of(sentence, options);
  const char *method = options->method != NULL ? options->method : scene->method;
  if (scene->terms->damping > 0) {
    section = "damping";
    sentence = "marches of fields have no damping; a conductor has 'sigma', and mechanical methods "
               "such as verlet take the friction";
  } else if (status == DVI_UNSUPPORTED && is_yee_on_mesh(scene, method)) {
    section = "star";
    sentence = "yee has no star: leave it out, or take leapfrog";
  }
  /* of a callback that failed the scene knows the place better */
  if (status == DVI_NO_MEMORY || status == DVI_CALLBACK_FAILED || section == NULL)
    return library_error(status);
  dvi_scene_tell(scene->scene, section, sentence, message, sizeof message);
  return usage_error("%s", message);
}

/* A grid without a mesh has what no other method knows, or is too large for a mesh. */
static int refuse_method(const problem *scene, const char *method, bool is_own)
{
  char sentence[MESSAGE_SIZE], message[MESSAGE_SIZE] = "";
  char reason[MESSAGE_SIZE / 2] = "yee has no options";
  if (strncmp(method, "yee:", 4) != 0) grid_sentence(scene, true, reason, sizeof reason);
  (void)snprintf(sentence, sizeof sentence, "%s: %s", method, reason);
  if (!is_own) return usage_error("--method %s", sentence);
  dvi_scene_tell(scene->scene, "method", sentence, message, sizeof message);
  return usage_error("%s", message);
}

int open_march(const problem *scene, const dvi_march_options *options, dvi_march **march)
{
  const char *method = options->method != NULL ? options->method : scene->method;
  dvi_march_options asked = *options;
  if (method != NULL && scene->method != NULL && strcmp(method, scene->method) == 0)
    asked.method = NULL;
  const dvi_status status = dvi_scene_march_create(scene->scene, &asked, march);
  if (status == DVI_OK) return DONE;
  if (method != NULL && dvi_scene_grid_only(scene->scene) != NULL && strcmp(method, "yee") != 0)
    return refuse_method(scene, method, asked.method == NULL);
  return refuse(status, scene, &asked);
}

bool march_has_step(const char *method)
{
  return strncmp(method, "tents", 5) != 0 || (method[5] != '\0' && method[5] != ':');
}

int check_studied_march(const char *command, const problem *scene, const char *method)
{
  const dvi_march_options options = {
      .size = sizeof options, .method = method, .fraction = 0.5, .potential = 1};
  dvi_march *march = NULL;
  if (!march_has_step(method))
    return usage_error("%s: tents have no common step, so that order and bench do not take them; "
                       "take leapfrog or avi",
                       command);
  const int code = open_march(scene, &options, &march);
  dvi_march_destroy(&march);
  return code;
}
