#include "load/open_march.h"

#include <dvi/scene.h>
#include <stdbool.h>
#include <stdio.h>
#include <string.h>

#include "cli/command.h"
#include "load/density.h"
#include "load/elastic.h"
#include "load/field.h"
#include "load/open.h"
#include "module/ranks.h"

enum { MESSAGE_SIZE = 2048 };

/* A word of a sentence, and the section that it is about. */
typedef struct subject {
  const char *word, *section;
} subject;

/* Subjects of sentences on steps of densities. */
static const subject of_density[] = {{"do not see values", "space"},
                                     {"does not see values", "space"},
                                     {"one-form", "density"},
                                     {"variable", "density"},
                                     {"no parts", "density"},
                                     {"kinetic part", "density"},
                                     {"bounds the step", "step"},
                                     {"the step ", "step"},
                                     {"method", "method"},
                                     {" option", "method"},
                                     {"weight", "method"},
                                     {"datum", "boundary"},
                                     {"condition", "boundary"},
                                     {"boundary", "boundary"},
                                     {"cells", "space"},
                                     {NULL, NULL}};

/* Subjects of sentences on marches of fields on meshes. */
static const subject of_mesh[] = {{"eps =", "materials"},
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
                                  {"cannot be divided", "mesh"},
                                  {"the start", "initial"},
                                  {"the step ", "step"},
                                  {"common step", "step"},
                                  {"fraction", "step"},
                                  {" option", "method"},
                                  {" is for ", "method"},
                                  {"simplices of", "method"},
                                  {"the star", "star"},
                                  {"not diagonal", "star"},
                                  {"has a potential", "method"},
                                  {NULL, NULL}};

/* Subjects of sentences on marches of solids. */
static const subject of_solid[] = {
    {"steps of", "step"},  {"obstacle", "obstacles"},    {"the step", "step"},
    {"a step", "step"},    {"common step", "step"},      {"fraction", "step"},
    {" option", "method"}, {"no method", "method"},      {"inverted", "initial"},
    {"beta", "materials"}, {"displacement", "boundary"}, {NULL, NULL}};

/* Return the section of the scene that a sentence of the library is about, or NULL. A step and a
 * method that the options have are not the scene's. */
static const char *section_of(const char *sentence, const subject *at,
                              const dvi_march_options *options)
{
  for (; at->word != NULL; at++) {
    if (strstr(sentence, at->word) == NULL) continue;
    const bool is_step = strcmp(at->section, "step") == 0,
               is_method = strcmp(at->section, "method") == 0;
    if ((is_step && (options->step > 0 || options->fraction > 0)) ||
        (is_method && options->method != NULL))
      return NULL;
    return at->section;
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
  const subject *subjects = density_of(scene) != NULL   ? of_density
                            : elastic_of(scene) != NULL ? of_solid
                                                        : of_mesh;
  const char *sentence = dvi_last_error(), *section = section_of(sentence, subjects, options);
  const char *method = options->method != NULL ? options->method : scene->method;
  const char *reason = dvi_scene_march_refused(scene->scene, method, &section);
  if (reason != NULL) {
    sentence = reason;
  } else if (scene->terms->damping > 0) {
    section = "damping";
    sentence = ranks_count() > 1
                   ? "processes share no damping of waves: a conductor has 'sigma', and verlet "
                     "takes the friction in one process"
                   : "marches of fields have no damping; a conductor has 'sigma', and mechanical "
                     "methods such as verlet take the friction";
  } else if (status == DVI_UNSUPPORTED && ranks_count() > 1 && strcmp(method, "yee") == 0 &&
             strncmp(sentence, "yee", 3) != 0) {
    sentence = "several processes share yee on grids alone, without probes of parts and a start by "
               "A: take leapfrog, or leave mpirun out";
    if (options->method != NULL) return usage_error("--method yee: %s", sentence);
    section = "method";
  } else if (status == DVI_UNSUPPORTED && ranks_count() == 1 && is_yee_on_mesh(scene, method)) {
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
  const bool has_step = density_of(scene) != NULL && scene->h > 0;
  const dvi_march_options options = {.size = sizeof options,
                                     .method = method,
                                     .step = has_step ? scene->h : 0,
                                     .fraction = has_step ? 0 : 0.5,
                                     .potential = 1};
  dvi_march *march = NULL;
  if (!march_has_step(method))
    return usage_error("%s: tents have no common step, so that order and bench do not take them; "
                       "take leapfrog or avi",
                       command);
  const int code = open_march(scene, &options, &march);
  dvi_march_destroy(&march);
  if (code != DONE || dvi_scene_march_order(scene->scene, method) > 0) return code;
  return usage_error("%s: short steps of %s do not tend to the motion of the space's own mass, to "
                     "which they are compared; take space=exact with fem:degree=1, or "
                     "space=trapezoid with lumped=yes, and a start without t",
                     command, method);
}
